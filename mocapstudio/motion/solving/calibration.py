"""Where markers sit and how long bones are, found together with the poses of some frames.

A bundle adjustment: of each frame's normal equations the pose is eliminated (Schur's complement),
so that one small system remains for all offsets and lengths.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.solving.body import Body, Pose
from mocapstudio.motion.solving.pose import Seen, limited, normal
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]

_OVERALL = 0.04
"""Share of the body's length that it may well differ from the first guess."""
_OF_ONE = 0.025
"""Share that one bone may well differ from the others."""
_SHORT = 5e-3
"""Metres below which a bone's length is not looked for."""
_INDEPENDENT = 5
"""Frames that tell as much as all do together: skin slides alike in many of them."""
_GROWTH = 0.15
"""Share by which lengths change in one step at most."""


@dataclass(frozen=True, eq=False)
class _Unknowns:
    """Lengths looked for: one overall, and one for each pair of bones left and right."""

    groups: tuple[NDArray[np.int64], ...]

    @classmethod
    def of(cls, body: Body) -> _Unknowns:
        skeleton = body.template.skeleton
        parts = topology(skeleton)
        left_out = parts.above_hips | {parts.hips}
        groups = []
        for joint in range(len(skeleton)):
            twin = int(parts.mirror[joint])
            long_ = np.linalg.norm(skeleton.offsets[joint]) > _SHORT
            if joint in left_out or twin < joint or not long_:
                continue
            pair = np.unique([joint, twin])
            if body.carries[:, pair].any():
                groups.append(pair)
        return cls(tuple(groups))


def calibrate(body: Body, pose: Pose, seen: Seen, rounds: int) -> tuple[Body, Pose]:
    """Take Gauss-Newton steps of markers' places, bone lengths and the poses of K frames.

    Bones left and right keep one proportion. What the markers do not tell stays near where the
    body has it: places by the attachment's spreads, lengths near the template's proportions.

    Parameters
    ----------
    body
        Where everything is expected, and starts.
    pose, seen
        K frames.
    rounds
        Steps.
    """
    unknowns = _Unknowns.of(body)
    expected = body.attachment.offsets
    overall = float(np.median(body.scales))
    lengths = np.zeros(1 + len(unknowns.groups))
    for _ in range(rounds):
        matrix, right, back = _reduced(body, pose, seen, unknowns)
        _add_priors(matrix, right, body, expected, lengths)
        step = np.linalg.solve(matrix, right)
        places = 3 * len(expected)
        grow = step[places:]
        grow = grow * min(1.0, _GROWTH / max(float(np.abs(grow).max()), 1e-12))
        step[places:] = grow
        poses, slopes = back
        pose = body.moved(pose, limited(poses - slopes @ step))
        lengths = lengths + grow
        scales = np.full(len(body.scales), overall + lengths[0])
        for at, group in enumerate(unknowns.groups, 1):
            scales[group] += lengths[at]
        body = body.with_offsets(body.attachment.offsets + step[:places].reshape(-1, 3), scales)
    return body, pose


def _reduced(
    body: Body, pose: Pose, seen: Seen, unknowns: _Unknowns
) -> tuple[Array, Array, tuple[Array, Array]]:
    """The system of offsets and lengths, and what it leaves for each frame's pose.

    Returns
    -------
    matrix, right
        (G, G) and (G,).
    back
        (K, P) steps of the poses were nothing else to move, and (K, P, G) what to take off.
    """
    matrix, right, slopes, weighed = normal(body, pose, seen)
    roots = _roots(slopes, len(body.attachment.joints))
    own = _by_unknowns(body, pose, unknowns) * np.repeat(roots, 3, axis=1)[..., None]
    across = np.swapaxes(slopes, 1, 2) @ own
    solved = np.linalg.solve(matrix, np.concatenate([across, right[..., None]], axis=2))
    poses, per_unknown = solved[..., -1], solved[..., :-1]
    rows, crossing = _stacked(own), _stacked(across)
    whole = rows.T @ rows - crossing.T @ _stacked(per_unknown)
    side = rows.T @ weighed.ravel() - crossing.T @ poses.ravel()
    share = min(1.0, _INDEPENDENT / len(slopes))
    return share * whole, share * side, (poses, per_unknown)


def _stacked(frames: Array) -> Array:
    """(K, R, G) of all frames below each other: (K R, G)."""
    return frames.reshape(-1, frames.shape[2])


def _roots(slopes: Array, markers: int) -> Array:
    # The hips' place moves each marker one to one: its slope is the root of the weight itself.
    return np.asarray(slopes.reshape(len(slopes), markers, 3, -1)[:, :, 0, 0])


def _by_unknowns(body: Body, pose: Pose, unknowns: _Unknowns) -> Array:
    """(K, 3 M, G) derivative of the markers by their offsets, then by lengths."""
    _, world = body.joints(pose)
    joints = body.attachment.joints
    frames, markers = len(pose.place), len(joints)
    before = body.parents_world(world)
    bones = np.einsum("kjab,jb->kja", before, body.template.skeleton.offsets)
    parts = topology(body.template.skeleton)
    bones[:, [parts.hips, *parts.above_hips]] = 0.0
    moved = body.carries[None, :, :, None] * bones[:, None]
    result = np.zeros((frames, markers, 3, 3 * markers + 1 + len(unknowns.groups)))
    for row, joint in enumerate(joints):
        result[:, row, :, 3 * row : 3 * row + 3] = world[:, joint]
    result[..., 3 * markers] = moved.sum(axis=2)
    for at, group in enumerate(unknowns.groups, 3 * markers + 1):
        result[..., at] = moved[:, :, group].sum(axis=2)
    return result.reshape(frames, 3 * markers, -1)


def _add_priors(matrix: Array, right: Array, body: Body, expected: Array, lengths: Array) -> None:
    spreads = np.repeat(body.attachment.spreads, 3)
    precision = np.concatenate(
        [spreads**-2.0, [_OVERALL**-2.0], np.full(len(lengths) - 1, _OF_ONE**-2.0)]
    )
    away = np.concatenate([(body.attachment.offsets - expected).ravel(), lengths])
    right -= precision * away
    matrix[np.diag_indices_from(matrix)] += precision
