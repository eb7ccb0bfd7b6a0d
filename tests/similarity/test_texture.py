"""The motion-texture: what it keeps of a take, and what it leaves out."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from made_takes import below_a_reference, chain, elsewhere, horse, person, walking

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError, SkeletonMismatchError
from mocapstudio.motion.facing import split_heading
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Source, Take
from mocapstudio.similarity.texture import (
    TEXTURE_RATE,
    TRAVEL,
    body_motion,
    comparable_joints,
    motion_texture,
    texture_of,
)

JOINTS = person().names


def apart(a: np.ndarray, b: np.ndarray) -> float:
    return float(rot.angle(a.astype(float), b.astype(float)).max())


def test_at_24_fps_it_is_the_take_without_its_heading() -> None:
    take = walking(3.0, rate=24)
    texture = motion_texture(take, JOINTS)
    _, tilt = split_heading(take)
    assert len(texture) == take.frames
    np.testing.assert_allclose(texture.quaternions[:, 1:], take.rotations[:, 1:], atol=1e-6)
    assert apart(texture.quaternions[:, 0], tilt) < 1e-3


@pytest.mark.parametrize("rate", [30, 60, 120, 25, 100])
def test_every_rate_gives_the_same_texture(rate: int) -> None:
    at_24, other = (motion_texture(walking(4.0, rate=r), JOINTS) for r in (24, rate))
    assert abs(len(other) - len(at_24)) <= 1
    count = min(len(other), len(at_24))
    # Between two frames the chord departs from the motion by a fraction of a degree.
    assert np.rad2deg(apart(at_24.quaternions[:count], other.quaternions[:count])) < 0.6
    assert other.frames_each == rate / TEXTURE_RATE


@pytest.mark.parametrize("degrees", [0.0, 90.0, 180.0, -37.5])
def test_turning_and_moving_the_take_leave_it_alone(degrees: float) -> None:
    take = walking(3.0)
    one = motion_texture(take, JOINTS)
    other = motion_texture(elsewhere(take, degrees, (5.0, 0.0, -8.0)), JOINTS)
    assert apart(one.quaternions, other.quaternions) < 1e-3
    np.testing.assert_allclose(one.travel, other.travel, atol=1e-4)
    np.testing.assert_allclose(one.turning, other.turning, atol=1e-4)


def test_travel_is_speed_in_the_bodys_own_directions() -> None:
    """Straight on, then sideways, then up, whatever the world's direction."""
    frames = 49
    rotations = np.tile([0.0, 0.0, 0.0, 1.0], (frames, len(JOINTS), 1))
    rotations[:, 0] = rot.about_axis(1, np.full(frames, np.pi / 2))  # faces +X, left is -Z
    time = np.arange(frames) / 24
    for direction, expected in (
        ((1.0, 0, 0), (1.0, 0.0)),
        ((0, 0, -1.0), (0.0, 1.0)),
        ((0, 0, 1.0), (0.0, -1.0)),
    ):
        place = 1.5 * time[:, None] * np.array(direction)
        place[:, 1] += 0.9
        take = Take("glide", person(), rotations, place[:, None], Fraction(24))
        travel = motion_texture(take, JOINTS).travel
        np.testing.assert_allclose(travel[:, :2], 1.5 * np.array([expected] * frames), atol=1e-5)
        np.testing.assert_allclose(travel[:, 2], 0.9, atol=1e-6)


def test_turning_is_the_headings_rate() -> None:
    frames = 60
    rotations = np.tile([0.0, 0.0, 0.0, 1.0], (frames, len(JOINTS), 1))
    rotations[:, 0] = rot.about_axis(1, 2.0 * np.arange(frames) / 30)  # over a whole turn
    take = Take("spin", person(), rotations, np.zeros((frames, 1, 3)), Fraction(30))
    np.testing.assert_allclose(motion_texture(take, JOINTS).turning, 2.0, atol=1e-4)


def test_quaternions_run_on_and_have_length_one() -> None:
    take = walking(3.0)
    signs = np.random.default_rng(0).choice([-1.0, 1.0], (take.frames, len(JOINTS), 1))
    q = motion_texture(take.with_motion(take.rotations * signs), JOINTS).quaternions
    np.testing.assert_allclose(np.linalg.norm(q, axis=-1), 1.0, atol=1e-6)
    assert np.all(np.sum(q[1:] * q[:-1], axis=-1) > 0)
    assert apart(q, motion_texture(take, JOINTS).quaternions) < 1e-3


