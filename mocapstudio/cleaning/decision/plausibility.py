"""What holds for bodies, not only for a context: departures in units of what is usual there.

A joint that hardly bends sideways, a foot that stays where it stands: such things are known even of
an action that nothing in the context resembles. Measured in standard deviations, in degrees to the
nearest pose ever seen, and in metres, these features mean the same for any take.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.decision import kernels
from mocapstudio.cleaning.decision.gaussian import OFFSETS, RIDGE, Moments
from mocapstudio.cleaning.decision.matching import Matches
from mocapstudio.similarity.texture import TEXTURE_RATE, BodyMotion, MotionTexture

F32 = NDArray[np.float32]
F64 = NDArray[np.float64]
I64 = NDArray[np.int64]

SCORES = ("z pose", "z velocity", "z given others", "z given limbs", "z given limb")
NEAREST = ("near alone", "near pair", "own near alone", "own near pair")
FEET = (
    "foot height", "foot speed", "other foot height", "other foot speed", "foot acceleration",
)  # fmt: skip

_BEFORE, _AFTER = OFFSETS.index(-2), OFFSETS.index(2)
_LOW = 0.05


def scores(motion: F64, known: Moments, limb: I64) -> F32:
    """Departures of every joint in standard deviations (Mahalanobis distances).

    Parameters
    ----------
    motion
        (T, d) stacked poses, see `gaussian.stacked`.
    known
        Moments of the context.
    limb
        (m,) which limb each joint belongs to.

    Returns
    -------
    (T, m, 5) in the order of SCORES: the joint's pose by itself, its angular velocity by itself,
    its pose given all other joints, given all joints of other limbs (both also given its own past
    and future), and given the present pose of its own limb.
    """
    joints, n = len(limb), 3 * len(limb)
    covariance = known.covariance
    away = motion - known.mean
    before, after = (slice(i * n, i * n + n) for i in (_BEFORE, _AFTER))
    velocity = away[:, after] - away[:, before]
    mixed = covariance[after, before]
    of_velocity = covariance[after, after] + covariance[before, before] - mixed - mixed.T
    pulled = away @ known.precision[:, :n]
    ridge = RIDGE * np.eye(3)
    out = np.empty((len(motion), joints, len(SCORES)), dtype=np.float32)
    for k in range(joints):
        part = slice(3 * k, 3 * k + 3)
        out[:, k, 0] = _length(away[:, part], np.linalg.inv(covariance[part, part] + ridge))
        out[:, k, 1] = _length(velocity[:, part], np.linalg.inv(of_velocity[part, part] + ridge))
        # The conditional residual is P⁻¹ times what is pulled, its covariance P⁻¹.
        out[:, k, 2] = _length(pulled[:, part], np.linalg.inv(known.precision[part, part]))
    for one in np.unique(limb):
        members = np.flatnonzero(limb == one)
        columns = (3 * members[:, None] + np.arange(3)).ravel()
        block = np.ix_(columns, columns)
        spread = np.linalg.inv(known.precision[block])
        residual = pulled[:, columns] @ spread
        precision = np.linalg.inv(covariance[block] + RIDGE * np.eye(len(columns)))
        posture = away[:, columns] @ precision
        for i, k in enumerate(members.tolist()):
            part = slice(3 * i, 3 * i + 3)
            out[:, k, 3] = _length(residual[:, part], np.linalg.inv(spread[part, part]))
            out[:, k, 4] = _length(posture[:, part], np.linalg.inv(precision[part, part]))
    return out


def _length(vectors: F64, metric: NDArray[np.floating[Any]]) -> F64:
    squared = np.einsum("ti,ij,tj->t", vectors, metric, vectors)
    return np.asarray(np.sqrt(np.maximum(squared, 0.0)))


def nearest(texture: MotionTexture, matches: Matches, limb: I64) -> F32:
    """Degrees to the nearest rotation ever seen of a joint, and of a joint with its neighbour.

    Parameters
    ----------
    texture
        S frames, m joints.
    matches
        Its corpus: the take itself, then its context.
    limb
        (m,) which limb each joint belongs to.

    Returns
    -------
    (S, m, 4) in the order of NEAREST; the last two look in the take itself, more than a second
    away. NaN where there is nothing to look in.
    """
    frames, joints = texture.quaternions.shape[:2]
    mate = _mates(limb)
    out = np.full((frames, joints, len(NEAREST)), np.nan, dtype=np.float32)
    spans = ((frames, matches.planes.shape[2], -1), (0, frames, round(TEXTURE_RATE)))
    for i, span in enumerate(spans):
        kernels.nearest_rotations(
            texture.quaternions, matches.planes, mate, np.array(span, dtype=np.int64),
            out[..., 2 * i : 2 * i + 2],
        )  # fmt: skip
    return out


def _mates(limb: I64) -> I64:
    """(m,) the joint before in the same limb, or the one after for a limb's first."""
    mate = np.arange(len(limb))
    for one in np.unique(limb):
        members = np.flatnonzero(limb == one)
        if len(members) > 1:
            mate[members] = np.append(members[1], members[:-1])
    return mate.astype(np.int64)


def feet(motion: BodyMotion, texture: MotionTexture, limb: I64) -> F32:
    """Where the feet are and how fast: an error in a leg lifts or slides the foot that stands.

    Returns
    -------
    (S, m, 5) in the order of FEET, metres and seconds: height of the leg's own foot above where it
    usually stands, its horizontal speed, the lowest and slowest of the other legs, and the
    acceleration of its own. NaN for what a joint has not.
    """
    out = np.full((len(texture), len(limb), len(FEET)), np.nan, dtype=np.float32)
    if not motion.chains:
        return out
    at = np.round(np.arange(len(texture)) * texture.frames_each).astype(np.int64)
    places = motion.feet[np.minimum(at, len(motion) - 1)]
    velocity = np.gradient(places, axis=0) * TEXTURE_RATE
    heights = places[..., 1] - np.quantile(places[..., 1], _LOW, axis=0)
    speeds = np.linalg.norm(velocity[..., [0, 2]], axis=-1)
    pulls = np.linalg.norm(np.gradient(velocity, axis=0), axis=-1) * TEXTURE_RATE
    # The outermost point of each leg: the toes stay down while the heel already rises.
    outermost = {int(limb[chain[-1][0]]): i for i, chain in enumerate(motion.chains)}
    for one in np.unique(limb):
        members, own = np.flatnonzero(limb == one), outermost.get(int(one))
        if own is not None:
            out[:, members, 0], out[:, members, 1] = heights[:, [own]], speeds[:, [own]]
            out[:, members, 4] = pulls[:, [own]]
        others = [foot for leg, foot in outermost.items() if leg != one]
        if others:
            out[:, members, 2] = heights[:, others].min(axis=1)[:, None]
            out[:, members, 3] = speeds[:, others].min(axis=1)[:, None]
    return out
