"""A Gaussian of whole motions: what a joint should do, given all others and its own near past.

Poses of a context, stacked with their neighbours in time, have a covariance; its inverse gives the
conditional expectation of any part given the rest, for all parts at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]
F32 = NDArray[np.float32]

OFFSETS = (0, -2, 2, -5, 5, -10, 10)
RIDGE = np.deg2rad(2.5) ** 2
"""Variance (rad²) by which every direction is widened: what a context is too short to tell."""


@dataclass(frozen=True, eq=False)
class Moments:
    """Sums over frames from which mean and covariance follow; they add and subtract.

    Parameters
    ----------
    count
        Number of frames.
    total
        (d,) sum of the stacked poses.
    outer
        (d, d) sum of their outer products.
    """

    count: int
    total: F64
    outer: F64

    @cached_property
    def mean(self) -> F64:
        """(d,) mean stacked pose."""
        return np.asarray(self.total / self.count)

    @cached_property
    def covariance(self) -> F64:
        """(d, d) covariance of the stacked poses."""
        return np.asarray(self.outer / self.count - np.outer(self.mean, self.mean))

    @cached_property
    def precision(self) -> F64:
        """(d, d) inverse of the covariance, widened by 2.5 degrees in every direction."""
        return np.asarray(np.linalg.inv(self.covariance + RIDGE * np.eye(len(self.mean))))

    def __add__(self, other: Moments) -> Moments:
        return Moments(self.count + other.count, self.total + other.total, self.outer + other.outer)

    def __sub__(self, other: Moments) -> Moments:
        return Moments(self.count - other.count, self.total - other.total, self.outer - other.outer)


def rotation_vectors(quaternions: F32, centre: F32) -> F64:
    """(T, 3 m) rotation vectors of (T, m, 4) relative to the mean pose (m, 4), radians."""
    conj = centre * np.array([-1, -1, -1, 1], dtype=np.float32)
    ax, ay, az, aw = np.moveaxis(conj.astype(np.float64), -1, 0)
    bx, by, bz, bw = np.moveaxis(quaternions.astype(np.float64), -1, 0)
    w = aw * bw - ax * bx - ay * by - az * bz
    vector = np.stack(
        [
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ],
        axis=-1,
    )
    vector = np.where(w[..., None] < 0, -vector, vector)
    sine = np.linalg.norm(vector, axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, np.abs(w)[..., None])
    scaled = vector * np.where(sine > 1e-9, angle / np.maximum(sine, 1e-9), 2.0)
    return np.asarray(scaled.reshape(len(quaternions), -1))


def stacked(vectors: F64) -> F64:
    """(T, d) every pose with those at OFFSETS frames from it, held at the ends."""
    frames = len(vectors)
    at = np.arange(frames)
    return np.concatenate([vectors[np.clip(at + o, 0, frames - 1)] for o in OFFSETS], axis=1)


def moments(motion: F64) -> Moments:
    """Moments of stacked poses (T, d)."""
    return Moments(len(motion), motion.sum(axis=0), motion.T @ motion)


def conditional_residuals(motion: F64, known: Moments, limb: NDArray[np.int64]) -> tuple[F32, F32]:
    """Departure of every joint from what the rest of the motion lets expect.

    Parameters
    ----------
    motion
        (T, d) stacked poses.
    known
        Moments of the context.
    limb
        (m,) which limb each joint belongs to.

    Returns
    -------
    given_others, given_other_limbs
        (T, m) degrees: given all other joints, and given all joints of other limbs; both also
        given the joint's own past and future at the offsets.
    """
    joints = len(limb)
    precision = known.precision
    pulled = (motion - known.mean) @ precision[:, : 3 * joints]
    others = np.empty((len(motion), joints), dtype=np.float32)
    limbs = np.empty_like(others)
    for k in range(joints):
        part = slice(3 * k, 3 * k + 3)
        away = pulled[:, part] @ np.linalg.inv(precision[part, part])
        others[:, k] = np.rad2deg(np.linalg.norm(away, axis=1))
    for one in np.unique(limb):
        members = np.flatnonzero(limb == one)
        columns = (3 * members[:, None] + np.arange(3)).ravel()
        away = pulled[:, columns] @ np.linalg.inv(precision[np.ix_(columns, columns)])
        away = away.reshape(len(motion), len(members), 3)
        limbs[:, members] = np.rad2deg(np.linalg.norm(away, axis=2))
    return others, limbs
