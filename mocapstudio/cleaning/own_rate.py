"""Pops and jitter at the take's own rate, which 24 fps mostly misses.

Both look at what a smooth local motion does not explain: a frame is predicted from the frames
around it, and its departure is compared with what is usual for that row in this take.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot
from mocapstudio.similarity.texture import BodyMotion

Array = NDArray[np.float64]

POP_SECONDS = 0.05
JITTER_SECONDS = 0.35
_LEAST_POP = np.deg2rad(6.0)
_LEAST_JITTER = np.deg2rad(1.2)
_LEAST_POP_METRES = 0.02
_POP_RATIO = 9.0
_JITTER_RATIO = 5.0


@dataclass(frozen=True, eq=False)
class OwnRate:
    """Departures of one or several rows from a smooth motion, at the take's own rate.

    Parameters
    ----------
    pops
        (F, R) how many times the threshold of a pop is exceeded; 1 and more is a pop.
    jitter
        (F, R) the same for jitter.
    """

    pops: NDArray[np.float32]
    jitter: NDArray[np.float32]

    def placed(self, start: int, frames: int) -> OwnRate:
        """Lay a trimmed span into its take of so many frames; 0 outside."""
        lead, tail = start, frames - start - len(self.pops)
        around = ((lead, tail), (0, 0))
        return OwnRate(np.pad(self.pops, around), np.pad(self.jitter, around))


def of_motion(motion: BodyMotion) -> OwnRate:
    """Find pops and jitter of joints and of the two root rows, which come last."""
    turns = rot.continuous(rot.about_axis(1, motion.heading)[:, None])
    parts = [
        of_rotations(motion.rotations, motion.rate),
        of_positions(motion.position[:, None], motion.rate),
        of_rotations(turns, motion.rate),
    ]
    return OwnRate(
        np.hstack([part.pops for part in parts]), np.hstack([part.jitter for part in parts])
    )


def of_rotations(q: Array, rate: float) -> OwnRate:
    """Find pops and jitter of joints.

    Parameters
    ----------
    q
        (F, R, 4) rotations, sign-continuous.
    rate
        Frames a second.
    """
    return _measure(q, rate, _LEAST_POP, _LEAST_JITTER, _rotation_departure)


def of_positions(p: Array, rate: float) -> OwnRate:
    """Find pops and jitter of points (F, R, 3), metres."""
    return _measure(p, rate, _LEAST_POP_METRES, _LEAST_POP_METRES / 5, _position_departure)


def _rotation_departure(q: Array, reach: int) -> Array:
    before, after = _shifted(q, -reach), _shifted(q, reach)
    after = np.where(np.sum(before * after, axis=-1, keepdims=True) < 0, -after, after)
    return rot.angle(q, rot.normalize(before + after))


def _position_departure(p: Array, reach: int) -> Array:
    middle = 0.5 * (_shifted(p, -reach) + _shifted(p, reach))
    return np.asarray(np.linalg.norm(p - middle, axis=-1))


def _shifted(values: Array, by: int) -> Array:
    at = np.clip(np.arange(len(values)) + by, 0, len(values) - 1)
    return values[at]


def _measure(
    values: Array,
    rate: float,
    least_pop: float,
    least_jitter: float,
    departure: Callable[[Array, int], Array],
) -> OwnRate:
    frames = len(values)
    # What a natural acceleration bends between frames grows fast where the rate is low.
    coarse = max(1.0, 60.0 / rate) ** 1.5
    least_pop, least_jitter = least_pop * coarse, least_jitter * coarse
    reach = max(1, round(POP_SECONDS * rate / 2))
    pops = np.zeros(values.shape[:2])
    for step in sorted({1, reach, 2 * reach}):
        if frames <= 2 * step + 1:
            continue
        away = departure(values, step)
        away[:step] = away[frames - step :] = 0.0
        usual = _usual(away, max(2 * step, round(0.25 * rate)))
        pops = np.maximum(pops, away / np.maximum(least_pop, _POP_RATIO * usual))
    fine = departure(values, 1) if frames > 3 else np.zeros(values.shape[:2])
    fine[:1] = fine[-1:] = 0.0
    # A pop, and what it does to the frames beside it, would count as jitter all over the window.
    popped = np.maximum(pops, np.maximum(_shifted(pops, -1), _shifted(pops, 1))) >= 1.0
    fine = np.where(popped, 0.0, fine)
    window = max(3, round(JITTER_SECONDS * rate))
    level = np.sqrt(_moving_mean(fine**2, window))
    calm = np.median(level, axis=0, keepdims=True)
    jitter = level / np.maximum(least_jitter * min(1.0, 60.0 / rate), _JITTER_RATIO * calm)
    return OwnRate(pops.astype(np.float32), jitter.astype(np.float32))


def _usual(values: Array, reach: int) -> Array:
    """Mean over a neighbourhood that leaves out its own centre, where a pop would be."""
    wide, narrow = 4 * reach + 1, 2 * (reach // 2) + 1
    total = _moving_mean(values, wide) * wide - _moving_mean(values, narrow) * narrow
    return np.asarray(np.maximum(total / (wide - narrow), 0.0))


def _moving_mean(values: Array, window: int) -> Array:
    window = min(window | 1, (len(values) - 1) | 1)
    half = window // 2
    padded = np.concatenate([values[half:0:-1], values, values[-2 : -half - 2 : -1]])
    total = np.cumsum(np.concatenate([np.zeros((1, *values.shape[1:])), padded]), axis=0)
    return np.asarray((total[window:] - total[:-window]) / window)
