"""Curve quantities against independent computations."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import plot_scene
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from mocapstudio.gui.plots import quantities as q
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION
from mocapstudio.motion.kinematics import take_pose

ORDERS = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")


def tumbling(frames: int, seed: int) -> np.ndarray:
    """Smooth rotations that turn far beyond 180 degrees."""
    generator = np.random.default_rng(seed)
    steps = generator.normal(0, 0.02, (frames, 3)).cumsum(axis=0) * 0.1
    result = Rotation.identity()
    quaternions = []
    for step in steps:
        result = result * Rotation.from_rotvec(step)
        quaternions.append(result.as_quat())
    return np.array(quaternions)


@pytest.mark.parametrize("row", ["Hips", "Head", "LeftHand", "RightToeBase"])
def test_the_position_of_a_joint_is_that_of_forward_kinematics(row):
    take = plot_scene.walking(50)
    positions, _ = take_pose(take)
    expected = positions[:, take.skeleton.index[row]]
    np.testing.assert_allclose(q.world_position(take, row), expected, atol=1e-12)


def test_translated_joints_below_the_root_are_walked_too():
    take = plot_scene.walking(20)
    hand = take.skeleton.index["LeftHand"]
    moves = np.random.default_rng(0).normal(size=(20, 1, 3))
    take = replace(
        take,
        translated=(0, hand),
        translations=np.concatenate([take.translations, moves], axis=1),
    )
    positions, _ = take_pose(take)
    np.testing.assert_allclose(q.world_position(take, "LeftHand"), positions[:, hand], atol=1e-12)


@given(st.integers(0, 10_000))
@settings(max_examples=25, deadline=None)
def test_rotation_vectors_stand_for_the_rotations(seed):
    quaternions = tumbling(200, seed)
    vectors = q.rotation_vectors(quaternions)
    apart = (Rotation.from_rotvec(vectors) * Rotation.from_quat(quaternions).inv()).magnitude()
    assert apart.max() < 1e-6


def test_a_rotation_vector_passes_half_a_turn_without_a_jump():
    angles = np.linspace(0.2, 5.5, 200)
    quaternions = Rotation.from_rotvec(angles[:, None] * [0.0, 0.6, 0.8]).as_quat()
    vectors = q.rotation_vectors(quaternions)
    assert np.abs(np.diff(vectors, axis=0)).max() < 0.05


@given(st.sampled_from(ORDERS), st.integers(0, 10_000))
@settings(max_examples=40, deadline=None)
def test_euler_angles_stand_for_the_rotations(order, seed):
    quaternions = tumbling(200, seed)
    angles = q.euler_angles(order, quaternions)
    again = Rotation.from_euler(order, angles)
    assert (again * Rotation.from_quat(quaternions).inv()).magnitude().max() < 1e-5


@pytest.mark.parametrize("order", ORDERS)
def test_euler_angles_go_through_the_pole_without_a_jump(order):
    # The middle angle runs over 90 degrees; the outer ones are kept off the exact pole.
    middle = np.linspace(-0.5, 3.6, 300)
    true = np.stack([np.full(300, 0.3), middle, np.full(300, -0.4)], axis=-1)
    quaternions = Rotation.from_euler(order, true).as_quat()
    angles = q.euler_angles(order, quaternions)
    assert np.abs(np.diff(angles, axis=0)).max() < 0.05
    np.testing.assert_allclose(angles, true, atol=1e-6)


@given(st.sampled_from(ORDERS), st.integers(0, 1000), st.integers(-2, 2))
@settings(max_examples=25, deadline=None)
def test_the_description_nearest_to_another_curve_is_taken(order, seed, turns):
    quaternions = tumbling(80, seed)
    goal = q.euler_angles(order, quaternions) + 2 * np.pi * turns
    np.testing.assert_allclose(q.euler_angles(order, -quaternions, goal), goal, atol=1e-5)
    vectors = q.rotation_vectors(quaternions)
    np.testing.assert_allclose(q.rotation_vectors(-quaternions, vectors), vectors, atol=1e-6)


def test_a_window_of_the_same_motion_lies_on_its_own_curve():
    take = plot_scene.walking(300)
    part = replace(take, rotations=take.rotations[40:90], translations=take.translations[40:90])
    for row in ("LeftLeg", ROOT_POSITION, ROOT_HEADING):
        for quantity in q.quantities_of(row):
            whole = q.curves(take, row, quantity).values
            piece = q.curves(part, row, quantity, near=whole[40:90]).values
            # A step needs the frame before, so a window's first speed is another's.
            np.testing.assert_allclose(piece[1:], whole[41:90], atol=1e-9)


def test_speed_is_the_length_of_a_step_times_the_rate():
    positions = np.array([[0.0, 0, 0], [0.03, 0.04, 0], [0.03, 0.04, 0]])
    np.testing.assert_allclose(q.speed(positions, 120.0), [6.0, 6.0, 0.0])
    assert q.speed(positions[:1], 120.0).tolist() == [0.0]


def test_turning_speed_of_a_steady_turn():
    take = plot_scene.walking(60)
    joint = take.skeleton.index["Head"]
    rotations = take.rotations.copy()
    rotations[:, joint] = Rotation.from_euler(
        "Y", np.arange(60)[:, None] * 0.5, degrees=True
    ).as_quat()
    turned = q.curves(take.with_motion(rotations), "Head", q.Quantity.TURNING)
    np.testing.assert_allclose(turned.values[:, 0], 0.5 * 120, rtol=1e-4)


@pytest.mark.parametrize("row", ["Head", ROOT_POSITION, ROOT_HEADING])
def test_every_offered_quantity_has_a_value_for_every_frame(row):
    take = plot_scene.walking(1)
    for quantity in q.quantities_of(row):
        found = q.curves(take, row, quantity)
        assert found.values.shape == (1, len(found.names))
        assert np.isfinite(found.values).all()
        assert found.unit == q.unit_of(quantity)
