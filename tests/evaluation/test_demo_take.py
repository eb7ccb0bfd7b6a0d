"""The demo take is believable: a body of fixed bones, feet that stand, joints that bend right."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import minimum_filter1d

from mocapstudio.evaluation.demo import curves, demo_take
from mocapstudio.evaluation.demo.route import build_route
from mocapstudio.evaluation.demo.score import SCORE, reaches
from mocapstudio.evaluation.demo.skeleton import HEEL, SIDES
from mocapstudio.evaluation.demo.take import SEED, demo_motion
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import body_frame, split_heading
from mocapstudio.motion.kinematics import end_positions, take_pose
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

RATE = 60.0


@pytest.fixture(scope="module")
def take() -> Take:
    return demo_take()


@pytest.fixture(scope="module")
def pose(take: Take) -> tuple[np.ndarray, np.ndarray]:
    return take_pose(take)


def sole(take: Take, pose: tuple[np.ndarray, np.ndarray], side: str) -> dict[str, np.ndarray]:
    """World positions (F, 3) of what of a foot may touch the floor."""
    positions, world = pose
    foot, toe = take.skeleton.index[f"{side}Foot"], take.skeleton.index[f"{side}Toe"]
    tips = end_positions(take.skeleton, positions, world)
    tip = list(take.skeleton.end_parents).index(toe)
    heel = positions[:, foot] + rot.rotate(world[:, foot], np.broadcast_to(HEEL, (len(world), 3)))
    return {"heel": heel, "ball": positions[:, toe], "tip": tips[:, tip]}


def degrees(take: Take, joint: str, order: str = "XYZ") -> np.ndarray:
    return np.rad2deg(rot.to_euler(order, take.rotations[:, take.skeleton.index[joint]]))


def test_it_lasts_two_minutes_and_has_twenty_joints(take: Take) -> None:
    assert take.duration == 120.0
    assert len(take.skeleton) == 20
    np.testing.assert_allclose(np.linalg.norm(take.rotations, axis=-1), 1.0, atol=1e-12)
    assert np.all(np.sum(take.rotations[1:] * take.rotations[:-1], axis=-1) > 0)


def test_the_topology_is_told_from_the_skeleton(take: Take) -> None:
    names = {limb.name: len(limb.joints) for limb in topology(take.skeleton).limbs}
    assert names == {
        "spine": 3,
        "head": 1,
        "left arm": 4,
        "right arm": 4,
        "left leg": 4,
        "right leg": 4,
    }
    np.testing.assert_allclose(body_frame(take.skeleton), rot.IDENTITY, atol=1e-6)


def test_the_same_seed_gives_the_same_take_and_another_seed_another() -> None:
    first, again, other = demo_take(3), demo_take(3), demo_take(4)
    assert np.array_equal(first.rotations, again.rotations)
    assert np.array_equal(first.translations, again.translations)
    assert not np.allclose(first.rotations, other.rotations, atol=1e-3)


@pytest.mark.parametrize("side", [side for side, _ in SIDES])
def test_a_standing_foot_keeps_a_point_on_the_floor_in_its_place(
    take: Take, pose: tuple[np.ndarray, np.ndarray], side: str
) -> None:
    stance = demo_motion().stance[side]
    points = sole(take, pose, side)
    both = stance[1:] & stance[:-1]
    speeds = [np.linalg.norm(np.diff(points[p], axis=0), axis=1) * RATE for p in ("heel", "ball")]
    slowest = np.minimum(*speeds)[both]
    # The foot rolls, so it is the slower of heel and ball that stands; metres a second.
    assert slowest.max() < 0.02
    assert 0.5 < stance.mean() < 1.0


@pytest.mark.parametrize("side", [side for side, _ in SIDES])
def test_no_foot_goes_through_the_floor(
    take: Take, pose: tuple[np.ndarray, np.ndarray], side: str
) -> None:
    points = sole(take, pose, side)
    assert min(points[p][:, 1].min() for p in points) > -0.001
    assert points["heel"][:, 1].max() > 0.1


@pytest.mark.parametrize("side", [side for side, _ in SIDES])
def test_joints_stay_inside_human_limits(take: Take, side: str) -> None:
    knee, elbow = degrees(take, f"{side}Leg"), degrees(take, f"{side}ForeArm", "YXZ")
    hip, ankle = degrees(take, f"{side}UpLeg"), degrees(take, f"{side}Foot")
    sign = 1.0 if side == "Right" else -1.0
    # Knees and elbows are hinges, but for the noise of measurement.
    assert knee[:, 0].min() > 0
    assert knee[:, 0].max() < 140
    assert np.abs(knee[:, 1:]).max() < 1
    assert (sign * elbow[:, 0]).min() > 0
    assert (sign * elbow[:, 0]).max() < 145
    assert np.abs(elbow[:, 1:]).max() < 2
    assert hip[:, 0].min() > -125
    assert hip[:, 0].max() < 30
    assert np.abs(hip[:, 1:]).max() < 45
    assert ankle[:, 0].min() > -40
    assert ankle[:, 0].max() < 50


def test_nothing_jumps(take: Take) -> None:
    turned = np.rad2deg(rot.angle(take.rotations[1:], take.rotations[:-1])) * RATE
    root = np.diff(take.translations[:, 0], axis=0) * RATE
    # Knees reach 400 to 550 degrees a second in walking, the body some 1.4 m/s.
    assert turned.max() < 700
    assert np.linalg.norm(root, axis=1).max() < 1.8
    assert np.linalg.norm(np.diff(root, axis=0), axis=1).max() * RATE < 12


def steady(take: Take) -> tuple[np.ndarray, np.ndarray]:
    """Phase of the right foot, and where the walk is straight and at its pace."""
    times = np.arange(take.frames) / RATE
    rng = np.random.Generator(np.random.PCG64(SEED))
    route = build_route([item.what for item in SCORE], times, rng)
    x, z, heading = route.path(route.phase).T
    straight = np.abs(np.gradient(heading)) * RATE < 0.3
    speed = np.hypot(np.gradient(x), np.gradient(z)) * RATE
    # A foot that trails took its step before, so half a stride on either side counts too.
    return route.phase % 1.0, straight & (minimum_filter1d(speed, 67) > 1.0)


@pytest.mark.parametrize(("side", "shift"), [("Right", 0.0), ("Left", 0.5)])
def test_knees_follow_the_published_curve(take: Take, side: str, shift: float) -> None:
    phase, good = steady(take)
    knee = np.deg2rad(degrees(take, f"{side}Leg")[:, 0])
    published = curves.knee_angle(phase - shift)
    assert good.sum() > 300
    assert np.corrcoef(knee[good], published[good])[0, 1] > 0.88
    swing = good & (np.abs((phase - shift) % 1.0 - 0.75) < 0.05)
    assert 45 < np.rad2deg(knee[swing]).mean() < 70


def test_arms_swing_with_the_other_leg(take: Take, pose: tuple[np.ndarray, np.ndarray]) -> None:
    positions, _ = pose
    _, good = steady(take)
    heading, _ = split_heading(take)
    ahead = np.stack([np.sin(heading), np.zeros_like(heading), np.cos(heading)], axis=-1)
    index = take.skeleton.index

    def forward(joint: str) -> np.ndarray:
        away = positions[:, index[joint]] - positions[:, index["Hips"]]
        return np.sum(away * ahead, axis=-1)[good]

    hand = forward("RightHand")
    assert np.corrcoef(hand, forward("LeftFoot"))[0, 1] > 0.7
    assert np.corrcoef(hand, forward("RightFoot"))[0, 1] < -0.7


def test_cycles_vary_but_little(take: Take) -> None:
    phase, good = steady(take)
    knee = degrees(take, "RightLeg")[:, 0]
    middle = knee[good & (np.abs(phase - 0.75) < 0.015)]
    assert len(middle) >= 5
    assert 0.2 < middle.std() < 12


def test_reaches_are_repeated_and_hold_their_targets(
    take: Take, pose: tuple[np.ndarray, np.ndarray]
) -> None:
    times = np.arange(take.frames) / RATE
    route = build_route([i.what for i in SCORE], times, np.random.default_rng(0))
    plan = reaches(route.pauses)
    counts = [
        sum(one is reach for _, one in plan) for reach in {id(r): r for _, r in plan}.values()
    ]
    assert min(counts) >= 3
    positions, _ = pose
    for begin, reach in plan:
        at = round((begin + 1.25) * RATE)
        for side, target in reach.targets:
            wrist = positions[at - 2 : at + 3, take.skeleton.index[f"{side}Hand"]]
            still = np.linalg.norm(np.diff(wrist, axis=0), axis=1).max() * RATE
            assert still < 0.15
            assert abs(wrist[2, 1] - target[1]) < 0.10
