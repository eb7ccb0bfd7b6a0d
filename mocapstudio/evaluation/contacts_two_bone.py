"""The usual clean-up to compare with: analytic two-bone inverse kinematics, frame by frame.

In every frame in which points of a foot are in contact, the ankle is moved by what they are off
their places on average; knee and hip follow by the law of cosines, the foot keeps its direction in
the world. Nothing is eased, as in a rig's foot lock.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.anatomy import Extremity, extremities
from mocapstudio.cleaning.contacts.model import Contact, ContactPoint
from mocapstudio.cleaning.ik.targets import Hold, holds
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]

_STRAIGHT = 1 - 1e-6
"""Of a leg's length: how far it is stretched at most."""


def two_bone(take: Take, contacts: Sequence[Contact], points: Sequence[ContactPoint]) -> Take:
    """Hold contacts of feet at their places; legs that cannot be told are left as they are.

    Raises
    ------
    MocapError
        If a contact does not fit the take.
    """
    laid = holds(take, contacts, points, {})
    positions, world = take_pose(take)
    rotations = take.rotations.copy()
    for foot in extremities(take.skeleton, "leg"):
        below = set(take.skeleton.descendants(foot.joint))
        step, held = _step(take.frames, [hold for hold in laid if hold.joint in below])
        joints = _leg(take, foot)
        if joints is not None and held.any():
            _bend(take, rotations, positions, world, joints, step, held)
    return take.with_motion(rot.continuous(rotations))


def _step(frames: int, laid: Sequence[Hold]) -> tuple[Array, NDArray[np.bool_]]:
    """(F, 3) metres by which a foot is to be moved, and (F,) whether it is held."""
    total, count = np.zeros((frames, 3)), np.zeros(frames)
    for hold in laid:
        total[hold.frames] += hold.target - hold.place
        count[hold.frames] += 1
    return total / np.maximum(count, 1)[:, None], count > 0


def _leg(take: Take, foot: Extremity) -> tuple[int, int, int] | None:
    """Hip, knee and ankle: the ends of the last two bones that have a length."""
    found = [foot.joint]
    while len(found) < 3:
        joint = found[-1]
        while joint >= 0 and np.linalg.norm(take.skeleton.offsets[joint]) < 1e-6:
            joint = int(take.skeleton.parents[joint])
        parent = int(take.skeleton.parents[joint]) if joint >= 0 else -1
        if parent < 0:
            return None
        found.append(parent)
    return found[2], found[1], found[0]


def _bend(
    take: Take,
    rotations: Array,
    positions: Array,
    world: Array,
    joints: tuple[int, int, int],
    step: Array,
    held: NDArray[np.bool_],
) -> None:
    """Turn hip, knee and ankle in place so that the ankle is moved by `step` (F, 3)."""
    hip, knee, ankle = joints
    thigh, shank = positions[:, knee] - positions[:, hip], positions[:, ankle] - positions[:, knee]
    upper, lower = _length(thigh), _length(shank)
    wanted = positions[:, ankle] + step - positions[:, hip]
    away = np.clip(_length(wanted), np.abs(upper - lower), (upper + lower) * _STRAIGHT)
    axis = np.cross(thigh, shank)
    straight = _length(axis) < 1e-9
    axis[straight] = np.cross(thigh[straight], [0.0, 0.0, 1.0])
    axis /= np.maximum(_length(axis), 1e-12)[:, None]
    now = np.arccos(np.clip(np.sum(thigh * shank, axis=1) / (upper * lower), -1, 1))
    bent = np.arccos(np.clip((away**2 - upper**2 - lower**2) / (2 * upper * lower), -1, 1))
    at_knee = rot.from_rotation_vector(axis * (bent - now)[:, None])
    at_hip = _between(thigh + rot.rotate(at_knee, shank), wanted)
    turned = {hip: rot.multiply(at_hip, world[:, hip])}
    turned[knee] = rot.multiply(rot.multiply(at_hip, at_knee), world[:, knee])
    turned[ankle] = world[:, ankle]
    for joint, above in ((hip, None), (knee, hip), (ankle, knee)):
        parent = int(take.skeleton.parents[joint])
        base = world[:, parent] if parent >= 0 else np.broadcast_to(rot.IDENTITY, (len(step), 4))
        if above is not None:
            # Joints of no length between two of the three turn with the one above.
            turn = rot.multiply(turned[above], rot.conjugate(world[:, above]))
            base = rot.multiply(turn, base)
        local = rot.multiply(rot.conjugate(base), turned[joint])
        rotations[held, joint] = local[held]


def _between(a: Array, b: Array) -> Array:
    """(F, 4) the shortest turn from the directions of (F, 3) vectors to those of others."""
    a, b = (v / np.maximum(_length(v), 1e-12)[:, None] for v in (a, b))
    axis = np.cross(a, b)
    sine, cosine = _length(axis), np.sum(a * b, axis=1)
    scale = np.arctan2(sine, cosine) / np.maximum(sine, 1e-12)
    return rot.from_rotation_vector(axis * scale[:, None])


def _length(vectors: Array) -> Array:
    return np.asarray(np.linalg.norm(vectors, axis=-1))
