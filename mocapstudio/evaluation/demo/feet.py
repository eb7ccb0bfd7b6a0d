"""Planted footsteps: where either foot is, so that it stands still while it carries.

In stance a foot rolls over heel, sole and ball, which stay where they touch the floor. In swing
the ankle follows the published curves of thigh and knee, led out of the last footprint and into
the next.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from mocapstudio.evaluation.demo import curves
from mocapstudio.evaluation.demo.route import Route
from mocapstudio.evaluation.demo.skeleton import ANKLE_HEIGHT, BALL, HEEL, HIP, SHANK, THIGH
from mocapstudio.evaluation.demo.variation import minimum_jerk
from mocapstudio.motion import rotations as rot

Array = NDArray[np.float64]

_UP = np.array([0.0, ANKLE_HEIGHT, 0.0])
_TOE_OUT = np.deg2rad(6.0)
_WALKING_BASE, _STANDING_BASE = 0.055, 0.100
_IDLE_THIGH = np.deg2rad(10.0)
_TOE_SECONDS = 0.03
_CLEARANCE = 0.024
_LED = np.array([0.49, 0.325, 0.49])
"""Shares of the swing over which either footprint leads the foot: along, up, aside."""


@dataclass(frozen=True, eq=False)
class FootMotion:
    """One foot over time.

    Parameters
    ----------
    ankle
        (F, 3) metres, world.
    rotation
        (F, 4) world rotation of the foot.
    toe
        (F,) radians: how far the toes are bent up against the foot.
    stance
        (F,) bool: on the floor.
    """

    ankle: Array
    rotation: Array
    toe: Array
    stance: NDArray[np.bool_]


def foot_motion(
    route: Route, sign: float, hip: Array, heading: Array, rng: np.random.Generator
) -> FootMotion:
    """Plan one foot.

    Parameters
    ----------
    route
        F frames.
    sign
        +1 for the left foot, -1 for the right.
    hip
        (F, 3) metres: the hip joint in the world.
    heading
        (F,) radians: where the body faces.
    """
    # The published roles of the right foot, half a stride later for the left.
    phase = route.phase - (0.5 if sign > 0 else 0.0)
    cycle = np.floor(phase).astype(int)
    inside = phase - cycle
    swing = np.clip((inside - curves.TOE_OFF) / (1 - curves.TOE_OFF), 0.0, 1.0)
    prints, yaws = _footprints(route, sign, cycle, rng)
    here, ahead = cycle - cycle.min(), cycle - cycle.min() + 1
    pitch = route.stepping * curves.foot_angle(inside)
    yaw = yaws[here] + (yaws[ahead] - yaws[here]) * minimum_jerk(swing)
    rolls_on_ball = (swing > 0) | (pitch < 0)
    last = _planted(prints[here], yaw, pitch, np.where(rolls_on_ball[:, None], BALL, HEEL))
    following = _planted(prints[ahead], yaw, pitch, np.broadcast_to(HEEL, last.shape))
    free = _free_ankle(route, hip, heading, inside)
    share = swing[:, None] / _LED
    free = free + (1 - minimum_jerk(share)) * (last - free)
    ankle = free + minimum_jerk(share + 1 - 1 / _LED) * (following - free)
    ankle[:, 1] += _CLEARANCE * 16 * (swing * (1 - swing)) ** 2
    toe = np.maximum(-pitch, 0.0) * (1 - minimum_jerk(swing / 0.7))
    return FootMotion(
        np.where((swing > 0)[:, None], ankle, last),
        rot.multiply(rot.about_axis(1, yaw), rot.about_axis(0, -pitch)),
        # Toes are soft: they neither bend nor spring back at once.
        gaussian_filter1d(toe, _TOE_SECONDS / route.step),
        swing == 0,
    )


def _footprints(
    route: Route, sign: float, cycle: NDArray[np.int64], rng: np.random.Generator
) -> tuple[Array, Array]:
    """Ankle projections (N, 3) and yaws (N,) of all footprints, first cycle to last plus one."""
    numbers = np.arange(cycle.min(), cycle.max() + 2)
    middle = numbers + (0.5 if sign > 0 else 0.0) + curves.MID_STANCE
    middle = np.clip(middle, route.path.x[0], route.path.x[-1])
    x, z, heading = route.path(middle).T
    base = _STANDING_BASE + (_WALKING_BASE - _STANDING_BASE) * route.spread(middle)
    aside = sign * (base + rng.normal(0.0, 0.008, len(numbers)))
    along = rng.normal(0.0, 0.012, len(numbers))
    yaw = heading + sign * _TOE_OUT + rng.normal(0.0, np.deg2rad(1.5), len(numbers))
    place = np.stack([x, np.zeros_like(x), z], axis=-1)
    local = np.stack([aside, np.zeros_like(x), along], axis=-1)
    return place + rot.rotate(rot.about_axis(1, heading), local), yaw


def _planted(place: Array, yaw: Array, pitch: Array, pivot: Array) -> Array:
    """Ankle of a foot that stands at `place` and rolls over a point of its sole."""
    turn = rot.about_axis(1, yaw)
    roll = rot.multiply(turn, rot.about_axis(0, -pitch))
    return place + rot.rotate(turn, _UP + pivot) - rot.rotate(roll, pivot)


def _free_ankle(route: Route, hip: Array, heading: Array, inside: Array) -> Array:
    """Ankle as the published thigh and knee angles put it below the hip joint."""
    show = route.stepping
    thigh = _IDLE_THIGH + show * (curves.thigh_angle(inside) - _IDLE_THIGH)
    knee = 2 * _IDLE_THIGH + show * (curves.knee_angle(inside) - 2 * _IDLE_THIGH)
    shank = thigh - knee
    forward = THIGH * np.sin(thigh) + SHANK * np.sin(shank)
    down = THIGH * np.cos(thigh) + SHANK * np.cos(shank)
    local = np.stack([np.zeros_like(down), -down, forward], axis=-1)
    return hip + rot.rotate(rot.about_axis(1, heading), local)


def hip_joint(sign: float) -> Array:
    """(3,) metres: the hip joint in the pelvis's frame."""
    return np.array([sign * HIP[0], HIP[1], HIP[2]])
