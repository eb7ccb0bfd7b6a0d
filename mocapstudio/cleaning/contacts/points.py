"""Which points of a body may touch something, and where they are over time.

Few skeletons carry a sole: the ankle and the ball of the foot are joints, heel and toe tip are
often nothing or an end site of no length. What is missing is put where it lies on a foot of that
size: the sole's direction is read off the frames in which the foot stands (a rest pose need not be
a standing one), proportions are those of Winter, *Biomechanics and Motor Control of Human
Movement*, chapter 4.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.anatomy import Extremity, extremities
from mocapstudio.cleaning.contacts.model import ContactPoint
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]
Pose = tuple[Array, Array]
"""Positions (F, J, 3) and world rotations (F, J, 4), as `take_pose` returns them."""

_SOLE = 0.02
"""Ball joint above the sole, as a share of the leg."""
_HEEL = 0.35
"""Heel behind the ankle, as a share of the way from ankle to ball."""
_TOES = 0.4
"""Length of the toes, as a share of the way from ankle to ball."""
_PALM = 0.5
"""Palm between wrist and knuckles or tip, as a share of the way."""
_HAND = 0.25
"""Length of a hand of which nothing is known, as a share of both bones of the arm."""
_FLAT = 0.4
"""A foot whose level part is shorter than this share of it has no sole that could be told."""
_SLOW, _LOW = 0.3, 0.06
"""Speed (shares of the leg a second) and height (shares of the leg) that speak equally against a
foot's standing flat."""
_UNEQUAL = np.radians(12.0)
"""A foot that stands steeper than the other by more than this never stood flat."""
_STANDING, _FEWEST = 0.08, 5
"""Share and number of frames from which the standing foot is read."""


def contact_points(take: Take, pose: Pose | None = None) -> tuple[ContactPoint, ...]:
    """Heel, ball and toe of each foot, palm of each hand, in the frames of their joints.

    Parameters
    ----------
    take
        F frames. Its motion tells how the feet stand; the offsets are constant.
    pose
        What `take_pose(take)` returns, if it is at hand.

    Returns
    -------
    tuple of ContactPoint
        Feet first, in the order of the skeleton's limbs; offsets in metres. A leg without a foot
        has one point, its end, whose `point` is None. Empty where nothing can be told apart.
    """
    pose = take_pose(take) if pose is None else pose
    skeleton = take.skeleton
    soles = [_sole(take, foot, pose) for foot in extremities(skeleton, "leg")]
    flattest = min((sole.drop for sole in soles if sole is not None), default=0.0)
    found: list[ContactPoint] = []
    for foot, sole in zip(extremities(skeleton, "leg"), soles, strict=True):
        found += _foot_points(take, foot, None if sole is None else sole.levelled(flattest), pose)
    for hand in extremities(skeleton, "arm"):
        found.append(_palm(take, hand))
    return tuple(found)


def point_positions(take: Take, points: Sequence[ContactPoint], pose: Pose | None = None) -> Array:
    """(F, P, 3) metres: places of P contact points in the world.

    Raises
    ------
    MocapError
        If a point's joint is not in the take.
    """
    positions, world = take_pose(take) if pose is None else pose
    joints = [_joint(take, point) for point in points]
    offsets = np.array([point.offset for point in points], dtype=np.float64).reshape(-1, 3)
    result: Array = positions[:, joints] + rot.rotate(world[:, joints], offsets)
    return result


def named(points: Iterable[ContactPoint]) -> dict[tuple[str, str | None], ContactPoint]:
    """Points by joint and name of the point."""
    return {(point.joint, point.point): point for point in points}


def _joint(take: Take, point: ContactPoint) -> int:
    joint = take.skeleton.index.get(point.joint)
    if joint is None:
        raise MocapError(f"no joint {point.joint} in {take.name}")
    return joint


@dataclass(frozen=True, eq=False)
class _Sole:
    """How a foot stands.

    Attributes
    ----------
    standing
        Frames in which it stands as flat as it ever does.
    to_ball
        (3,) metres, from ankle to ball in the ankle's frame.
    up
        (3,) unit, the sole's normal in the ankle's frame.
    """

    standing: NDArray[np.int64]
    to_ball: Array
    up: Array

    @property
    def drop(self) -> float:
        """Radians by which the way from ankle to ball falls towards the ball."""
        return float(-np.arcsin(np.clip(self.to_ball @ self.up / _norm(self.to_ball), -1.0, 1.0)))

    @property
    def forward(self) -> Array:
        """(3,) metres: level part of the way to the ball, in the ankle's frame."""
        way: Array = self.to_ball - self.up * (self.to_ball @ self.up)
        return way

    def levelled(self, drop: float) -> _Sole:
        """Turn the sole so that it drops as the flattest foot does, if it never stood as flat."""
        if self.drop - drop < _UNEQUAL or _norm(self.forward) < 1e-9:
            return self
        along = self.forward / _norm(self.forward)
        turn = self.drop - drop
        return replace(self, up=np.cos(turn) * self.up + np.sin(turn) * along)


