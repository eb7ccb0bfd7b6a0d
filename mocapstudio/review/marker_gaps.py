"""Where the markers of a take are missing or filled, and which are the worst."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.runs import runs

Span = tuple[int, int]


class GapSpan(NamedTuple):
    """One gap: a half-open span of frames of one marker, which comes first where gaps are sorted.

    Frames first, so that gaps sort by time.
    """

    start: int
    end: int
    marker: str


@dataclass(frozen=True)
class MarkerGaps:
    """What is missing of one marker.

    Parameters
    ----------
    label
        Its name.
    gaps
        Half-open spans in which it is missing, by time.
    filled
        Half-open spans in which it was filled, by time.
    frames
        Frames of the take.
    """

    label: str
    gaps: tuple[Span, ...]
    filled: tuple[Span, ...]
    frames: int

    @cached_property
    def missing(self) -> int:
        """Number of frames in which it is missing."""
        return sum(end - start for start, end in self.gaps)

    @property
    def longest(self) -> int:
        """Frames of its longest gap; 0 without one."""
        return max((end - start for start, end in self.gaps), default=0)

    @property
    def share(self) -> float:
        """Share of the frames in which it is missing, 0..1."""
        return self.missing / self.frames

    @property
    def share_filled(self) -> float:
        """Share of the frames in which it is filled, 0..1."""
        return sum(end - start for start, end in self.filled) / self.frames

    @property
    def never_seen(self) -> bool:
        """Whether nothing can bring it back, since it is nowhere there."""
        return self.missing == self.frames


@dataclass(frozen=True)
class TakeGaps:
    """What is missing of all markers of a take, worst first; what is never seen comes last."""

    markers: tuple[MarkerGaps, ...]

    @cached_property
    def by_label(self) -> dict[str, MarkerGaps]:
        """Each marker by its name."""
        return {one.label: one for one in self.markers}

    @cached_property
    def in_time(self) -> tuple[GapSpan, ...]:
        """Gaps of all markers that are ever seen, by their start."""
        return tuple(
            sorted(
                GapSpan(start, end, one.label)
                for one in self.markers
                if not one.never_seen
                for start, end in one.gaps
            )
        )

    def span_at(self, label: str, frame: int) -> Span | None:
        """Return the gap or the filled span of a marker at a frame, or None."""
        one = self.by_label[label]
        spans = (*one.gaps, *one.filled)
        return next((span for span in spans if span[0] <= frame < span[1]), None)

    def first_within(self, label: str, start: int, end: int) -> Span | None:
        """Return the first gap or filled span of a marker that touches [start, end), or None."""
        one = self.by_label[label]
        touching = (span for span in (*one.gaps, *one.filled) if span[0] < end and start < span[1])
        return min(touching, default=None)

    @cached_property
    def shortest(self) -> int:
        """Frames of the shortest gap; 0 without one."""
        return min((one.end - one.start for one in self.in_time), default=0)

    def up_to(self, frames: int) -> tuple[GapSpan, ...]:
        """Return the gaps of at most so many frames."""
        return tuple(one for one in self.in_time if one.end - one.start <= frames)


def take_gaps(take: MarkerTake) -> TakeGaps:
    """Find what is missing and filled in a take."""
    filled = np.zeros_like(take.missing) if take.filled is None else take.filled & ~take.missing
    found = [
        MarkerGaps(label, tuple(runs(gone)), tuple(runs(made)), take.frames)
        for label, gone, made in zip(take.labels, take.missing.T, filled.T, strict=True)
    ]
    return TakeGaps(tuple(sorted(found, key=lambda one: (one.never_seen, -one.missing))))
