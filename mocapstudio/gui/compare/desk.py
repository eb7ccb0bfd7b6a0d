"""How the parts of the Compare workspace are laid out."""

from __future__ import annotations

from PySide6.QtWidgets import QLabel, QStackedWidget, QVBoxLayout, QWidget

from mocapstudio.gui.actions import Actions
from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.compare.live_bridge import LiveBridge
from mocapstudio.gui.compare.live_view import LiveView
from mocapstudio.gui.compare.matrix_view import MatrixView
from mocapstudio.gui.compare.multiples import MultiplesView
from mocapstudio.gui.compare.parameter_form import ParameterForm
from mocapstudio.gui.compare.performances import PerformancesView
from mocapstudio.gui.compare.pictures import PicturesView
from mocapstudio.gui.compare.segments_table import SegmentsView
from mocapstudio.gui.compare.stage import StageView
from mocapstudio.gui.compare.transport import CompareTransport
from mocapstudio.gui.compare.weights_view import WeightsView
from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.widgets.parts import header, panel
from mocapstudio.gui.widgets.splitters import Splitters, above


class CompareDesk(QWidget):
    """Performances, viewports and segments above, pictures below.

    Parameters
    ----------
    bridge, live
        Where state comes from and intents go.
    jobs
        Runs what takes long.
    actions
        The commands behind the buttons.
    """

    def __init__(
        self, bridge: CompareBridge, live: LiveBridge, jobs: Jobs, actions: Actions
    ) -> None:
        super().__init__()
        self._bridge, self._live = bridge, live
        self.performances = PerformancesView(bridge, actions)
        self.parameters = ParameterForm(bridge, actions)
        self._left = QStackedWidget()
        self._left.addWidget(self.performances)
        self._left.addWidget(self.parameters)
        bridge.ui_changed.connect(lambda _old, new: self._left.setCurrentIndex(int(new.parameters)))
        corner = [actions[n] for n in ("compare-overlay", "compare-align-here")]
        corner += [actions[n] for n in ("compare-differences", "compare-others", "follow")]
        self.stage = StageView(bridge, [*corner, None, actions["frame-joint"]])
        self.transport = CompareTransport(bridge, actions)
        self.pictures = PicturesView(bridge)
        self.segments = SegmentsView(bridge, actions)
        self._side = QStackedWidget()
        self._side.addWidget(self.segments)
        self.matrix = MatrixView(bridge, live, jobs)
        self._side.addWidget(self.matrix)
        self._side.addWidget(WeightsView(bridge, live, actions))
        self._below = QStackedWidget()
        self._below.addWidget(self.pictures)
        self.multiples = MultiplesView(bridge)
        self._below.addWidget(self.multiples)
        self.live = LiveView(bridge, live, actions)
        self._below.addWidget(self.live)
        self._splitters = Splitters("compare-")
        self._shared_out = False
        self._lay_out(actions)
        bridge.ui_changed.connect(lambda _old, _new: self._show_parts())
        live.changed.connect(lambda _old, _new: self._show_parts())
        self._show_parts()

    @property
    def below(self) -> QWidget:
        """What is shown below the viewports: pictures of one source, or strips of all."""
        return self.multiples if self._bridge.ui.multiples else self.pictures

    def _lay_out(self, actions: Actions) -> None:
        side = panel("compare-side")
        inner = QVBoxLayout(side)
        inner.setContentsMargins(0, 0, 0, 0)
        inner.setSpacing(0)
        buttons = (actions.tool_button(n) for n in ("weights-show", "compare-matrix"))
        head = header("Segments", *buttons)
        titles = head.findChildren(QLabel)
        self._title = titles[0]
        inner.addWidget(head)
        inner.addWidget(self._side, 1)
        centre = above(self.stage, self.transport)
        self._splitters.fill(((self._left, 0), (centre, 1), (side, 0)), 1, ((self._below, 1),))
        whole = QVBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.addWidget(self._splitters.rows)

    def _show_parts(self) -> None:
        ui, live = self._bridge.ui, self._live.shown
        side = 2 if live.weights_shown else int(ui.matrix)
        below = 2 if live.on else int(ui.multiples)
        if (side, below) != (self._side.currentIndex(), self._below.currentIndex()):
            self._side.setCurrentIndex(side)
            self._below.setCurrentIndex(below)
        title = ("Segments", "Matrix", "Weights")[side]
        if self._title.text() != title:
            self._title.setText(title)

    def share_out(self) -> None:
        """Share the room out as it comes."""
        self._shared_out = True
        width, height = self.width(), self.height()
        left = min(max(round(0.21 * width), 262), 320)
        right = min(max(round(0.22 * width), 290), 360)
        self._splitters.columns.setSizes([left, width - left - right, right])
        self._splitters.rows.setSizes([round(0.47 * height), round(0.53 * height)])

    def remember(self) -> None:
        """Remember sizes."""
        self._splitters.remember()

    def restore(self) -> None:
        """Lay out as remembered, else as it comes."""
        if self._shared_out:
            return
        self.share_out()
        self._splitters.restore()

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        self.performances.restyle()
        self.parameters.restyle()
        self.segments.restyle()
