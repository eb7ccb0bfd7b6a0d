"""The inspector: why the selected flag was raised, the decision, and the list of edits."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QTabWidget, QVBoxLayout

from mocapstudio.gui.actions import Actions
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.inspector.edits_page import EditsPage
from mocapstudio.gui.inspector.flag_page import FlagPage
from mocapstudio.gui.reasons import Reasons
from mocapstudio.review.state import DocumentState


class InspectorView(QFrame):
    """Two pages: the flag, and the edits.

    Parameters
    ----------
    bridge
        The document's door.
    reasons
        Neighbours of the selected flag.
    actions
        The commands behind the buttons.
    """

    def __init__(self, bridge: DocumentBridge, reasons: Reasons, actions: Actions) -> None:
        super().__init__()
        self.setObjectName("inspector")
        self.setProperty("role", "panel")
        self.setMinimumWidth(270)
        self._tabs = QTabWidget()
        self._tabs.setObjectName("inspector-tabs")
        self._tabs.setDocumentMode(True)
        self._tabs.tabBar().setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._tabs.tabBar().setDrawBase(False)
        self._flag = FlagPage(bridge, reasons, actions)
        self._edits = EditsPage(bridge)
        self._tabs.addTab(self._flag, "Flag")
        self._tabs.addTab(self._edits, "Edits")
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self._tabs)
        bridge.changed.connect(self._show)

    def show_edit(self, flag_id: str) -> None:
        """Show the edit that a flag was accepted with."""
        self._tabs.setCurrentWidget(self._edits)
        self._edits.reveal(flag_id)

    def show_alignment(self) -> bool:
        """Show how the previewed neighbour answers to the flag's span; False without one."""
        return self._flag.show_alignment()

    def _show(self, old: DocumentState, new: DocumentState) -> None:
        count = sum(1 for one in new.sitting.edits if one.performer == new.active)
        self._tabs.setTabText(1, f"Edits ({count})" if count else "Edits")
        if old.selection.flag != new.selection.flag and new.selection.flag is not None:
            self._tabs.setCurrentWidget(self._flag)
