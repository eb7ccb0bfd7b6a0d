"""Segments that keep out of each other's way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from mocapstudio.comparison.model import Segment
from mocapstudio.motion.errors import MocapError

Segments = tuple[Segment, ...]


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
