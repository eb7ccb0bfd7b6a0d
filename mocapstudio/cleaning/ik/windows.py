"""Windows of frames in which contacts are solved for, and what is wanted in them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.anatomy import leg_length
from mocapstudio.cleaning.ik.freedom import Freedom, chain, freedom
from mocapstudio.cleaning.ik.limits import RangeLimit
from mocapstudio.cleaning.ik.objectives.orientation import Orientation
from mocapstudio.cleaning.ik.objectives.over_time import KeepPose, Smoothness
from mocapstudio.cleaning.ik.objectives.position import PointAtTarget
from mocapstudio.cleaning.ik.objectives.rows import Objective
from mocapstudio.cleaning.ik.posed import Posed, window
from mocapstudio.cleaning.ik.priority import weights
from mocapstudio.cleaning.ik.ranges import JointRanges
from mocapstudio.cleaning.ik.solve import Problem
from mocapstudio.cleaning.ik.targets import Hold
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]

CONTACT_WEIGHTS = (2e2, 4e5)
"""Per metre, growing: at first contacts on one foot find places that agree, at last they hold."""
TOLERANCE, SMALLEST = 5e-4, 1.5e-3
"""When a window counts as solved: a tenth of a degree is not seen."""
_LIMIT_WEIGHT = 30.0
_TURN_WEIGHT = 2.0
"""Per radian: feet and hands in contact keep their direction rather than their angle."""
_SMOOTHNESS = 2.5
"""Per metre: that of a joint 0.9 m from the end of its limb, 2.25 per radian."""
_LEG = 0.9
"""Metres: what is farther from a limb's end moves more smoothly, as its inertia would have it."""
_LEAST_LEVER = 0.05
_STEADY = 0.15
_FADES = 3.3
"""The easing in lengths over which a smooth departure fades by e."""
_ORDER = 2


def cut(take: Take, holds: Sequence[Hold], easing: float) -> list[tuple[int, int]]:
    """Half-open spans that hold all contacts with room to ease, those that meet joined.

    Frames outside the take's trim stay out, unless a contact lies there.
    """
    room = max(2, round(easing * float(take.rate)))
    low, high = take.span
    if any(h.contact.start < low or h.contact.end > high for h in holds):
        low, high = 0, take.frames
    spans: list[tuple[int, int]] = []
    for hold in sorted(holds, key=lambda h: h.contact.start):
        start = max(low, hold.contact.start - room)
        end = min(high, hold.contact.end + room)
        if spans and start <= spans[-1][1]:
            spans[-1] = (spans[-1][0], max(spans[-1][1], end))
        else:
            spans.append((start, end))
    return spans


def problem(
    take: Take,
    holds: Sequence[Hold],
    span: tuple[int, int],
    ranges: JointRanges,
    easing: float,
    root_reach: float,
    weight: float,
) -> Problem:
    """State what is wanted of one window: contacts met, the rest as it was.

    `weight` is that of contacts, per metre; hands give way to feet.
    """
    start, end = span
    ends = sorted({h.joint for h in holds})
    joints = {j for end_joint in ends for j in chain(take.skeleton, end_joint, ranges)}
    free = freedom(joints, ranges, reach=root_reach * leg_length(take.skeleton))
    view = window(take, start, end, [*ends, *joints])
    asis = Posed(view, free, np.zeros((end - start, free.size)))
    wishes: list[Objective] = [
        PointAtTarget(h.joint, h.offset, h.frames - start, h.target, weight * share, h.projection)
        for h, share in zip(holds, weights(take.skeleton, holds), strict=True)
    ]
    every = np.arange(end - start)
    wishes += [
        Orientation(
            j, every, asis.rotations[:, asis.at(j)].copy(), np.full(len(every), _TURN_WEIGHT)
        )
        for j in ends
    ]
    wishes += [range_limit(take, j, span, ranges, _LIMIT_WEIGHT) for j in free.joints]
    return Problem(view, free, wishes, smooth(take, free, span, easing))


def range_limit(
    take: Take, joint: int, span: tuple[int, int], ranges: JointRanges, weight: float
) -> RangeLimit:
    """Bound a joint by its range, widened where the take itself goes beyond it."""
    q = rot.multiply(rot.conjugate(ranges.mean[joint]), take.rotations[slice(*span), joint])
    own = rot.to_rotation_vector(q) @ ranges.axes[joint]
    low = np.minimum(ranges.low[joint], own)
    high = np.maximum(ranges.high[joint], own)
    return RangeLimit(joint, ranges.mean[joint], ranges.axes[joint], low, high, weight)


def smooth(
    take: Take, free: Freedom, span: tuple[int, int], easing: float
) -> tuple[KeepPose, Smoothness]:
    """Keep the pose, and ease into and out of every departure within about `easing` seconds."""
    start, end = span
    low, high = take.span
    length = max(1.0, easing * float(take.rate) / _FADES)
    # What is stiff has to fade as slowly as what is soft, or it would be used in bursts.
    lever = levers(take.skeleton, free)
    lever[free.first :] *= lever[free.first :] / _LEG
    steady = np.maximum(_SMOOTHNESS * lever, _STEADY * free.stiffness)
    joins = start not in (0, low), end not in (take.frames, high)
    return (
        KeepPose(end - start, free.stiffness),
        Smoothness(end - start, steady * length**_ORDER, _ORDER, *joins),
    )


def levers(skeleton: Skeleton, free: Freedom) -> Array:
    """(n,) metres that the farthest tip moves with each unknown of 1: what is to move smoothly."""
    place = skeleton.rest_positions
    tips = place[skeleton.end_parents] + skeleton.end_offsets
    found = [1.0] * 3 if free.moves else []
    for joint in free.joints:
        below = skeleton.descendants(joint)
        ends = tips[np.isin(skeleton.end_parents, below)]
        away = np.linalg.norm(np.concatenate([place[below], ends]) - place[joint], axis=1)
        found += [max(float(away.max()), _LEAST_LEVER)] * 3
    return np.array(found)
