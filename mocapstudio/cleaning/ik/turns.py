"""Small turns as vectors: rotation matrices, and how they change with their rotation vector.

Chirikjian, *Stochastic Models, Information Theory, and Lie Groups*, volume 2, section 10.6: the
right Jacobian ``Jr`` of SO(3), with ``exp(v + d) = exp(v) exp(Jr(v) d)`` to first order.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot

Array = NDArray[np.float64]

_EYE = np.eye(3)
_SMALL = 1e-4


def hat(v: Array) -> Array:
    """(..., 3, 3) matrices with ``hat(v) @ w == cross(v, w)`` for vectors (..., 3)."""
    result = np.zeros((*v.shape, 3))
    result[..., 0, 1], result[..., 0, 2] = -v[..., 2], v[..., 1]
    result[..., 1, 0], result[..., 1, 2] = v[..., 2], -v[..., 0]
    result[..., 2, 0], result[..., 2, 1] = -v[..., 1], v[..., 0]
    return result


def exp(v: Array) -> Array:
    """Rotation matrices (..., 3, 3) of rotation vectors (..., 3), radians."""
    return rot.to_matrix(rot.from_rotation_vector(v))


def log(m: Array) -> Array:
    """Rotation vectors (..., 3), radians, of rotation matrices (..., 3, 3)."""
    return rot.to_rotation_vector(rot.from_matrix(m))


def right_jacobian(v: Array) -> Array:
    """Right Jacobian (..., 3, 3) of the exponential at rotation vectors (..., 3)."""
    angle = np.linalg.norm(v, axis=-1)
    small = angle < _SMALL
    safe = np.where(small, 1.0, angle)
    first = np.where(small, 0.5, (1.0 - np.cos(safe)) / safe**2)
    second = np.where(small, 1.0 / 6.0, (safe - np.sin(safe)) / safe**3)
    k = hat(v)
    result: Array = _EYE - first[..., None, None] * k + second[..., None, None] * (k @ k)
    return result


def inverse_right_jacobian(v: Array) -> Array:
    """Inverse (..., 3, 3) of `right_jacobian`, for angles up to pi."""
    angle = np.linalg.norm(v, axis=-1)
    small = angle < _SMALL
    safe = np.where(small, 1.0, angle)
    square = np.where(small, 1.0 / 12.0, 1.0 / safe**2 - 0.5 / (safe * np.tan(0.5 * safe)))
    k = hat(v)
    result: Array = _EYE + 0.5 * k + square[..., None, None] * (k @ k)
    return result
