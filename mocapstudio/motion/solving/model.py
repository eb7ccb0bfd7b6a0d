"""What comes of solving markers: a take, where the markers sit on it, and how well it fits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.take import Take

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Solved:
    """A marker take solved to a skeleton.

    Attributes
    ----------
    take
        The motion: the template's joints with bone lengths fitted to the markers.
    labels
        The M markers that were used, as the marker take calls them.
    joints
        (M,) the joint that carries each of them.
    offsets
        (M, 3) metres: where on that joint, in its local frame.
    residuals
        (F, M) metres from each measured marker to where the solved joints put it; NaN where it
        was missing or filled.
    scales
        (J,) length of each joint's offset over the template's.
    left_out
        Markers that belong to no joint: never seen, or rigid with nothing.
    warnings
        What the user should know, a sentence each.
    """

    take: Take
    labels: tuple[str, ...]
    joints: NDArray[np.int64]
    offsets: Array
    residuals: Array
    scales: Array
    left_out: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    @property
    def mean(self) -> float:
        """Mean residual in metres."""
        return float(np.nanmean(self.residuals))

    @property
    def max(self) -> float:
        """Largest residual in metres."""
        return float(np.nanmax(self.residuals))
