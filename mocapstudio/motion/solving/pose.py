"""Poses that put markers nearest to where they were seen: Gauss-Newton on all frames at once."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.solving.body import Body, Pose
from mocapstudio.motion.solving.template import STIFF

Array = NDArray[np.float64]

MARKER = 0.01
"""Metres that a marker usually is off."""
_TURNS = (0.4, 1.0, 3.0)
"""Radians that a joint without, with one, with more markers of its own may well be turned from the
usual pose: decides what no marker tells, and keeps spine and neck from folding."""
_STRAIGHT, _WRONG_WAY = 0.17, 0.05
"""Radians that a knee or elbow bends beyond straight; how far it may well go past that."""
_BESIDE = 0.15
"""Radians that a joint may well be turned from where it is just before and after."""
_FAR = 0.04
"""Metres beyond which a marker counts the less the farther it is off (Huber)."""
_STEP = 0.6
"""Radians that a joint turns in one step at most."""
_STUCK = 0.06
"""Metres by which a marker is off in a frame that may be stuck."""
_ATTEMPTS = 3
_AT_ONCE = 128


@dataclass(frozen=True, eq=False)
class Seen:
    """Markers of K frames.

    Attributes
    ----------
    places
        (K, M, 3) metres; anything where not seen.
    weights
        (K, M) 1 where measured, less where filled, 0 where missing.
    """

    places: Array
    weights: Array

    def __getitem__(self, frames: slice | NDArray[np.int64]) -> Seen:
        return Seen(self.places[frames], self.weights[frames])

    def __len__(self) -> int:
        return len(self.places)


def residuals(body: Body, pose: Pose, seen: Seen) -> Array:
    """(K, M, 3) metres from where the markers are predicted to where they were seen."""
    positions, world = body.joints(pose)
    return np.asarray(seen.places - body.markers(positions, world))


def trusted(left: Array, weights: Array) -> Array:
    """(K, M) weights, lower where a marker is far off (Huber's)."""
    far = np.linalg.norm(left, axis=2)
    return np.asarray(weights * _FAR / np.maximum(far, _FAR))


def pull(body: Body, pose: Pose, axes: Array, towards: Array) -> Array:
    """(K, D) radians by which to turn about axes (K, D, 3) to come to local rotations."""
    own, back = np.unique(body.freedoms, return_inverse=True)
    away = towards[..., own, :, :] @ np.swapaxes(pose.turns[:, own], -1, -2)
    vectors = rot.to_rotation_vector(rot.from_matrix(away))
    return np.asarray(np.einsum("kda,kda->kd", vectors[:, back], axes))


def usual_precision(body: Body) -> Array:
    """(D,) inverse variances of turns from the usual pose; 0 for the hips."""
    joints = body.freedoms
    own = np.bincount(body.attachment.joints, minlength=len(body.scales))
    usual = np.array(_TURNS)[np.minimum(own, 2)]
    for joint, kind in body.template.stiff.items():
        usual[joint] = min(usual[joint], STIFF[kind])
    deviation = usual[joints]
    return np.where(joints == body.template.hips, 0.0, deviation**-2.0)


def normal(body: Body, pose: Pose, seen: Seen) -> tuple[Array, Array, Array, Array]:
    """Normal equations of a step of the pose: matrix (K, P, P), right side (K, P), P = 3 + D.

    Returns
    -------
    matrix, right
        With the pull to the usual pose.
    slopes, weighed
        (K, 3 M, P) derivative and (K, 3 M) residual, both times the root of the weights.
    """
    positions, world = body.joints(pose)
    markers = body.markers(positions, world)
    left = seen.places - markers
    roots = np.sqrt(trusted(left, seen.weights)) / MARKER
    axes = body.axes(pose)
    slopes = body.by_turns(axes, positions, world, markers)
    slopes *= np.repeat(roots, 3, axis=1)[..., None]
    weighed = (left * roots[..., None]).reshape(len(left), -1)
    matrix = np.swapaxes(slopes, 1, 2) @ slopes
    right = (np.swapaxes(slopes, 1, 2) @ weighed[..., None])[..., 0]
    _add_prior(matrix, right, usual_precision(body), pull(body, pose, axes, body.usual))
    _hold_bends(matrix, right, body, pose)
    return matrix, right, slopes, weighed


def _add_prior(matrix: Array, right: Array, precision: Array, wanted: Array) -> None:
    diagonal = np.einsum("kii->ki", matrix)
    # A little damping keeps steps short along what nothing tells about.
    diagonal += 1e-3 * diagonal + 1e-9
    diagonal[:, 3:] += precision
    right[:, 3:] += precision * wanted


def _hold_bends(matrix: Array, right: Array, body: Body, pose: Pose) -> None:
    """Hold knees and elbows from bending the wrong way."""
    for joint, (sign, straight) in body.template.bends.items():
        if joint not in body.spans:
            continue
        at = 3 + body.spans[joint].start
        bent = sign * (body.template.angle(joint, pose.turns[:, joint]) - straight)
        beyond = np.maximum(-_STRAIGHT - bent, 0.0)
        matrix[:, at, at] += np.where(beyond > 0, _WRONG_WAY**-2.0, 0.0)
        right[:, at] += sign * beyond * _WRONG_WAY**-2.0


def refine(body: Body, pose: Pose, seen: Seen, rounds: int, *, beside: bool = False) -> Pose:
    """Take Gauss-Newton steps of the poses of all frames.

    Parameters
    ----------
    body
        The body; stays as it is.
    pose, seen
        K frames.
    rounds
        Steps.
    beside
        Whether frames are neighbours in time, so that what markers leave open is taken from the
        frames before and after.
    """
    for _ in range(rounds):
        around = _smoothed(pose) if beside else None
        pose = _joined(
            _step(body, pose[span], seen[span], None if around is None else around[span])
            for span in _spans(len(seen))
        )
    return pose


def _step(body: Body, pose: Pose, seen: Seen, around: Array | None) -> Pose:
    matrix, right, _, _ = normal(body, pose, seen)
    if around is not None:
        beside = np.full(matrix.shape[1] - 3, _BESIDE**-2.0)
        _add_prior(matrix, right, beside, pull(body, pose, body.axes(pose), around))
    steps: Array = np.asarray(np.linalg.solve(matrix, right[..., None])[..., 0], dtype=float)
    return body.moved(pose, limited(steps))


def freed(body: Body, pose: Pose, seen: Seen, rounds: int) -> Pose:
    """Pose frames anew that are stuck in a wrong fold, from the nearest frame in time that is not.

    Parameters
    ----------
    body
        The body.
    pose, seen
        K frames, neighbours in time.
    rounds
        Gauss-Newton steps of each attempt.
    """
    for _ in range(_ATTEMPTS):
        worst = _worst(body, pose, seen)
        stuck = worst > max(_STUCK, 3.0 * float(np.median(worst)))
        if not stuck.any() or stuck.all():
            return pose
        rows, good = np.flatnonzero(stuck), np.flatnonzero(~stuck)
        after = np.minimum(np.searchsorted(good, rows), len(good) - 1)
        before = np.maximum(after - 1, 0)
        for side in (before, after):
            tried = refine(body, pose[good[side]], seen[rows], rounds)
            better = _worst(body, tried, seen[rows]) < _worst(body, pose[rows], seen[rows])
            place, turns = pose.place.copy(), pose.turns.copy()
            place[rows[better]] = tried.place[better]
            turns[rows[better]] = tried.turns[better]
            pose = Pose(place, turns)
    return pose


def _worst(body: Body, pose: Pose, seen: Seen) -> Array:
    """(K,) metres by which the worst marker is off that was seen."""
    far = np.linalg.norm(residuals(body, pose, seen), axis=2)
    return np.asarray(np.where(seen.weights > 0, far, 0.0).max(axis=1))


def limited(steps: Array) -> Array:
    """Shorten steps (K, 3 + D) in which a joint would turn too far at once."""
    far = np.abs(steps[:, 3:]).max(axis=1, initial=0.0)
    return np.asarray(steps * (_STEP / np.maximum(far, _STEP))[:, None])


def _smoothed(pose: Pose) -> Array:
    """(K, J, 3, 3) rotations between those of the frames before and after."""
    turns = np.concatenate([pose.turns[:1], pose.turns, pose.turns[-1:]])
    u, _, vt = np.linalg.svd(turns[:-2] + turns[2:])
    return np.asarray(u @ vt)


def _spans(frames: int) -> Iterator[slice]:
    return (slice(at, at + _AT_ONCE) for at in range(0, frames, _AT_ONCE))


def _joined(parts: Iterator[Pose]) -> Pose:
    poses = list(parts)
    return Pose(
        np.concatenate([one.place for one in poses]), np.concatenate([one.turns for one in poses])
    )
