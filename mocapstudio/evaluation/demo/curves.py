"""Published curves of level walking, over one stride from heel strike to heel strike.

Sagittal angles of hip, knee and foot in whole degrees, read off the normative curves of adults
walking at their own pace (Perry and Burnfield, Gait Analysis, 2nd edition; Winter, Biomechanics
and Motor Control of Human Movement); thigh and foot are segment angles against the vertical and
the floor. The foot's push-off is fitted within the published spread, so that the knees of planted
feet follow their own curve. Pelvis, thorax and arms are the first harmonics of the curves of
Murray (1967) and Perry. The phase of a foot is 0 at its heel strike.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.ndimage import gaussian_filter1d

Array = NDArray[np.float64]

TOE_OFF = 0.62
"""Phase at which a foot leaves the floor."""
MID_STANCE = 0.23
"""Phase at which the hip passes over the ankle of the standing foot."""

_GRID, _ROUNDING = 400, 0.018

# fmt: off
_THIGH = ((0, 21), (5, 20), (10, 18), (20, 10), (30, 1), (40, -9), (50, -17), (55, -16), (62, -6),
          (70, 8), (80, 20), (88, 25), (95, 23), (100, 21))
_KNEE = ((0, 5), (5, 11), (12, 18), (20, 16), (30, 9), (40, 5), (47, 9), (55, 22), (62, 40),
         (68, 55), (73, 60), (79, 53), (88, 22), (95, 4), (100, 5))
_FOOT = ((0, 18), (7, 1), (10, 0), (20, 0), (30, 0), (37, -1), (43, -5), (50, -13), (57, -34),
         (62, -56), (66, -61), (72, -47), (80, -18), (86, 2), (92, 15), (97, 19), (100, 18))
# fmt: on


def _knots(table: tuple[tuple[int, int], ...]) -> tuple[Array, Array]:
    phase, degrees = np.array(table, dtype=np.float64).T
    return phase / 100.0, np.deg2rad(degrees)


def _periodic(table: tuple[tuple[int, int], ...]) -> CubicSpline[np.float64]:
    return CubicSpline(*_knots(table), bc_type="periodic")


def _flat_where_flat(table: tuple[tuple[int, int], ...]) -> CubicSpline[np.float64]:
    """Interpolate without overshooting between equal knots, then round off the corners."""
    phase, angle = _knots(table)
    around = np.concatenate([phase[:-1] - 1, phase[:-1], phase + 1])
    between = PchipInterpolator(around, np.concatenate([angle[:-1], angle[:-1], angle]))
    grid = np.arange(_GRID) / _GRID
    rounded = gaussian_filter1d(between(grid), _ROUNDING * _GRID, mode="wrap")
    return CubicSpline(np.append(grid, 1.0), np.append(rounded, rounded[0]), bc_type="periodic")


_thigh, _knee, _foot = _periodic(_THIGH), _periodic(_KNEE), _flat_where_flat(_FOOT)


def thigh_angle(phase: Array) -> Array:
    """Radians (F,), forward positive: thigh against the vertical, at phases (F,) of the stride."""
    return np.asarray(_thigh(phase % 1.0))


def knee_angle(phase: Array) -> Array:
    """Radians (F,), flexion positive, at phases (F,) of the stride."""
    return np.asarray(_knee(phase % 1.0))


def foot_angle(phase: Array) -> Array:
    """Radians (F,), toes up positive: sole against the floor, at phases (F,) of the stride."""
    return np.asarray(_foot(phase % 1.0))


def wave(phase: Array, peak: float, harmonic: int = 1) -> Array:
    """(F,) cosine over the stride with its maximum at phase `peak`."""
    return np.cos(2 * np.pi * harmonic * (phase - peak))
