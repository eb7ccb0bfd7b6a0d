"""Analytic inverse kinematics of two bones, for arms and legs of the demo performer."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot

Array = NDArray[np.float64]


def unit(v: Array) -> Array:
    """Vectors (..., 3) scaled to length 1."""
    return np.asarray(v / np.linalg.norm(v, axis=-1, keepdims=True))


def bend(
    base: Array,
    target: Array,
    pole: Array,
    lengths: tuple[float, float],
    softness: float = 0.001,
) -> tuple[Array, Array]:
    """Directions of both bones so that the chain from `base` ends at `target`.

    Parameters
    ----------
    base, target
        (F, 3) metres, world.
    pole
        (F, 3): the side to which the middle joint points.
    lengths
        Of the upper and the lower bone, metres. A target out of reach is approached along its
        direction, smoothly: the chain never straightens fully.
    softness
        Metres before full reach within which the chain falls short of its target.

    Returns
    -------
    (F, 3) unit directions of the upper and the lower bone, world.
    """
    upper, lower = lengths
    reach = target - base
    straight = unit(reach)
    longest = 0.9995 * (upper + lower)
    distance = _soft_limit(np.linalg.norm(reach, axis=-1), longest, softness)
    cosine = (upper**2 + distance**2 - lower**2) / (2 * upper * distance)
    alpha = np.arccos(np.clip(cosine, -1, 1))[:, None]
    side = unit(pole - straight * np.sum(pole * straight, axis=-1, keepdims=True))
    first = np.cos(alpha) * straight + np.sin(alpha) * side
    second = unit(straight * distance[:, None] - upper * first)
    return first, second


def _soft_limit(distance: Array, longest: float, softness: float) -> Array:
    return np.asarray(longest - softness * np.logaddexp(0.0, (longest - distance) / softness))


def frame(x: Array, y: Array) -> Array:
    """Quaternions (F, 4) of the right-handed frames whose X is `x` and whose Y lies near `y`."""
    x = unit(x)
    z = unit(np.cross(x, y))
    return rot.from_matrix(np.stack([x, np.cross(z, x), z], axis=-1))
