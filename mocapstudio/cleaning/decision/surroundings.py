"""What a take is compared with, put together from the textures of its context."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.decision import gaussian
from mocapstudio.cleaning.decision.features import Surroundings
from mocapstudio.cleaning.decision.gaussian import Moments
from mocapstudio.cleaning.decision.spoiling import Anatomy
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.topology import topology
from mocapstudio.similarity.texture import MotionTexture

F32 = NDArray[np.float32]


def anatomy_of(skeleton: Skeleton, joints: Sequence[str]) -> Anatomy:
    """Tell limbs and mirror images of the compared joints."""
    parts = topology(skeleton)
    index = [skeleton.index[name] for name in joints]
    names = [limb.name for limb in parts.limbs]
    limb = [names.index(parts.limb_of(j).name) for j in index]
    mirrored = [int(parts.mirror[j]) for j in index]
    mirror = [index.index(m) if m in index else k for k, m in enumerate(mirrored)]
    _, compact = np.unique(limb, return_inverse=True)
    return Anatomy(compact.astype(np.int64), np.array(mirror, dtype=np.int64))


def surroundings(
    textures: Sequence[MotionTexture], itself: MotionTexture, limb: NDArray[np.int64]
) -> Surroundings:
    """Put the context of one take together.

    Parameters
    ----------
    textures
        The context without the take.
    itself
        The take: it is its own context where there is no other.
    limb
        (m,) which limb each joint belongs to.
    """
    known = tuple(textures) or (itself,)
    centre, total = _known(known)
    return Surroundings(tuple(textures), total, centre, limb)


@lru_cache(maxsize=4)
def _known(textures: tuple[MotionTexture, ...]) -> tuple[F32, Moments]:
    centre = mean_pose(textures)
    parts = [moments_of(one, centre) for one in textures]
    total = parts[0]
    for one in parts[1:]:
        total = total + one
    return centre, total


def mean_pose(textures: Sequence[MotionTexture]) -> F32:
    """(m, 4) chordal mean of all poses."""
    poses = np.concatenate([one.quaternions for one in textures])
    same = np.sum(poses * poses[:1], axis=-1, keepdims=True) >= 0
    total = np.where(same, poses, -poses).sum(axis=0)
    return np.asarray(total / np.linalg.norm(total, axis=-1, keepdims=True), dtype=np.float32)


def moments_of(texture: MotionTexture, centre: F32) -> Moments:
    """Moments of a take's stacked poses, as rotation vectors from the mean pose `centre` (m, 4)."""
    vectors = gaussian.rotation_vectors(texture.quaternions, centre)
    return gaussian.moments(gaussian.stacked(vectors))
