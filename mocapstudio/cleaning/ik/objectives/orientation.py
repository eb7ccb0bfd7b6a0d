"""A joint turned in the world as it should be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.ik import turns
from mocapstudio.cleaning.ik.objectives.rows import Rows
from mocapstudio.cleaning.ik.posed import Posed

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Orientation:
    """A joint keeps a rotation in the world.

    The residual is ``weight * log(target^-1 rotation)``.

    Parameters
    ----------
    joint
        Index of the joint.
    frames
        (m,) frames of the window.
    target
        (m, 3, 3) rotations in the world.
    weight
        (m,) per radian.
    """

    joint: int
    frames: NDArray[np.int64]
    target: Array
    weight: Array

    def rows(self, posed: Posed) -> Rows:
        """Rotation vectors (m, 3) from the target, and their derivative."""
        world = posed.rotations[self.frames, posed.at(self.joint)]
        away, inverse = turns.log(np.swapaxes(self.target, 1, 2) @ world)
        partials = posed.angular_partials(self.joint, self.frames)
        step = inverse @ np.swapaxes(world, 1, 2) @ partials
        return Rows(self.frames, self.weight[:, None] * away, self.weight[:, None, None] * step)
