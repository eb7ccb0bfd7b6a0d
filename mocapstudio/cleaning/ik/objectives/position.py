"""A point of the body at its target: a place, a plane or a line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.ik.objectives.rows import Rows
from mocapstudio.cleaning.ik.posed import Posed

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class PointAtTarget:
    """A point stays at a target; directions in which it may slide are projected away.

    The residual is ``weight * projection @ (point - target)``.

    Parameters
    ----------
    joint, offset
        The joint that carries the point, and the point (3,) metres in its frame.
    frames
        (m,) frames of the window.
    target
        (m, 3) metres in the world.
    weight
        Per metre.
    projection
        (r, 3) or (m, r, 3): rows span the directions in which the point is held; the identity
        holds it in all, one row on a plane, two on a line.
    """

    joint: int
    offset: Array
    frames: NDArray[np.int64]
    target: Array
    weight: float
    projection: Array

    def rows(self, posed: Posed) -> Rows:
        """Distance from the target (m, r) and its derivative."""
        point = posed.point(self.joint, self.offset, self.frames)
        scaled = self.weight * self.projection
        partials = posed.point_partials(self.joint, point, self.frames)
        away = (scaled @ (point - self.target)[..., None])[..., 0]
        return Rows(self.frames, away, scaled @ partials)


def across(direction: Array) -> Array:
    """(2, 3): two unit vectors at right angles to a unit direction and to each other."""
    least = np.eye(3)[np.argmin(np.abs(direction))]
    first = np.cross(direction, least)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(direction, first)])
