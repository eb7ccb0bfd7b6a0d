"""A first pose of every frame: joints turned one after the other from the hips outward.

Each joint is turned so that the markers on it, or the nearest below it, come nearest to where they
were seen (Arun, Huang and Blostein 1987), with a weak pull to the standing pose where they leave
a turn open.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.rigidity import fit_rigid
from mocapstudio.motion.solving.body import Body, Pose
from mocapstudio.motion.solving.pose import Seen
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]

_PULL = 0.04
"""Metres of lever with which the standing pose holds a joint."""
_BENT = 0.35
"""Sine of the angle from which a bent elbow or knee tells how the bone above is twisted."""
_ENOUGH = 0.5
"""Weight of a marker that counts as seen."""


def first_pose(body: Body, seen: Seen) -> Pose:
    """Return a pose of all frames from the markers alone.

    Parameters
    ----------
    body
        Template, markers on it and lengths.
    seen
        K frames.
    """
    frames, joints = len(seen), len(body.scales)
    standing_positions, standing_world = _standing(body)
    markers = body.markers(standing_positions[None], standing_world[None])[0]
    turns = np.broadcast_to(body.standing, (frames, joints, 3, 3)).copy()
    hips = body.template.hips
    place, facing = _hips(body, seen, markers, standing_positions[hips])
    above = topology(body.template.skeleton).above_hips
    world = np.broadcast_to(np.eye(3), (frames, joints, 3, 3)).copy()
    level = world[:, 0].copy()
    positions = np.zeros((frames, joints, 3))
    for joint, parent in enumerate(body.template.skeleton.parents):
        before = world[:, parent] if parent >= 0 else level
        if joint == hips:
            positions[:, joint] = place
            world[:, joint] = facing @ standing_world[joint]
            turns[:, joint] = np.swapaxes(before, 1, 2) @ world[:, joint]
            continue
        if joint in above:
            world[:, joint] = before @ turns[:, joint]
            continue
        positions[:, joint] = positions[:, parent] + before @ body.offsets[joint]
        own = _telling(body, joint)
        if len(own) and len(body.template.axes[joint]):
            turned = _turned(
                markers[own] - standing_positions[joint],
                seen.places[:, own] - positions[:, joint, None],
                seen.weights[:, own],
                before @ body.standing[joint] @ standing_world[joint].T,
            )
            turns[:, joint] = _allowed(
                body, joint, np.swapaxes(before, 1, 2) @ turned @ standing_world[joint]
            )
        world[:, joint] = before @ turns[:, joint]
        for hinge in set(body.template.skeleton.children[joint]) & body.template.bends.keys():
            if len(body.template.axes[joint]) == 3:
                twist = _twist(body, hinge, seen, positions[:, joint], world[:, joint])
                world[:, joint] = twist @ world[:, joint]
                turns[:, joint] = np.swapaxes(before, 1, 2) @ world[:, joint]
    return Pose(place, turns)


def _standing(body: Body) -> tuple[Array, Array]:
    hips = body.template.skeleton.rest_positions[body.template.hips]
    pose = Pose(hips[None], body.standing[None])
    positions, world = body.joints(pose)
    return positions[0], world[0]


def _telling(body: Body, joint: int) -> NDArray[np.int64]:
    """Markers that tell how a joint is turned: its own, or those of the nearest below."""
    skeleton, carriers = body.template.skeleton, body.attachment.joints
    level = [joint]
    while level:
        own = np.flatnonzero(np.isin(carriers, level))
        if len(own):
            return own
        level = [child for one in level for child in skeleton.children[one]]
    return np.zeros(0, dtype=np.int64)


def _hips(body: Body, seen: Seen, markers: Array, standing: Array) -> tuple[Array, Array]:
    """Place (K, 3) of the hips and their turn (K, 3, 3) from the standing pose."""
    level, chosen = [body.template.hips], np.zeros(0, dtype=np.int64)
    while len(chosen) < 3 and level:
        chosen = np.union1d(chosen, np.flatnonzero(np.isin(body.attachment.joints, level)))
        level = [child for one in level for child in body.template.skeleton.children[one]]
    visible = np.where((seen.weights > _ENOUGH)[..., None], seen.places, np.nan)
    known = np.where((seen.weights > 0)[..., None], seen.places, np.nan)
    turn, shift = fit_rigid(markers[chosen], known[:, chosen])
    open_ = np.isnan(turn).any(axis=(1, 2))
    if open_.any():
        turn[open_], shift[open_] = fit_rigid(markers, visible[open_])
    good = np.flatnonzero(~np.isnan(turn).any(axis=(1, 2)))
    if len(good):
        nearest = good[np.abs(np.arange(len(turn))[:, None] - good).argmin(axis=1)]
        turn, shift = turn[nearest], shift[nearest]
    else:
        turn, shift = np.broadcast_to(np.eye(3), turn.shape), np.zeros_like(shift)
    return shift + turn @ standing, turn


def _turned(template: Array, seen: Array, weights: Array, otherwise: Array) -> Array:
    """World turns (K, 3, 3) that bring vectors (P, 3) onto those seen (K, P, 3)."""
    seen = np.where(weights[..., None] > 0, seen, 0.0)
    both = np.einsum("kp,kpi,pj->kij", weights, seen, template) + _PULL**2 * otherwise
    u, _, vt = np.linalg.svd(both)
    u[:, :, 2] *= np.sign(np.linalg.det(u @ vt))[:, None]
    return np.asarray(u @ vt)


def _twist(body: Body, hinge: int, seen: Seen, start: Array, world: Array) -> Array:
    """Turns (K, 3, 3) of a bone about itself after which the hinge at its end bends as it is seen.

    Parameters
    ----------
    body, seen
        As in `first_pose`.
    hinge
        Elbow or knee.
    start, world
        (K, 3) and (K, 3, 3): where the bone starts, and how it is turned.
    """
    bone = world @ body.offsets[hinge]
    below = np.flatnonzero(body.carries[:, hinge])
    weights = seen.weights[:, below, None]
    there = (weights * seen.places[:, below]).sum(axis=1) / np.maximum(weights.sum(axis=1), 1e-9)
    away = there - start - bone
    axis = world @ body.template.axes[hinge][0]
    along = bone / np.maximum(np.linalg.norm(bone, axis=1, keepdims=True), 1e-9)
    wanted = body.template.bends[hinge][0] * np.cross(along, away)
    sideways = (np.cross(axis, wanted) * along).sum(axis=1)
    straight = (axis * wanted).sum(axis=1) - (axis * along).sum(axis=1) * (wanted * along).sum(1)
    bent = np.linalg.norm(wanted, axis=1) > _BENT * np.linalg.norm(away, axis=1)
    known = bent & (weights[..., 0].sum(axis=1) > _ENOUGH)
    angle = np.where(known, np.arctan2(sideways, straight), 0.0)
    return np.asarray(rot.to_matrix(rot.from_rotation_vector(angle[:, None] * along)))


def _allowed(body: Body, joint: int, turn: Array) -> Array:
    """The part of local rotations (K, 3, 3) that a joint can follow."""
    base = rot.to_matrix(body.template.bases[joint])
    parts = body.template.turned(joint, turn)
    for part in reversed(parts):
        base = part @ base
    return base if parts else turn
