"""What carries a comparison sitting: its state, its steps, its listeners, its play heads."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from mocapstudio.comparison.kata import retimed
from mocapstudio.comparison.parameters import TIMING_ONLY, ComparisonParameters
from mocapstudio.motion.errors import MocapError
from mocapstudio.review.announcer import Announcer
from mocapstudio.review.comparing_segments import Segments
from mocapstudio.review.comparing_state import (
    Compared,
    ComparingState,
    Linked,
    Recording,
    differing,
)
from mocapstudio.review.comparing_steps import Steps, Undoable


class ComparingCore:
    """State, steps and listeners; every intent ends in `_put`."""

    def __init__(self) -> None:
        self._state = ComparingState()
        self._steps = Steps()
        self._saved: Segments = ()
        self._absent: object = None
        self._announcer: Announcer[ComparingState] = Announcer()

    @property
    def state(self) -> ComparingState:
        """The frozen state as of now."""
        return self._state

    def subscribe(
        self, listener: Callable[[ComparingState, ComparingState], None]
    ) -> Callable[[], None]:
        """Call `listener(old, new)` at every change; returns what ends that."""
        return self._announcer.subscribe(listener)

    # -- where the play heads are

    def go(self, frame: int) -> None:
        """Go to a frame of the reference; the source follows along the path."""
        at = self._kept(frame, self._state.reference)
        linked = self._state.linked
        self._put(frame=at, source_frame=0 if linked is None else linked.source_of(at))

    def go_source(self, frame: int) -> None:
        """Go to a frame of the chosen source; the reference follows along the path."""
        source = self._state.source
        at = self._kept(frame, None if source is None else source.take)
        linked = self._state.linked
        self._put(source_frame=at, frame=0 if linked is None else linked.reference_of(at))

    def go_both(self, frame: int, source_frame: int) -> None:
        """Go to a frame of each, whether or not the path joins them."""
        source = self._state.source
        self._put(
            frame=self._kept(frame, self._state.reference),
            source_frame=self._kept(source_frame, None if source is None else source.take),
        )

    def show(self, start: float, end: float) -> None:
        """Show another stretch of the pictures, in frames of the chosen source."""
        self._put(shown=(float(start), float(end)))

    def select_row(self, row: str | None) -> None:
        """Select a joint or marker, or none."""
        self._put(row=row)

    # -- within

    def _put(self, **changes: Any) -> None:
        steps, old = self._steps, self._state
        present = steps.present
        if present.parameters != old.parameters:
            changes.setdefault("sources", _under(present.parameters, old))
        new = replace(
            old,
            **changes,
            segments=present.segments,
            parameters=present.parameters,
            can_undo=steps.past[-1][0] if steps.past else None,
            can_redo=steps.future[-1][0] if steps.future else None,
            unsaved=present.segments != self._saved,
        )
        if differing(old, new):
            self._state = new
            self._announcer.announce(old, new)

    def _begin_segments(self) -> None:
        """Forget the segments, and how to bring them back."""
        self._steps, self._saved = Steps(Undoable(parameters=self._state.parameters)), ()
        self._absent = None

    def _source(self, source: str) -> Compared:
        found = next((one for one in self._state.sources if one.id == source), None)
        if found is None:
            raise MocapError(f"no source {source}")
        return found

    def _choice(self, one: Compared, frame: int | None = None) -> dict[str, Any]:
        """Fields of a state that shows a source, at the reference's frame."""
        at = self._state.frame if frame is None else frame
        linked, before = one.linked, self._state.linked
        whole = (-0.5, one.take.frames - 0.5)
        shown = whole
        if linked is not None and before is not None and self._state.source is not None:
            start, end = self._state.shown
            zoomed = end - start < self._state.source.take.frames
            if zoomed:
                edges = (linked.source_of(before.reference_of(edge)) for edge in (start, end))
                left, right = edges
                shown = (left - 0.5, max(right, left + 5) + 0.5)
        row = self._state.row
        if linked is not None and row not in linked.comparison.rows:
            row = None
        source_frame = 0 if linked is None else linked.source_of(at)
        return {"chosen": one.id, "source_frame": source_frame, "shown": shown, "row": row}

    @staticmethod
    def _kept(frame: int, take: Recording | None) -> int:
        return 0 if take is None else min(max(int(frame), 0), take.frames - 1)


def _under(parameters: ComparisonParameters, old: ComparingState) -> tuple[Compared, ...]:
    """Return the sources as they are under other parameters: timed anew, or not compared yet."""
    before = old.parameters
    same = replace(before, **{name: getattr(parameters, name) for name in TIMING_ONLY})
    if same != parameters:
        return tuple(Compared(one.id, one.take) for one in old.sources)
    return tuple(
        one
        if one.comparison is None
        else replace(one, linked=Linked(retimed(one.comparison, parameters)))
        for one in old.sources
    )
