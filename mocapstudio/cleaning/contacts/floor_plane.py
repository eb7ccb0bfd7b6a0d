"""A plane of small slope under places of rest, fitted robustly.

Each point has a level of its own above the plane, since nobody knows how thick its skin and shoe
are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_SCATTER = 0.03
"""Share of the leg within which rests on one floor scatter."""
_SLOPE_PRIOR = 0.2
"""Pull of the plane towards level, as rests of one second, a leg away, on a level floor."""
_LEVEL_PRIOR = 0.1
"""Pull of each point's level towards the others', as a rest of so many seconds."""
_UNEVEN = 0.08
"""Share of the leg by which levels differ at most: who stands on tiptoe has no higher heels."""
_STARTS = np.array(
    [(0.0, 0.0)]
    + [
        (steep * np.cos(turn), steep * np.sin(turn))
        for steep in (0.08, 0.18)
        for turn in np.arange(8) * np.pi / 4
    ]
)
"""Slopes from which the plane is sought: level, and 5 and 10 degrees in every direction."""
_ITERATIONS = 12


@dataclass(frozen=True)
class Rest:
    """A point at rest.

    Parameters
    ----------
    point
        Index of the point.
    start, end
        Half-open span of frames.
    place
        (x, y, z) metres: the middle of where it was.
    """

    point: int
    start: int
    end: int
    place: tuple[float, float, float]

    @property
    def across(self) -> Array:
        """(2,) metres: x and z."""
        return np.array([self.place[0], self.place[2]])


def fit_plane(
    found: Sequence[Rest], points: int, rate: float, leg: float
) -> tuple[float, Array, Array]:
    """Fit a plane to rests by Tukey's biweight, from several slopes on: the best one stays.

    From the level alone a run down a ramp would find one step of it and take the rest for air.

    Parameters
    ----------
    found
        At least one rest, of P = `points` points.
    rate, leg
        Frames a second; metres.

    Returns
    -------
    tuple
        Height in metres at x = z = 0, slope (2,) in metres a metre along x and z, and levels (P,)
        in metres of each point above the plane.
    """
    rests = _Rests(
        np.array([rest.point for rest in found]),
        np.stack([rest.across for rest in found]),
        np.array([rest.place[1] for rest in found]),
        # A long rest tells little more than a short one.
        np.minimum([(rest.end - rest.start) / rate for rest in found], 1.0),
    )
    middle = np.average(rests.across, axis=0, weights=rests.weight)
    centred = replace(rests, across=rests.across - middle)
    fits = [_refined(centred, start, points, leg) for start in _STARTS]
    solution = min(fits, key=lambda fit: _misfit(centred, fit, leg))
    slope, levels = solution[:2], solution[3:]
    shift = float(np.median(levels))
    return float(solution[2]) + shift - float(middle @ slope), slope, levels - shift


@dataclass(frozen=True, eq=False)
class _Rests:
    """R rests: (R,) their points, (R, 2) and (R,) metres where, (R,) seconds that they weigh."""

    which: NDArray[np.int64]
    across: Array
    up: Array
    weight: Array

    def off(self, solution: Array, leg: float) -> Array:
        """(R,) how far each is from its place on a plane, 1 where it no longer counts."""
        fitted = self.across @ solution[:2] + solution[2] + solution[3 + self.which]
        return np.asarray((self.up - fitted) / (3 * _SCATTER * leg))


def _refined(rests: _Rests, start: Array, points: int, leg: float) -> Array:
    """(3 + P,) slope, height and levels by iteratively reweighted least squares from a slope."""
    count = len(rests.up)
    design = np.zeros((count + 2 + points, 3 + points))
    design[:count, :2] = rests.across
    design[:count, 2] = 1.0
    design[np.arange(count), 3 + rests.which] = 1.0
    design[count : count + 2, :2] = np.eye(2) * leg
    design[count + 2 :, 3:] = np.eye(points)
    target = np.concatenate([rests.up, np.zeros(2 + points)])
    priors = [_SLOPE_PRIOR] * 2 + [_LEVEL_PRIOR] * points
    lowest = _lowest_levels(rests.which, rests.up - rests.across @ start, rests.weight, points)
    height = float(np.median(lowest))
    solution = np.concatenate([start, [height], lowest - height])
    for _ in range(_ITERATIONS):
        solution[3:] = np.clip(solution[3:], -_UNEVEN * leg, _UNEVEN * leg)
        trust = rests.weight * np.clip(1 - rests.off(solution, leg) ** 2, 0, None) ** 2 + 1e-9
        scaled = design * np.concatenate([trust, priors])[:, None]
        solution = np.linalg.solve(scaled.T @ design, scaled.T @ target)
    return solution


def _misfit(rests: _Rests, solution: Array, leg: float) -> float:
    """Tukey's biweight loss of the rests, and what the slope costs, in legs squared."""
    off = np.minimum(rests.off(solution, leg) ** 2, 1.0)
    loss = (3 * _SCATTER) ** 2 / 6 * float(rests.weight @ (1 - (1 - off) ** 3))
    loss += 0.5 * _SLOPE_PRIOR * float(solution[:2] @ solution[:2])
    return loss + 0.5 * _LEVEL_PRIOR * float(np.sum((solution[3:] / leg) ** 2))


def _lowest_levels(which: NDArray[np.int64], up: Array, weights: Array, points: int) -> Array:
    """(P,) metres: a low, well supported height of each point's rests."""
    lowest = float(np.percentile(up, 20))
    levels = np.full(points, lowest)
    for point in range(points):
        mine = which == point
        if not mine.any():
            continue
        order = np.argsort(up[mine])
        share = np.cumsum(weights[mine][order]) / weights[mine].sum()
        levels[point] = up[mine][order][np.searchsorted(share, 0.3)]
    return levels
