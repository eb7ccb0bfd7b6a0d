"""The body that markers are solved to: a skeleton, a standing pose of it, and how joints turn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.kinematics import global_pose, take_pose
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]

_STILL = 1e-4
_MOVING = 0.1
"""Radians: a joint that turns less never turns; a take that turns as much shows what can turn."""
_STANDING = 0.7
"""Share of a leg's length that its height has in a standing pose."""
_LOOKED_AT = 200


@dataclass(frozen=True, eq=False)
class Template:
    """A body to solve to.

    Attributes
    ----------
    skeleton
        J joints; offsets are medians where the template moves joints along.
    hips
        The joint that carries the body through the world.
    standing
        (J, 4) local rotations of a standing pose, facing anywhere.
    axes
        For each joint a (3, d) basis of the axes, in its parent's frame, that it can turn about:
        d = 3 for a ball, 1 for a hinge, 0 for a joint that never turns.
    """

    skeleton: Skeleton
    hips: int
    standing: Array
    axes: tuple[Array, ...]

    @property
    def standing_pose(self) -> tuple[Array, Array]:
        """Positions (J, 3) and world rotations (J, 3, 3) of the standing pose."""
        positions, world = global_pose(
            self.skeleton, self.standing[None], self.skeleton.offsets[None, :1]
        )
        return positions[0], rot.to_matrix(world[0])


def template_of(take: Take) -> Template:
    """Return the template that a take's skeleton is.

    The rest pose is the standing pose where it stands; else that frame of the take is in which
    its legs and trunk are straightest. Joints that never turn in a take that moves, or about one
    axis only, are taken to be built so.
    """
    skeleton = _with_own_lengths(take)
    hips = topology(skeleton).hips
    some = np.unique(np.linspace(0, take.frames - 1, _LOOKED_AT).astype(int))
    standing = np.tile(rot.IDENTITY, (len(skeleton), 1))
    if _height_share(skeleton, skeleton.rest_positions[None])[0] < _STANDING:
        standing = _straightest(take, skeleton, some)
    axes, standing = _axes(take.rotations[some], standing, hips)
    return Template(skeleton, hips, standing, axes)


def _with_own_lengths(take: Take) -> Skeleton:
    skeleton = take.skeleton
    offsets = skeleton.offsets.copy()
    above = {0, topology(skeleton).hips}
    for at, joint in enumerate(take.translated):
        if joint not in above:
            offsets[joint] = np.median(take.translations[:, at], axis=0)
    return Skeleton(
        skeleton.names, skeleton.parents, offsets, skeleton.end_parents, skeleton.end_offsets
    )


def _height_share(skeleton: Skeleton, positions: Array) -> Array:
    """(F,) how upright legs and head are in (F, J, 3): 1 for a body that stands straight."""
    parts = topology(skeleton)
    shares = [np.ones(len(positions))]
    for limb in parts.limbs:
        joints = [j for j in limb.joints if j not in parts.details]
        if limb.name.endswith("leg") and len(joints) > 2:
            path = joints[: joints.index(joints[-1]) + 1]
            length = np.linalg.norm(skeleton.offsets[path[1:]], axis=1).sum()
            lowest = positions[:, path, 1].min(axis=1)
            shares.append((positions[:, path[0], 1] - lowest) / max(length, 1e-9))
        elif limb.name == "head":
            rise = positions[:, joints[-1]] - positions[:, parts.hips]
            shares.append(rise[:, 1] / np.maximum(np.linalg.norm(rise, axis=1), 1e-9))
    return np.asarray(np.min(shares, axis=0))


def _straightest(take: Take, skeleton: Skeleton, some: NDArray[np.int64]) -> Array:
    positions, _ = take_pose(take)
    best = int(some[int(np.argmax(_height_share(skeleton, positions[some])))])
    return np.asarray(take.rotations[best].copy())


def _axes(turns: Array, standing: Array, hips: int) -> tuple[tuple[Array, ...], Array]:
    """Axes of every joint, and the standing pose with what never turns as the take has it."""
    frames, joints = turns.shape[:2]
    first = turns[:1]
    away = rot.to_rotation_vector(rot.multiply(turns, rot.conjugate(first)))
    moving = np.linalg.norm(away, axis=2).max(axis=0)
    known = frames > 1 and float(np.median(moving)) > _MOVING
    axes, standing = [], standing.copy()
    for joint in range(joints):
        if joint == hips or not known:
            axes.append(np.eye(3))
        elif moving[joint] < _STILL:
            axes.append(np.zeros((3, 0)))
            standing[joint] = first[0, joint]
        else:
            axes.append(_hinge(turns[:, joint], standing[joint]))
    return tuple(axes), standing


def _hinge(turns: Array, standing: Array) -> Array:
    """The axis (3, 1) that all turns from the standing pose are about, or all three axes."""
    away = rot.to_rotation_vector(rot.multiply(turns, rot.conjugate(standing)))
    _, sizes, axes = np.linalg.svd(away, full_matrices=False)
    hinge = sizes[0] > 0 and sizes[1] <= _STILL * sizes[0] * 10
    return np.asarray(axes[:1].T if hinge else np.eye(3))
