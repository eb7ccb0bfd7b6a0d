"""Keep hands and feet where they were when something nearer the trunk is repaired."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.anatomy import extremities
from mocapstudio.cleaning.ik.apply import Departure, declared_changes, with_departures
from mocapstudio.cleaning.ik.freedom import chain, freedom
from mocapstudio.cleaning.ik.objectives.orientation import Orientation
from mocapstudio.cleaning.ik.objectives.position import PointAtTarget
from mocapstudio.cleaning.ik.objectives.rows import Objective
from mocapstudio.cleaning.ik.posed import window
from mocapstudio.cleaning.ik.ranges import JointRanges, joint_ranges
from mocapstudio.cleaning.ik.solve import Problem, solve
from mocapstudio.cleaning.ik.windows import range_limit, smooth
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.runs import runs
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]

_HOLD = 5e4
_TURN = 1e2
"""Per radian: hands and feet keep their direction within a fraction of a degree."""
_LIMIT = 30.0
_MOVED = 1e-6
_EASING = 0.05


@dataclass(frozen=True, eq=False)
class KeptEnds:
    """A repair whose hands and feet stay.

    Attributes
    ----------
    take
        The repaired take, its other limbs bent so that they reach where they were.
    declared
        What changed further: limb joints × spans, beyond the repair's own.
    gaps
        Metres that each end effector is off at most, by joint: more than a millimetre only where
        the limb is too short.
    """

    take: Take
    declared: tuple[Declared, ...]
    gaps: dict[str, float]


def keep_ends(before: Take, after: Take, ranges: JointRanges | None = None) -> KeptEnds:
    """Bring hands and feet of limbs that a repair did not touch back to where they were.

    Parameters
    ----------
    before, after
        F frames of one take, without and with the repair.
    ranges
        How far joints turn; by default learnt from `before`.

    Raises
    ------
    MocapError
        If the two are not versions of one take.
    """
    if before.skeleton.names != after.skeleton.names or before.frames != after.frames:
        raise MocapError(f"{after.name} is no version of {before.name}")
    ranges = ranges or joint_ranges([before])
    ends = _ends_outside(before, after)
    was, moved = take_pose(before), take_pose(after)
    departures: list[Departure] = []
    for joint in ends:
        away = np.linalg.norm(moved[0][:, joint] - was[0][:, joint], axis=1)
        away += rot.angle(moved[1][:, joint], was[1][:, joint])
        departures += [_bring_back(after, was, joint, span, ranges) for span in runs(away > _MOVED)]
    kept = with_departures(after, departures)
    now = take_pose(kept)[0]
    gaps = {
        before.skeleton.names[j]: float(np.linalg.norm(now[:, j] - was[0][:, j], axis=1).max())
        for j in ends
    }
    return KeptEnds(kept, declared_changes(after, departures), gaps)


def _ends_outside(before: Take, after: Take) -> list[int]:
    """Wrists and ankles of limbs in which nothing changed."""
    changed = np.flatnonzero((before.rotations != after.rotations).any(axis=(0, 2)))
    parts = topology(before.skeleton)
    touched = set(changed.tolist())
    ends = [*extremities(before.skeleton, "leg"), *extremities(before.skeleton, "arm")]
    return [e.joint for e in ends if not touched & set(parts.limb_of(e.joint).joints)]


def _bring_back(
    take: Take, was: tuple[Array, Array], joint: int, span: tuple[int, int], ranges: JointRanges
) -> Departure:
    start, end = span
    joints = chain(take.skeleton, joint, ranges)
    free = freedom(joints, ranges)
    frames = np.arange(end - start)
    target = rot.to_matrix(was[1][start:end, joint])
    place = was[0][start:end, joint]
    weight = np.full(len(frames), _TURN)
    wishes: list[Objective] = [
        PointAtTarget(joint, np.zeros(3), frames, place, _HOLD, np.eye(3)),
        Orientation(joint, frames, target, weight),
        *(range_limit(take, j, span, ranges, _LIMIT) for j in joints),
    ]
    view = window(take, start, end, [joint, *joints])
    problem = Problem(view, free, wishes, smooth(take, free, span, _EASING))
    return Departure(span, problem, solve(problem).unknowns)
