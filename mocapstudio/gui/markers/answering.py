"""What each command does in the Markers workspace, and whether it can be done now."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from mocapstudio.gui.markers.filing import Filing
from mocapstudio.gui.workspaces.workspace import Answers
from mocapstudio.review.marker_fills import METHODS

if TYPE_CHECKING:
    from mocapstudio.gui.workspaces.markers import MarkersWorkspace

Slots = dict[str, Callable[[], object]]
_ELSEWHERE = ("view-queue", "view-inspector", "view-map", "view-curves", "find", "select-all",
              "partner", "context", "trim-in", "trim-out", "trim-clear", "ghosts",
              "trails", "distances", "beside-texture", "beside-map")  # fmt: skip
"""Commands about the take under review, which has no place here."""


class Answering(QObject):
    """Connects the commands with the sitting.

    Parameters
    ----------
    workspace
        The workspace.
    filing
        Asks what has to be asked first.
    """

    def __init__(self, workspace: MarkersWorkspace, filing: Filing) -> None:
        super().__init__(workspace)
        self._workspace, self._filing = workspace, filing
        self._bridge = workspace.bridge
        self._slots = self._work() | self._play() | self._views()
        self._slots |= dict.fromkeys(_ELSEWHERE, _nothing)

    def answers(self) -> Answers:
        """Say what is answered, and what of it can be done now."""
        shown = self._bridge.shown
        return Answers(
            slots=self._slots,
            allowed=self._allowed(),
            checked={"loop": shown.loop},
            playing=shown.playing,
        )

    def _allowed(self) -> dict[str, bool]:
        shown, working = self._bridge.shown, self._workspace.working
        there = shown.result is not None
        found = dict.fromkeys(self._slots, there) | dict.fromkeys(_ELSEWHERE, False)
        gap = shown.chosen_gap is not None
        some = bool(shown.gaps.in_time)
        found |= {f"markers-fill-{one.name}": gap for one in METHODS}
        return found | {
            "markers-next": some, "markers-previous": some,
            "markers-fill-all": 0 < shown.gaps.shortest <= shown.longest,
            "markers-exchange": shown.marker is not None and len(shown.gaps.markers) > 1,
            "markers-clear": shown.marker is not None,
            "markers-take-back": bool(working.edits_here()),
            "markers-protect": shown.span is not None,
            "markers-unprotect": bool(shown.protected),
            "zoom-flag": shown.span is not None, "loop": shown.span is not None or shown.loop,
            "deselect": shown.marker is not None or shown.span is not None,
        }  # fmt: skip

    def _work(self) -> Slots:
        working, filing, bridge = self._workspace.working, self._filing, self._bridge
        fills: Slots = {f"markers-fill-{one.name}": partial(working.fill, one.name)
                        for one in METHODS}  # fmt: skip
        return fills | {
            "markers-next": partial(bridge.next_gap, 1),
            "markers-previous": partial(bridge.next_gap, -1),
            "markers-fill-all": working.fill_all,
            "markers-exchange": filing.ask_exchange,
            "markers-clear": working.clear,
            "markers-take-back": working.take_back,
            "markers-protect": working.protect,
            "markers-unprotect": working.unprotect,
            "markers-solve": filing.ask_solve,
            "markers-compare": filing.compare,
            "export": filing.ask_export,
            "close-take": filing.close,
            "import-report": filing.show_import_report,
            "report": filing.ask_report,
            "deselect": self._deselect,
        }

    def _play(self) -> Slots:
        playback, bridge = self._workspace.playback, self._bridge
        transport = self._workspace.transport

        def step(by: int) -> None:
            bridge.go(bridge.shown.frame + by)

        def last() -> None:
            take = bridge.shown.result
            bridge.go(0 if take is None else take.frames - 1)

        return {
            "play": playback.toggle, "loop": playback.toggle_loop,
            "frame-back": partial(step, -1), "frame-on": partial(step, 1),
            "ten-back": partial(step, -10), "ten-on": partial(step, 10),
            "first": partial(bridge.go, 0), "last": last,
            "slower": partial(transport.step_speed, -1), "faster": partial(transport.step_speed, 1),
        }  # fmt: skip

    def _views(self) -> Slots:
        workspace = self._workspace
        return {
            "zoom-flag": workspace.lanes.zoom,
            "whole-take": workspace.time_range.whole,
            "frame-joint": workspace.stage.frame_all,
            "reset-layout": workspace.share_out,
        }

    def _deselect(self) -> None:
        if self._bridge.shown.span is not None:
            self._bridge.set(span=None)
        else:
            self._bridge.set(marker=None)


def _nothing() -> None:
    """Leave a command of another workspace without effect."""
