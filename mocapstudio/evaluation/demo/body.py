"""From the plan to joint rotations: pelvis and trunk, legs to the footprints, arms to targets."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from mocapstudio.evaluation.demo.curves import wave
from mocapstudio.evaluation.demo.feet import FootMotion, foot_motion, hip_joint
from mocapstudio.evaluation.demo.limbs import bend, frame
from mocapstudio.evaluation.demo.poses import Reaching
from mocapstudio.evaluation.demo.route import STRIDE_SECONDS, Route
from mocapstudio.evaluation.demo.skeleton import (
    FOREARM,
    SHANK,
    SIDES,
    STANDING_HEIGHT,
    THIGH,
    UPPER_ARM,
)
from mocapstudio.evaluation.demo.variation import smooth_noise
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.skeleton import Skeleton

Array = NDArray[np.float64]

_FORWARD = np.array([0.0, 0.0, 1.0])
_ARC = np.array([0.0, 0.0, 0.15])
_EASE, _SINK, _BOB = 0.003, 0.017, 0.009
"""Metres: pelvis below straight legs in standing, further in walking, and its bob."""
_LONGEST_LEG = THIGH + SHANK - 0.0025
"""Metres: a leg keeps its knee bent a few degrees."""


@dataclass(frozen=True, eq=False)
class Motion:
    """The performer's motion; rotations (F, J, 4) local, root (F, 3) metres, stance by side."""

    rotations: Array
    root: Array
    stance: dict[str, NDArray[np.bool_]]


def move(
    skeleton: Skeleton, route: Route, reaching: Reaching, times: Array, rng: np.random.Generator
) -> Motion:
    """Move the whole body along the route, reaching on the way; `times` (F,) seconds."""
    local = np.tile(rot.IDENTITY, (len(times), len(skeleton), 1))
    x, z, heading = route.path(route.phase).T
    ground = rot.about_axis(1, heading)
    root, pelvis = _pelvis(route, reaching, times, x, z, heading, rng)
    feet = {}
    for side, sign in SIDES:
        hip = root + rot.rotate(pelvis, np.broadcast_to(hip_joint(sign), root.shape))
        feet[side] = foot_motion(route, sign, hip, heading, rng)
    root[:, 1] -= _drop(root, pelvis, feet, route.step)
    local[:, 0] = pelvis
    _trunk(local, skeleton, route, reaching, times, rng)
    for side, sign in SIDES:
        _leg(local, skeleton, side, sign, root, pelvis, ground, feet[side])
        _arm(local, skeleton, side, sign, route, reaching, times, root, ground, (x, z), rng)
    _measure(local, skeleton, times, rng)
    stance = {side: foot.stance for side, foot in feet.items()}
    return Motion(rot.continuous(local), root, stance)


def _measure(local: Array, skeleton: Skeleton, times: Array, rng: np.random.Generator) -> None:
    """Add what even good markers leave: noise, but none that would make the feet slide."""
    carrying = {"Hips", *(side + part for side, _ in SIDES for part in ("UpLeg", "Leg", "Foot"))}
    free = [j for j, name in enumerate(skeleton.names) if name not in carrying]
    noise = np.deg2rad(smooth_noise(rng, times, 8.0, 0.04, 3 * len(free)))
    vectors = noise.reshape(len(times), len(free), 3)
    local[:, free] = rot.multiply(local[:, free], rot.from_rotation_vector(vectors))


def _pelvis(
    route: Route,
    reaching: Reaching,
    times: Array,
    x: Array,
    z: Array,
    heading: Array,
    rng: np.random.Generator,
) -> tuple[Array, Array]:
    """Root position (F, 3) and rotation (F, 4); height still without regard to the legs."""
    phase, show = route.phase, route.stepping
    idle = smooth_noise(rng, times, 0.25, 1.0, 3) * (1 - 0.7 * show)[:, None]
    aside = -0.022 * show * wave(phase, 0.31) + 0.010 * idle[:, 0]
    up = -_EASE - show * (_SINK - _BOB * wave(phase, 0.31, 2)) - 0.002 * np.abs(idle[:, 1])
    along = 0.010 * show * wave(phase, 0.45, 2) + 0.006 * idle[:, 2]
    local = np.stack([aside, STANDING_HEIGHT + up, along], axis=-1) + reaching.shift
    ground = rot.about_axis(1, heading)
    root = np.stack([x, np.zeros_like(x), z], axis=-1) + rot.rotate(ground, local)
    drift = np.deg2rad(smooth_noise(rng, times, 0.7, 0.5, 3))
    yaw = np.deg2rad(5.0) * show * wave(phase, 0.0) + drift[:, 0]
    list_ = -np.deg2rad(4.0) * show * wave(phase, 0.15) + drift[:, 1]
    tilt = np.deg2rad(3.0 + 2.0 * show + 1.2 * show * wave(phase, 0.05, 2)) + drift[:, 2]
    gait = rot.from_euler("YZX", np.stack([yaw, list_, tilt], axis=-1))
    return root, rot.multiply(ground, rot.multiply(reaching.pelvis, gait))


