"""Keep the pose, and depart from it smoothly: wishes on the unknowns over time."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import comb

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class KeepPose:
    """Every unknown stays near the departure that is wanted, by default none.

    Parameters
    ----------
    frames
        F.
    weights
        (n,) per unit of each unknown.
    reference
        (F, n) or None.
    """

    frames: int
    weights: Array
    reference: Array | None = None

    @cached_property
    def difference(self) -> Array:
        """(1, F) of ones: no difference in time at all."""
        return np.ones((1, self.frames))


@dataclass(frozen=True, eq=False)
class Smoothness:
    """The departure changes smoothly in time; the motion's own detail stays, since it is no part.

    The residual is the difference of the given order of the unknowns over frames.

    Parameters
    ----------
    frames
        F.
    weights
        (n,) per unit of each unknown.
    order
        2 for steady velocities, 3 for steady accelerations.
    joins_before, joins_after
        Whether frames just outside the window stay as they were, so that the departure has to fade
        out towards them; otherwise that end is free.
    """

    frames: int
    weights: Array
    order: int
    joins_before: bool = True
    joins_after: bool = True
    reference: None = None

    @cached_property
    def difference(self) -> Array:
        """(order + 1, F + order) coefficients of the rows that count."""
        k = self.order
        signs = np.array([(-1.0) ** (k - i) * comb(k, i) for i in range(k + 1)])
        counts = np.ones(self.frames + k)
        if not self.joins_before:
            counts[:k] = 0.0
        if not self.joins_after:
            counts[self.frames :] = 0.0
        return signs[:, None] * counts
