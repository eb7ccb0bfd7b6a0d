"""The demo take: two minutes of walking, turning, standing and reaching."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from mocapstudio.evaluation.demo.body import Motion, move
from mocapstudio.evaluation.demo.poses import perform
from mocapstudio.evaluation.demo.route import build_route
from mocapstudio.evaluation.demo.score import SCORE, reaches
from mocapstudio.evaluation.demo.skeleton import demo_skeleton
from mocapstudio.motion.take import Take

RATE = Fraction(60)
SECONDS = 120
SEED = 20180


def demo_motion(seed: int = SEED) -> Motion:
    """Generate the motion with the spans in which either foot stands."""
    rng = np.random.Generator(np.random.PCG64(seed))
    times: NDArray[np.float64] = np.arange(SECONDS * int(RATE)) / float(RATE)
    route = build_route([item.what for item in SCORE], times, rng)
    reaching = perform(reaches(route.pauses), times, rng)
    return move(demo_skeleton(), route, reaching, times, rng)


def demo_take(seed: int = SEED) -> Take:
    """Generate the clean demo take: 7,200 frames at 60 Hz, twenty joints, metres, Y up.

    Parameters
    ----------
    seed
        Chooses the natural variation; the same seed gives the same take.
    """
    motion = demo_motion(seed)
    return Take(
        name="demo" if seed == SEED else f"demo-{seed}",
        skeleton=demo_skeleton(),
        rotations=motion.rotations,
        translations=motion.root[:, None, :],
        rate=RATE,
    )


def demo_context(count: int = 2) -> tuple[Take, ...]:
    """Generate other recordings of the demo performer doing the same, without errors."""
    return tuple(demo_take(seed) for seed in range(1, count + 1))
