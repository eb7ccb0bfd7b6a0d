"""How far joints turn, learnt from takes.

Each joint gets its natural axes, the principal axes of its rotations about their mean: a knee its
hinge first. A joint is soft where it is used to turning, so a knee bends before it twists.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]

_USUAL = 0.25
"""Radians: the spread of a joint axis whose stiffness is 1."""
_LEAST = 0.05
"""Radians: spreads below are not told apart."""
_RIGID = 0.01
"""Radians: a joint whose spread is smaller than this does not turn."""
_MARGIN = np.deg2rad(2.0)


@dataclass(frozen=True, eq=False)
class JointRanges:
    """Ranges of the J joints of one skeleton.

    Parameters
    ----------
    mean
        (J, 4) mean local rotation.
    axes
        (J, 3, 3): columns are the natural axes in the joint's own frame, the widest first.
    low, high
        (J, 3) radians: bounds of ``axes.T @ log(mean^-1 rotation)``.
    stiffness
        (J, 3): cost a radian about each axis.
    rigid
        (J,) bool: joints that never turn while others do.
    """

    mean: Array
    axes: Array
    low: Array
    high: Array
    stiffness: Array
    rigid: NDArray[np.bool_]


def joint_ranges(takes: Sequence[Take]) -> JointRanges:
    """Learn how far each joint turns from takes of one skeleton.

    Parameters
    ----------
    takes
        At least one; all with the joints of the first, in its order. Trimmed spans count.

    Raises
    ------
    MocapError
        If there is no take, or one has other joints.
    """
    if not takes:
        raise MocapError("joint ranges need at least one take")
    names = takes[0].skeleton.names
    for take in takes:
        if take.skeleton.names != names:
            raise MocapError(f"joint ranges: {take.name} has other joints than {takes[0].name}")
    q = np.concatenate([take.rotations[slice(*take.span)] for take in takes])
    mean = rot.mean(q)
    away = rot.to_rotation_vector(rot.multiply(rot.conjugate(mean), q))
    second = np.einsum("fja,fjb->jab", away, away) / len(away)
    spread, axes = np.linalg.eigh(second)
    spread, axes = np.sqrt(np.maximum(spread[:, ::-1], 0.0)), axes[:, :, ::-1]
    along = np.einsum("jab,fja->fjb", axes, away)
    return JointRanges(
        mean,
        np.ascontiguousarray(axes),
        along.min(axis=0) - _MARGIN,
        along.max(axis=0) + _MARGIN,
        _USUAL / np.hypot(spread, _LEAST),
        spread[:, 0] < _RIGID,
    )
