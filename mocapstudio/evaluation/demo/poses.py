"""Reaching: key poses joined by minimum-jerk motion, with the hand led to a target.

A reach takes the whole body along: each carries how far pelvis and trunk follow. The hand meets
its target exactly while it holds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.evaluation.demo.variation import minimum_jerk
from mocapstudio.motion import rotations as rot

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Reach:
    """A key pose of reaching, in the frame of who stands: left, up, forward.

    Parameters
    ----------
    targets
        Side ("Left", "Right") to the wrist's target, metres.
    shift
        Metres that the pelvis moves.
    pelvis, spine, chest, head
        Degrees about left (forward bend), up (turn left) and forward (lean right).
    shrug
        Degrees that the shoulders of reaching arms rise.
    """

    targets: tuple[tuple[str, tuple[float, float, float]], ...]
    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    pelvis: tuple[float, float, float] = (0.0, 0.0, 0.0)
    spine: tuple[float, float, float] = (0.0, 0.0, 0.0)
    chest: tuple[float, float, float] = (0.0, 0.0, 0.0)
    head: tuple[float, float, float] = (0.0, 0.0, 0.0)
    shrug: float = 0.0


SHELF = Reach(
    targets=(("Right", (-0.20, 1.74, 0.46)),),
    shift=(-0.030, 0.0, 0.045),
    pelvis=(2.0, 7.0, 0.0),
    spine=(0.0, 6.0, -4.0),
    chest=(-4.0, 6.0, -5.0),
    head=(-14.0, -10.0, 4.0),
    shrug=14.0,
)
TABLE = Reach(
    targets=(("Left", (0.16, 1.03, 0.54)),),
    shift=(0.015, -0.010, 0.040),
    pelvis=(5.0, -5.0, 0.0),
    spine=(5.0, -6.0, 1.0),
    chest=(5.0, -6.0, 2.0),
    head=(4.0, 12.0, 0.0),
    shrug=3.0,
)
FLOOR_BOX = Reach(
    targets=(("Left", (0.20, 0.56, 0.40)), ("Right", (-0.20, 0.56, 0.40))),
    shift=(0.0, -0.270, -0.110),
    pelvis=(36.0, 0.0, 0.0),
    spine=(12.0, 0.0, 0.0),
    chest=(8.0, 0.0, 0.0),
    head=(-24.0, 0.0, 0.0),
    shrug=3.0,
)
ACROSS = Reach(
    targets=(("Right", (0.26, 1.18, 0.36)),),
    shift=(0.030, -0.005, 0.015),
    pelvis=(2.0, 12.0, 0.0),
    spine=(3.0, 12.0, -1.0),
    chest=(3.0, 13.0, -1.0),
    head=(4.0, 4.0, 0.0),
    shrug=4.0,
)


@dataclass(frozen=True, eq=False)
class Reaching:
    """All reaches of a take, summed over time.

    Parameters
    ----------
    shift
        (F, 3) metres in the standing frame.
    pelvis, spine, chest, head
        (F, 4) rotations.
    hands
        Side to (weight (F,), shrug (F,) radians, target (F, 3) metres in the standing frame).
    """

    shift: Array
    pelvis: Array
    spine: Array
    chest: Array
    head: Array
    hands: dict[str, tuple[Array, Array, Array]]


def perform(
    plan: tuple[tuple[float, Reach], ...], times: Array, rng: np.random.Generator
) -> Reaching:
    """Carry out reaches, no two alike.

    Parameters
    ----------
    plan
        When each begins, seconds, and which it is.
    times
        (F,) seconds.
    """
    frames = len(times)
    bends = {part: np.zeros((frames, 3)) for part in ("pelvis", "spine", "chest", "head")}
    shift = np.zeros((frames, 3))
    hands = {s: (np.zeros(frames), np.zeros(frames), np.zeros((frames, 3))) for s in SIDE_NAMES}
    for begin, reach in plan:
        tempo, size = rng.normal(1.0, 0.06), rng.normal(1.0, 0.06)
        body = _bell(times, begin, 1.0 * tempo, 0.35, 1.05 * tempo)
        arm = _bell(times, begin + 0.06, 0.95 * tempo, 0.30, 1.0 * tempo)
        shift += size * body[:, None] * np.array(reach.shift)
        for part, bend in bends.items():
            bend += size * body[:, None] * np.deg2rad(getattr(reach, part))
        moved = rng.normal(0.0, 0.018, 3)
        for side, target in reach.targets:
            weight, shrug, place = hands[side]
            weight += arm
            shrug += arm * np.deg2rad(reach.shrug)
            place[arm > 0] = np.array(target) + moved
    turned = {part: rot.from_rotation_vector(bend) for part, bend in bends.items()}
    return Reaching(shift=shift, hands=hands, **turned)


SIDE_NAMES = ("Left", "Right")
REACH_SECONDS = 3.3
"""From the beginning of one reach to the next."""


def _bell(times: Array, begin: float, out: float, hold: float, back: float) -> Array:
    rise = minimum_jerk((times - begin) / out)
    return rise - minimum_jerk((times - begin - out - hold) / back)
