"""Undoable steps over the segments of a comparison sitting."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from mocapstudio.comparison.model import Segment
from mocapstudio.motion.errors import MocapError

Segments = tuple[Segment, ...]


@dataclass(frozen=True)
class Steps:
    """The present segments, and those before and after each step that was done or undone."""

    present: Segments = ()
    past: tuple[tuple[str, Segments], ...] = ()
    future: tuple[tuple[str, Segments], ...] = ()

    def push(self, label: str, segments: Segments) -> Steps:
        """Go on to other segments; the same ones are no step."""
        if segments == self.present:
            return self
        return Steps(segments, (*self.past, (label, self.present)))

    def undo(self) -> Steps:
        """Go a step back; the same where there is none."""
        if not self.past:
            return self
        label, before = self.past[-1]
        return Steps(before, self.past[:-1], (*self.future, (label, self.present)))

    def redo(self) -> Steps:
        """Do an undone step again; the same where there is none."""
        if not self.future:
            return self
        label, after = self.future[-1]
        return Steps(after, (*self.past, (label, self.present)), self.future[:-1])


def with_segment(segments: Segments, new: Segment) -> Segments:
    """Put a segment among others; those that it covers are shortened, or go where all is covered.

    A segment that lies on both sides of the new one keeps its longer side.
    """
    kept: list[Segment] = [new]
    for one in segments:
        left = replace(one, end=min(one.end, new.start))
        right = replace(one, start=max(one.start, new.end))
        kept.append(max((left, right), key=lambda part: part.end - part.start))
    return tuple(sorted((s for s in kept if s.start < s.end), key=lambda s: s.start))


def check(segments: Sequence[Segment], frames: int) -> Segments:
    """Return segments that fit a take of so many frames.

    Raises
    ------
    MocapError
        If one lies outside, is empty, or overlaps the one before.
    """
    last = 0
    for one in segments:
        if not last <= one.start < one.end <= frames:
            raise MocapError(
                f"segment {one.name!r} ({one.start}..{one.end}) is empty, overlaps the one before,"
                f" or lies outside the take's {frames} frames"
            )
        last = one.end
    return tuple(segments)
