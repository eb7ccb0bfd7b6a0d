"""From a column of times to frames a second, and rows put where their times say."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.frame_time import USUAL_RATES, rate_from_frame_time

Array = NDArray[np.float64]

# Of a step: what clocks and rounding leave.
_TOLERATED = 0.1
# Steps over which a sample is still interpolated from its neighbours.
_WIDEST = 2.5
_MOST_ROWS = 4
# How far a usual rate may be from the mean step.
_NEAR = 0.02
_FASTEST, _SLOWEST = 1e-5, 0.6


@dataclass(frozen=True)
class Clock:
    """What a column of times says.

    Attributes
    ----------
    rate
        Frames a second, or None where the times tell none.
    departure
        Seconds by which a row is farthest from where the rate puts it.
    uniform
        Whether that is as little as rounding and clocks leave.
    why
        Why there is no rate, as a phrase; empty where there is one.
    """

    rate: Fraction | None
    departure: float = 0.0
    uniform: bool = True
    why: str = ""


def read_clock(times: Array, resolution: float) -> Clock:
    """Tell the rate from times.

    Parameters
    ----------
    times
        (F,) seconds, as in the file.
    resolution
        Seconds of the last digit that is written.
    """
    if len(times) < 2 or not np.isfinite(times).all():
        return Clock(None, why="a single row" if len(times) < 2 else "a time is missing")
    steps = np.diff(times)
    if not steps.any():
        return Clock(None, why="all times are alike")
    if not (steps >= 0).all() or np.median(steps) <= 0:
        return Clock(None, why="times do not increase")
    mean = float(times[-1] - times[0]) / (len(times) - 1)
    step = mean if departure(times, mean) <= _TOLERATED * mean + resolution else _usual(steps)
    if not _FASTEST <= step <= _SLOWEST:
        return Clock(None, why=f"steps of {step:g} s are no frames")
    off = departure(times, step)
    rate = _usual_rate(times, step, resolution) or rate_from_frame_time(f"{step:.9f}")
    return Clock(rate, off, off <= _TOLERATED * step + resolution)


def _usual_rate(times: Array, step: float, resolution: float) -> Fraction | None:
    """Return the likeliest of the usual and whole rates that explains the times, if any does."""
    count = np.arange(len(times))

    def misses(seconds: float) -> float:
        return float(np.ptp(times - seconds * count)) / 2

    # Half of the last digit is lost by rounding, all of it where digits are cut off.
    allowed = max(1.01 * resolution, 1.2 * misses(step)) + 1e-9 * float(np.abs(times).max())
    near = [rate for rate in USUAL_RATES if abs(float(rate) * step - 1) < _NEAR]
    whole = [Fraction(round(1 / step))] if step < 1 else []
    return next((rate for rate in near + whole if misses(1 / float(rate)) <= allowed), None)


def departure(times: Array, step: float) -> float:
    """Seconds by which times (F,) differ at most from even steps after the first."""
    return float(np.abs(times - times[0] - step * np.arange(len(times))).max())


def _usual(steps: Array) -> float:
    return float(np.median(steps[steps > 0]))


def can_resample(times: Array, rate: Fraction) -> bool:
    """Tell whether even steps from the first of times (F,) to the last are sensibly many frames."""
    if not np.isfinite(times).all() or not (np.diff(times) > 0).all():
        return False
    return float(times[-1] - times[0]) * float(rate) < _MOST_ROWS * len(times)


def resampled(positions: Array, times: Array, rate: Fraction) -> Array:
    """Positions at even steps, linearly between neighbours; missing where they are far apart.

    Parameters
    ----------
    positions
        (F, M, 3), NaN where missing.
    times
        (F,) increasing seconds.
    rate
        Frames a second of the result.

    Returns
    -------
    (G, M, 3)
    """
    count = int(np.floor(float(times[-1] - times[0]) * float(rate) + 1e-6)) + 1
    grid = times[0] + np.arange(count) / float(rate)
    after = np.clip(np.searchsorted(times, grid), 1, len(times) - 1)
    before = after - 1
    gap = times[after] - times[before]
    weight = np.clip((grid - times[before]) / gap, 0.0, 1.0)[:, None, None]
    between = positions[before] * (1 - weight) + positions[after] * weight
    far = (gap > _WIDEST / float(rate))[:, None, None]
    between = np.where(far, np.nan, between)
    between = np.where(weight < 1e-6, positions[before], between)
    return np.asarray(np.where(weight > 1 - 1e-6, positions[after], between))
