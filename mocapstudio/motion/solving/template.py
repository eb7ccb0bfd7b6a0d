"""The body that markers are solved to: a skeleton, a standing pose of it, and how joints turn."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.kinematics import global_pose, take_pose
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.solving.segments import segments
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]

_STILL = 1e-4
_MOVING = 0.1
"""Radians: a joint that turns less never turns; a take that turns as much shows what can turn."""
_STANDING = 0.7
"""Share of a leg's length that its height has in a standing pose."""
_LOOKED_AT = 200
_TRUNK = {"spine", "head"}
_HELD = 0.5
"""Share of that within which a joint stays that a take holds in one place."""
_BENDS = {"forearm": ("upper arm", 1.0), "shank": ("thigh", -1.0)}
"""What is above, and whether what is below moves to the front or to the back when it bends."""
_TOLD = 0.5
"""Cosine of the angle to there, from which on a hinge tells which way it bends."""
STIFF = {"spine": 0.4, "clavicle": 0.25, "hand": 0.4, "foot": 0.5}
"""Radians, about a third of what joints of these segments can turn in all."""


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
        For each joint the (d, 3) unit axes, in its parent's frame, that it can turn about from
        its base, outermost first: d = 3 for a ball, 2 for a saddle, 1 for a hinge, 0 for a joint
        that never turns.
    bases
        (J, 4) local rotations from which joints turn.
    held
        (J, 4) mean local rotations of the take, and (J,) radians that joints usually are turned
        from there; none for a take that does not move.
    """

    skeleton: Skeleton
    hips: int
    standing: Array
    axes: tuple[Array, ...]
    bases: Array
    held: tuple[Array, Array] | None = None

    @property
    def standing_pose(self) -> tuple[Array, Array]:
        """Positions (J, 3) and world rotations (J, 3, 3) of the standing pose."""
        positions, world = global_pose(
            self.skeleton, self.standing[None], self.skeleton.offsets[None, :1]
        )
        return positions[0], rot.to_matrix(world[0])

    @cached_property
    def stiff(self) -> dict[int, str]:
        """Joints that turn little, with the part of the body that each carries."""
        trunk = [limb for limb in topology(self.skeleton).limbs if limb.name in _TRUNK]
        found = {joint: "spine" for limb in trunk for joint in limb.joints}
        for name, part in segments(self.skeleton, self.standing_pose[0], {}).items():
            kind = name.removeprefix("left ").removeprefix("right ")
            if kind in STIFF:
                found.setdefault(part.joint, kind)
        return found

    @cached_property
    def usual(self) -> Array:
        """(J, 4) local rotations that joints are turned about: where markers leave a turn open.

        The standing pose, but for joints that the take holds elsewhere all the time: that is how
        its skeleton was laid out, or its performer is built. How feet stand is the floor's doing.
        """
        usual = self.standing.copy()
        if self.held is not None:
            mean, spread = self.held
            for joint, kind in self.stiff.items():
                if kind != "foot" and spread[joint] < _HELD * STIFF[kind]:
                    usual[joint] = mean[joint]
        return usual

    @cached_property
    def bends(self) -> dict[int, tuple[float, float]]:
        """Knees and elbows that are hinges: the sign of their bend, and where they are straight.

        Both of the angle (radians) that `angle` returns.
        """
        hinges, found = self.hinges, {}
        parts = segments(self.skeleton, self.standing_pose[0], {})
        for name, part in parts.items():
            side, _, kind = name.partition(" ")
            above, ahead = _BENDS.get(kind, ("", 0.0))
            if not above or part.joint not in hinges:
                continue
            bones = part.bone, parts[f"{side} {above}"].bone
            below, before = (bone / max(float(np.linalg.norm(bone)), 1e-9) for bone in bones)
            told = float(np.cross(hinges[part.joint], below) @ part.front)
            if abs(told) > _TOLD:
                sign = float(np.sign(told)) * ahead
                bent = float(np.arccos(np.clip(below @ before, -1.0, 1.0)))
                standing = rot.to_matrix(self.standing[part.joint][None])
                found[part.joint] = (sign, float(self.angle(part.joint, standing)[0]) - sign * bent)
        return found

    @property
    def hinges(self) -> dict[int, Array]:
        """The axis (3,) in the world of the standing pose of every joint with only one."""
        _, world = self.standing_pose
        parents = self.skeleton.parents
        return {
            joint: world[parents[joint]] @ axes[0]
            for joint, axes in enumerate(self.axes)
            if len(axes) == 1 and parents[joint] >= 0
        }

    def angle(self, joint: int, turns: Array) -> Array:
        """Radians (K,) by which a hinge is turned in local rotations (K, 3, 3)."""
        return _angle(self.axes[joint][-1], turns @ rot.to_matrix(self.bases[joint]).T)

    def turned(self, joint: int, turns: Array) -> list[Array]:
        """Take local rotations (K, 3, 3) of a hinge or saddle apart into those about its axes.

        The nearest ones where a rotation is about other axes too; none for a ball.
        """
        axes = self.axes[joint]
        if len(axes) == 3:
            return []
        left = turns @ rot.to_matrix(self.bases[joint]).T
        parts = []
        if len(axes) == 2:
            # The inner axis is moved by the outer turn alone.
            seen = left @ axes[1]
            bearing = np.arctan2(seen @ np.cross(axes[0], axes[1]), seen @ axes[1])
            parts.append(_about(axes[0], bearing))
            left = np.swapaxes(parts[0], 1, 2) @ left
        if len(axes):
            parts.append(_about(axes[-1], _angle(axes[-1], left)))
        return parts


def _angle(axis: Array, turns: Array) -> Array:
    """Radians (K,) in -pi..pi by which rotations (K, 3, 3) turn about an axis."""
    away = rot.from_matrix(turns)
    angle = 2.0 * np.arctan2(away[:, :3] @ axis, away[:, 3])
    return np.asarray((angle + np.pi) % (2.0 * np.pi) - np.pi)


def _about(axis: Array, angles: Array) -> Array:
    """Rotations (K, 3, 3) about an axis."""
    return np.asarray(rot.to_matrix(rot.from_rotation_vector(angles[:, None] * axis)))


def template_of(take: Take) -> Template:
    """Return the template that a take's skeleton is.

    The rest pose is the standing pose where it stands; else that frame of the take is in which
    its legs and trunk are straightest. Joints turn about the axes that the file gives them; those
    that never turn in a take that moves, or about one axis only, are taken to be built so.
    """
    skeleton = _with_own_lengths(take)
    hips = topology(skeleton).hips
    some = np.unique(np.linspace(0, take.frames - 1, _LOOKED_AT).astype(int))
    standing = np.tile(rot.IDENTITY, (len(skeleton), 1))
    if _height_share(skeleton, skeleton.rest_positions[None])[0] < _STANDING:
        standing = _straightest(take, skeleton, some)
    turns = take.rotations[some]
    axes, standing, bases = _axes(skeleton, turns, standing, hips)
    return Template(skeleton, hips, standing, axes, bases, _held(turns) if _moves(turns) else None)


def _with_own_lengths(take: Take) -> Skeleton:
    skeleton = take.skeleton
    offsets = skeleton.offsets.copy()
    above = {0, topology(skeleton).hips}
    for at, joint in enumerate(take.translated):
        if joint not in above:
            offsets[joint] = np.median(take.translations[:, at], axis=0)
    return replace(skeleton, offsets=offsets)


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


def _axes(
    skeleton: Skeleton, turns: Array, standing: Array, hips: int
) -> tuple[tuple[Array, ...], Array, Array]:
    """Axes and bases of every joint; what never turns stands as the take has it."""
    joints = turns.shape[1]
    first, moving, known = turns[:1], _turned(turns), _moves(turns)
    axes, standing = [], standing.copy()
    bases = np.tile(rot.IDENTITY, (joints, 1))
    for joint in range(joints):
        own = np.eye(3) if skeleton.axes is None else skeleton.axes[joint]
        if joint == hips:
            own = np.eye(3)
        elif known and moving[joint] < _STILL:
            own = np.zeros((0, 3))
            bases[joint] = standing[joint] = first[0, joint]
        elif known and len(own) == 3 and (hinge := _hinge(turns[:, joint], standing[joint])).size:
            own, bases[joint] = hinge, standing[joint]
        axes.append(own)
    return tuple(axes), standing, bases


def _turned(turns: Array) -> Array:
    """(J,) radians that joints turn away from the first of (F, J, 4) local rotations."""
    return np.asarray(rot.angle(turns, turns[:1]).max(axis=0))


def _moves(turns: Array) -> bool:
    """Whether a take shows what its joints can turn."""
    return float(np.median(_turned(turns))) > _MOVING


def _held(turns: Array) -> tuple[Array, Array]:
    mean = rot.mean(turns)
    return mean, np.sqrt((rot.angle(turns, mean) ** 2).mean(axis=0))


def _hinge(turns: Array, standing: Array) -> Array:
    """The axis (1, 3) that all turns from the standing pose are about, or none (0, 3)."""
    away = rot.to_rotation_vector(rot.multiply(turns, rot.conjugate(standing)))
    _, sizes, axes = np.linalg.svd(away, full_matrices=False)
    hinge = sizes[0] > 0 and sizes[1] <= _STILL * sizes[0] * 10
    return np.asarray(axes[:1] if hinge else axes[:0])
