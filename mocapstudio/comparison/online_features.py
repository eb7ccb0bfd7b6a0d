"""Poses in the form in which they are aligned online: rotations of joints or directions of bones.

Paper 3 compares rotations only, so that bodies of other proportions can be aligned: those of the
joints relative to their parents, and that of the root relative to the first frame of the action.
Markers have no rotations; there the directions of bones between markers stand in, the whole body
turned about the vertical so that it begins as the reference does.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import minimum_spanning_tree

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError, SkeletonMismatchError
from mocapstudio.motion.facing import hips_world
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology
from mocapstudio.similarity.texture import comparable_joints

F32 = NDArray[np.float32]
F64 = NDArray[np.float64]

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

    def of(self, take: Take | MarkerTake) -> F32:
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
    """

    names: tuple[str, ...]
    root: int | None
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
        hips = reference.skeleton.names[topology(reference.skeleton).hips]
        return cls(names, names.index(hips) if hips in names else None)

    def of(self, take: Take | MarkerTake) -> F32:
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
        poses = _completed(cls(names, pairs, empty).of(reference))
        return cls(names, pairs, poses[0])

    def of(self, take: Take | MarkerTake) -> F32:
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
        """Turn about the vertical that brings `pose` closest to the reference's first pose."""
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


@dataclass(frozen=True, eq=False)
class Reference:
    """The performance that others are aligned with, R frames at the rate of alignment.

    Parameters
    ----------
    name
        Of the take.
    features
        What is compared.
    poses
        (R, D, 4) turned as the action begins, without gaps.
    rate
        Frames a second of `poses`.
    start
        The take's own frame that is the first here.
    frames_each
        Own frames of the take for one frame of `poses`.
    """

    name: str
    features: Features
    poses: F32
    rate: float
    start: int = 0
    frames_each: float = 1.0

    def __len__(self) -> int:
        return len(self.poses)

    def own_frame(self, at: int) -> int:
        """Frame of the take, 0-based at its own rate, nearest to a frame of `poses`."""
        return self.start + round(at * self.frames_each)


def reference_of(
    take: Take | MarkerTake,
    streams: tuple[Take | MarkerTake, ...] = (),
    rate: Fraction | float | None = None,
) -> Reference:
    """Prepare a take as a reference for streams.

    Parameters
    ----------
    take
        The reference; its trimmed span is the action.
    streams
        Takes that are going to be aligned with it: only what all of them have is compared.
    rate
        Frames a second of the alignment: the take's own by default. Streams of about this rate
        align best, since the paths then run near the diagonal.

    Raises
    ------
    SkeletonMismatchError
        If the takes have too little in common.
    MocapError
        If the reference has fewer than three frames.
    """
    features = features_of(take, streams)
    raw = _completed(features.of(take))
    turn = features.start(raw[0])
    poses = raw if turn is None else features.turned(raw, turn)
    each = 1.0 if rate is None else float(take.rate) / float(rate)
    if each != 1.0:
        poses = _sampled(poses, each)
    if len(poses) < 3:
        raise MocapError(f"{take.name}: {len(poses)} frames are too few for a reference")
    return Reference(take.name, features, poses, float(take.rate) / each, take.span[0], each)


def features_of(take: Take | MarkerTake, others: tuple[Take | MarkerTake, ...] = ()) -> Features:
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
    positions = take.positions[:: max(1, take.frames // 200), kept]
    apart = np.linalg.norm(positions[:, :, None] - positions[:, None], axis=-1)
    with np.errstate(invalid="ignore"):
        mean, spread = np.nanmean(apart, axis=0), np.nanstd(apart, axis=0)
    # Absolute spread plus a little of the length: near neighbours rather than far ones.
    cost = np.where(mean > _SHORTEST_BONE, spread + 0.01 * mean + 1e-9, 0.0)
    tree = minimum_spanning_tree(np.nan_to_num(np.triu(cost, 1)))
    rows, columns = tree.nonzero()
    return [(kept[int(a)], kept[int(b)]) for a, b in zip(rows, columns, strict=True)]


def _completed(poses: F32) -> F32:
    """Bridge gaps of each row linearly, and hold its ends."""
    if not np.isnan(poses).any():
        return poses
    filled, frames = poses.copy(), np.arange(len(poses))
    for row in range(poses.shape[1]):
        seen = ~np.isnan(poses[:, row, 0])
        if not seen.any():
            raise MocapError(f"row {row} of the reference is never seen")
        for k in range(poses.shape[2]):
            filled[:, row, k] = np.interp(frames, frames[seen], poses[seen, row, k])
    return _unit(filled)


def _sampled(poses: F32, each: float) -> F32:
    count = int((len(poses) - 1) / each + 1e-6) + 1
    at = np.arange(count) * each
    low = np.minimum(at.astype(np.int64), max(len(poses) - 2, 0))
    part = (at - low).astype(np.float32)[:, None, None]
    a, b = poses[low], poses[np.minimum(low + 1, len(poses) - 1)]
    return _unit(a * (1 - part) + b * part)


def _unit(poses: F32) -> F32:
    length = np.linalg.norm(poses, axis=-1, keepdims=True)
    return np.asarray(poses / np.where(length > 0, length, 1.0), dtype=np.float32)
