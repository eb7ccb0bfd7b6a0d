"""Performances of joints: rows, roles and body frames read off the skeleton."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison.performance import BodyFrame, Performance, Row, frame_along
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import body_frame, split_heading
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import Limb, Topology, topology

Array = NDArray[np.float64]

_ARM = ("collar", "shoulder", "elbow", "hand", "fingers")
_LEG = ("hip joint", "hip", "knee", "foot", "toes")
_MIDDLE = 2
"""Place of elbow and knee among those."""
_NEARLY = 0.9


def performance_of_take(take: Take, unreliable: NDArray[np.bool_] | None = None) -> Performance:
    """Describe a take of joints; `unreliable` is (F, J), True where a joint should not count."""
    skeleton, parts = take.skeleton, topology(take.skeleton)
    body = set(parts.body_joints())
    joints = [j for limb in parts.limbs for j in limb.joints if j in body]
    limbs = {j: limb.name for limb in parts.limbs for j in limb.joints}
    roles = joint_roles(skeleton)
    positions, world = take_pose(take)
    heading, tilt = split_heading(take)
    rotations = take.rotations[:, joints].copy()
    rotations[:, joints.index(parts.hips)] = tilt
    root = _root_frame(take, positions[:, parts.hips], heading)
    head, warnings = _head_frame(skeleton, parts, positions, world, root)
    mask = np.zeros((take.frames, len(joints)), bool)
    return Performance(
        name=take.name,
        rate=take.rate,
        span=take.span,
        rows=tuple(Row(skeleton.names[j], limbs[j], roles.get(j, "")) for j in joints),
        positions=positions[:, joints],
        rotations=rotations,
        head=head,
        root=root,
        unreliable=mask if unreliable is None else unreliable[:, joints],
        warnings=warnings,
    )


def joint_roles(skeleton: Skeleton) -> dict[int, str]:
    """Tell what joints are in any body, by the shape of the limbs: ``"left elbow"``, ``"head"``.

    The elbow (knee) is where the two longest bones of an arm (leg) meet, or the farther from the
    trunk where two places are nearly alike: a collar bone may be as long as a forearm.
    """
    parts = topology(skeleton)
    roles = {parts.hips: "pelvis"}
    for limb in parts.limbs:
        joints = [j for j in limb.joints if j not in parts.details]
        if limb.name == "spine":
            inside = [j for j in joints if j > parts.hips]
            roles |= {inside[-1]: "chest"} if inside else {}
        elif limb.name == "head":
            roles |= {joints[0]: "neck", joints[-1]: "head"} if len(joints) > 1 else {}
        elif limb.name in {"left arm", "right arm", "left leg", "right leg"}:
            roles |= _limb_roles(skeleton, limb, joints)
    return roles


def _limb_roles(skeleton: Skeleton, limb: Limb, joints: list[int]) -> dict[int, str]:
    side, kind = limb.name.split()
    names = _ARM if kind == "arm" else _LEG
    chain = [joints[0]]
    for joint in joints[1:]:
        if skeleton.parents[joint] == chain[-1]:
            chain.append(joint)
    bones = np.linalg.norm(skeleton.offsets[chain], axis=1)
    if len(chain) < 3:
        return {}
    reach = bones[1:-1] + bones[2:]
    middle = 1 + int(np.flatnonzero(reach >= _NEARLY * reach.max())[-1])
    found = {}
    for at, joint in enumerate(chain):
        place = at - middle + _MIDDLE
        if 0 <= place < len(names):
            found[joint] = f"{side} {names[place]}"
    return found


def _root_frame(take: Take, hips: Array, heading: Array) -> BodyFrame:
    turn = rot.about_axis(1, -heading)
    return BodyFrame(hips, rot.to_matrix(turn))


def _head_frame(
    skeleton: Skeleton, parts: Topology, positions: Array, world: Array, root: BodyFrame
) -> tuple[BodyFrame, tuple[str, ...]]:
    """Neck at the origin, neck to head along z, and forward of the chest in the yz plane."""
    head = next((limb.joints for limb in parts.limbs if limb.name == "head"), ())
    rigid = [j for j in head if j not in parts.details]
    if not rigid:
        return root, ("no head can be told in the skeleton: compared in the frame of the hips",)
    neck, chest = rigid[0], int(skeleton.parents[rigid[0]])
    top = next((j for j in reversed(rigid) if np.linalg.norm(skeleton.offsets[j]) > 1e-6), neck)
    if top == neck:
        tip = np.flatnonzero(np.isin(skeleton.end_parents, rigid))
        reach = skeleton.end_offsets[tip[0]] if len(tip) else np.array([0.0, 1.0, 0.0])
        along = rot.rotate(world[:, neck], np.broadcast_to(reach, (len(world), 3)))
    else:
        along = positions[:, top] - positions[:, neck]
    forward = rot.rotate(world[:, chest], _forward_at_rest(skeleton))
    return frame_along(positions[:, neck], along, -forward), ()


def _forward_at_rest(skeleton: Skeleton) -> Array:
    axes = rot.to_matrix(body_frame(skeleton))
    return np.asarray(axes[:, 2])