def _drop(root: Array, pelvis: Array, feet: dict[str, FootMotion], step: float) -> Array:
    """Metres (F,) by which the pelvis must sink so that both legs reach their feet."""
    need = np.zeros(len(root))
    for side, sign in SIDES:
        hip = root + rot.rotate(pelvis, np.broadcast_to(hip_joint(sign), root.shape))
        reach = hip - feet[side].ankle
        level = np.hypot(reach[:, 0], reach[:, 2])
        highest = np.sqrt(np.maximum(_LONGEST_LEG**2 - level**2, 0.0))
        need = np.maximum(need, reach[:, 1] - highest)
    # Widened before it is smoothed, so that the smoothed drop still suffices.
    width = 0.05 / step
    return np.asarray(
        gaussian_filter1d(maximum_filter1d(need, int(3.2 * width) | 1), 0.8 * width, truncate=2.0)
    )


def _trunk(
    local: Array,
    skeleton: Skeleton,
    route: Route,
    reaching: Reaching,
    times: Array,
    rng: np.random.Generator,
) -> None:
    """Thorax against the pelvis, level shoulders, a head that looks where the way goes."""
    phase, show = route.phase, route.stepping
    sway = np.deg2rad(smooth_noise(rng, times, 0.6, 0.7, 9))
    breath = np.deg2rad(0.5) * np.sin(2 * np.pi * (0.24 * times + sway[:, 8]))
    twist = -np.deg2rad(9.5) * show * wave(phase, 0.02)
    list_ = np.deg2rad(4.5) * show * wave(phase, 0.15)
    lean = np.deg2rad(-1.0 + 0.6 * show * wave(phase, 0.1, 2))
    for part, share, at in (("Spine", 0.45, 0), ("Chest", 0.55, 3)):
        angles = np.stack([share * twist, share * list_, share * lean], axis=-1)
        angles += sway[:, at : at + 3]
        angles[:, 2] += breath if part == "Chest" else 0.0
        extra = reaching.spine if part == "Spine" else reaching.chest
        local[:, skeleton.index[part]] = rot.multiply(extra, rot.from_euler("YZX", angles))
    heading = route.path(route.phase)[:, 2]
    ahead = np.clip(np.interp(times + 0.35, times, heading) - heading, -0.6, 0.6)
    ahead = gaussian_filter1d(ahead, 0.15 / route.step)
    look = np.deg2rad(smooth_noise(rng, times, 0.3, 4.0, 2)) * (1.2 - show)[:, None]
    nod = np.deg2rad(2.0) - 0.5 * np.deg2rad(1.2) * show * wave(phase, 0.05, 2) + 0.5 * look[:, 1]
    turn = ahead + look[:, 0] + 0.45 * np.deg2rad(9.5) * show * wave(phase, 0.02)
    angles = np.stack([turn, np.zeros_like(turn), nod], axis=-1)
    local[:, skeleton.index["Head"]] = rot.multiply(reaching.head, rot.from_euler("YZX", angles))


def _leg(
    local: Array,
    skeleton: Skeleton,
    side: str,
    sign: float,
    root: Array,
    pelvis: Array,
    ground: Array,
    foot: FootMotion,
) -> None:
    hip = root + rot.rotate(pelvis, np.broadcast_to(hip_joint(sign), root.shape))
    forward = np.broadcast_to(_FORWARD, root.shape)
    # The knee points between body and toes; a foot that points down must not turn it.
    level = rot.rotate(foot.rotation, np.broadcast_to(np.array([1.0, 0.0, 0.0]), root.shape))
    toes = np.cross(level, np.array([0.0, 1.0, 0.0]))
    pole = rot.rotate(ground, forward) + toes
    thigh, shank = bend(hip, foot.ankle, pole, (THIGH, SHANK))
    hinge = np.cross(hip - foot.ankle, pole)
    upper, lower = _hanging(hinge, thigh), _hanging(hinge, shank)
    at = {part: skeleton.index[side + part] for part in ("UpLeg", "Leg", "Foot", "Toe")}
    local[:, at["UpLeg"]] = rot.multiply(rot.conjugate(pelvis), upper)
    local[:, at["Leg"]] = rot.multiply(rot.conjugate(upper), lower)
    local[:, at["Foot"]] = rot.multiply(rot.conjugate(lower), foot.rotation)
    local[:, at["Toe"]] = rot.about_axis(0, -foot.toe)


