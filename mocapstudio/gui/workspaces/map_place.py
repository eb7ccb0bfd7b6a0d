"""The digression map and, on demand, what is shown under it on the same axes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtWidgets import QMenu, QVBoxLayout, QWidget

from mocapstudio.gui.actions import Actions
from mocapstudio.gui.document import DocumentBridge, UiState
from mocapstudio.gui.plots.context_choice import CornerButton
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.gui.second_map import SecondMap
from mocapstudio.gui.views.digression_map import DigressionMapView
from mocapstudio.review.state import DocumentState

if TYPE_CHECKING:
    from mocapstudio.gui.views.beside import BesideView


class MapPlace(QWidget):
    """Lays the map and the plot under it out, and holds the switch between them.

    Parameters
    ----------
    bridge
        The document's door.
    second
        The map of another context.
    actions
        The commands of the switch.
    time_range
        The visible frames, shared with other plots.
    """

    def __init__(
        self, bridge: DocumentBridge, second: SecondMap, actions: Actions, time_range: TimeRange
    ) -> None:
        super().__init__()
        self._bridge, self._second, self._range = bridge, second, time_range
        self.map = DigressionMapView(bridge, time_range)
        self.map.setObjectName("digression-map")
        self.beside: BesideView | None = None
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(0)
        self._column.addWidget(self.map, 1)
        self._switch = CornerButton(self.map.labels, "map-switch")
        self._switch.setToolTip("What to show under the map, on the same axes")
        menu = QMenu(self._switch)
        menu.setObjectName("map-switch-menu")
        for name in ("beside-texture", "beside-map"):
            menu.addAction(actions[name])
        self._switch.setMenu(menu)
        bridge.changed.connect(self._follow)
        bridge.ui_changed.connect(self._follow_ui)
        self._name(bridge.state)

    def _follow(self, old: DocumentState, new: DocumentState) -> None:
        if old.analysis is not new.analysis:
            self._name(new)

    def _follow_ui(self, old: UiState, new: UiState) -> None:
        if old.beside == new.beside:
            return
        if self.beside is None and new.beside:
            from mocapstudio.gui.views.beside import BesideView

            self.beside = BesideView(self._bridge, self._second, self._range)
            self.beside.setObjectName("beside")
            self._column.addWidget(self.beside, 1)
        if self.beside is not None:
            self.beside.setVisible(bool(new.beside))
        self._name(self._bridge.state)

    def _name(self, state: DocumentState) -> None:
        words, analysis = "digression map", state.analysis
        if self._bridge.ui.beside == "map" and analysis is not None:
            count = len(analysis.context)
            words = f"against {count} takes" if count != 1 else "against 1 take"
            words = words if count else "against the take alone"
        self._switch.say(words)
