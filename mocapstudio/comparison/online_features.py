"""Poses in the form in which they are aligned online: rotations of joints or directions of bones.

Paper 3 compares rotations only, so that bodies of other proportions can be aligned: those of the
joints relative to their parents, and that of the root relative to the first frame of the action.
Markers have no rotations; there the directions of bones between markers stand in, the whole body
turned about the vertical so that it begins as the reference does.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError, SkeletonMismatchError
from mocapstudio.motion.facing import hips_world
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology
from mocapstudio.similarity.texture import comparable_joints

F32 = NDArray[np.float32]
F64 = NDArray[np.float64]
I32 = NDArray[np.int32]
Recording = Take | MarkerTake

_SHORTEST_BONE = 0.04
_SEEN = 0.5


class Features(Protocol):
    """What is compared of a pose: D rows of four numbers, unit vectors."""

    @property
    def names(self) -> tuple[str, ...]:
        """Of the D rows: joints, or bones as ``"marker-marker"``."""

    @property
    def directions(self) -> bool:
        """Whether rows are directions of bones, with a fourth component of 0, or quaternions."""

    @property
    def root(self) -> int | None:
        """Row that turns the whole body, or None where all rows do."""

    def of(self, take: Recording) -> F32:
        """(F, D, 4): the poses of a take's trimmed span; NaN where a row cannot be told."""

    def start(self, pose: F32) -> F32 | None:
        """(4, 4) matrix that turns poses as the action's first pose tells, None if it cannot."""

    def turned(self, poses: F32, turn: F32) -> F32:
        """Poses (..., D, 4) turned by a matrix of `start`."""


@dataclass(frozen=True, eq=False)
class JointRotations:
    """Rotations of joints relative to their parents, of the hips relative to the first frame.

    Parameters
    ----------
    names
        D joints.
    root
        Row of the hips, or None where they are not compared.
    above
        The joints above the hips, nearest first: they move the world, not the body.
    """

    names: tuple[str, ...]
    root: int | None
    above: tuple[str, ...] = ()
    directions: bool = False

    @classmethod
    def common(cls, reference: Take, others: tuple[Take, ...] = ()) -> JointRotations:
        """Compare the reference's body joints that all other takes have too.

        Raises
        ------
        SkeletonMismatchError
            If a take lacks half of them or more.
        """
        names = comparable_joints(reference, others)
        skeleton = reference.skeleton
        hips = topology(skeleton).hips
        above = tuple(skeleton.names[joint] for joint in skeleton.ancestors(hips))
        name = skeleton.names[hips]
        return cls(names, names.index(name) if name in names else None, above)

    def of(self, take: Recording) -> F32:
        """(F, D, 4) quaternions; of the hips in the world. See `Features.of`."""
        if isinstance(take, MarkerTake):
            raise SkeletonMismatchError(f"{take.name} holds markers, the reference joints")
        first, last = take.span
        missing = [name for name in self.names if name not in take.skeleton.index]
        if missing:
            raise SkeletonMismatchError(f"{take.name} has no joint {missing[0]}")
        columns = [take.skeleton.index[name] for name in self.names]
        poses = take.rotations[first:last, columns]
        if self.root is not None:
            poses[:, self.root] = rot.continuous(hips_world(take, first, last)[1])
        return poses.astype(np.float32)

    def start(self, pose: F32) -> F32 | None:
        """Return the inverse of the hips' rotation. See `Features.start`."""
        if self.root is None:
            return np.eye(4, dtype=np.float32)
        x, y, z, w = (float(value) for value in pose[self.root])
        # Left multiplication by the conjugate (-x, -y, -z, w).
        rows = [[w, z, -y, -x], [-z, w, x, -y], [y, -x, w, -z], [x, y, z, w]]
        matrix = np.array(rows, dtype=np.float32)
        return matrix if np.isfinite(matrix).all() else None

    def turned(self, poses: F32, turn: F32) -> F32:
        """Turn the hips alone. See `Features.turned`."""
        if self.root is None:
            return poses
        poses = poses.copy()
        poses[..., self.root, :] = poses[..., self.root, :] @ turn.T
        return poses


