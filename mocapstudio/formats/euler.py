"""Euler angles that continue what stands before them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.errors import MocapError

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Parts = tuple[Array, Array, Array, Mask, Mask]

_LOCKED = 1e-9
_OFF_AXIS = 1e-4


def nearest_euler(order: str, q: Array, previous: Array) -> Array:
    """Euler angles of a sequence of rotations, each nearest to the ones before it.

    Of the two solutions of every rotation and all their turns by 2 pi, the one with the smallest
    sum of absolute differences to the previous frame is taken. In gimbal lock the outermost angle
    stays as it was.

    Parameters
    ----------
    order
        One to three different axis letters, outermost first (intrinsic, as BVH lists them).
    q
        (F, ..., 4) unit quaternions.
    previous
        (..., len(order)) radians: the angles of the frame before the first.

    Returns
    -------
    (F, ..., len(order)) radians.

    Raises
    ------
    MocapError
        If a letter repeats, or fewer than three axes cannot express the rotations within
        1e-4 radians.
    """
    if not order or len(set(order)) != len(order):
        raise MocapError(f"rotation channels {order or 'absent'!s} cannot hold an edited rotation")
    letters = len(order)
    full = order + "".join(letter for letter in "XYZ" if letter not in order)
    last = np.zeros((*q.shape[1:-1], 3))
    last[..., :letters] = previous
    half_sum, half_difference, middle, no_sum, no_difference = _solve(full, q)
    result = np.empty((*q.shape[:-1], 3))
    for f in range(len(q)):
        last = _nearest(
            full,
            (half_sum[f], half_difference[f], middle[f], no_sum[f], no_difference[f]),
            last,
        )
        result[f] = last
        last[..., letters:] = 0.0
    if letters < 3 and np.abs(_wrapped(result[..., letters:])).max(initial=0.0) > _OFF_AXIS:
        raise MocapError(f"rotation channels {order} cannot hold this rotation: an axis is missing")
    return result[..., :letters]


def _solve(order: str, q: Array) -> Parts:
    """Half sum and half difference of the outer angles, and the middle one.

    Bernardes and Viollet 2022, exact up to and in gimbal lock, where one of the two is free.
    """
    k, j, i = ("XYZ".index(letter) for letter in order)
    sign = _parity(order)
    a, b = q[..., 3] - q[..., j], q[..., i] + sign * q[..., k]
    c, d = q[..., j] + q[..., 3], sign * q[..., k] - q[..., i]
    first, second = np.hypot(a, b), np.hypot(c, d)
    middle = 2.0 * np.arctan2(second, first) - 0.5 * np.pi
    half_sum: Array = np.arctan2(b, a)
    half_difference: Array = np.arctan2(d, c)
    return half_sum, half_difference, middle, first < _LOCKED, second < _LOCKED


def _parity(order: str) -> float:
    _, j, i = ("XYZ".index(letter) for letter in order)
    # The parity of the axes counted from the innermost, as the extrinsic sequence has them.
    return 1.0 if (i + 1) % 3 == j else -1.0


def _nearest(order: str, parts: Parts, previous: Array) -> Array:
    half_sum, half_difference, middle, no_sum, no_difference = parts
    sign = _parity(order)
    outer = sign * previous[..., 0]
    half_sum = np.where(no_sum, outer - half_difference, half_sum)
    half_difference = np.where(no_difference, outer - half_sum, half_difference)
    one = np.stack(
        [sign * (half_sum + half_difference), middle, half_sum - half_difference], axis=-1
    )
    other = np.stack([one[..., 0] + np.pi, np.pi - one[..., 1], one[..., 2] + np.pi], axis=-1)
    one, other = (previous + _wrapped(angles - previous) for angles in (one, other))
    distances = [np.abs(angles - previous).sum(axis=-1, keepdims=True) for angles in (one, other)]
    return np.where(distances[1] < distances[0], other, one)


def _wrapped(angles: Array) -> Array:
    return np.asarray(angles - 2 * np.pi * np.round(angles / (2 * np.pi)))
