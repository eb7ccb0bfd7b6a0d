"""A view in a native window of its own."""

from __future__ import annotations

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QMoveEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget


class NativeView(QWidget):
    """Fills its parent, and spares the desk from compositing itself whenever it is painted.

    Where the window system is slow to tell of two moves in a row, Qt takes the first, reported
    late, for one of the user's, and in the wrong coordinates: those of the nearest native
    ancestor. The view would then stand where nobody put it; so it goes back.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DontCreateNativeAncestors)
        self.setAttribute(Qt.WidgetAttribute.WA_NativeWindow)
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)

    def moveEvent(self, event: QMoveEvent) -> None:
        """Notice a move that no layout asked for."""
        super().moveEvent(event)
        parent = self.parentWidget()
        if parent is not None and self.pos() != parent.rect().topLeft():
            QTimer.singleShot(0, self._fill)

    def _fill(self) -> None:
        parent = self.parentWidget()
        if parent is not None:
            self.setGeometry(parent.rect())


def alone(view: NativeView) -> QWidget:
    """Put a view into a plain widget of its own.

    What lies beside a native window becomes native as well, and what a viewport in it paints is
    sometimes lost when pages are switched.
    """
    place = QWidget()
    whole = QVBoxLayout(place)
    whole.setContentsMargins(0, 0, 0, 0)
    whole.addWidget(view)
    return place
