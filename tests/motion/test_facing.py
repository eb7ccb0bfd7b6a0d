"""Heading, tilt and travel of the hips."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from made_takes import below_a_reference, chain, elsewhere, horse, person, walking
from scipy.spatial.transform import Rotation

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import (
    above_hips,
    body_frame,
    carrier,
    hips_rotation,
    hips_world,
    split_heading,
)
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology


def leaning(headings: np.ndarray, skeleton: Skeleton | None = None) -> Take:
    """A person with known headings whose hips lean this way and that by up to 40 degrees."""
    skeleton = skeleton or person()
    frames = len(headings)
    rotations = np.tile([0.0, 0.0, 0.0, 1.0], (frames, len(skeleton), 1))
    rng = np.random.default_rng(0)
    direction = rng.uniform(0, 2 * np.pi, frames)
    lean = np.stack([np.cos(direction), np.zeros(frames), np.sin(direction)], axis=-1)
    lean *= rng.uniform(0, 0.7, (frames, 1))
    rotations[:, 0] = rot.multiply(rot.about_axis(1, headings), rot.from_rotation_vector(lean))
    return Take("leaning", skeleton, rotations, np.zeros((frames, 1, 3)), Fraction(30))


def test_heading_is_what_was_turned_about_the_vertical() -> None:
    headings = np.linspace(-7.0, 9.0, 200)  # more than two turns, unwrapped
    heading, tilt = split_heading(leaning(headings))
    turns = np.round((heading[0] - headings[0]) / (2 * np.pi))
    np.testing.assert_allclose(heading - 2 * np.pi * turns, headings, atol=1e-9)
    np.testing.assert_allclose(rot.twist_angle(tilt, 1), 0.0, atol=1e-9)


def test_heading_and_tilt_make_up_the_rotation() -> None:
    take = walking(3.0)
    heading, tilt = split_heading(take)
    _, world = hips_world(take)
    np.testing.assert_allclose(rot.multiply(rot.about_axis(1, heading), tilt), world, atol=1e-12)


def test_zero_heading_faces_plus_z() -> None:
    take = leaning(np.array([0.0, np.pi / 2]))
    heading, _ = split_heading(take)
    forward = np.stack([np.sin(heading), np.zeros(2), np.cos(heading)], axis=-1)
    np.testing.assert_allclose(forward, [[0, 0, 1], [1, 0, 0]], atol=1e-9)


@pytest.mark.parametrize("degrees", [0.0, 37.0, -120.0, 180.0])
def test_turning_the_take_adds_to_the_heading_and_leaves_the_tilt(degrees: float) -> None:
    take = walking(2.0)
    heading, tilt = split_heading(take)
    turned, same = split_heading(elsewhere(take, degrees, (3.0, 0.0, -2.0)))
    difference = (turned - heading - np.deg2rad(degrees) + np.pi) % (2 * np.pi) - np.pi
    np.testing.assert_allclose(difference, 0.0, atol=1e-9)
    assert rot.angle(same, tilt).max() < 1e-7


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("quarters", [1, 2, 3])
def test_the_body_frame_follows_the_rest_pose(axis: int, quarters: int) -> None:
    """However the rest pose lies, the body frame leads from body axes to it."""
    upright = person()
    lie = rot.about_axis(axis, np.array(quarters * np.pi / 2))
    lying = replace(upright, offsets=rot.rotate(lie, upright.offsets))
    expected = Rotation.from_quat(lie) * Rotation.from_quat(body_frame(upright))
    found = Rotation.from_quat(body_frame(lying))
    assert (expected.inv() * found).magnitude() < 1e-9
    np.testing.assert_allclose(np.abs(body_frame(upright)), [0, 0, 0, 1], atol=1e-9)


def test_a_body_frame_needs_a_pair_of_legs() -> None:
    np.testing.assert_array_equal(body_frame(chain()), [0, 0, 0, 1])
    assert abs(Rotation.from_quat(body_frame(horse())).as_matrix()[0, 0]) > 0.99


def test_hips_below_other_joints_move_as_the_kinematics_say() -> None:
    take = below_a_reference(walking(2.0), rot.from_euler("ZX", np.array([0.5, -1.2])))
    assert topology(take.skeleton).hips == 1
    positions, world = take_pose(take)
    place, rotation = hips_world(take)
    np.testing.assert_allclose(place, positions[:, 1], atol=1e-12)
    np.testing.assert_allclose(rotation, world[:, 1], atol=1e-12)
    np.testing.assert_allclose(above_hips(take), world[:, 0], atol=1e-12)
    part = hips_world(take, 5, 9)
    np.testing.assert_array_equal(part[0], place[5:9])
    np.testing.assert_array_equal(part[1], rotation[5:9])


def test_a_reference_above_the_hips_changes_neither_heading_nor_tilt() -> None:
    take = walking(2.0)
    below = below_a_reference(take, rot.from_euler("YX", np.array([2.0, -np.pi / 2])))
    for mine, theirs in zip(split_heading(take), split_heading(below), strict=True):
        np.testing.assert_allclose(mine, theirs, atol=1e-9)


@pytest.mark.parametrize("reference", [False, True])
def test_hips_get_another_tilt_and_keep_their_heading(reference: bool) -> None:
    take = walking(2.0)
    if reference:
        take = below_a_reference(take, rot.from_euler("YX", np.array([2.0, -1.0])))
    heading, _ = split_heading(take)
    tilt = split_heading(leaning(np.zeros(8)))[1]
    hips = topology(take.skeleton).hips
    rotations = take.rotations.copy()
    rotations[4:12, hips] = hips_rotation(take, tilt, 4, 12)
    found, leaned = split_heading(take.with_motion(rotations))
    np.testing.assert_allclose(found, heading, atol=1e-9)
    assert rot.angle(leaned[4:12], tilt).max() < 1e-7


def test_the_carrier_is_the_nearest_translated_joint_from_the_hips_up() -> None:
    take = walking(1.0)
    assert carrier(take) == 0
    below = below_a_reference(take, np.array([0.0, 0.0, 0.0, 1.0]))
    assert carrier(below) == 1
    fixed = replace(below, translated=(0,), translations=below.translations[:, :1])
    assert carrier(fixed) == 0
