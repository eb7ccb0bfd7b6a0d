"""Known errors in the demo take, one of every kind."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from mocapstudio.cleaning.model import Kind
from mocapstudio.evaluation.demo.take import demo_take
from mocapstudio.evaluation.injection import inject
from mocapstudio.evaluation.truth import Truth
from mocapstudio.motion.take import Take

_SEED = 7
_PLAN: tuple[tuple[float, Kind, tuple[str, ...] | None], ...] = (
    (5.2, Kind.SPIKE, ("LeftForeArm",)),
    (9.0, Kind.OFFSET, ("RightUpLeg",)),
    (13.1, Kind.FREEZE, ("RightArm",)),
    (25.4, Kind.NOISE, ("LeftLeg",)),
    (29.2, Kind.ROOT_POP, None),
    (33.2, Kind.LIMB, ("LeftArm", "LeftForeArm", "LeftHand")),
    (43.0, Kind.GAP, ("RightLeg",)),
    (47.6, Kind.FLIP, ("LeftFoot",)),
    (55.6, Kind.DRIFT, ("Chest",)),
    (68.4, Kind.SWAP, ("LeftUpLeg",)),
    (73.2, Kind.JITTER, ("RightArm",)),
    (80.0, Kind.POP, ("Head",)),
    (94.6, Kind.HEADING_FLIP, None),
    (111.5, Kind.HEIGHT_DRIFT, None),
)
"""When (seconds), what, and which joints; root kinds have a row of their own."""


@lru_cache(maxsize=1)
def demo_with_errors() -> tuple[Take, tuple[Truth, ...]]:
    """Generate the demo take with known errors, and the list of them in order of time.

    The joints, places and kinds are chosen; sizes and shapes are drawn with a fixed seed. Outside
    the truths' rows and spans the take equals `demo_take()`.
    """
    take = demo_take()
    rng = np.random.Generator(np.random.PCG64(_SEED))
    truths = []
    for seconds, kind, joints in _PLAN:
        start = round(seconds * float(take.rate))
        take, truth = inject(take, kind, rng, joints=joints, start=start)
        truths.append(truth)
    return take, tuple(truths)
