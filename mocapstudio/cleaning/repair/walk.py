"""How the hips travel, given what the body does: height, speed and turning.

A foot that stands tells how the hips move over it; the rest is learnt from the context and the
take itself, as in `repair.regression`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.repair.material import centre_of
from mocapstudio.cleaning.repair.regression import OWN_WEIGHT
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.take import Take
from mocapstudio.similarity.texture import TEXTURE_RATE, BodyMotion, body_motion

F64 = NDArray[np.float64]
Mask = NDArray[np.bool_]

FORWARD, SIDEWAYS, HEIGHT, TURNING = range(4)
_RIDGE = 0.05**2
_SPREAD = (0, -3, 3)
_LEAST = 24


@dataclass(frozen=True, eq=False)
class Walk:
    """Expected travel of the hips at the take's own rate, over the trimmed span.

    Parameters
    ----------
    velocity
        (F', 3) m/s in the world, without a vertical part.
    height
        (F',) metres.
    turning
        (F',) rad/s.
    """

    velocity: F64
    height: F64
    turning: F64


def expected_walk(
    take: Take, context: tuple[Take, ...], joints: tuple[str, ...], wrong: Mask
) -> Walk | None:
    """Expect the travel of the hips of a take from its joints.

    Parameters
    ----------
    take, context
        The take, and others of its skeleton.
    joints
        Names of the m joints to learn from.
    wrong
        (F',) where the take is not to be learnt from.

    Returns
    -------
    None where there is too little to learn from.
    """
    motion = body_motion(take, joints)
    centre = centre_of(context, joints) if context else rot.mean(motion.rotations)
    inputs, stance = _inputs(motion, centre), _stance(motion)
    targets = _targets(motion)
    step = max(1, round(motion.rate / TEXTURE_RATE))
    chosen = np.flatnonzero(~wrong)[::step]
    parts = [_of_context(context, joints)] if context else []
    if len(chosen) >= _LEAST:
        own = _sums(np.hstack([inputs, stance])[chosen], targets[chosen])
        parts.append((OWN_WEIGHT * own[0], OWN_WEIGHT * own[1], OWN_WEIGHT * own[2]))
    if not parts:
        return None
    count, total, outer = _added(parts)
    everything = np.hstack([inputs, stance])
    # What a standing foot tells of the speed rests on the heading's own turning.
    seen = _conditioned(everything, count, total, outer, everything.shape[1], targets.shape[1])
    blind = _conditioned(inputs, count, total, outer, everything.shape[1], targets.shape[1])
    sine, cosine = np.sin(motion.heading), np.cos(motion.heading)
    forward, sideways = seen[:, FORWARD], seen[:, SIDEWAYS]
    velocity = np.stack(
        [
            forward * sine + sideways * cosine,
            np.zeros(len(motion)),
            forward * cosine - sideways * sine,
        ],
        axis=1,
    )
    return Walk(velocity, seen[:, HEIGHT], blind[:, TURNING])


def _conditioned(inputs: F64, count: float, total: F64, outer: F64, width: int, wanted: int) -> F64:
    """(F', wanted) expectation of the targets, which follow `width` inputs in the sums."""
    n = inputs.shape[1]
    at = np.concatenate([np.arange(n), width + np.arange(wanted)])
    mean = total[at] / count
    covariance = outer[np.ix_(at, at)] / count - np.outer(mean, mean)
    slopes = np.linalg.solve(covariance[:n, :n] + _RIDGE * np.eye(n), covariance[:n, n:])
    return np.asarray((inputs - mean[:n]) @ slopes + mean[n:])


def _sums(inputs: F64, targets: F64) -> tuple[float, F64, F64]:
    whole = np.hstack([inputs, targets])
    return float(len(whole)), whole.sum(axis=0), whole.T @ whole


def _added(parts: Sequence[tuple[float, F64, F64]]) -> tuple[float, F64, F64]:
    return (
        sum(count for count, _, _ in parts),
        np.sum([total for _, total, _ in parts], axis=0),
        np.sum([outer for _, _, outer in parts], axis=0),
    )


@lru_cache(maxsize=8)
def _of_context(context: tuple[Take, ...], joints: tuple[str, ...]) -> tuple[float, F64, F64]:
    centre = centre_of(context, joints)
    parts = []
    for take in context:
        motion = body_motion(take, joints)
        step = max(1, round(motion.rate / TEXTURE_RATE))
        inputs = np.hstack([_inputs(motion, centre), _stance(motion)])[::step]
        parts.append(_sums(inputs, _targets(motion)[::step]))
    return _added(parts)


def _inputs(motion: BodyMotion, centre: F64) -> F64:
    """(F', d) rotation vectors of all joints, now and an eighth of a second before and after."""
    turned = rot.multiply(rot.conjugate(centre), motion.rotations)
    vectors = rot.to_rotation_vector(turned).reshape(len(motion), -1)
    return _spread(vectors, motion.rate)


def _stance(motion: BodyMotion) -> F64:
    """(F', 9) how the hips would move and how high they would be, were the lowest foot to stand."""
    back = rot.about_axis(1, -motion.heading)
    feet = rot.rotate(back[:, None], motion.feet - motion.position[:, None])
    lowest = feet[..., 1].argmin(axis=1)
    speed = np.gradient(feet, axis=0) * motion.rate
    turning = np.gradient(motion.heading) * motion.rate
    at = np.arange(len(motion))
    foot, moving = feet[at, lowest], speed[at, lowest]
    forward = -(moving[:, 2] - turning * foot[:, 0])
    sideways = -(moving[:, 0] + turning * foot[:, 2])
    return _spread(np.stack([forward, sideways, -foot[:, 1]], axis=1), motion.rate)


def _targets(motion: BodyMotion) -> F64:
    velocity = np.gradient(motion.position, axis=0) * motion.rate
    sine, cosine = np.sin(motion.heading), np.cos(motion.heading)
    forward = velocity[:, 0] * sine + velocity[:, 2] * cosine
    sideways = velocity[:, 0] * cosine - velocity[:, 2] * sine
    turning = np.gradient(motion.heading) * motion.rate
    return np.stack([forward, sideways, motion.position[:, 1], turning], axis=1)


def _spread(values: F64, rate: float) -> F64:
    frames = np.arange(len(values))
    lags = [round(one * rate / TEXTURE_RATE) for one in _SPREAD]
    return np.concatenate(
        [values[np.clip(frames + lag, 0, len(values) - 1)] for lag in lags], axis=1
    )
