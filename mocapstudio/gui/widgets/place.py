"""A part of the desk that waits for the view that fills it."""

from __future__ import annotations

from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QMoveEvent
from PySide6.QtWidgets import QFrame, QVBoxLayout, QWidget

from mocapstudio.gui.widgets.parts import label


class Place(QFrame):
    """Says that something is loading until it is put there."""

    def __init__(self) -> None:
        super().__init__()
        self.setProperty("role", "panel")
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._waiting = label("Loading…", "faint", "loading")
        self._waiting.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._column.addWidget(self._waiting)

    def put(self, view: QWidget) -> None:
        """Fill the place."""
        self._column.removeWidget(self._waiting)
        self._waiting.hide()
        self._column.addWidget(view)

    def moveEvent(self, event: QMoveEvent) -> None:
        """Take views with windows of their own along.

        Qt moves such a window only when the view itself changes, not when what it lies in moves.
        """
        super().moveEvent(event)
        for view in self.findChildren(QWidget):
            window = view.windowHandle()
            parent = view.nativeParentWidget()
            if window is not None and parent is not None and not view.isWindow():
                window.setPosition(view.mapTo(parent, QPoint(0, 0)))
