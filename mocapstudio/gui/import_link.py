"""How much was odd about the file under review, in the status bar; it leads to the report."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QPushButton

from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.opening import Opening
from mocapstudio.review.state import DocumentState


class ImportLink(QPushButton):
    """Hidden while nothing is odd.

    Parameters
    ----------
    bridge
        Tells which take is under review.
    opening
        Knows its file, and is told that the report is wanted.
    """

    def __init__(self, bridge: DocumentBridge, opening: Opening) -> None:
        super().__init__()
        self._imports = opening.imports
        self.setObjectName("import-link")
        self.setProperty("role", "link")
        self.setToolTip("See what was odd or guessed about the file, and read it otherwise")
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.clicked.connect(opening.report_wanted.emit)
        bridge.changed.connect(self._follow)
        self._imports.changed.connect(self._show)
        self._show()

    def _follow(self, old: DocumentState, new: DocumentState) -> None:
        if old.active != new.active or old.markers is not new.markers:
            self._show()

    def _show(self) -> None:
        path = self._imports.active
        one = None if path is None else self._imports.of(path)
        counts = "" if one is None else one.counts
        self.setText(f"Import: {counts}")
        self.setVisible(bool(counts))
