"""From a score of walks and pauses to a clock of strides and a path over the floor.

Everything that walks is a function of the stride phase, which grows by one a stride; only the
clock knows time. In a pause the clock stands still, both feet on the floor.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_simpson
from scipy.interpolate import CubicSpline

from mocapstudio.evaluation.demo.variation import minimum_jerk, smooth_noise

Array = NDArray[np.float64]

STRIDE_SECONDS = 1.12
STRIDE_METRES = 1.16
RAMP_SECONDS = 0.9
RAMP_STRIDES = 0.8
START_PHASE = 0.06
"""A phase in the middle of double support, where the clock may stand still."""

_GRID = 500


@dataclass(frozen=True)
class Walk:
    """Walk a multiple of half strides.

    Parameters
    ----------
    strides
        Length of the walk.
    turns
        (first stride, number of strides, degrees to the left) of each turn on the way.
    pace
        Stride length as a share of the usual; 0 turns on the spot.
    """

    strides: float
    turns: tuple[tuple[float, float, float], ...] = ()
    pace: float = 1.0


@dataclass(frozen=True)
class Stand:
    """Stand for some seconds."""

    seconds: float


@dataclass(frozen=True, eq=False)
class Route:
    """Where the body is, as functions of time and of phase.

    Parameters
    ----------
    phase
        (F,) strides: the right foot strikes at whole numbers, the left half a stride later.
    stepping
        (F,) 0..1: how much of the gait's angles is shown.
    path
        Phase to (x, z, heading): metres on the floor, radians about +Y, 0 facing +Z.
    spread
        Phase to 0..1: 1 on the way, 0 where the feet stand side by side.
    pauses
        Seconds (from, to) of every pause.
    step
        Seconds a frame.
    """

    phase: Array
    stepping: Array
    path: CubicSpline[np.float64]
    spread: CubicSpline[np.float64]
    pauses: tuple[tuple[float, float], ...]
    step: float


def build_route(score: Sequence[Walk | Stand], times: Array, rng: np.random.Generator) -> Route:
    """Lay out a score; the last pause lasts as long as `times` (F, seconds) does."""
    seconds, at = [times[0]], [START_PHASE]
    pauses = []
    for item in score:
        if isinstance(item, Stand):
            pauses.append((seconds[-1], seconds[-1] + item.seconds))
            seconds.append(seconds[-1] + item.seconds)
            at.append(at[-1])
        else:
            inner = _walk_clock(item)
            seconds.extend(seconds[-1] + inner[0])
            at.extend(at[-1] + inner[1])
    phase = np.interp(times, seconds, at)
    grid = np.arange(at[-1] * _GRID + 2 * _GRID) / _GRID
    length, angles, turning = _along(score, grid)
    varied = 1.0 + smooth_noise(rng, grid, 0.8, 0.02)[:, 0]
    heading = cumulative_simpson(turning, x=grid, initial=0.0)
    speed = STRIDE_METRES * length * varied
    x = cumulative_simpson(speed * np.sin(heading), x=grid, initial=0.0)
    z = cumulative_simpson(speed * np.cos(heading), x=grid, initial=0.0)
    return Route(
        phase,
        np.interp(phase, grid, angles),
        CubicSpline(grid, np.stack([x, z, heading], axis=-1)),
        CubicSpline(grid, angles),
        tuple(pauses),
        float(times[1] - times[0]),
    )


def _walk_clock(walk: Walk) -> tuple[Array, Array]:
    """Seconds and strides since the start of a walk; the clock starts and stops smoothly."""
    seconds = walk.strides * STRIDE_SECONDS + RAMP_SECONDS
    t = np.linspace(0.0, seconds, int(seconds * 240))
    speed = minimum_jerk(t / RAMP_SECONDS) * minimum_jerk((seconds - t) / RAMP_SECONDS)
    phase = cumulative_simpson(speed, x=t, initial=0.0)
    return t[1:], phase[1:] * (walk.strides / phase[-1])


def _along(score: Sequence[Walk | Stand], grid: Array) -> tuple[Array, Array, Array]:
    """Stride length and angles as shares of the usual, and turning in radians a stride."""
    length, angles, turning = np.zeros((3, len(grid)))
    start = START_PHASE
    for item in score:
        if isinstance(item, Stand):
            continue
        end = start + item.strides
        ramp = _ramps(grid, start, end, RAMP_STRIDES)
        turn = np.zeros(len(grid))
        for first, strides, degrees in item.turns:
            turn += _bump(grid - start - first, strides) * np.deg2rad(degrees)
        # Who turns sharply takes shorter steps.
        length += ramp * item.pace / (1.0 + 0.35 * np.abs(turn))
        shown = _ramps(grid, start, end, 0.5 * RAMP_STRIDES)
        angles += shown * max(item.pace, 0.4) / (1.0 + 0.12 * np.abs(turn))
        turning += turn
        start = end
    return length, angles, turning


def _ramps(phase: Array, start: float, end: float, width: float) -> Array:
    return minimum_jerk((phase - start) / width) * minimum_jerk((end - phase) / width)


def _bump(phase: Array, width: float) -> Array:
    """Smooth bump over [0, width] whose integral is 1."""
    u = np.clip(phase / width, 0.0, 1.0)
    return 30.0 * (u * (1 - u)) ** 2 / width
