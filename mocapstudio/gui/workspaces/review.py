"""The Review workspace: queue, viewport, digression map, curves and inspector, linked."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QTimer, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget

from mocapstudio.gui import settings
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.document import DocumentBridge, UiState
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.gui.reasons import Reasons
from mocapstudio.gui.second_map import SecondMap
from mocapstudio.gui.views.inspector import InspectorView
from mocapstudio.gui.views.queue import QueueView
from mocapstudio.gui.views.transport import TransportView
from mocapstudio.gui.widgets.page_tabs import Page, PageTabs
from mocapstudio.gui.widgets.place import Place
from mocapstudio.gui.widgets.rooms import Rooms
from mocapstudio.gui.widgets.splitters import Splitters, above
from mocapstudio.gui.workspaces.workspace import Workspace

if TYPE_CHECKING:
    from mocapstudio.gui.views.curves import CurvesView
    from mocapstudio.gui.views.digression_map import DigressionMapView
    from mocapstudio.gui.views.distances import DistancesView
    from mocapstudio.gui.views.viewport import Viewport
    from mocapstudio.gui.workspaces.map_place import MapPlace

# Shares of the height that a part needs while it shows two plots instead of one.
_TWO_MAPS, _TWO_CURVES = 0.41, 0.29


class ReviewWorkspace(Workspace):
    """Lays the five parts out in splitters.

    Viewport, map and curves come a moment after the rest: what they are drawn with takes a second
    to load, and the window should not wait for it.

    Parameters
    ----------
    bridge
        The document's door.
    reasons
        Neighbours of the selected flag.
    second
        The map of another context.
    actions
        The commands behind the buttons.
    """

    filled = Signal()
    """Emitted once viewport, map and curves are there."""

    def __init__(
        self, bridge: DocumentBridge, reasons: Reasons, second: SecondMap, actions: Actions
    ) -> None:
        super().__init__()
        self.setObjectName("review")
        self._bridge, self._reasons, self._second = bridge, reasons, second
        self.queue = QueueView(bridge)
        self.inspector = InspectorView(bridge, reasons, actions)
        self.transport = TransportView(bridge, actions)
        self.viewport: Viewport | None = None
        self.maps: MapPlace | None = None
        self.map: DigressionMapView | None = None
        self.curves: CurvesView | None = None
        self.distances: DistancesView | None = None
        self._stage, self._map_place, self._curves_place = Place(), Place(), Place()
        self._splitters = Splitters()
        self._rooms = Rooms(self._splitters.rows)
        self._shared_out = False
        self._lay_out()
        self._parts = {
            "view-queue": self.queue,
            "view-inspector": self.inspector,
            "view-map": self._map_place,
            "view-curves": self._curves_place,
        }
        for name, part in self._parts.items():
            actions[name].setChecked(True)
            actions[name].toggled.connect(part.setVisible)
        self._actions = actions
        self._to_fill: list[Callable[[], None]] = [
            self._fill_map, self._fill_curves, self._fill_viewport,
        ]  # fmt: skip

    def fill(self) -> None:
        """Begin to load viewport, map and curves, one at a time between other events."""
        QTimer.singleShot(0, self._fill_next)

    def reset_layout(self) -> None:
        """Put all parts back where they came from."""
        for name in self._parts:
            self._actions[name].setChecked(True)
        self._share_out()

    def showEvent(self, event: QShowEvent) -> None:
        """Share the room out at first; later the splitters keep what the user made of it."""
        super().showEvent(event)
        if not self._shared_out:
            self._shared_out = True
            self._share_out()

    def _share_out(self) -> None:
        width, height = self.width(), self.height()
        queue = min(max(round(0.33 * width), 340), 480)
        inspector = min(max(round(0.24 * width), 310), 380)
        self._splitters.columns.setSizes([queue, width - queue - inspector, inspector])
        rows = [round(share * height) for share in (0.57, 0.25, 0.18)]
        self._splitters.rows.setSizes(rows)

    def frame_joint(self) -> None:
        """Move the camera to the selected joint."""
        if self.viewport is not None:
            self.viewport.frame_joint(None)

    def zoom_to_flag(self) -> None:
        """Zoom map and curves to the selected flag."""
        if self.map is not None:
            self.map.zoom_to_selection()

    def show_whole_take(self) -> None:
        """Show the whole take on map and curves."""
        if self.map is not None:
            self.map.whole_take()

    def remember(self) -> None:
        """Remember sizes and what is shown."""
        self._splitters.remember()
        hidden = [name for name in self._parts if not self._actions[name].isChecked()]
        settings.set_text("hidden", " ".join(hidden))

    def restore(self) -> None:
        """Lay out as remembered."""
        if self._splitters.restore():
            self._shared_out = True
        for name in settings.text("hidden").split():
            if name in self._parts:
                self._actions[name].setChecked(False)

    def _lay_out(self) -> None:
        centre = above(self._stage, self.transport)
        centre.setObjectName("centre")
        self._splitters.fill(
            ((self.queue, 0), (centre, 1), (self.inspector, 0)),
            6,
            ((self._map_place, 3), (self._curves_place, 2)),
        )
        whole = QVBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.addWidget(self._splitters.rows)

    def _fill_next(self) -> None:
        if self._to_fill:
            self._to_fill.pop(0)()
        if self._to_fill:
            QTimer.singleShot(0, self._fill_next)
        else:
            self.filled.emit()

    def _fill_map(self) -> None:
        from mocapstudio.gui.workspaces.map_place import MapPlace

        self.time_range = TimeRange(self)
        self.maps = MapPlace(self._bridge, self._second, self._actions, self.time_range)
        self.map = self.maps.map
        self._map_place.put(self.maps)

    def _fill_curves(self) -> None:
        keys = self._actions["distances"].shortcut().toString()
        pages = (
            Page("Curves", "The selected joint before and after", self._make_curves),
            Page(
                "Distances",
                f"How far the flagged span is from every other place, in degrees ({keys})",
                self._make_distances,
            ),
        )
        tabs = PageTabs("curves-tabs", pages)
        tabs.show_page(0)
        self._curves_place.put(tabs)
        tabs.chosen.connect(lambda page: self._bridge.set_ui(distances=page == 1))

        def follow(_old: UiState, new: UiState) -> None:
            tabs.show_page(int(new.distances))
            self._rooms.hold({1: _TWO_MAPS if new.beside else 0.0,
                              2: _TWO_CURVES if new.distances else 0.0})  # fmt: skip

        self._bridge.ui_changed.connect(follow)

    def _make_curves(self) -> QWidget:
        from mocapstudio.gui.views.curves import CurvesView

        self.curves = CurvesView(self._bridge, self.time_range)
        self.curves.setObjectName("curves")
        return self.curves

    def _make_distances(self) -> QWidget:
        from mocapstudio.gui.views.distances import DistancesView

        self.distances = DistancesView(self._bridge, self._reasons, self.time_range)
        self.distances.setObjectName("distances")
        return self.distances

    def _fill_viewport(self) -> None:
        from mocapstudio.gui.views.viewport import Viewport

        self.viewport = Viewport(self._bridge)
        self.viewport.setObjectName("viewport")
        self._stage.put(self.viewport)
