"""The inspector of the Markers workspace: the chosen gap, and the edits."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QTabWidget, QVBoxLayout

from mocapstudio.gui.actions import Actions
from mocapstudio.gui.markers.bridge import MarkersBridge, MarkersShown
from mocapstudio.gui.markers.edit_list import EditList
from mocapstudio.gui.markers.gap_page import GapPage
from mocapstudio.gui.markers.working import Working


class MarkersInspector(QFrame):
    """Two pages: what can be done, and what was done.

    Parameters
    ----------
    bridge
        What is shown and chosen.
    working
        Knows which gaps would be filled.
    actions
        The commands behind the buttons.
    """

    def __init__(self, bridge: MarkersBridge, working: Working, actions: Actions) -> None:
        super().__init__()
        self.setObjectName("markers-inspector")
        self.setProperty("role", "panel")
        self.setMinimumWidth(264)
        self._tabs = QTabWidget()
        self._tabs.setObjectName("markers-tabs")
        self._tabs.setDocumentMode(True)
        self._tabs.tabBar().setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._tabs.tabBar().setDrawBase(False)
        self._gap = GapPage(bridge, working, actions)
        self._tabs.addTab(self._gap, "Gap")
        self._tabs.addTab(EditList(bridge, working), "Edits")
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self._tabs)
        bridge.changed.connect(self._follow)

    def _follow(self, old: MarkersShown, new: MarkersShown) -> None:
        if old.edits != new.edits:
            count = len({edit.group for edit in new.edits})
            self._tabs.setTabText(1, f"Edits ({count})" if count else "Edits")
        if new.marker is not None and (old.marker, old.span) != (new.marker, new.span):
            self._tabs.setCurrentWidget(self._gap)
