"""The calibrated map: a departure measured against what is normal for its joint."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

F32 = NDArray[np.float32]

_LEAST_DEGREES = 12.0
_USUAL_SHARE = 0.9
_TIMES_USUAL = 2.0
HEIGHT_CENTIMETRES = 5.0
HEADING_DEGREES = 40.0


def value_of(residual: F32, scale: F32 | float) -> F32:
    """Map residuals (T, m) to 0..1 so that they reach 0.5 at `scale`, (m,) or one for all."""
    return np.asarray(1.0 - np.exp2(-((residual / scale) ** 2)), dtype=np.float32)


def joint_scales(degrees: F32) -> F32:
    """Residual that counts 0.5 for each joint, (m,) degrees, from residuals (T, m).

    A robust share of the take's own residuals, never below what a clean capture shows.
    """
    usual = np.quantile(degrees, _USUAL_SHARE, axis=0)
    return np.asarray(np.maximum(_TIMES_USUAL * usual, _LEAST_DEGREES), dtype=np.float32)


def calibrated(departures: F32) -> F32:
    """Turn departures (T, m), radians, into the calibrated map (T, m)."""
    degrees = np.asarray(np.rad2deg(departures), dtype=np.float32)
    return value_of(degrees, joint_scales(degrees))


def exceeding(ratio: F32) -> F32:
    """Map how many times a threshold is reached, of any shape, to 0..1: 0.5 where it just is."""
    return value_of(ratio, 1.0)
