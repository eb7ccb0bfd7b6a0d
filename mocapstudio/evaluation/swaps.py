"""A limb that takes the other side's place, as after a swap of marker labels."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mocapstudio.evaluation.shapes import Family
from mocapstudio.evaluation.truth import Array
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import body_frame, hips_world
from mocapstudio.motion.kinematics import global_pose
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

LABELS = "labels"
"""Each bone takes the direction in the world that its mirror partner's has."""
MIRRORED = "mirrored"
"""The same, reflected in the hips' median plane: the limb mimics the other side."""
CHANNELS = "channels"
"""Local rotations are exchanged as they stand in the file."""


def draw_manner(family: Family, rng: np.random.Generator) -> str:
    """How to swap: `LABELS` or `MIRRORED`; held out: `CHANNELS`."""
    if family == "held-out":
        return CHANNELS
    return LABELS if rng.random() < 0.5 else MIRRORED


def pairs(
    skeleton: Skeleton, joint: int | None = None
) -> list[tuple[tuple[int, ...], tuple[int, ...]]]:
    """Limbs with their mirror images (the side that comes first first), details left out.

    Given a joint, only the pair that holds it.
    """
    parts = topology(skeleton)
    found = []
    for limb in parts.limbs:
        joints = tuple(j for j in limb.joints if j not in parts.details and parts.mirror[j] != j)
        other = tuple(int(parts.mirror[j]) for j in joints)
        if joints and joints[0] < other[0] and (joint is None or joint in {*joints, *other}):
            found.append((joints, other))
    return found


def swap(take: Take, start: int, joints: Sequence[int], manner: str, out: Array) -> None:
    """Exchange a limb and its mirror image in `out`, the (n, J, 4) rotations from `start` on.

    Bone directions are exchanged, not rotations: the rest frames of the two sides differ from
    skeleton to skeleton, and twist is what markers on a bone's ends do not show, so each bone
    turns by the least rotation that gives it its new direction.
    """
    mirror = topology(take.skeleton).mirror
    if manner == CHANNELS:
        original = out.copy()
        for joint in joints:
            out[:, joint] = original[:, mirror[joint]]
        return
    skeleton, end = take.skeleton, start + len(out)
    _, world = global_pose(skeleton, out, take.translations[start:end], take.translated)
    target = world.copy()
    for joint in sorted(joints):
        bone, other = _bone(skeleton, joint), _bone(skeleton, int(mirror[joint]))
        parent = int(skeleton.parents[joint])
        if bone is None or other is None:
            # Without a bone of its own a joint keeps its angle to its parent.
            local = rot.multiply(rot.conjugate(world[:, parent]), world[:, joint])
            target[:, joint] = rot.multiply(target[:, parent], local)
            continue
        now = rot.rotate(world[:, joint], np.broadcast_to(bone, (len(out), 3)))
        then = rot.rotate(world[:, mirror[joint]], np.broadcast_to(other, (len(out), 3)))
        if manner == MIRRORED:
            then = _reflect(take, start, then)
        target[:, joint] = rot.multiply(_least_turn(now, then), world[:, joint])
    for joint in sorted(joints):
        above = target[:, int(skeleton.parents[joint])]
        out[:, joint] = rot.multiply(rot.conjugate(above), target[:, joint])


def _bone(skeleton: Skeleton, joint: int) -> Array | None:
    """Return the joint's bone as a unit vector in its own frame: to its child, or its tip."""
    reach = [skeleton.offsets[c] for c in skeleton.children[joint]]
    reach += list(skeleton.end_offsets[skeleton.end_parents == joint])
    for vector in reach:
        norm = np.linalg.norm(vector)
        if norm > 1e-4:
            return np.asarray(vector / norm)
    return None


def _reflect(take: Take, start: int, vectors: Array) -> Array:
    _, hips = hips_world(take, start, start + len(vectors))
    body = rot.multiply(hips, body_frame(take.skeleton))
    left = rot.rotate(body, np.broadcast_to([1.0, 0.0, 0.0], vectors.shape))
    return np.asarray(vectors - 2 * np.sum(vectors * left, axis=-1, keepdims=True) * left)


def _least_turn(a: Array, b: Array) -> Array:
    """(n, 4) the shortest rotations from unit vectors `a` to `b`; half a turn where opposite."""
    q = np.concatenate([np.cross(a, b), 1.0 + np.sum(a * b, axis=-1, keepdims=True)], axis=-1)
    aside = np.cross(a, np.eye(3)[np.abs(a).argmin(axis=-1)])
    half_turn = np.concatenate([aside, np.zeros((len(a), 1))], axis=-1)
    opposite = np.linalg.norm(q, axis=-1, keepdims=True) < 1e-6
    return rot.normalize(np.where(opposite, half_turn, q))
