"""The Compare workspace: performances beside a reference."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent
from PySide6.QtWidgets import QStackedLayout, QWidget

from mocapstudio.gui.compare.answering import Answering
from mocapstudio.gui.compare.bridge import CompareBridge, CompareUi
from mocapstudio.gui.compare.desk import CompareDesk
from mocapstudio.gui.compare.empty import EmptyCompare
from mocapstudio.gui.compare.flagging import Flagging
from mocapstudio.gui.compare.inviting import Inviting
from mocapstudio.gui.compare.keeping import Keeping
from mocapstudio.gui.compare.live_answering import LiveAnswering
from mocapstudio.gui.compare.live_bridge import LiveBridge, LiveShown
from mocapstudio.gui.compare.live_mode import LiveMode
from mocapstudio.gui.compare.playing import ComparePlayback
from mocapstudio.gui.compare.weight_rows import WeightRow, weight_rows
from mocapstudio.gui.compare.working import Working
from mocapstudio.gui.dialogs.question import confirm
from mocapstudio.gui.dialogs.rate import ask_rate
from mocapstudio.gui.workspaces.workspace import Answers, Workspace
from mocapstudio.motion.errors import MocapError
from mocapstudio.review.comparing import ComparingState
from mocapstudio.review.comparing_state import only_view_differs

if TYPE_CHECKING:
    from mocapstudio.gui.main_window import MainWindow


class CompareWorkspace(Workspace):
    """One reference and up to eight sources: pictures, viewports, segments, all linked.

    Parameters
    ----------
    window
        The desk.
    """

    needs_take = False

    def __init__(self, window: MainWindow) -> None:
        super().__init__()
        self.setObjectName("compare")
        self._actions = window.actions_
        self.bridge = CompareBridge(self)
        flagging = Flagging(window.bridge, window.jobs, window.messages, self)
        self.working = Working(self.bridge, flagging, window.jobs, window.messages, self)
        self.playback = ComparePlayback(self.bridge, self)
        self._document = window.bridge
        keeping = Keeping(self.bridge, window.bridge, self)
        window.files.handing_over.about_to_save.connect(keeping.keep)
        self.live: LiveBridge = LiveBridge(self)
        self.live_mode: LiveMode = LiveMode(
            self.bridge, self.live, window.jobs, window.messages, self
        )
        self.desk = CompareDesk(self.bridge, self.live, window.jobs, window.actions_)
        self.empty = EmptyCompare(window.actions_)
        self.answering = Answering(window, self)
        self.live_answering = LiveAnswering(window, self)
        Inviting(self.bridge, self.live, self.live_mode, self.desk.stage)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(self.empty)
        self._stack.addWidget(self.desk)
        self.working.rate_wanted.connect(partial(ask_rate, window))
        self.bridge.changed.connect(self._follow)
        self.bridge.ui_changed.connect(self._follow_ui)
        self.live.changed.connect(self._follow_live)
        self.desk.live.asked.connect(self.live_mode.look)
        self._show(self.bridge.state)

    def answers(self) -> Answers:
        """Answer the shared commands."""
        return self.live_answering.answers(self.answering.answers())

    def tools(self) -> Sequence[QWidget]:
        """What it adds to the toolbar."""
        names = {
            "compare-reference": "Reference", "compare-sources": "Sources",
            "compare-true-speed": "True speed", "compare-multiples": "All sources",
            "compare-matrix": "", "compare-picture": "",
        }  # fmt: skip
        return [self._actions.tool_button(name, text=text) for name, text in names.items()]

    def zones(self, opened: bool) -> Sequence[str]:
        """Files are dropped as reference or as sources."""
        return ("reference", "sources")

    def drop(self, zone: str, paths: Sequence[Path]) -> bool:
        """Compare dropped files."""
        if zone == "reference" and paths:
            self.working.set_reference(paths[0])
            if paths[1:]:
                self.working.add_sources(paths[1:])
        else:
            self.working.add_sources(paths)
        return True

    def open_paths(self, paths: Sequence[Path]) -> bool:
        """Compare what was chosen from the recent files."""
        self.working.add_sources(paths)
        return True

    def enter(self) -> None:
        """Lay out as remembered."""
        self.desk.restore()

    def leave(self) -> None:
        """Stop playing."""
        self.bridge.set_ui(playing=False)
        self.live_mode.pause()

    def hold_back(self, close: Callable[[], object]) -> bool:
        """Ask before segments that stand in no file are lost."""
        state = self.bridge.state
        in_session = self._document.state.path is not None
        if in_session or not (state.unsaved and state.segments):
            return False
        words = "The segments drawn in the Compare workspace stand in no file and would be lost."
        confirm(self, "Close without saving the segments?", words, "Close", close)
        return True

    def remember(self) -> None:
        """Remember the layout, and listen no more."""
        self.live_mode.hang_up()
        self.desk.remember()

    def _follow(self, old: ComparingState, new: ComparingState) -> None:
        if not only_view_differs(old, new):
            self._show(new)
            self._show_weights()
            self.answers_changed.emit()

    def _follow_ui(self, _old: CompareUi, _new: CompareUi) -> None:
        self.answers_changed.emit()

    def _follow_live(self, old: LiveShown, new: LiveShown) -> None:
        switches = ("phase", "wait", "weights", "weights_shown", "streams")
        if all(getattr(old, name) == getattr(new, name) for name in switches):
            return
        self._show(self.bridge.state)
        self._show_weights()
        self.answers_changed.emit()

    def _show_weights(self) -> None:
        shown = self.live.shown
        rows: tuple[WeightRow, ...] = ()
        if shown.weights_shown:
            with suppress(MocapError):
                rows = weight_rows(shown.weights, self.bridge.state.reference)
        self.desk.stage.show_weights(rows)

    def _show(self, state: ComparingState) -> None:
        filled = state.reference and (state.sources or self.live.shown.on)
        page: QWidget = self.desk if filled else self.empty
        self.empty.tell("" if state.reference is None else state.reference.name)
        if self._stack.currentWidget() is not page:
            self._stack.setCurrentWidget(page)

    def changeEvent(self, event: QEvent) -> None:
        """Follow the theme."""
        super().changeEvent(event)
        if event.type() in (QEvent.Type.StyleChange, QEvent.Type.PaletteChange):
            self.empty.restyle()
            self.desk.restyle()
