"""What each command does in the Compare workspace, and whether it can be done now."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from mocapstudio.comparison.parameters import ComparisonParameters
from mocapstudio.gui.compare.bridge import Alignment
from mocapstudio.gui.compare.exporting import Exporting
from mocapstudio.gui.compare.part import WorkspacePart
from mocapstudio.gui.compare.segmenting import Segmenting
from mocapstudio.gui.compare.sitting_takes import SittingTakes
from mocapstudio.gui.dialogs.files import FileRequest, ask_for_files
from mocapstudio.gui.workspaces.workspace import Answers

if TYPE_CHECKING:
    from mocapstudio.gui.main_window import MainWindow
    from mocapstudio.gui.workspaces.compare import CompareWorkspace

Slots = dict[str, Callable[[], object]]


class Answering(WorkspacePart):
    """Connects the commands with the sitting.

    Parameters
    ----------
    window, workspace
        See `WorkspacePart`.
    """

    def __init__(self, window: MainWindow, workspace: CompareWorkspace) -> None:
        super().__init__(window, workspace)
        self._segmenting = Segmenting(window, workspace)
        self._exporting = Exporting(window, workspace)
        self._sitting_takes = SittingTakes(window, workspace)
        self._slots = self._files() | self._views() | self._heads()
        self._slots |= self._segmenting.slots() | self._exporting.slots()

    def answers(self) -> Answers:
        """Say what is answered, and what of it can be done now."""
        state, ui = self._bridge.state, self._bridge.ui
        return Answers(
            slots=self._slots,
            allowed=self._allowed(),
            checked={
                "compare-true-speed": state.parameters.true_speed,
                "compare-parameters": ui.parameters,
                "compare-path": ui.along_path,
                "compare-overlay": ui.overlay,
                "compare-align-here": ui.alignment is Alignment.HERE,
                "compare-align-all": ui.alignment is Alignment.THROUGHOUT,
                "compare-align-none": ui.alignment is Alignment.RECORDED,
                "compare-differences": ui.differences,
                "compare-others": ui.others,
                "compare-multiples": ui.multiples,
                "compare-matrix": ui.matrix,
                "follow": ui.follow,
                "loop": ui.loop,
            },
            playing=ui.playing,
            undo=state.can_undo,
            redo=state.can_redo,
            alone=True,
        )

    def _allowed(self) -> dict[str, bool]:
        state = self._bridge.state
        reference, source = state.reference is not None, state.source is not None
        linked, several = state.linked is not None, len(state.sources) > 1
        segment, some = state.segment is not None, bool(state.segments)
        opened = bool(self._window.bridge.state.everyone)
        found = dict.fromkeys(self._slots, linked)
        return found | {
            "open": True, "new": reference, "compare-reference": True, "compare-sources": True,
            "compare-scene": opened, "compare-swap": reference and source,
            "compare-remove": source, "compare-next": several, "compare-previous": several,
            "compare-parameters": True,
            "compare-defaults": state.parameters != ComparisonParameters(),
            "compare-again": any(one.failure for one in state.sources),
            "compare-true-speed": True, "compare-path": True, "compare-overlay": True,
            "compare-align-here": True, "compare-align-all": True, "compare-align-none": True,
            "compare-differences": True, "compare-others": True, "compare-multiples": True,
            "compare-matrix": True, "follow": True, "loop": True, "reset-layout": True,
            "slower": True, "faster": True, "segment-rename": segment,
            "segment-delete": segment, "segment-next": some, "segment-previous": some,
            "segment-save": some, "segment-load": reference, "segment-carry": some and linked,
            "segment-suggest": reference, "segment-new": reference,
            "undo": state.can_undo is not None, "redo": state.can_redo is not None,
        }  # fmt: skip

    # -- who is compared

    def _files(self) -> Slots:
        sitting = self._bridge.sitting
        return {
            "open": self._ask_sources,
            "new": sitting.clear,
            "compare-reference": self._ask_reference,
            "compare-sources": self._ask_sources,
            "compare-scene": self._sitting_takes.take_in,
            "compare-swap": sitting.swap,
            "compare-remove": lambda: sitting.remove(self._bridge.state.chosen),
            "compare-next": partial(self._step_source, 1),
            "compare-previous": partial(self._step_source, -1),
        }

    def _ask_reference(self) -> None:
        request = FileRequest("Choose the reference", "compare")
        ask_for_files(
            self._window, request, lambda paths: self._workspace.working.set_reference(paths[0])
        )

    def _ask_sources(self) -> None:
        request = FileRequest("Add performances to compare", "compare", several=True)
        ask_for_files(self._window, request, self._workspace.working.add_sources)

    def _step_source(self, by: int) -> None:
        ranking = [one.id for one in self._bridge.state.ranking]
        at = (ranking.index(self._bridge.state.chosen) + by) % len(ranking)
        self._bridge.sitting.choose(ranking[at])

    # -- how it is shown

    def _views(self) -> Slots:
        bridge, desk = self._bridge, self._workspace.desk

        def switch(name: str) -> Callable[[], None]:
            return lambda: bridge.set_ui(**{name: not getattr(bridge.ui, name)})

        def align(how: Alignment) -> Callable[[], None]:
            return lambda: bridge.set_ui(alignment=how, anchor=bridge.state.frame)

        return {
            "compare-true-speed": self._switch_speed,
            "compare-parameters": switch("parameters"),
            "compare-defaults": partial(bridge.sitting.set_parameters, ComparisonParameters()),
            "compare-again": bridge.sitting.compare_again,
            "compare-path": switch("along_path"),
            "compare-overlay": switch("overlay"),
            "compare-align-here": align(Alignment.HERE),
            "compare-align-all": align(Alignment.THROUGHOUT),
            "compare-align-none": align(Alignment.RECORDED),
            "compare-differences": switch("differences"),
            "compare-others": switch("others"),
            "compare-multiples": switch("multiples"),
            "compare-matrix": switch("matrix"),
            "follow": switch("follow"),
            "loop": switch("loop"),
            "frame-joint": desk.stage.frame_all,
            "zoom-flag": desk.pictures.zoom_to_segment,
            "whole-take": desk.pictures.whole,
            "reset-layout": desk.share_out,
            "deselect": self._deselect,
        }

    def _switch_speed(self) -> None:
        old = self._bridge.state.parameters
        self._bridge.sitting.set_parameters(replace(old, true_speed=not old.true_speed))

    def _deselect(self) -> None:
        self._bridge.sitting.select_row(None)
        self._bridge.sitting.select_segment(None)

    # -- where the play heads are

    def _heads(self) -> Slots:
        bridge, playback = self._bridge, self._workspace.playback
        transport = self._workspace.desk.transport

        def step(by: int) -> Callable[[], None]:
            return lambda: bridge.sitting.go_source(bridge.state.source_frame + by)

        def last() -> None:
            linked = bridge.state.linked
            bridge.sitting.go_source(0 if linked is None else linked.frames[1] - 1)

        return {
            "play": playback.toggle,
            "frame-back": step(-1),
            "frame-on": step(1),
            "ten-back": step(-10),
            "ten-on": step(10),
            "first": lambda: bridge.sitting.go_source(0),
            "last": last,
            "slower": partial(transport.step_speed, -1),
            "faster": partial(transport.step_speed, 1),
            "undo": bridge.sitting.undo,
            "redo": bridge.sitting.redo,
        }
