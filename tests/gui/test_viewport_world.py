"""World positions worked out in blocks are those of the kinematics."""

from __future__ import annotations

import numpy as np
import pytest
from plot_scene import walking

from mocapstudio.formats import read
from mocapstudio.gui.viewport.world import WorldMotion, WorldMotions
from mocapstudio.motion.facing import hips_world, split_heading
from mocapstudio.motion.kinematics import end_positions, take_pose

TAKES = (
    "cmu_salsa_pairs_bvh/60_10_scaled.bvh",
    "bandai_1_styles_bvh_CCBYNC4",
    "rokoko_animated_drawings_bvh_MIT",
)


@pytest.fixture(params=TAKES)
def take(request, data):
    path = data / request.param
    return read(path if path.is_file() else sorted(path.glob("*.bvh"))[0])[0][0]


def test_points_are_joints_then_tips(take):
    positions, world = take_pose(take)
    expected = np.concatenate([positions, end_positions(take.skeleton, positions, world)], axis=1)
    motion = WorldMotion(take)
    for frame in {0, 1, min(255, take.frames - 1), min(256, take.frames - 1), take.frames - 1}:
        assert motion.points(frame) == pytest.approx(expected[frame], abs=1e-5)


def test_the_heading_is_that_of_the_hips(take):
    motion = WorldMotion(take)
    heading, _ = split_heading(take)
    for frame in (0, take.frames // 2, take.frames - 1):
        turn = motion.heading(frame) - heading[frame]
        assert np.remainder(turn + np.pi, 2 * np.pi) == pytest.approx(np.pi, abs=1e-6)


def test_what_is_followed_is_the_hips_without_their_bobbing():
    take = walking(frames=1200)
    followed, hips = WorldMotion(take).followed, hips_world(take)[0]
    assert followed.shape == hips.shape
    inside = slice(240, -240)
    assert np.abs(followed - hips)[inside].max() < 0.15
    assert np.ptp(followed[inside, 1]) < 0.2 * np.ptp(hips[inside, 1])


@pytest.mark.parametrize("frames", [1, 2, 7])
def test_a_take_shorter_than_the_smoothing_is_followed_all_the_same(frames):
    take = walking(frames=1200)
    few = take.with_motion(take.rotations[:frames], take.translations[:frames])
    followed, hips = WorldMotion(few).followed, hips_world(few)[0]
    assert followed.shape == (frames, 3)
    assert (followed >= hips.min(axis=0) - 1e-9).all()
    assert (followed <= hips.max(axis=0) + 1e-9).all()


def test_a_take_is_known_by_identity_and_forgotten_when_no_longer_kept():
    motions, one, other = WorldMotions(), walking(60), walking(60)
    first = motions.of(one)
    assert motions.of(one) is first
    assert motions.of(other) is not first
    motions.keep([other])
    assert motions.of(one) is not first
