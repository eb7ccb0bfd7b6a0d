"""The Markers workspace: a take of markers as it is, its gaps filled and its labels mended."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QStackedLayout, QWidget

from mocapstudio.gui.markers.answering import Answering
from mocapstudio.gui.markers.bridge import MarkersBridge, MarkersShown
from mocapstudio.gui.markers.curves_view import CurvesView
from mocapstudio.gui.markers.empty import EmptyMarkers
from mocapstudio.gui.markers.filing import Filing
from mocapstudio.gui.markers.gap_table import GapTable
from mocapstudio.gui.markers.inspector import MarkersInspector
from mocapstudio.gui.markers.lanes_view import LanesView
from mocapstudio.gui.markers.playing import MarkersPlayback
from mocapstudio.gui.markers.stage import MarkersStage
from mocapstudio.gui.markers.transport import MarkersTransport
from mocapstudio.gui.markers.working import Working
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.gui.widgets.native import alone
from mocapstudio.gui.widgets.splitters import Splitters, above
from mocapstudio.gui.workspaces.workspace import Answers, Workspace

if TYPE_CHECKING:
    from mocapstudio.gui.main_window import MainWindow


class MarkersWorkspace(Workspace):
    """List, viewport and inspector above, lanes and curves below, all at one frame and one choice.

    Parameters
    ----------
    window
        The desk.
    """

    needs_take = False

    def __init__(self, window: MainWindow) -> None:
        super().__init__()
        self.setObjectName("markers")
        self._actions = window.actions_
        self.bridge = MarkersBridge(window.bridge, self)
        self.working = Working(self.bridge, window.jobs, window.messages, self)
        self.playback = MarkersPlayback(self.bridge, self)
        self.time_range = TimeRange(self)
        self.table = GapTable(self.bridge)
        actions = window.actions_
        self.stage = MarkersStage(self.bridge, [actions["follow"], None, actions["frame-joint"]])
        self.transport = MarkersTransport(self.bridge, actions)
        self.inspector = MarkersInspector(self.bridge, self.working, actions)
        self.lanes = LanesView(self.bridge, self.time_range)
        self.curves = CurvesView(self.bridge, self.time_range)
        self.answering = Answering(self, Filing(window, self.bridge, self.working))
        self._answered: tuple[object, ...] = ()
        self._empty = EmptyMarkers(actions)
        self._splitters = Splitters("markers-")
        self._shared_out = False
        self._stack = QStackedLayout(self)
        self._lay_out()
        self.bridge.changed.connect(self._follow)
        self._show(self.bridge.shown)

    def answers(self) -> Answers:
        """Answer the commands about markers."""
        return self.answering.answers()

    def tools(self) -> Sequence[QWidget]:
        """What it adds to the toolbar."""
        names = {
            "markers-previous": "", "markers-next": "Next gap", "markers-fill-best": "Fill",
            "markers-fill-all": "Fill all short", "markers-exchange": "Exchange",
            "markers-solve": "Solve", "export": "",
        }  # fmt: skip
        return [self._actions.tool_button(name, text=text) for name, text in names.items()]

    def zones(self, opened: bool) -> Sequence[str]:
        """Files are opened."""
        return ("open",)

    def leave(self) -> None:
        """Stop playing."""
        self.bridge.set(playing=False)

    def share_out(self) -> None:
        """Share the room out as it comes."""
        width, height = self.width(), self.height()
        left = min(max(round(0.24 * width), 310), 360)
        right = min(max(round(0.2 * width), 280), 310)
        self._splitters.columns.setSizes([left, width - left - right, right])
        lanes = min(max(round(0.27 * height), 150), 300)
        curves = min(max(round(0.19 * height), 110), 190)
        self._splitters.rows.setSizes([height - lanes - curves, lanes, curves])

    def remember(self) -> None:
        """Remember sizes."""
        self._splitters.remember()

    def showEvent(self, event: QShowEvent) -> None:
        """Lay out as remembered, else as it comes."""
        super().showEvent(event)
        if self._shared_out:
            return
        self._shared_out = True
        self.share_out()
        self._splitters.restore()

    def changeEvent(self, event: QEvent) -> None:
        """Follow the theme."""
        super().changeEvent(event)
        if event.type() in (QEvent.Type.StyleChange, QEvent.Type.PaletteChange):
            for part in (self.table, self.lanes, self.curves, self._empty):
                part.restyle()

    def _lay_out(self) -> None:
        centre = above(self.stage, self.transport)
        self._splitters.fill(
            ((self.table, 0), (centre, 1), (self.inspector, 0)),
            1,
            ((alone(self.lanes), 0), (alone(self.curves), 0)),
        )
        self._stack.addWidget(self._empty)
        self._stack.addWidget(self._splitters.rows)

    def _follow(self, old: MarkersShown, new: MarkersShown) -> None:
        if old.result is not new.result:
            self._show(new)
        # Applying answers to every command costs more than asking for them.
        answers = self.answering.answers()
        if (answers.allowed, answers.checked, answers.playing) != self._answered:
            self._answered = (answers.allowed, answers.checked, answers.playing)
            self.answers_changed.emit()

    def _show(self, shown: MarkersShown) -> None:
        self._stack.setCurrentWidget(self._empty if shown.result is None else self._splitters.rows)
