"""Features from which the decision is learnt: residuals of every joint and frame at 24 fps.

All are computed without the take itself in the context; an error neither chooses its own
neighbours (the joint's limb is left out of the search) nor hides in the covariance.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from mocapstudio.cleaning.decision import gaussian, kernels, plausibility
from mocapstudio.cleaning.decision.gaussian import Moments
from mocapstudio.cleaning.decision.matching import Matches
from mocapstudio.cleaning.own_rate import OwnRate
from mocapstudio.similarity.texture import BodyMotion, MotionTexture

F32 = NDArray[np.float32]
I64 = NDArray[np.int64]

_RESIDUALS = (
    "nearest", "median", "mean", "spread", "distance", "last distance",
    "velocity", "speed", "count",
)  # fmt: skip
NAMES = (
    *(f"context {name}" for name in _RESIDUALS),
    *(f"own {name}" for name in _RESIDUALS),
    "given others", "given other limbs",
    "context mean onset", "own mean onset", "given limbs onset",
    "context mean usual", "given others usual", "given limbs usual", "pop usual", "jitter usual",
    "context mean 4 before", "context mean 4 after", "given limbs 4 before", "given limbs 4 after",
    "lowest around", "highest around", "limb others", "body others",
    "speed", "acceleration", "jerk", "constancy", "calm before", "calm after",
    "pop", "jitter", "pop around",
    *plausibility.SCORES, *plausibility.NEAREST, *plausibility.FEET,
    "z limbs onset", "z limbs lowest", "z limbs body",
)  # fmt: skip
COLUMN = {name: i for i, name in enumerate(NAMES)}
USUAL = ("context mean", "given others", "given limbs", "pop", "jitter")
"""What is divided by its usual size: rows of `Surroundings.usual`."""


@dataclass(frozen=True, eq=False)
class Surroundings:
    """What a take is compared with.

    Parameters
    ----------
    textures
        Of the context's takes, without the take itself.
    moments
        Of the same takes.
    centre
        (m, 4) mean pose of the whole context.
    limb
        (m,) which limb each joint belongs to.
    usual
        (5, m) what is usual for clean takes of this context (98 % quantiles), see `USUAL`; None
        while it is being measured.
    """

    textures: Sequence[MotionTexture]
    moments: Moments
    centre: F32
    limb: I64
    usual: F32 | None = None


def features(
    motion: BodyMotion,
    texture: MotionTexture,
    around: Surroundings,
    matches: Matches,
    rates: OwnRate,
) -> F32:
    """Assemble the features of the joints.

    Parameters
    ----------
    motion, texture
        The take: at its own rate, and sampled at 24 fps; S frames, m joints.
    around
        Its surroundings.
    matches
        From `matching.match`.
    rates
        Pops and jitter of the joints, pooled to 24 fps: (S, m) and more columns.

    Returns
    -------
    (S, m, len(NAMES)) float32; NaN where something does not exist.
    """
    source = texture.quaternions
    frames, joints = source.shape[:2]
    out = np.full((frames, joints, len(NAMES)), np.nan, dtype=np.float32)
    n = kernels.RESIDUALS
    context, own = np.empty((2, frames, joints, n), dtype=np.float32)
    common = (source, matches.planes, around.limb, matches.centre_of, matches.centres)
    kernels.residuals(*common, matches.found, matches.distance, context)
    kernels.residuals(*common, matches.own_found, matches.own_distance, own)
    out[..., :n], out[..., n : 2 * n] = context, own
    vectors = gaussian.rotation_vectors(source, around.centre)
    stacked = gaussian.stacked(vectors)
    others, limbs = gaussian.conditional_residuals(stacked, around.moments, around.limb)
    mean = context[..., 2] if len(around.textures) else own[..., 2]
    pops, jitter = rates.pops[:, :joints], rates.jitter[:, :joints]
    for name, values in (
        ("given others", others), ("given other limbs", limbs), ("pop", pops), ("jitter", jitter),
        ("pop around", windows(pops, 2).max(axis=-1)),
    ):  # fmt: skip
        out[..., COLUMN[name]] = values
    for i, values in enumerate((mean, others, limbs, pops, jitter)):
        scale = 1.0 if around.usual is None else around.usual[i]
        out[..., COLUMN[f"{USUAL[i]} usual"]] = values / scale
    _add_onsets(out, mean, own[..., 2], limbs)
    _add_neighbourhood(out, mean, limbs, around.limb)
    _add_motion(out, source)
    _add(out, plausibility.SCORES, plausibility.scores(stacked, around.moments, around.limb))
    _add(out, plausibility.NEAREST, plausibility.nearest(texture, matches, around.limb))
    _add(out, plausibility.FEET, plausibility.feet(motion, texture, around.limb))
    score = out[..., COLUMN["z given limbs"]]
    out[..., COLUMN["z limbs onset"]] = score - running_median(score, 24)
    out[..., COLUMN["z limbs lowest"]] = windows(score, 2).min(axis=-1)
    out[..., COLUMN["z limbs body"]] = np.median(score, axis=1)[:, None]
    return out


def _add(out: F32, names: Sequence[str], values: F32) -> None:
    out[..., [COLUMN[name] for name in names]] = values


def _add_onsets(out: F32, mean: F32, own: F32, limbs: F32) -> None:
    """A difference in style varies slowly, an error begins: subtract the median around."""
    for name, values in (
        ("context mean onset", mean),
        ("own mean onset", own),
        ("given limbs onset", limbs),
    ):
        out[..., COLUMN[name]] = values - running_median(values, 24)


def _add_neighbourhood(out: F32, mean: F32, limbs: F32, limb: I64) -> None:
    for name, values in (("context mean", mean), ("given limbs", limbs)):
        out[..., COLUMN[f"{name} 4 before"]] = moved(values, -4)
        out[..., COLUMN[f"{name} 4 after"]] = moved(values, 4)
    around = windows(mean, 2)
    out[..., COLUMN["lowest around"]] = around.min(axis=-1)
    out[..., COLUMN["highest around"]] = around.max(axis=-1)
    for one in np.unique(limb):
        members = np.flatnonzero(limb == one)
        for k in members:
            rest = members[members != k]
            out[:, k, COLUMN["limb others"]] = mean[:, rest].max(axis=1) if len(rest) else 0.0
        out[:, members, COLUMN["body others"]] = (
            np.median(mean[:, limb != one], axis=1)[:, None] if np.any(limb != one) else 0.0
        )


def _add_motion(out: F32, source: F32) -> None:
    speed = _steps(source)
    turn = np.abs(np.gradient(speed, axis=0))
    out[..., COLUMN["speed"]] = speed
    out[..., COLUMN["acceleration"]] = turn
    out[..., COLUMN["jerk"]] = np.abs(np.gradient(turn, axis=0))
    # Freezes and straight gaps show as a speed that hardly changes for some frames.
    near = windows(speed, 3)
    steady = (near.max(axis=-1) - near.min(axis=-1)) / (near.mean(axis=-1) + 0.2)
    out[..., COLUMN["constancy"]] = steady
    out[..., COLUMN["calm before"]] = moved(steady, -4)
    out[..., COLUMN["calm after"]] = moved(steady, 4)


def _steps(source: F32) -> F32:
    """(S, m) degrees a frame, from the frame before to the frame after."""
    at = np.arange(len(source))
    a, b = source[np.maximum(at - 1, 0)], source[np.minimum(at + 1, len(source) - 1)]
    dot = np.abs(np.sum(a * b, axis=-1))
    return np.asarray(np.rad2deg(np.arccos(np.clip(dot, 0.0, 1.0))), dtype=np.float32)


def moved(values: F32, by: int) -> F32:
    """Values (S, ...) of the frame `by` frames on, held at the ends."""
    return values[np.clip(np.arange(len(values)) + by, 0, len(values) - 1)]


def windows(values: F32, half: int) -> F32:
    """(S, n, 2 half + 1) the frames around each, ends repeated."""
    padded = np.pad(values, ((half, half), (0, 0)), mode="edge")
    return np.asarray(sliding_window_view(padded, 2 * half + 1, axis=0))


def running_median(values: F32, half: int) -> F32:
    """(S, n) median over about 2 half + 1 frames of each column, taken of every third frame."""
    coarse = values[::3]
    median = np.median(windows(coarse, half // 3), axis=-1)
    return np.asarray(np.repeat(median, 3, axis=0)[: len(values)], dtype=np.float32)
