"""Left and right exchanged: undone by exchanging them once more.

An exchange of marker labels gives each bone the direction in the world that its mirror partner's
had; an exchange of channels, its local rotations. Either is its own inverse, so the limbs' true
motion comes back exactly, where it really was one.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import body_frame, hips_world
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

F64 = NDArray[np.float64]

DIRECTIONS = "directions"
REFLECTED = "reflected"
CHANNELS = "channels"
MANNERS = (DIRECTIONS, REFLECTED, CHANNELS)
"""Ways of exchanging: bones' directions in the world, the same reflected in the body's median
plane (the limb mimics the other side), or local rotations as they stand."""


def has_two_sides(skeleton: Skeleton, joints: Sequence[int]) -> bool:
    """Tell whether some of the joints are mirror images of each other."""
    mirror = topology(skeleton).mirror
    return any(int(mirror[j]) != j and int(mirror[j]) in joints for j in joints)


def exchanged(take: Take, joints: Sequence[int], start: int, end: int, manner: str) -> F64:
    """(n, u, 4) local rotations of `joints` over [start, end), each side in the other's place.

    Parameters
    ----------
    joints
        Joints of both sides, parents before children.
    manner
        Of `MANNERS`.
    """
    skeleton, mirror = take.skeleton, topology(take.skeleton).mirror
    if manner == CHANNELS:
        return take.rotations[start:end, [int(mirror[j]) for j in joints]].copy()
    _, world = take_pose(take, start, end)
    target, found = world.copy(), np.empty((end - start, len(joints), 4))
    for i, joint in enumerate(joints):
        above = target[:, int(skeleton.parents[joint])]
        bone, other = _bone(skeleton, joint), _bone(skeleton, int(mirror[joint]))
        if bone is None or other is None:
            # Without a bone of its own a joint keeps its angle to its parent.
            found[:, i] = take.rotations[start:end, joint]
        else:
            now = rot.rotate(world[:, joint], np.broadcast_to(bone, (end - start, 3)))
            then = rot.rotate(world[:, mirror[joint]], np.broadcast_to(other, (end - start, 3)))
            if manner == REFLECTED:
                then = _reflected(take, start, then)
            turned = rot.multiply(_least_turn(now, then), world[:, joint])
            found[:, i] = rot.multiply(rot.conjugate(above), turned)
        target[:, joint] = rot.multiply(above, found[:, i])
        _carry(skeleton, take, target, joint, set(joints), start, end)
    return found


def _carry(
    skeleton: Skeleton,
    take: Take,
    target: F64,
    joint: int,
    exchanged_too: set[int],
    start: int,
    end: int,
) -> None:
    """Let joints below that are not exchanged follow, so that what is below them finds them."""
    for child in skeleton.children[joint]:
        if child not in exchanged_too:
            target[:, child] = rot.multiply(target[:, joint], take.rotations[start:end, child])
            _carry(skeleton, take, target, child, exchanged_too, start, end)


def _bone(skeleton: Skeleton, joint: int) -> F64 | None:
    """Return the joint's bone as a unit vector in its own frame: to its child, or its tip."""
    reach = [skeleton.offsets[c] for c in skeleton.children[joint]]
    reach += list(skeleton.end_offsets[skeleton.end_parents == joint])
    norms = ((vector, float(np.linalg.norm(vector))) for vector in reach)
    return next((np.asarray(vector / norm) for vector, norm in norms if norm > 1e-4), None)


def _reflected(take: Take, start: int, vectors: F64) -> F64:
    _, hips = hips_world(take, start, start + len(vectors))
    body = rot.multiply(hips, body_frame(take.skeleton))
    left = rot.rotate(body, np.broadcast_to([1.0, 0.0, 0.0], vectors.shape))
    return np.asarray(vectors - 2 * np.sum(vectors * left, axis=-1, keepdims=True) * left)


def _least_turn(a: F64, b: F64) -> F64:
    """(n, 4) the shortest rotations from unit vectors `a` to `b`; half a turn where opposite."""
    q = np.concatenate([np.cross(a, b), 1.0 + np.sum(a * b, axis=-1, keepdims=True)], axis=-1)
    aside = np.cross(a, np.eye(3)[np.abs(a).argmin(axis=-1)])
    half_turn = np.concatenate([aside, np.zeros((len(a), 1))], axis=-1)
    opposite = np.linalg.norm(q, axis=-1, keepdims=True) < 1e-6
    return rot.normalize(np.where(opposite, half_turn, q))
