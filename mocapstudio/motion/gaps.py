"""Where markers are missing, and how what was completed goes back into a take."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.runs import runs

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Gap:
    """One run of frames in which one marker is missing.

    Attributes
    ----------
    marker
        Its index.
    start, end
        Half-open span of frames.
    frames
        Frames of the take: a gap may touch its start or its end.
    """

    marker: int
    start: int
    end: int
    frames: int

    @property
    def inner(self) -> bool:
        """Whether the marker is seen right before and right after."""
        return self.start > 0 and self.end < self.frames

    @property
    def edges(self) -> list[int]:
        """Frames right before and right after, where the marker is seen."""
        return [f for f in (self.start - 1, self.end) if 0 <= f < self.frames]

    @property
    def span(self) -> slice:
        """The frames as a slice."""
        return slice(self.start, self.end)


def gaps(take: MarkerTake, spans: Iterable[Declared] | None = None) -> list[Gap]:
    """Runs of missing frames of each marker, by marker and frame.

    Parameters
    ----------
    take
        The take.
    spans
        Only gaps that touch one of these markers and spans; None for all. A gap is not cut: what
        completes it needs both its edges.

    Raises
    ------
    MocapError
        If a span names no marker of the take.
    """
    wanted: Mask | None = None
    if spans is not None:
        wanted = np.zeros((take.frames, len(take.labels)), dtype=bool)
        for one in spans:
            if one.row not in take.index:
                raise MocapError(f"{one.row} is no marker of {take.name}")
            wanted[max(one.start, 0) : max(one.end, 0), take.index[one.row]] = True
    found: list[Gap] = []
    for marker, missing in enumerate(take.missing.T):
        for start, end in runs(missing):
            if wanted is None or wanted[start:end, marker].any():
                found.append(Gap(marker, start, end, take.frames))
    return found


def completed(take: MarkerTake, positions: Array, spans: Iterable[Declared] | None) -> MarkerTake:
    """Return the take with positions that were missing in it, marked as filled.

    Parameters
    ----------
    take
        The take before.
    positions
        (F, M, 3) metres; only what was missing differs.
    spans
        What may be filled; None for all that was missing.
    """
    filled = take.missing & ~np.isnan(positions).any(axis=2)
    if spans is not None:
        allowed = np.zeros_like(filled)
        for one in spans:
            allowed[max(one.start, 0) : max(one.end, 0), take.index[one.row]] = True
        filled &= allowed
    if not filled.any():
        return take
    result = np.where(filled[..., None], positions, take.positions)
    return take.with_positions(result, filled)
