"""Breaks: rotations faster than people turn, which tell errors that a context came with.

Errors that recur in a context would be learnt as normal; around a break nothing is taken for clean.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.decision.model import pool
from mocapstudio.motion import rotations as rot
from mocapstudio.similarity.texture import TEXTURE_RATE, BodyMotion, MotionTexture

Bool = NDArray[np.bool_]
Array = NDArray[np.float64]

_FASTEST_JOINT = np.deg2rad(1400.0)
_FASTEST_HEADING = np.deg2rad(1100.0)
_TIMES_USUAL = 2.0
_EDGE_SECONDS = 0.1
_AROUND = round(0.75 * TEXTURE_RATE)


def limits(motions: Sequence[BodyMotion]) -> Array:
    """(m,) rad/s that a joint does not exceed: what people reach, or twice a usual take's fastest.

    The first and last tenth of a second are left out: captures begin and end with artefacts.
    """
    fastest = []
    for motion in motions:
        edge = max(1, round(_EDGE_SECONDS * motion.rate))
        inner = speeds(motion)[edge:-edge]
        if len(inner):
            fastest.append(inner.max(axis=0))
    usual = np.median(fastest, axis=0) if fastest else np.zeros(len(motions[0].joints))
    return np.asarray(np.maximum(_TIMES_USUAL * usual, _FASTEST_JOINT))


def speeds(motion: BodyMotion) -> Array:
    """(F, m) rad/s, each frame's the larger of the steps to it and from it."""
    steps = rot.angle(motion.rotations[1:], motion.rotations[:-1]) * motion.rate
    still = np.zeros((1, steps.shape[1]))
    return np.asarray(np.maximum(np.concatenate([still, steps]), np.concatenate([steps, still])))


def doubtful(motion: BodyMotion, texture: MotionTexture, limit: Array) -> Bool:
    """(S, m + 2) True within 0.75 s of a break of the row; root rows where the heading breaks."""
    turning = np.abs(np.gradient(motion.heading)) * motion.rate > _FASTEST_HEADING
    broken = np.hstack([speeds(motion) > limit, turning[:, None], turning[:, None]])
    at = pool(broken.astype(np.float32), texture) > 0
    count = np.cumsum(np.pad(at, ((_AROUND + 1, _AROUND), (0, 0))), axis=0)
    return np.asarray(count[2 * _AROUND + 1 :] - count[: -2 * _AROUND - 1] > 0)
