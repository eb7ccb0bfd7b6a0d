"""Numba kernels of inverse kinematics: turns, forward kinematics, partials, normal equations.

Serial and `nogil`, over contiguous float64 arrays: contacts are held to a hundredth of a
millimetre against wishes that weigh a billionth of them, which float32 cannot carry.
"""

from __future__ import annotations

import numba as nb
import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]

_SMALL = 1e-4


@nb.njit(nogil=True, cache=True, inline="always")
def _square_form(v: F64, a: float, b: float, c: float, out: F64) -> None:
    """``a I + b hat(v) + c hat(v)^2``."""
    x, y, z = v[0], v[1], v[2]
    out[0, 0] = a - c * (y * y + z * z)
    out[1, 1] = a - c * (x * x + z * z)
    out[2, 2] = a - c * (x * x + y * y)
    out[0, 1], out[1, 0] = c * x * y - b * z, c * x * y + b * z
    out[0, 2], out[2, 0] = c * x * z + b * y, c * x * z - b * y
    out[1, 2], out[2, 1] = c * y * z - b * x, c * y * z + b * x


@nb.njit(nogil=True, cache=True)
def exponentials(vectors: F64, turn: F64, jacobian: F64) -> None:
    """Rotation matrix and right Jacobian of every rotation vector.

    Parameters
    ----------
    vectors
        (N, 3) radians.
    turn, jacobian
        (N, 3, 3), overwritten.
    """
    for i in range(len(vectors)):
        v = vectors[i]
        square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
        angle = np.sqrt(square)
        if angle < _SMALL:
            sine, versine, cubic = 1.0 - square / 6.0, 0.5 - square / 24.0, 1.0 / 6.0
        else:
            sine = np.sin(angle) / angle
            versine = (1.0 - np.cos(angle)) / square
            cubic = (1.0 - sine) / square
        _square_form(v, 1.0, sine, versine, turn[i])
        _square_form(v, 1.0, -versine, cubic, jacobian[i])


@nb.njit(nogil=True, cache=True, inline="always")
def _quaternion(m: F64) -> tuple[float, float, float, float]:
    trace = m[0, 0] + m[1, 1] + m[2, 2]
    if trace > max(m[0, 0], m[1, 1], m[2, 2]):
        x, y, z, w = m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], 1.0 + trace
    elif m[0, 0] >= m[1, 1] and m[0, 0] >= m[2, 2]:
        x, w = 1.0 + m[0, 0] - m[1, 1] - m[2, 2], m[2, 1] - m[1, 2]
        y, z = m[0, 1] + m[1, 0], m[0, 2] + m[2, 0]
    elif m[1, 1] >= m[2, 2]:
        y, w = 1.0 + m[1, 1] - m[0, 0] - m[2, 2], m[0, 2] - m[2, 0]
        x, z = m[0, 1] + m[1, 0], m[1, 2] + m[2, 1]
    else:
        z, w = 1.0 + m[2, 2] - m[0, 0] - m[1, 1], m[1, 0] - m[0, 1]
        x, y = m[0, 2] + m[2, 0], m[1, 2] + m[2, 1]
    if w < 0.0:
        x, y, z, w = -x, -y, -z, -w
    return x, y, z, w


@nb.njit(nogil=True, cache=True)
def logarithms(matrices: F64, vectors: F64, inverse: F64) -> None:
    """Rotation vector of every rotation matrix, and the inverse right Jacobian there.

    Parameters
    ----------
    matrices
        (N, 3, 3).
    vectors
        (N, 3) radians, overwritten.
    inverse
        (N, 3, 3), overwritten.
    """
    for i in range(len(matrices)):
        x, y, z, w = _quaternion(matrices[i])
        sine = np.sqrt(x * x + y * y + z * z)
        factor = 2.0 / w
        if sine > 1e-9 * w:
            factor = 2.0 * np.arctan2(sine, w) / sine
        v = vectors[i]
        v[0], v[1], v[2] = factor * x, factor * y, factor * z
        inverse_at(v, inverse[i])


@nb.njit(nogil=True, cache=True)
def inverse_at(v: F64, out: F64) -> None:
    """Inverse right Jacobian (3, 3) at one rotation vector (3,), angle at most pi."""
    square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    angle = np.sqrt(square)
    third = 1.0 / 12.0
    if angle >= _SMALL:
        third = 1.0 / square - 0.5 / (angle * np.tan(0.5 * angle))
    _square_form(v, 1.0, 0.5, third, out)


