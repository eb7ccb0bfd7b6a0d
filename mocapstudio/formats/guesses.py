"""Guesses about what a motion file leaves open: unit, up axis, T-pose. Named as guesses."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.options import UNITS, Forward, Up
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import ParameterError
from mocapstudio.motion.kinematics import global_pose
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]

# Thigh and shank of an adult; half of all people lie within a tenth of it.
_LEG_METRES = 0.85
_HEIGHT_METRES = 1.7
# Below it a small child, above it nobody: then the unit is none of the usual ones.
_PLAUSIBLE_LEG = (0.55, 1.05)

_LATEST_START = 4
_EARLY = 120
# A low-pass filter rings for a few frames after a jump.
_RINGING = 16


def guess_unit(skeleton: Skeleton) -> tuple[float, str]:
    """Metres per unit of a skeleton given in units of its file, and the reason as a phrase."""
    legs = [limb.joints for limb in topology(skeleton).limbs if limb.name.endswith("leg")]
    leg = max((_two_longest(skeleton, joints) for joints in legs), default=0.0)
    height = float(np.ptp(skeleton.rest_positions, axis=0).max())
    if leg > 0:
        length, metres, what = leg, _LEG_METRES, "legs"
    elif height > 0:
        length, metres, what = height, _HEIGHT_METRES, "a rest pose"
    else:
        return UNITS["cm"], "no bone has a length"
    free = metres / length
    unit = min(UNITS.values(), key=lambda u: abs(np.log(u / free)))
    low, high = (bound / _LEG_METRES for bound in _PLAUSIBLE_LEG)
    if not low <= unit / free <= high:
        unit = float(f"{free:.1g}")
    return unit, f"{what} of {length * unit:.2f} m"


def _two_longest(skeleton: Skeleton, leg: tuple[int, ...]) -> float:
    """Length of thigh and shank, of which the latter may end in a tip instead of a joint."""
    tips = skeleton.end_offsets[np.isin(skeleton.end_parents, leg)]
    bones = np.concatenate([skeleton.offsets[list(leg[1:])], tips])
    return float(np.sort(np.linalg.norm(bones, axis=1))[-2:].sum())


def guess_up(
    skeleton: Skeleton, rotations: Array, translations: Array, translated: tuple[int, ...]
) -> tuple[Up, str]:
    """Which world axis points from feet to head in the first seconds; Y where none can be told.

    Parameters
    ----------
    skeleton, rotations, translations, translated
        As in `Take`, still in the file's own axes.
    """
    parts = topology(skeleton)
    legs = [limb.joints[-1] for limb in parts.limbs if "leg" in limb.name]
    heads = [limb.joints[-1] for limb in parts.limbs if limb.name == "head"]
    if not legs or not heads:
        return "y", "no head and feet to tell by"
    some = np.unique(np.linspace(0, len(rotations) - 1, 40).astype(int))
    positions, _ = global_pose(skeleton, rotations[some], translations[some], translated)
    rise = positions[:, heads].mean(axis=1) - positions[:, legs].mean(axis=1)
    length = np.linalg.norm(rise, axis=-1, keepdims=True)
    mean = (rise / np.where(length > 0, length, 1.0)).mean(axis=0)
    up: Up = "z" if mean[2] > 0.6 and mean[2] > 1.2 * abs(mean[1]) else "y"
    if up == "y" and mean[1] < 0.2:
        return "y", "usual; the head is not above the feet"
    return up, "the head is above the feet"


def turn_to_y_up(up: Up) -> Array:
    """(4,) quaternion that turns a world whose `up` axis points up into one where Y does."""
    quarter = np.sqrt(0.5)
    if up == "z":
        return np.array([-quarter, 0.0, 0.0, quarter])
    if up == "x":
        return np.array([0.0, 0.0, quarter, quarter])
    return rot.IDENTITY.copy()


def turn_to_inside(up: Up, forward: Forward | None = None) -> Array:
    """(4,) quaternion that turns a world with these axes into one of Y up and, if told, Z forward.

    Raises
    ------
    ParameterError
        If forward is along the axis that points up.
    """
    if forward is None:
        return turn_to_y_up(up)
    if forward[-1] == up:
        raise ParameterError(f"forward {forward} is along the up axis {up}")
    rise, ahead = np.eye(3)["xyz".index(up)], np.eye(3)["xyz".index(forward[-1])]
    if forward.startswith("-"):
        ahead = -ahead
    return rot.from_matrix(np.stack([np.cross(rise, ahead), rise, ahead]))


def synthetic_start(rotations: Array) -> int:
    """Count the rows of a synthetic pose (a T-pose, or all zero) put before the motion.

    They are rows in which most joints that move later stand at exactly no rotation, and from the
    last of which the body jumps many times faster than it moves afterwards. Where the whole was
    filtered afterwards, none stands exactly so any more, and the jump is smeared over some rows:
    those in which the body comes straight from no rotation, faster than it ever moves again, and
    in which the filter rings.

    Parameters
    ----------
    rotations
        (F, J, 4) local rotations.
    """
    return _exact_start(rotations) or _smeared_start(rotations)


def _exact_start(rotations: Array) -> int:
    early = rotations[:_EARLY]
    if len(early) < _LATEST_START * 2:
        return 0
    step = rot.angle(early[1:], early[:-1])
    moving = step[_LATEST_START:].max(axis=0) > 1e-4
    if moving.sum() < 4:
        return 0
    pace = float(np.median(step[_LATEST_START:, moving].mean(axis=1)))
    jumps = step[:, moving].mean(axis=1)
    unturned = (np.abs(early[:, moving, 3]) > 1 - 1e-12).mean(axis=1) >= 0.5
    for rows in range(1, _LATEST_START + 1):
        if not unturned[rows - 1]:
            return 0
        if not unturned[rows] and jumps[rows - 1] > max(np.radians(3), 8 * pace):
            return rows
    return 0


def _smeared_start(rotations: Array) -> int:
    early = rotations[: 2 * _RINGING]
    if len(early) < 2 * _RINGING:
        return 0
    step = rot.angle(early[1:], early[:-1])
    moving = step.max(axis=0) > 1e-4
    speed = step[:, moving].mean(axis=1) if moving.sum() >= 4 else np.zeros(len(step))
    afterwards = float(np.median(speed[_RINGING // 2 :]))
    if speed[0] < max(np.radians(3), 8 * afterwards):
        return 0
    # One slow step alone is where the ringing turns round.
    slow = speed[: _RINGING + 1] < 2 * afterwards
    settled = np.flatnonzero(slow[1:] & slow[:-1])
    rows = int(settled[0]) if len(settled) else _RINGING
    turned = rot.angle(early[[0, 1, rows]][:, moving], rot.IDENTITY).mean(axis=1)
    left = rot.angle(early[:2, moving], early[rows, moving]).mean(axis=1)
    is_straight = bool((turned[:2] + left < 1.1 * turned[2]).all())
    if not is_straight or turned[0] > turned[2] / 2:
        return 0
    every = rot.angle(rotations[rows + 1 :, moving], rotations[rows:-1, moving]).mean(axis=1)
    return rows if speed[0] > 2 * np.quantile(every, 0.99) else 0