def _sole(take: Take, foot: Extremity, pose: Pose) -> _Sole | None:
    """Read off how a foot stands; None where nothing lies beyond the ankle."""
    place = take.skeleton.rest_positions
    to_ball = foot.tip if foot.outer is None else place[foot.outer] - place[foot.joint]
    if to_ball is None:
        return None
    standing = _standing(take, foot, to_ball, pose)
    return _Sole(standing, to_ball, _mean_up(pose[1][standing, foot.joint]))


def _foot_points(take: Take, foot: Extremity, sole: _Sole | None, pose: Pose) -> list[ContactPoint]:
    names = take.skeleton.names
    if sole is None:
        return [ContactPoint(names[foot.joint], None, np.zeros(3))]
    level = _norm(sole.forward)
    if level < _FLAT * _norm(sole.to_ball):
        end = sole.to_ball if foot.outer is None else np.zeros(3)
        return [ContactPoint(names[foot.key_joint()], None, end)]
    forward = sole.forward / level
    thick = _SOLE * foot.length
    fall = float(sole.to_ball @ sole.up)
    below = thick - min(fall, 0.0)
    heel = -sole.up * below - forward * _HEEL * level
    points = [ContactPoint(names[foot.joint], "heel", heel)]
    if foot.outer is None:
        return [*points, ContactPoint(names[foot.joint], "ball", forward * level - sole.up * below)]
    up = _in_toes(sole.up, sole, foot, pose)
    tip = foot.tip
    if tip is None:
        tip = _in_toes(forward, sole, foot, pose) * _TOES * level
    toes = names[foot.outer]
    ball = ContactPoint(toes, "ball", -up * thick)
    return [*points, ball, ContactPoint(toes, "toe", tip - up * (tip @ up + thick))]


def _in_toes(direction: Array, sole: _Sole, foot: Extremity, pose: Pose) -> Array:
    """Turn a unit direction of the ankle's frame into that of the toes, as the foot stands."""
    world = pose[1][sole.standing]
    there = rot.rotate(
        rot.conjugate(world[:, foot.key_joint()]), rot.rotate(world[:, foot.joint], direction)
    )
    median = np.median(there, axis=0)
    return median / max(_norm(median), 1e-9)


def _standing(take: Take, foot: Extremity, to_ball: Array, pose: Pose) -> NDArray[np.int64]:
    """Frames in which the foot is flat on the floor: slow, and the ankle low."""
    low, high = take.span
    ankle = pose[0][low:high, foot.joint]
    ball = ankle + rot.rotate(pose[1][low:high, foot.joint], to_ball)
    frames = high - low
    if frames < 3:
        return np.arange(low, high)
    speed = sum(np.linalg.norm(np.gradient(p, axis=0), axis=1) for p in (ankle, ball))
    against = speed * float(take.rate) / (_SLOW * foot.length)
    against += (ankle[:, 1] - np.percentile(ankle[:, 1], 2)) / (_LOW * foot.length)
    count = max(min(_FEWEST, frames), int(_STANDING * frames))
    return np.asarray(low + np.argsort(against, kind="stable")[:count], dtype=np.int64)


def _mean_up(world: Array) -> Array:
    """(3,) unit: the world's up in the frame of a joint, median over (S, 4) world rotations."""
    up = np.median(rot.rotate(rot.conjugate(world), np.array([0.0, 1.0, 0.0])), axis=0)
    return up / _norm(up) if _norm(up) > 0 else np.array([0.0, 1.0, 0.0])


def _norm(vector: Array) -> float:
    """Length of a vector (3,)."""
    return float(np.linalg.norm(vector))


def _palm(take: Take, hand: Extremity) -> ContactPoint:
    place = take.skeleton.rest_positions
    if hand.outer is not None:
        way = place[hand.outer] - place[hand.joint]
    elif hand.tip is not None:
        way = _PALM * hand.tip
    else:
        # Nothing beyond the wrist: the hand goes on as the forearm does.
        forearm = take.skeleton.offsets[hand.joint]
        way = forearm / max(_norm(forearm), 1e-9) * _PALM * _HAND * hand.length
        return ContactPoint(take.skeleton.names[hand.joint], "palm", way)
    return ContactPoint(take.skeleton.names[hand.joint], "palm", way)
