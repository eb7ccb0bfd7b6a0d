"""How an edit fades in time."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def minimum_jerk(share: Array) -> Array:
    """From 0 to 1 as `share` goes from 0 to 1, at rest at both ends (Flash and Hogan, 1985)."""
    t = np.clip(share, 0.0, 1.0)
    return np.asarray(t**3 * (10.0 - 15.0 * t + 6.0 * t * t))


def falloff(frames: int, at: int, reach: int) -> Array:
    """(frames,) strength of an edit: 1 at frame `at`, 0 from `reach` frames away on."""
    away = np.abs(np.arange(frames) - at) / max(reach, 1)
    return minimum_jerk(1.0 - away)