def _hanging(hinge: Array, down: Array) -> Array:
    """World rotation of a leg bone: X along the knee's hinge, -Y along the bone."""
    return frame(hinge, -down)


def _arm(
    local: Array,
    skeleton: Skeleton,
    side: str,
    sign: float,
    route: Route,
    reaching: Reaching,
    times: Array,
    root: Array,
    ground: Array,
    place: tuple[Array, Array],
    rng: np.random.Generator,
) -> None:
    at = {part: skeleton.index[side + part] for part in ("Shoulder", "Arm", "ForeArm", "Hand")}
    swing = _swinging(route, sign, times, rng)
    weight, shrug, target = reaching.hands[side]
    raised = rot.about_axis(
        2, sign * (shrug + np.deg2rad(smooth_noise(rng, times, 0.4, 0.6)[:, 0]))
    )
    local[:, at["Shoulder"]] = raised
    chest = local[:, 0]
    spot = root
    for part in ("Spine", "Chest", side + "Shoulder", side + "Arm"):
        joint = skeleton.index[part]
        spot = spot + rot.rotate(chest, np.broadcast_to(skeleton.offsets[joint], spot.shape))
        if part != side + "Arm":
            chest = rot.multiply(chest, local[:, joint])
    floor = np.stack([place[0], np.zeros_like(place[0]), place[1]], axis=-1)
    upper, lower, elbow = _swung(chest, swing, sign)
    wrist = spot + UPPER_ARM * upper + FOREARM * lower
    # A hand goes straight to its target, but for an arc around the body.
    arc = np.outer(4 * weight * (1 - weight) * np.maximum(target[:, 1] - 0.8, 0.0), _ARC)
    goal = wrist + weight[:, None] * (floor + rot.rotate(ground, target) - wrist)
    goal = goal + rot.rotate(ground, arc)
    out = rot.rotate(chest, np.broadcast_to(np.array([0.25 * sign, -0.85, -0.4]), goal.shape))
    pole = elbow + weight[:, None] * (out - elbow)
    upper, lower = bend(spot, goal, pole, (UPPER_ARM, FOREARM), 0.006)
    hinge = sign * np.cross(goal - spot, pole)
    first, second = frame(sign * upper, hinge), frame(sign * lower, hinge)
    local[:, at["Arm"]] = rot.multiply(rot.conjugate(chest), first)
    local[:, at["ForeArm"]] = rot.multiply(rot.conjugate(first), second)
    local[:, at["Hand"]] = swing[2]


def _swung(
    chest: Array, swing: tuple[Array, Array, Array], sign: float
) -> tuple[Array, Array, Array]:
    """World directions (F, 3) of upper arm and forearm, and the side the elbow points to."""
    along = np.broadcast_to(np.array([sign, 0.0, 0.0]), (len(chest), 3))
    first = rot.multiply(chest, swing[0])
    second = rot.multiply(first, swing[1])
    back = rot.rotate(first, np.broadcast_to(-_FORWARD, along.shape))
    return rot.rotate(first, along), rot.rotate(second, along), back


def _swinging(
    route: Route, sign: float, times: Array, rng: np.random.Generator
) -> tuple[Array, Array, Array]:
    """Local rotations (F, 4) of upper arm, forearm and hand that swings with the other leg."""
    show = route.stepping
    # Either arm is farthest forward as the other foot strikes.
    peak = 0.5 if sign < 0 else 0.0
    noise = np.deg2rad(smooth_noise(rng, times, 0.5, 1.6, 6))
    size = 1 + smooth_noise(rng, times, 0.8 / STRIDE_SECONDS, 0.06)[:, 0]
    forward = np.deg2rad(1.0 + 17.0 * show * size * wave(route.phase, peak)) + noise[:, 0]
    aside = np.deg2rad(9.0) + noise[:, 1]
    inward = np.deg2rad(12.0) + noise[:, 2]
    elbow = np.deg2rad(14.0 + show * size * (5.0 + 9.0 * wave(route.phase, peak + 0.05)))
    elbow = elbow + noise[:, 3]
    hanging = rot.about_axis(2, -sign * (np.pi / 2 - aside))
    turned = rot.multiply(hanging, rot.about_axis(0, inward))
    arm = rot.multiply(rot.about_axis(0, -forward), turned)
    hand = rot.from_euler("YZX", np.stack([noise[:, 4], noise[:, 5], 0 * aside], axis=-1))
    return arm, rot.about_axis(1, -sign * elbow), hand