def test_only_the_trimmed_span_counts() -> None:
    take = replace(walking(4.0), trim=(15, 75))
    texture = motion_texture(take, JOINTS)
    alone = take.with_motion()
    cut = replace(
        alone, rotations=take.rotations[15:75], translations=take.translations[15:75], trim=None
    )
    np.testing.assert_array_equal(texture.quaternions, motion_texture(cut, JOINTS).quaternions)
    assert texture.frame(0.0) == 15
    assert texture.frame(8.0) == 25


@pytest.mark.parametrize("frames", [1, 2])
def test_a_take_of_one_moment_is_refused_by_name(frames: int) -> None:
    take = replace(walking(1.0, rate=120), trim=(5, 5 + frames), name="blink")
    with pytest.raises(MocapError, match=r"blink: .*too short"):
        motion_texture(take, JOINTS)
    with pytest.raises(MocapError, match="too short"):
        texture_of(body_motion(take, JOINTS))


def test_planes_hold_the_same_with_time_last() -> None:
    texture = motion_texture(walking(2.0), JOINTS)
    np.testing.assert_array_equal(texture.planes.transpose(2, 0, 1), texture.quaternions)
    assert texture.planes.flags.c_contiguous


def test_joints_are_compared_that_all_takes_have() -> None:
    take = walking(1.0)
    other = replace(
        take, skeleton=replace(take.skeleton, names=tuple(n.replace("Neck", "X") for n in JOINTS))
    )
    assert comparable_joints(take, []) == JOINTS
    assert comparable_joints(take, [other]) == tuple(n for n in JOINTS if n != "Neck")


def test_another_skeleton_is_refused_by_file() -> None:
    take, names = walking(1.0), horse().names
    rotations = np.tile([0.0, 0.0, 0.0, 1.0], (30, len(names), 1))
    stranger = Take(
        "horse", horse(), rotations, np.zeros((30, 1, 3)), Fraction(30),
        source=Source(Path("stable/horse.bvh"), "bvh", "0"),
    )  # fmt: skip
    with pytest.raises(SkeletonMismatchError, match=r"stable/horse\.bvh: -: another skeleton: 18"):
        comparable_joints(take, [take, stranger])
    nobody = replace(stranger, source=None, skeleton=chain(19))
    with pytest.raises(SkeletonMismatchError, match="horse"):
        comparable_joints(take, [nobody])


@pytest.mark.parametrize("skeleton", ["person", "below a reference"])
def test_feet_are_where_the_kinematics_put_them(skeleton: str) -> None:
    take = walking(2.0)
    if skeleton != "person":
        take = below_a_reference(take, rot.from_euler("YX", np.array([0.7, -1.2])))
    feet = body_motion(take, JOINTS).feet
    positions, _ = take_pose(take)
    names = ["LeftLeg", "LeftFoot", "RightLeg", "RightFoot"]
    assert feet.shape == (take.frames, 4, 3)
    for name in names:
        place = positions[:, take.skeleton.index[name]]
        assert min(np.abs(feet[:, i] - place).max() for i in range(4)) < 1e-9


def test_clearance_and_slide_tell_how_a_body_glides() -> None:
    rotations = np.tile([0.0, 0.0, 0.0, 1.0], (48, len(JOINTS), 1))
    place = np.stack([0.7 * np.arange(48) / 24, np.full(48, 1.0), np.zeros(48)], axis=-1)
    gliding = Take("glide", person(), rotations, place[:, None], Fraction(24))
    travel = motion_texture(gliding, JOINTS).travel
    np.testing.assert_allclose(travel[:, TRAVEL.index("slide")], 0.7, atol=1e-5)
    # The lowest joint of the rest pose: 5 cm to the hip joint, 43 to the knee, 43 to the foot.
    np.testing.assert_allclose(travel[:, TRAVEL.index("clearance")], 1.0 - 0.91, atol=1e-5)
    standing = gliding.with_motion(translations=np.full((48, 1, 3), 1.0))
    np.testing.assert_allclose(
        motion_texture(standing, JOINTS).travel[:, TRAVEL.index("slide")], 0.0, atol=1e-6
    )
    # Without legs the hips themselves count.
    alone = body_motion(standing, ("Hips", "Spine"))
    assert alone.feet.shape == (48, 1, 3)
