"""Natural variation: what makes no two cycles alike."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

Array = NDArray[np.float64]


def smooth_noise(
    rng: np.random.Generator, times: Array, cutoff: float, deviation: float, size: int = 1
) -> Array:
    """Band-limited noise around zero.

    Parameters
    ----------
    times
        (F,) ascending, in any unit.
    cutoff
        Highest frequency, cycles per unit of time.
    deviation
        Standard deviation of the values.
    size
        Number of independent signals.

    Returns
    -------
    (F, size).
    """
    step = 0.5 / cutoff
    knots = np.arange(times[0] - 2 * step, times[-1] + 3 * step, step)
    values = rng.normal(0.0, deviation, (len(knots), size))
    return np.asarray(CubicSpline(knots, values)(times))


def minimum_jerk(u: Array) -> Array:
    """Flash and Hogan's minimum-jerk profile, any shape: 0 below 0, 1 above 1, smooth between."""
    u = np.clip(u, 0.0, 1.0)
    return np.asarray(u**3 * (10 + u * (6 * u - 15)))
