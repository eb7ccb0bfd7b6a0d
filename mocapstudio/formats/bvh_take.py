"""From BVH's columns to a take and back: which column is which joint's, in which unit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.bvh_hierarchy import Hierarchy
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.skeleton import Skeleton

Array = NDArray[np.float64]

# Position channels that stay within this share of the skeleton's size are a bone, not a motion.
_STILL = 2e-5


@dataclass(frozen=True, eq=False)
class Layout:
    """How the motion of one hierarchy is laid out.

    Attributes
    ----------
    hierarchy
        Joints with their columns.
    skeleton
        In units of the file.
    translated
        Joints whose local translation changes in time; the root first.
    additive
        True where position channels below the root are displacements from the OFFSET.
    add_root
        The same for the root.
    radians
        True where rotation channels hold radians.
    """

    hierarchy: Hierarchy
    skeleton: Skeleton
    translated: tuple[int, ...]
    additive: bool
    add_root: bool = False
    radians: bool = False

    @property
    def to_radians(self) -> float:
        """Radians per unit of the rotation channels."""
        return 1.0 if self.radians else float(np.pi / 180)

    def base(self, joint: int) -> tuple[float, float, float]:
        """What the position channels of a joint are added to."""
        added = self.additive if joint else self.add_root
        return self.hierarchy.joints[joint].offset if added else (0.0, 0.0, 0.0)


def lay_out(
    hierarchy: Hierarchy, numbers: Array, *, radians: bool = False, add_root: bool = False
) -> Layout:
    """Tell moving joints from bones, and place the skeleton's joints.

    Position channels are the whole local translation and take the OFFSET's place: some exporters
    repeat it there, others leave it zero, and for the root some write a rest height that the
    channel already holds. Only where the channels below the root are all but zero while the
    offsets are not, are they displacements.

    Parameters
    ----------
    hierarchy
        What the file declares.
    numbers
        (F, C) of its motion, one column a channel.
    radians
        Whether its angles are radians.
    add_root
        Whether the root's OFFSET is added to its channels.
    """
    joints = hierarchy.joints
    offsets = np.array([joint.offset for joint in joints])
    size = float(np.abs(offsets).sum()) or 1.0
    moving = [j for j in range(1, len(joints)) if joints[j].moves]
    additive = _displacements(hierarchy, numbers, moving)
    translated = [0]
    for j in moving:
        track = _track(hierarchy, numbers, j, additive)
        if np.ptp(track, axis=0).max() > _STILL * size:
            translated.append(j)
            if not np.any(offsets[j]):
                offsets[j] = np.median(track, axis=0)
        else:
            offsets[j] = np.median(track, axis=0)
    skeleton = Skeleton(
        names=tuple(joint.name for joint in joints),
        parents=np.array([joint.parent for joint in joints], dtype=np.int64),
        offsets=offsets,
        end_parents=np.array([parent for parent, _ in hierarchy.ends], dtype=np.int64),
        end_offsets=np.array([offset for _, offset in hierarchy.ends]).reshape(-1, 3),
        axes=tuple(_axes(joint.order) for joint in joints),
    )
    return Layout(hierarchy, skeleton, tuple(translated), additive, add_root, radians)


def _axes(order: str) -> Array:
    """The (d, 3) axes that rotation channels turn about, outermost first; three channels do all."""
    letters = "XYZ" if len(order) > 2 else "".join(dict.fromkeys(order))
    return np.eye(3)[["XYZ".index(letter) for letter in letters]]


def _displacements(hierarchy: Hierarchy, numbers: Array, moving: list[int]) -> bool:
    ratios = []
    for j in moving:
        length = float(np.linalg.norm(hierarchy.joints[j].offset))
        columns = [c for c in hierarchy.joints[j].positions if c >= 0]
        if length > 0:
            ratios.append(float(np.linalg.norm(np.median(numbers[:, columns], axis=0))) / length)
    return bool(ratios) and float(np.median(ratios)) < 0.1


def _track(hierarchy: Hierarchy, numbers: Array, j: int, added: bool) -> Array:
    joint = hierarchy.joints[j]
    track = np.empty((len(numbers), 3))
    for axis, column in enumerate(joint.positions):
        if column < 0:
            track[:, axis] = joint.offset[axis]
        else:
            base = joint.offset[axis] if added else 0.0
            track[:, axis] = numbers[:, column] + base
    return track


def motion(layout: Layout, numbers: Array) -> tuple[Array, Array]:
    """Rotations (F, J, 4) and translations (F, T, 3) of the rows, in units and axes of the file."""
    joints = layout.hierarchy.joints
    rotations = np.empty((len(numbers), len(joints), 4))
    # One joint at a time keeps temporaries in the cache, and memory near that of the result.
    for j, joint in enumerate(joints):
        angles = [numbers[:, column] * layout.to_radians for column in joint.rotations]
        rotations[:, j] = _continuous(_quaternions(joint.order, angles, len(numbers)))
    translations = np.empty((len(numbers), len(layout.translated), 3))
    for t, j in enumerate(layout.translated):
        translations[:, t] = _track(
            layout.hierarchy, numbers, j, layout.additive if j else layout.add_root
        )
    return rotations, translations


def _quaternions(order: str, angles: list[Array], frames: int) -> Array:
    if not order:
        return np.tile(rot.IDENTITY, (frames, 1))
    if len(set(order)) != 3:
        return rot.from_euler(order, np.stack(angles, axis=-1))
    i, j, k = ("XYZ".index(letter) for letter in order)
    sign = 1.0 if (i + 1) % 3 == j else -1.0
    (s1, c1), (s2, c2), (s3, c3) = ((np.sin(0.5 * a), np.cos(0.5 * a)) for a in angles)
    q = np.empty((frames, 4))
    q[:, i] = s1 * c2 * c3 + sign * c1 * s2 * s3
    q[:, j] = c1 * s2 * c3 - sign * s1 * c2 * s3
    q[:, k] = c1 * c2 * s3 + sign * s1 * s2 * c3
    q[:, 3] = c1 * c2 * c3 - sign * s1 * s2 * s3
    return q


def _continuous(q: Array) -> Array:
    flips = np.flatnonzero(np.einsum("ij,ij->i", q[1:], q[:-1]) < 0) + 1
    for a, b in zip(flips[::2], [*flips[1::2], len(q)], strict=False):
        q[a:b] *= -1.0
    return q
