"""Unit quaternions in SciPy's order (x, y, z, w), vectorised over leading axes.

Every function takes arrays of shape (..., 4) and broadcasts. Angles are radians. The rotation
that a quaternion ``q`` stands for acts on column vectors from the left: ``rotate(q, v)`` is
``R(q) @ v``, and ``multiply(a, b)`` applies ``b`` first.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

IDENTITY = np.array([0.0, 0.0, 0.0, 1.0])
_CONJUGATE = np.array([-1.0, -1.0, -1.0, 1.0])
_AXES = {"X": 0, "Y": 1, "Z": 2}


def multiply(a: Array, b: Array) -> Array:
    """Hamilton product ``a b``: rotate by `b`, then by `a`."""
    ax, ay, az, aw = np.moveaxis(a, -1, 0)
    bx, by, bz, bw = np.moveaxis(b, -1, 0)
    product: Array = np.stack(
        [
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz,
        ],
        axis=-1,
    )
    return product


def conjugate(q: Array) -> Array:
    """Inverse rotation of unit quaternions."""
    return np.asarray(q * _CONJUGATE)


def normalize(q: Array) -> Array:
    """Scale to unit length; a zero quaternion becomes the identity."""
    norm = np.linalg.norm(q, axis=-1, keepdims=True)
    return np.where(norm > 0, q / np.where(norm > 0, norm, 1.0), IDENTITY)


def rotate(q: Array, v: Array) -> Array:
    """Rotate vectors (..., 3) by quaternions (..., 4)."""
    u, w = q[..., :3], q[..., 3:]
    t = 2.0 * np.cross(u, v)
    return np.asarray(v + w * t + np.cross(u, t), dtype=np.float64)


def log(q: Array) -> Array:
    """Logarithm of unit quaternions: half the rotation vector, shape (..., 3), radians.

    The sign of `q` is chosen so that the rotation angle is at most pi.
    """
    q = np.where(q[..., 3:] < 0, -q, q)
    vector, w = q[..., :3], q[..., 3:]
    norm = np.linalg.norm(vector, axis=-1, keepdims=True)
    half = np.arctan2(norm, w)
    factor = np.where(norm > 1e-12, half / np.where(norm > 1e-12, norm, 1.0), 1.0)
    return vector * factor


def exp(half_vector: Array) -> Array:
    """Inverse of `log`: quaternions of half rotation vectors (..., 3), radians."""
    half = np.linalg.norm(half_vector, axis=-1, keepdims=True)
    return np.concatenate([half_vector * np.sinc(half / np.pi), np.cos(half)], axis=-1)


def from_rotation_vector(vector: Array) -> Array:
    """Quaternions of rotation vectors (..., 3): axis times angle, radians."""
    return exp(0.5 * vector)


def to_rotation_vector(q: Array) -> Array:
    """Rotation vector (axis times angle in [0, pi]) of quaternions, shape (..., 3)."""
    return 2.0 * log(q)


def angle(a: Array, b: Array) -> Array:
    """Geodesic angle between rotations, radians in [0, pi], shape (...)."""
    dot: Array = np.abs(np.sum(a * b, axis=-1))
    return 2.0 * np.arccos(np.clip(dot, 0.0, 1.0))


def continuous(q: Array) -> Array:
    """Flip signs along axis 0 so that consecutive quaternions have a positive dot product."""
    if len(q) < 2:
        return q.copy()
    dots = np.sum(q[1:] * q[:-1], axis=-1)
    signs = np.cumprod(np.where(dots < 0, -1.0, 1.0), axis=0)
    result = q.copy()
    result[1:] *= signs[..., None]
    return result


def slerp(a: Array, b: Array, t: Array | float) -> Array:
    """Spherical interpolation from `a` (t = 0) to `b` (t = 1) on the shorter arc; `t` is (...)."""
    step = log(multiply(conjugate(a), b))
    return multiply(a, exp(np.asarray(t, dtype=float)[..., None] * step))


def mean(q: Array, axis: int = 0) -> Array:
    """Rotation mean along `axis`: signs aligned to the first, chordal mean, unit length.

    Unlike a mean of Euler angles it depends on no order of axes and jumps nowhere.
    """
    first = np.take(q, [0], axis=axis)
    signs = np.where(np.sum(q * first, axis=-1, keepdims=True) < 0, -1.0, 1.0)
    return normalize(np.sum(q * signs, axis=axis))


def twist_angle(q: Array, axis: int) -> Array:
    """Angle (...), radians in (-pi, pi], of the part of `q` that turns about coordinate `axis`."""
    turned = np.where(q[..., 3] < 0, -1.0, 1.0)
    return 2.0 * np.arctan2(turned * q[..., axis], turned * q[..., 3])


def about_axis(axis: int, angles: Array) -> Array:
    """Quaternions that turn by `angles` (...), radians, about coordinate axis 0, 1 or 2."""
    angles = np.asarray(angles, dtype=float)
    q = np.zeros((*angles.shape, 4))
    q[..., axis] = np.sin(0.5 * angles)
    q[..., 3] = np.cos(0.5 * angles)
    return q


def from_euler(order: str, angles: Array) -> Array:
    """Quaternion of intrinsic Euler angles, as BVH writes them.

    Parameters
    ----------
    order
        Axis letters, upper case, outermost first: ``"ZXY"`` means ``Rz Rx Ry``. One to three
        letters.
    angles
        (..., len(order)), radians.
    """
    angles = np.asarray(angles, dtype=float)
    q = about_axis(_AXES[order[0]], angles[..., 0])
    for i, letter in enumerate(order[1:], start=1):
        q = multiply(q, about_axis(_AXES[letter], angles[..., i]))
    return q


def to_matrix(q: Array) -> Array:
    """Rotation matrices (..., 3, 3)."""
    x, y, z, w = np.moveaxis(q, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def from_matrix(m: Array) -> Array:
    """Quaternion of rotation matrices (..., 3, 3), with w not negative."""
    # The largest of the four squared components is always well conditioned.
    d0, d1, d2 = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    squared = np.stack([1 + d0 - d1 - d2, 1 - d0 + d1 - d2, 1 - d0 - d1 + d2, 1 + d0 + d1 + d2], -1)
    plus, minus = m + np.swapaxes(m, -1, -2), m - np.swapaxes(m, -1, -2)
    xy, xz, yz = plus[..., 0, 1], plus[..., 0, 2], plus[..., 1, 2]
    wx, wy, wz = minus[..., 2, 1], minus[..., 0, 2], minus[..., 1, 0]
    candidates = np.stack(
        [
            np.stack([squared[..., 0], xy, xz, wx], -1),
            np.stack([xy, squared[..., 1], yz, wy], -1),
            np.stack([xz, yz, squared[..., 2], wz], -1),
            np.stack([wx, wy, wz, squared[..., 3]], -1),
        ],
        axis=-2,
    )
    best = np.argmax(squared, axis=-1)[..., None, None]
    q = normalize(np.take_along_axis(candidates, best, axis=-2)[..., 0, :])
    return np.where(q[..., 3:] < 0, -q, q)


def to_euler(order: str, q: Array) -> Array:
    """Intrinsic Euler angles of three different axes; inverse of `from_euler`.

    Parameters
    ----------
    order
        Three different axis letters, upper case, outermost first.
    q
        (..., 4).

    Returns
    -------
    (..., 3) radians; the middle angle lies in [-pi/2, pi/2]. In gimbal lock the last is 0.

    Raises
    ------
    ValueError
        If `order` does not name three different axes.
    """
    if len(order) != 3 or set(order) != {"X", "Y", "Z"}:
        raise ValueError(f"cannot convert to Euler order {order!r}: three different axes needed")
    i, j, k = (_AXES[letter] for letter in order)
    sign = 1.0 if (i + 1) % 3 == j else -1.0
    m = to_matrix(q)
    middle = np.arcsin(np.clip(sign * m[..., i, k], -1.0, 1.0))
    locked = np.abs(m[..., i, k]) > 1 - 1e-12
    first = np.where(
        locked,
        np.arctan2(sign * m[..., k, j], m[..., j, j]),
        np.arctan2(-sign * m[..., j, k], m[..., k, k]),
    )
    last = np.where(locked, 0.0, np.arctan2(-sign * m[..., i, j], m[..., i, i]))
    return np.stack([first, middle, last], axis=-1)
