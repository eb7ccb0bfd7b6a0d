"""How likely each point of a body rests on the floor, frame by frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.anatomy import extremities, leg_length
from mocapstudio.cleaning.contacts.floor import FittedFloor, fit_floor
from mocapstudio.cleaning.contacts.model import ContactPoint
from mocapstudio.cleaning.contacts.points import Pose
from mocapstudio.cleaning.contacts.speeds import one_sided, smoothed
from mocapstudio.cleaning.contacts.states import learnt, log_speed, posterior, usual
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class OnFloor:
    """Points of a body and the floor.

    Attributes
    ----------
    probability
        (F, P) that a point rests on the floor; 0 outside the take's trim.
    speed
        (F, P) legs a second.
    floor
        The floor under the feet; None where there are no feet, and nothing rests then.
    """

    probability: Array
    speed: Array
    floor: FittedFloor | None


def on_floor(take: Take, points: Sequence[ContactPoint], positions: Array, pose: Pose) -> OnFloor:
    """Judge P points over F frames by their speed and their height over the fitted floor.

    Parameters
    ----------
    points, positions
        P contact points, and (F, P, 3) metres where they are.
    pose
        What `take_pose(take)` returns.
    """
    rate, leg = float(take.rate), leg_length(take.skeleton)
    low, high = take.span
    inside = positions[low:high]
    velocity = one_sided(smoothed(inside, rate), rate)
    speed, probability = np.zeros(positions.shape[:2]), np.zeros(positions.shape[:2])
    speed[low:high] = np.linalg.norm(velocity, axis=2) / leg
    hands = {take.skeleton.names[hand.joint] for hand in extremities(take.skeleton, "arm")}
    feet = [i for i, p in enumerate(points) if p.joint not in hands and p.point != "palm"]
    if not feet:
        return OnFloor(probability, speed, None)
    hips = pose[0][low:high, topology(take.skeleton).hips]
    limbs = [_limb(take, points[i].joint) for i in feet]
    floor = fit_floor(inside[:, feet], rate, leg, hips, limbs)
    # What is no foot is held against the plane alone: nobody knows how it would rest.
    height = inside[..., 1] - floor.at(inside)
    height[:, feet] = inside[:, feet, 1] - floor.under
    height /= leg
    for kind in {point.point for point in points}:
        mine = [i for i, point in enumerate(points) if point.point == kind]
        model = usual(kind)
        if kind != "palm":
            model = learnt(model, speed[low:high, mine], height[:, mine], rate)
        odds = model.log_odds(log_speed(speed[low:high, mine]), height[:, mine])
        probability[low:high, mine] = posterior(odds, rate)
    return OnFloor(probability, speed, floor)


def _limb(take: Take, joint: str) -> int:
    """Index of a joint's limb; -1 for joints of none."""
    index = take.skeleton.index[joint]
    limbs = topology(take.skeleton).limbs
    return next((i for i, limb in enumerate(limbs) if index in limb.joints), -1)