@dataclass(frozen=True, eq=False)
class BoneDirections:
    """Directions of bones between markers, in the world.

    Parameters
    ----------
    names
        D bones, ``"marker-marker"``.
    pairs
        The labels of each bone's two markers.
    first
        (D, 4) the reference's first pose.
    """

    names: tuple[str, ...]
    pairs: tuple[tuple[str, str], ...]
    first: F32
    directions: bool = True
    root: None = None

    @classmethod
    def common(cls, reference: MarkerTake, others: tuple[MarkerTake, ...] = ()) -> BoneDirections:
        """Compare the bones of the reference whose markers all other takes have too.

        The bones are the take's own, else the tree that joins markers which keep their distance.

        Raises
        ------
        SkeletonMismatchError
            If there is no bone.
        """
        kept = [i for i, label in enumerate(reference.labels) if _seen(reference, i, others)]
        bones = [(a, b) for a, b in reference.bones if a in kept and b in kept]
        bones = bones or _rigid_pairs(reference, kept)
        if not bones:
            raise SkeletonMismatchError(f"{reference.name}: no bone that all takes have markers of")
        labels = reference.labels
        pairs = tuple((labels[a], labels[b]) for a, b in bones)
        names = tuple(f"{a}-{b}" for a, b in pairs)
        empty = np.zeros((len(pairs), 4), np.float32)
        poses = completed(cls(names, pairs, empty).of(reference))
        return cls(names, pairs, poses[0])

    def of(self, take: Recording) -> F32:
        """(F, D, 4) directions, NaN where a marker is missing. See `Features.of`."""
        if isinstance(take, Take):
            raise SkeletonMismatchError(f"{take.name} holds joints, the reference markers")
        first, last = take.span
        missing = [label for pair in self.pairs for label in pair if label not in take.index]
        if missing:
            raise SkeletonMismatchError(f"{take.name} has no marker {missing[0]}")
        ends = np.array([[take.index[a], take.index[b]] for a, b in self.pairs])
        vectors = take.positions[first:last, ends[:, 1]] - take.positions[first:last, ends[:, 0]]
        length = np.linalg.norm(vectors, axis=-1, keepdims=True)
        poses = np.zeros((*vectors.shape[:2], 4), np.float32)
        with np.errstate(invalid="ignore", divide="ignore"):
            poses[..., :3] = np.where(length > 0, vectors / length, np.nan)
        return poses

    def start(self, pose: F32) -> F32 | None:
        """Turn about the vertical that brings `pose` closest to the reference's first pose.

        See `Features.start`.
        """
        seen = ~np.isnan(pose[:, 0])
        if seen.sum() < _SEEN * len(seen):
            return None
        a, b = pose[seen], self.first[seen]
        sine = float(np.sum(a[:, 2] * b[:, 0] - a[:, 0] * b[:, 2]))
        cosine = float(np.sum(a[:, 0] * b[:, 0] + a[:, 2] * b[:, 2]))
        angle = np.arctan2(sine, cosine)
        c, s = np.cos(angle), np.sin(angle)
        rows = [[c, 0, s, 0], [0, 1, 0, 0], [-s, 0, c, 0], [0, 0, 0, 1]]
        return np.array(rows, dtype=np.float32)

    def turned(self, poses: F32, turn: F32) -> F32:
        """Turn the whole body. See `Features.turned`."""
        return np.asarray(poses @ turn.T, dtype=np.float32)


def features_of(take: Recording, others: tuple[Recording, ...] = ()) -> Features:
    """Tell what takes have in common that can be compared.

    Raises
    ------
    SkeletonMismatchError
        If that is too little, or some hold markers and some joints.
    """
    if isinstance(take, Take):
        joints = tuple(other for other in others if isinstance(other, Take))
        if len(joints) < len(others):
            raise SkeletonMismatchError(f"{take.name} holds joints, others markers only")
        return JointRotations.common(take, joints)
    markers = tuple(other for other in others if isinstance(other, MarkerTake))
    if len(markers) < len(others):
        raise SkeletonMismatchError(f"{take.name} holds markers only, others joints")
    return BoneDirections.common(take, markers)


def _seen(reference: MarkerTake, marker: int, others: tuple[MarkerTake, ...]) -> bool:
    label = reference.labels[marker]
    mostly = float(np.mean(~reference.missing[:, marker])) >= _SEEN
    return mostly and all(label in other.index for other in others)


def _rigid_pairs(take: MarkerTake, kept: list[int]) -> list[tuple[int, int]]:
    """Join markers into a tree along the pairs whose distance varies least."""
    # Takes of joints, which are aligned as they arrive, do not wait for this to be imported.
    from scipy.sparse.csgraph import minimum_spanning_tree

    positions = take.positions[:: max(1, take.frames // 200), kept]
    apart = np.linalg.norm(positions[:, :, None] - positions[:, None], axis=-1)
    with np.errstate(invalid="ignore"):
        mean, spread = np.nanmean(apart, axis=0), np.nanstd(apart, axis=0)
    # Absolute spread plus a little of the length: near neighbours rather than far ones.
    cost = np.where(mean > _SHORTEST_BONE, spread + 0.01 * mean + 1e-9, 0.0)
    tree = minimum_spanning_tree(np.nan_to_num(np.triu(cost, 1)))
    rows, columns = tree.nonzero()
    return [(kept[int(a)], kept[int(b)]) for a, b in zip(rows, columns, strict=True)]


def completed(poses: F32) -> F32:
    """Bridge gaps of each row of poses (F, D, 4) linearly, and hold its ends.

    Raises
    ------
    MocapError
        If a row is never seen.
    """
    if not np.isnan(poses).any():
        return poses
    filled, frames = poses.copy(), np.arange(len(poses))
    for row in range(poses.shape[1]):
        seen = ~np.isnan(poses[:, row, 0])
        if not seen.any():
            raise MocapError(f"row {row} of the reference is never seen")
        for k in range(poses.shape[2]):
            filled[:, row, k] = np.interp(frames, frames[seen], poses[seen, row, k])
    return unit_rows(filled)


def unit_rows(poses: F32) -> F32:
    """Scale rows (..., 4) to unit length."""
    length = np.linalg.norm(poses, axis=-1, keepdims=True)
    return np.asarray(poses / np.where(length > 0, length, 1.0), dtype=np.float32)
