"""How points move: speed and vertical speed that tell rest from motion at any frame rate."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

Array = NDArray[np.float64]

_SMOOTHING = 1 / 120
"""Seconds: standard deviation of the Gaussian that takes the noise of measurement off."""
_REACH = 1 / 48
"""Seconds over which a displacement is measured, at least a frame."""


def smoothed(positions: Array, rate: float) -> Array:
    """(F, P, 3) metres: positions without noise; untouched where frames are too far apart."""
    sigma = _SMOOTHING * rate
    if sigma < 0.5 or len(positions) < 2:
        return positions
    return np.asarray(gaussian_filter1d(positions, sigma, axis=0, mode="nearest"))


def one_sided(positions: Array, rate: float) -> Array:
    """(F, P, 3) metres a second: of the motion before and after a frame that which is slower.

    A central difference would mix the last frame of a swing into the first of a stance, which at
    30 Hz moves every edge by a frame.
    """
    frames = len(positions)
    reach = max(1, round(_REACH * rate))
    if frames <= reach:
        return np.zeros_like(positions)
    step = (positions[reach:] - positions[:-reach]) * (rate / reach)
    after = np.concatenate([step, np.repeat(step[-1:], reach, axis=0)])
    before = np.concatenate([np.repeat(step[:1], reach, axis=0), step])
    slower = np.linalg.norm(before, axis=-1) < np.linalg.norm(after, axis=-1)
    return np.where(slower[..., None], before, after)
