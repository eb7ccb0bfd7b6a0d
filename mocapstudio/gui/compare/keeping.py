"""Keeps the comparison in the document of the sitting, and brings back what a session had kept."""

from __future__ import annotations

from PySide6.QtCore import QObject

from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.review.comparing import ComparingState
from mocapstudio.review.comparing_state import only_view_differs
from mocapstudio.review.state import DocumentState


class Keeping(QObject):
    """Hands the comparison to the document at every change that lasts, and takes it from others.

    Parameters
    ----------
    bridge
        Of the comparison.
    document
        Of the sitting, whose session file keeps it.
    parent
        Qt's parent.
    """

    def __init__(self, bridge: CompareBridge, document: DocumentBridge, parent: QObject) -> None:
        super().__init__(parent)
        self._bridge, self._document = bridge, document
        self._known = bridge.sitting.kept()
        bridge.changed.connect(self._follow)
        document.changed.connect(self._follow_document)
        self._follow_document(document.state, document.state)

    def keep(self) -> None:
        """Hand over where one looks, too: before the session is saved."""
        self._hand_over(always=True)

    def _follow(self, old: ComparingState, new: ComparingState) -> None:
        if not only_view_differs(old, new):
            self._hand_over()

    def _hand_over(self, *, always: bool = False) -> None:
        kept = self._bridge.sitting.kept()
        if always or kept.lasting != self._known.lasting:
            self._known = kept
            self._document.document.keep_comparison(kept)

    def _follow_document(self, _old: DocumentState, new: DocumentState) -> None:
        if new.comparison is not self._known and new.comparison != self._known:
            self._known = new.comparison
            self._bridge.sitting.restore(new.comparison)
