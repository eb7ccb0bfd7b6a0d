"""Performances of a take at another pace, of which the true timing is known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]

_KNOT_SECONDS = 3.0


@dataclass(frozen=True)
class Disturbance:
    """What distinguishes a performance from the take that it repeats.

    Parameters
    ----------
    pace
        Largest ratio of its speed to the take's, or of the take's to its; varies smoothly.
    pauses
        How often the performer stands still.
    pause_seconds
        Longest of those; the shortest is a third of it.
    noise_degrees
        Standard deviation of the angle by which each joint is off, anew in each frame.
    sway_degrees
        The same of an angle that varies over seconds.
    style_degrees
        The same of an angle that stays.
    """

    pace: float = 1.6
    pauses: int = 3
    pause_seconds: float = 1.5
    noise_degrees: float = 5.0
    sway_degrees: float = 0.0
    style_degrees: float = 10.0


@dataclass(frozen=True, eq=False)
class WarpedTake:
    """A performance and its true timing.

    Parameters
    ----------
    take
        The performance.
    truth
        (F,) frame of the original, fractional, that each frame repeats.
    """

    take: Take
    truth: Array


def perform_again(take: Take, how: Disturbance, seed: int) -> WarpedTake:
    """Perform a take again, at another pace, with pauses, in another style and with noise."""
    rng = np.random.default_rng(seed)
    truth = _timing(take.frames, float(take.rate), how, rng)
    low = np.minimum(truth.astype(np.int64), take.frames - 2)
    part = truth - low
    rotations = rot.slerp(take.rotations[low], take.rotations[low + 1], part[:, None])
    before, after = take.translations[low], take.translations[low + 1]
    places = before + part[:, None, None] * (after - before)
    turned = list(topology(take.skeleton).body_joints())
    frames, joints = len(truth), len(turned)
    away = rng.normal(0, np.deg2rad(how.noise_degrees / np.sqrt(3)), (frames, joints, 3))
    away += rng.normal(0, np.deg2rad(how.style_degrees / np.sqrt(3)), (1, joints, 3))
    away += _sway(frames, joints, float(take.rate), how, rng)
    rotations[:, turned] = rot.multiply(rotations[:, turned], rot.from_rotation_vector(away))
    again = Take(
        name=f"{take.name} again {seed}",
        skeleton=take.skeleton,
        rotations=rot.continuous(rotations),
        translations=places,
        rate=take.rate,
        translated=take.translated,
    )
    return WarpedTake(again, truth)


def _timing(frames: int, rate: float, how: Disturbance, rng: np.random.Generator) -> Array:
    """Frames of the original at each frame of the performance."""
    pace = np.exp(np.log(how.pace) * _wave(4 * frames, rate, rng))
    moving = np.concatenate([[0.0], np.cumsum(pace)])
    moving = moving[moving <= frames - 1]
    pieces, last = [], 0
    for at in np.sort(rng.integers(1, len(moving) - 1, how.pauses)):
        held = round(rate * how.pause_seconds * rng.uniform(1 / 3, 1))
        pieces += [moving[last:at], np.full(held, moving[at])]
        last = int(at)
    return np.concatenate([*pieces, moving[last:]])


def _sway(
    frames: int, joints: int, rate: float, how: Disturbance, rng: np.random.Generator
) -> Array:
    if how.sway_degrees == 0:
        return np.zeros((1, joints, 3))
    knots = rng.normal(
        0, np.deg2rad(how.sway_degrees / np.sqrt(3)), (_knots(frames, rate), joints, 3)
    )
    return _through(knots, frames)


def _wave(frames: int, rate: float, rng: np.random.Generator) -> Array:
    """(frames,) smooth random values in -1..1."""
    return np.clip(_through(rng.uniform(-1, 1, _knots(frames, rate)), frames), -1, 1)


def _knots(frames: int, rate: float) -> int:
    return max(4, round(frames / rate / _KNOT_SECONDS))


def _through(knots: Array, frames: int) -> Array:
    from scipy.interpolate import CubicSpline

    return np.asarray(CubicSpline(np.linspace(0, 1, len(knots)), knots)(np.linspace(0, 1, frames)))
