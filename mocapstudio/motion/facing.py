"""Which way the body faces: heading, tilt and travel of the hips."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]

ROOT_POSITION = "root position"
ROOT_HEADING = "root heading"
ROOT_ROWS = (ROOT_POSITION, ROOT_HEADING)

_Y = 1


def body_frame(skeleton: Skeleton) -> Array:
    """Quaternion from body axes (x left, y up, z forward) to the hips' local frame.

    Read off the rest pose: left from the legs, up from the spine. The identity where the skeleton
    has no pair of legs.
    """
    parts = topology(skeleton)
    rest = skeleton.rest_positions
    legs = {limb.name: limb.joints for limb in parts.limbs if limb.name.endswith("leg")}
    trunk = [j for j in parts.limbs[0].joints if j > parts.hips]
    if "left leg" not in legs or "right leg" not in legs:
        return rot.IDENTITY.copy()
    left_leg, right_leg = _reach(skeleton, legs["left leg"]), _reach(skeleton, legs["right leg"])
    left = left_leg - right_leg
    # The nearest bone of the trunk: where the rest pose is no standing pose, farther ones mislead.
    rises = (rest[j] - rest[parts.hips] for j in trunk)
    up = next((v for v in rises if np.linalg.norm(v) > 1e-6), np.zeros(3))
    if np.linalg.norm(np.cross(left, up)) < 1e-9:
        return rot.IDENTITY.copy()
    left = left - up * (left @ up) / (up @ up)
    left, up = left / np.linalg.norm(left), up / np.linalg.norm(up)
    return rot.from_matrix(np.stack([left, up, np.cross(left, up)], axis=-1))


def _reach(skeleton: Skeleton, leg: tuple[int, ...]) -> Array:
    # Where a leg starts at the hips' own place (zero-length hip joint), its next joint tells.
    rest = skeleton.rest_positions
    base = rest[skeleton.parents[leg[0]]]
    vectors = [rest[j] - base for j in leg]
    return next((v for v in vectors if np.linalg.norm(v) > 1e-6), vectors[0])


def hips_world(take: Take, start: int = 0, end: int | None = None) -> tuple[Array, Array]:
    """World positions (F, 3) and rotations (F, 4) of the hips."""
    frames = slice(start, end)
    hips = topology(take.skeleton).hips
    chain = [*reversed(take.skeleton.ancestors(hips)), hips]
    at = {joint: i for i, joint in enumerate(take.translated)}
    position = np.zeros((len(take.rotations[frames]), 3))
    rotation = np.broadcast_to(rot.IDENTITY, (len(position), 4))
    for joint in chain:
        offset = (
            take.translations[frames, at[joint]] if joint in at else take.skeleton.offsets[joint]
        )
        position = position + rot.rotate(rotation, np.broadcast_to(offset, position.shape))
        rotation = rot.multiply(rotation, take.rotations[frames, joint])
    return position, rotation


def split_heading(take: Take, start: int = 0, end: int | None = None) -> tuple[Array, Array]:
    """Split the hips' world rotation into heading and what remains of it.

    Returns
    -------
    heading
        (F,) radians about +Y, unwrapped; 0 faces +Z.
    tilt
        (F, 4) the hips' rotation with the heading removed: ``about_y(-heading) * rotation``.
    """
    _, rotation = hips_world(take, start, end)
    body = rot.multiply(rotation, body_frame(take.skeleton))
    heading = np.unwrap(rot.twist_angle(body, _Y))
    return heading, rot.multiply(rot.about_axis(_Y, -heading), rotation)


def above_hips(take: Take, start: int = 0, end: int | None = None) -> Array:
    """World rotations (F, 4) of the hips' parent; the identity where the hips are the root."""
    hips = topology(take.skeleton).hips
    rotations = take.rotations[start:end]
    above = np.broadcast_to(rot.IDENTITY, (len(rotations), 4))
    for joint in reversed(take.skeleton.ancestors(hips)):
        above = rot.multiply(above, rotations[:, joint])
    return above


def hips_rotation(take: Take, tilt: Array, start: int, end: int) -> Array:
    """Local rotations (n, 4) of the hips with another tilt (n, 4) and the take's own heading."""
    heading, _ = split_heading(take, start, end)
    world = rot.multiply(rot.about_axis(_Y, heading), tilt)
    return rot.multiply(rot.conjugate(above_hips(take, start, end)), world)


def carrier(take: Take) -> int:
    """Position in `Take.translated` of the joint that carries the body through the world.

    The hips where they have translations of their own, else the nearest ancestor that has.
    """
    hips = topology(take.skeleton).hips
    for joint in (hips, *take.skeleton.ancestors(hips)):
        if joint in take.translated:
            return take.translated.index(joint)
    return 0
