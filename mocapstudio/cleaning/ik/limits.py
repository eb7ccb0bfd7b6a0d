"""Limits of joints: ranges that a solution keeps to, as soft or as nearly hard as wished."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.ik import turns
from mocapstudio.cleaning.ik.objectives.rows import Rows
from mocapstudio.cleaning.ik.posed import Posed
from mocapstudio.motion import rotations as rot

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class RangeLimit:
    """A joint stays within its range, or as far outside as it was before.

    The residual is the excess over the bounds, in radians times `weight`, about each natural axis.

    Parameters
    ----------
    joint
        Index of a joint that may turn.
    mean
        (4,) mean local rotation.
    axes
        (3, 3) natural axes, as those of the unknowns.
    low, high
        (F, 3) radians, or (3,).
    weight
        Per radian: large for a bound that is as good as hard.
    """

    joint: int
    mean: Array
    axes: Array
    low: Array
    high: Array
    weight: float

    def rows(self, posed: Posed) -> Rows:
        """Excess (F, 3) and its derivative by the unknowns."""
        local = posed.local(self.joint)
        away, inverse = turns.log(rot.to_matrix(self.mean).T @ local)
        along = away @ self.axes
        excess = along - np.clip(along, self.low, self.high)
        outside = np.flatnonzero(excess.any(axis=1))
        step = inverse[outside] @ posed.local_partials(self.joint)[outside]
        jacobian = np.zeros((len(outside), 3, posed.freedom.size))
        active = (excess[outside] != 0)[..., None] * self.weight
        jacobian[:, :, posed.freedom.columns(self.joint)] = active * (self.axes.T @ step)
        return Rows(outside, self.weight * excess[outside], jacobian)
