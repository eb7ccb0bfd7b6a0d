"""Angles of a bone's degrees of freedom from its rotation, as near as they come."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.euler import nearest_euler
from mocapstudio.motion import rotations as rot

Array = NDArray[np.float64]


def nearest_angles(order: str, q: Array, previous: Array) -> tuple[Array, Array]:
    """Angles about up to three axes that come nearest to rotations, and how far off they stay.

    Three axes express every rotation. With two, the product of the two turns is bilinear in the
    sines and cosines of the half angles, so the nearest is the first pair of singular vectors of a
    2 × 2 matrix; with one it is the twist about the axis.

    Parameters
    ----------
    order
        Different axis letters, outermost first; may be empty.
    q
        (F, 4) rotations in the bone's own frame.
    previous
        (len(order),) radians: the angles of the frame before the first, which are continued.

    Returns
    -------
    angles
        (F, len(order)) radians.
    off
        (F,) radians between each rotation and that of its angles.
    """
    if len(order) == 3:
        return nearest_euler(order, q, previous), np.zeros(len(q))
    if not order:
        return np.empty((len(q), 0)), rot.angle(q, rot.IDENTITY)
    angles = _one(order, q) if len(order) == 1 else _two(order, q)
    for f in range(len(angles)):
        previous = previous + _wrapped(angles[f] - previous)
        angles[f] = previous
    return angles, rot.angle(q, rot.from_euler(order, angles))


def _one(order: str, q: Array) -> Array:
    return rot.twist_angle(q, "XYZ".index(order))[:, None]


def _two(order: str, q: Array) -> Array:
    a, b = ("XYZ".index(letter) for letter in order)
    c = 3 - a - b
    # The product of the two axes' unit quaternions is the third one's, or its opposite.
    sign = 1.0 if (a + 1) % 3 == b else -1.0
    share = np.array([[q[:, 3], q[:, b]], [q[:, a], sign * q[:, c]]]).transpose(2, 0, 1)
    left, _, right = np.linalg.svd(share)
    outer, inner = left[:, :, 0], right[:, 0, :]
    angles: Array = 2.0 * np.stack(
        [np.arctan2(outer[:, 1], outer[:, 0]), np.arctan2(inner[:, 1], inner[:, 0])], axis=-1
    )
    return angles


def _wrapped(angles: Array) -> Array:
    return np.asarray(angles - 2 * np.pi * np.round(angles / (2 * np.pi)))
