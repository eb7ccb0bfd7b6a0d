"""How far points in contact slide: the figure that a clean-up is judged by."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.ik.targets import Hold
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Slide:
    """Speed of points against their targets while in contact, metres a second.

    Attributes
    ----------
    before, after
        Mean over all frames in contact.
    worst_before, worst_after
        The fastest of them.
    """

    before: float
    after: float
    worst_before: float
    worst_after: float


def places(take: Take, holds: Sequence[Hold]) -> list[Array]:
    """(m, 3) metres for each hold: where its point is in the world over its frames."""
    positions, world = take_pose(take)
    result = []
    for hold in holds:
        at = (slice(hold.contact.start, hold.contact.end), hold.joint)
        result.append(positions[at] + rot.rotate(world[at], hold.offset))
    return result


def slide(before: Take, after: Take, holds: Sequence[Hold]) -> Slide:
    """Measure the slide of the same contacts in two versions of a take."""
    was, is_now = (_speeds(take, holds) for take in (before, after))
    return Slide(*(float(f(v)) for f in (np.mean, np.max) for v in (was, is_now)))


def _speeds(take: Take, holds: Sequence[Hold]) -> Array:
    speeds = [hold.steps(place) for hold, place in zip(holds, places(take, holds), strict=True)]
    # Contacts of a single frame do not slide.
    return np.concatenate([*speeds, np.zeros(1)] if not any(map(len, speeds)) else speeds) * float(
        take.rate
    )