@nb.njit(nogil=True, cache=True, inline="always")
def _product(a: F64, b: F64, out: F64) -> None:
    for r in range(3):
        for c in range(3):
            out[r, c] = a[r, 0] * b[0, c] + a[r, 1] * b[1, c] + a[r, 2] * b[2, c]


@nb.njit(nogil=True, cache=True)
def place(
    local: F64,
    offsets: F64,
    parents: I64,
    carrier: int,
    displacement: F64,
    positions: F64,
    world: F64,
) -> None:
    """Forward kinematics.

    Parameters
    ----------
    local
        (F, j, 3, 3) local rotations.
    offsets
        (F, j, 3) metres.
    parents
        (j,) position of each joint's parent, -1 for the root.
    carrier
        Position of the joint that is displaced.
    displacement
        (F, 3) metres in the world.
    positions, world
        (F, j, 3) metres and (F, j, 3, 3), overwritten.
    """
    frames, joints = local.shape[:2]
    for f in range(frames):
        for j in range(joints):
            up = parents[j]
            p, o = positions[f, j], offsets[f, j]
            if up < 0:
                p[:] = o
                world[f, j] = local[f, j]
            else:
                m = world[f, up]
                for r in range(3):
                    p[r] = positions[f, up, r] + m[r, 0] * o[0] + m[r, 1] * o[1] + m[r, 2] * o[2]
                _product(m, local[f, j], world[f, j])
            if j == carrier:
                p += displacement[f]


@nb.njit(nogil=True, cache=True)
def turn_locals(local: F64, moving: I64, turn: F64) -> None:
    """Turn some local rotations (F, j, 3, 3), in place, by (F, m, 3, 3) in the joints' frames."""
    out = np.empty((3, 3))
    for f in range(len(local)):
        for i in range(len(moving)):
            _product(local[f, moving[i]], turn[f, i], out)
            local[f, moving[i]] = out


@nb.njit(nogil=True, cache=True)
def angular_gains(world: F64, moving: I64, jacobian: F64, axes: F64, out: F64) -> None:
    """Angular velocity in the world by each unknown: ``world @ jacobian @ axes``, (F, m, 3, 3)."""
    half = np.empty((3, 3))
    for f in range(len(world)):
        for i in range(len(moving)):
            _product(world[f, moving[i]], jacobian[f, i], half)
            _product(half, axes[i], out[f, i])


@nb.njit(nogil=True, cache=True)
def point_partials(
    points: F64, frames: I64, pivots: F64, gains: F64, which: I64, at: I64, first: int, out: F64
) -> None:
    """Velocity of points by the unknowns of the joints that carry them.

    Parameters
    ----------
    points
        (m, 3) metres in the world.
    frames
        (m,) frame of each.
    pivots
        (F, j, 3) metres: places of all joints.
    gains
        (F, M, 3, 3): see `angular_gains`.
    which, at
        (a,) of the turning joints those that carry the point, and their places among all joints.
    first
        Unknowns that stand before those of the first turning joint.
    out
        (m, 3, n), written where the joints' unknowns stand.
    """
    for k in range(len(points)):
        f = frames[k]
        for i in range(len(which)):
            x = points[k, 0] - pivots[f, at[i], 0]
            y = points[k, 1] - pivots[f, at[i], 1]
            z = points[k, 2] - pivots[f, at[i], 2]
            g = gains[f, which[i]]
            start = first + 3 * which[i]
            for c in range(3):
                out[k, 0, start + c] = g[1, c] * z - g[2, c] * y
                out[k, 1, start + c] = g[2, c] * x - g[0, c] * z
                out[k, 2, start + c] = g[0, c] * y - g[1, c] * x


@nb.njit(nogil=True, cache=True)
def add_squares(frames: I64, residual: F64, jacobian: F64, gradient: F64, band: F64) -> None:
    """Add ``J^T r`` and the lower half of ``J^T J`` of single frames to the normal equations.

    Parameters
    ----------
    frames
        (m,) frame of each row.
    residual, jacobian
        (m, r) and (m, r, n).
    gradient
        (F, n), added to.
    band
        (F, n, b), added to: element (f, i, k) is row ``i + k`` of column i of frame f.
    """
    size = jacobian.shape[2]
    some = np.empty(size, np.int64)
    for k in range(len(frames)):
        f = frames[k]
        for r in range(jacobian.shape[1]):
            row = jacobian[k, r]
            count = 0
            for i in range(size):
                if row[i] != 0.0:
                    some[count] = i
                    count += 1
            for a in range(count):
                i = some[a]
                gradient[f, i] += row[i] * residual[k, r]
                for b in range(a, count):
                    band[f, i, some[b] - i] += row[i] * row[some[b]]
