"""The source in the reference's timing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison.model import Comparison
from mocapstudio.comparison.segments import source_frames
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]


def warped(source: Take | MarkerTake, comparison: Comparison) -> Take | MarkerTake:
    """Play a source as the reference is timed: a frame for each of the reference's, at its rate.

    Rotations are interpolated along the shorter arc, places on the straight line; a marker that is
    missing on one side of a moment is missing then.
    """
    at = source_frames(comparison, np.arange(len(comparison.reference_poses), dtype=float))
    at = np.clip(at, 0, source.frames - 1)
    low = np.clip(at.astype(np.int64), 0, max(source.frames - 2, 0))
    high = np.minimum(low + 1, source.frames - 1)
    part = at - low
    if isinstance(source, MarkerTake):
        filled = source.filled
        return replace(
            source,
            positions=_between(source.positions, low, high, part),
            filled=None if filled is None else filled[low] | filled[high],
            rate=comparison.reference_rate,
            first_frame=0,
            timecode=None,
            trim=None,
            events=(),
            source=None,
        )
    rotations = rot.slerp(source.rotations[low], source.rotations[high], part[:, None])
    return replace(
        source,
        rotations=rot.continuous(rot.normalize(rotations)),
        translations=_between(source.translations, low, high, part),
        rate=comparison.reference_rate,
        first_frame=0,
        timecode=None,
        trim=None,
        source=None,
    )


def _between(places: Array, low: NDArray[np.int64], high: NDArray[np.int64], part: Array) -> Array:
    share = part[:, None, None]
    mixed = places[low] * (1 - share) + places[high] * share
    exact = part == 0
    mixed[exact] = places[low[exact]]
    return np.asarray(mixed)
