"""Intents about what is looked at: scene, frame, selection, analyses."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mocapstudio.cleaning.model import Proposal
from mocapstudio.cleaning.parameters import DetectionParameters
from mocapstudio.motion.take import Take
from mocapstudio.review import walk
from mocapstudio.review.comparing_kept import KeptComparison
from mocapstudio.review.core import Core
from mocapstudio.review.manner import Manner
from mocapstudio.review.model import Performer, Scene, Selection
from mocapstudio.review.rows import check_rows, check_span

if TYPE_CHECKING:
    from mocapstudio.cleaning.analysis import Analysis


class Viewing(Core):
    """Scene, frame, selection and analyses; nothing of this can be undone."""

    def open_take(self, take: Take, partner: bool = False, offset: float = 0.0) -> str:
        """Add a take to the scene and return its performer's id.

        The first take that is no partner becomes active.

        Parameters
        ----------
        partner
            True for a take that is only shown beside the one under review.
        offset
            Seconds by which the take starts after the scene's zero.
        """
        scene = self._state.scene
        name = self._free_id(take.name)
        performer = Performer(name, take, offset, partner)
        first = not any(not p.partner for p in scene.performers)
        changes: dict[str, Any] = {"scene": Scene((*scene.performers, performer))}
        if not scene.performers or (first and not partner):
            frame = walk.same_moment(self._state.performer, performer, self._state.frame)
            changes |= {"active": name, "selection": Selection(name), "frame": frame}
        self.recorder.opened(performer)
        self._put(**changes)
        return name

    def close_performer(self, performer: str) -> None:
        """Take a performer out of the scene and forget all about it, in the history too."""
        self._take(performer)
        left = tuple(p for p in self._state.scene.performers if p.id != performer)
        self._forget(performer)
        changes: dict[str, Any] = {"scene": Scene(left)}
        if self._state.active == performer:
            heir = next((p for p in left if not p.partner), left[0] if left else None)
            gone = self._state.performer
            frame = 0 if heir is None else walk.same_moment(gone, heir, self._state.frame)
            active = "" if heir is None else heir.id
            changes |= {"active": active, "selection": Selection(active), "frame": frame}
        self.recorder.closed(performer)
        self._put(**changes)

    def replace_take(self, performer: str, take: Take) -> None:
        """Put another reading of its file in the place of a performer's take.

        All about the performer is forgotten, in the history too.
        """
        self._take(performer)
        old = self._state.scene.performer(performer)
        new = replace(old, take=take)
        self._forget(performer)
        performers = (new if one is old else one for one in self._state.scene.performers)
        changes: dict[str, Any] = {"scene": Scene(tuple(performers))}
        if self._state.active == performer:
            # The rate may be another one now; the row of the file that is shown stays.
            frame = min(self._state.frame, take.frames - 1)
            changes |= {"selection": Selection(performer), "frame": frame}
        self.recorder.closed(performer)
        self.recorder.opened(new)
        self._put(**changes)

    def _forget(self, performer: str) -> None:
        self._history = self._history.forget(performer)
        self._analyses.forget(performer)
        self._results.forget(performer)
        self._sources.forget(performer)
        self._uncorrected.forget(performer)
        self._queues.pop(performer, None)

    def set_active(self, performer: str) -> None:
        """Put another performer under review, at the same moment of the scene."""
        self._take(performer)
        if performer == self._state.active:
            return
        to = self._state.scene.performer(performer)
        frame = walk.same_moment(self._state.performer, to, self._state.frame)
        self._put(active=performer, selection=Selection(performer), frame=frame)

    def set_frame(self, n: int) -> None:
        """Go to a frame of the active take; numbers outside are brought to its ends."""
        take = self._state.take
        self._put(frame=0 if take is None else min(max(int(n), 0), take.frames - 1))

    def select(
        self,
        joints: Iterable[str] | None = None,
        span: tuple[int, int] | tuple[()] | None = None,
        flag: str | None = None,
    ) -> None:
        """Select rows, a span or a flag; None leaves that part as it is, an empty value clears it.

        Raises
        ------
        MocapError
            If the active take has no such row or frames, or the queue no such flag.
        """
        take = self._take(self._state.active)
        selection = self._state.selection
        if joints is not None:
            rows = frozenset([joints] if isinstance(joints, str) else joints)
            check_rows(take, rows)
            selection = replace(selection, joints=rows)
        if span is not None:
            if span:
                check_span(take, *span)
            selection = replace(selection, span=(span[0], span[1]) if span else None)
        if flag is not None:
            selection = replace(selection, flag=self._item(flag).flag.id if flag else None)
        self._put(selection=selection)

    def clear_selection(self) -> None:
        """Select nothing."""
        self._put(selection=Selection(self._state.active))

    def select_flag(self, flag_id: str) -> None:
        """Select a flag with its row and span, and go to the frame of its peak."""
        flag = self._item(flag_id).flag
        selection = Selection(
            self._state.active, frozenset([flag.joint]), (flag.start, flag.end), flag.id
        )
        self._put(selection=selection, frame=flag.peak_frame)

    def set_threshold(self, x: float) -> None:
        """Flag again above another value of the map; decided flags stay.

        Raises
        ------
        ParameterError
            If `x` lies outside the parameter's bounds.
        """
        self.set_parameters(replace(self._state.parameters, threshold=float(x)))

    def set_mode(self, mode: str) -> None:
        """Choose the map of the next analysis: ``"calibrated"`` or ``"paper"``.

        Raises
        ------
        ParameterError
            If there is no such mode.
        """
        self.set_parameters(replace(self._state.parameters, mode=mode))

    def set_parameters(self, parameters: DetectionParameters) -> None:
        """Set all parameters of detection; the threshold takes effect at once."""
        if parameters.threshold != self._state.threshold:
            self._analyses.reflag(parameters.threshold)
        self._put(parameters=parameters)

    def set_context(self, paths: Iterable[Path | str], takes: Iterable[Take] = ()) -> None:
        """Set the context: its paths as shown and its takes."""
        self._context = tuple(takes)
        self._put(context=tuple(paths))

    def set_manner(self, manner: Manner) -> None:
        """Set how files are read from now on; takes that are open stay as they were read."""
        self._put(manner=manner)

    def keep_comparison(self, comparison: KeptComparison) -> None:
        """Keep another comparison beside the review."""
        self._put(comparison=comparison)

    def begin_analysis(self, performer: str) -> int:
        """Return the generation of a new analysis; earlier ones of that performer are stale."""
        self._take(performer)
        return self._analyses.begin(performer)

    def finish_analysis(self, performer: str, generation: int, analysis: Analysis) -> bool:
        """Take an analysis over. False, and nothing changes, where it is stale."""
        if not self._analyses.finish(performer, generation, analysis, self._state.threshold):
            return False
        self._put()
        return True

    def set_proposal(self, flag_id: str, choice: int | None, proposal: Proposal) -> bool:
        """Keep the proposal of a flag, made with the k-th neighbour or the engine's own choice.

        False, and nothing changes, where the flag is no longer in the queue.
        """
        if self._state.item(flag_id) is None:
            return False
        self._analyses.offer(self._state.active, flag_id, choice, proposal)
        self._put()
        return True
