"""Small turns as vectors: rotation matrices, and how they change with their rotation vector.

Chirikjian, *Stochastic Models, Information Theory, and Lie Groups*, volume 2, section 10.6: the
right Jacobian ``Jr`` of SO(3), with ``exp(v + d) = exp(v) exp(Jr(v) d)`` to first order.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.ik import kernels

Array = NDArray[np.float64]


def exp(vectors: Array) -> tuple[Array, Array]:
    """Rotation matrices (..., 3, 3) of rotation vectors (..., 3), radians; and right Jacobians."""
    turn, jacobian = np.empty((*vectors.shape, 3)), np.empty((*vectors.shape, 3))
    flat = np.ascontiguousarray(vectors, dtype=np.float64).reshape(-1, 3)
    kernels.exponentials(flat, turn.reshape(-1, 3, 3), jacobian.reshape(-1, 3, 3))
    return turn, jacobian


def log(matrices: Array) -> tuple[Array, Array]:
    """Rotation vectors (..., 3), radians, of matrices (..., 3, 3); and inverse right Jacobians."""
    vectors, inverse = np.empty(matrices.shape[:-1]), np.empty(matrices.shape)
    flat = np.ascontiguousarray(matrices, dtype=np.float64).reshape(-1, 3, 3)
    kernels.logarithms(flat, vectors.reshape(-1, 3), inverse.reshape(-1, 3, 3))
    return vectors, inverse
