from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from mocapstudio.formats.euler import nearest_euler
from mocapstudio.motion.errors import MocapError

ORDERS = ["".join(letters) for letters in itertools.permutations("XYZ")]
ANGLES = st.floats(-10, 10) | st.sampled_from([0.0, np.pi / 2, -np.pi / 2, np.pi, 3 * np.pi / 2])
TRIPLES = st.tuples(ANGLES, ANGLES, ANGLES)


def quaternions(order: str, angles) -> np.ndarray:
    return Rotation.from_euler(order, angles).as_quat().reshape(-1, 4)


@given(order=st.sampled_from(ORDERS), angles=TRIPLES, previous=TRIPLES)
def test_the_rotation_is_the_same(order: str, angles, previous) -> None:
    q = quaternions(order, np.array([angles]))
    found = nearest_euler(order, q, np.array(previous))
    apart = Rotation.from_euler(order, found).inv() * Rotation.from_quat(q)
    assert apart.magnitude().max() < 1e-7


@given(order=st.sampled_from(ORDERS), angles=TRIPLES)
def test_angles_stay_what_they_were_next_to_themselves(order: str, angles) -> None:
    q = quaternions(order, np.array([angles]))
    found = nearest_euler(order, q, np.array(angles))
    np.testing.assert_allclose(found, [angles], atol=1e-6)


@settings(max_examples=50, deadline=None)
@given(order=st.sampled_from(ORDERS), angles=TRIPLES, previous=TRIPLES)
def test_no_equivalent_is_nearer(order: str, angles, previous) -> None:
    q = quaternions(order, np.array([angles]))
    found = nearest_euler(order, q, np.array(previous))[0]
    distance = np.abs(found - previous).sum()
    # Both solutions, each a few turns to either side.
    for one in (found, [found[0] + np.pi, np.pi - found[1], found[2] + np.pi]):
        for turns in itertools.product((-2, -1, 0, 1, 2), repeat=3):
            other = np.abs(one + 2 * np.pi * np.array(turns) - previous).sum()
            assert distance <= other + 1e-9


@pytest.mark.parametrize("order", ORDERS)
def test_gimbal_lock_keeps_the_outermost_angle(order: str) -> None:
    inner = np.linspace(0, 1, 20)
    angles = np.stack([np.full(20, 0.7), np.full(20, np.pi / 2), inner], axis=-1)
    found = nearest_euler(order, quaternions(order, angles), angles[0])
    np.testing.assert_allclose(found, angles, atol=1e-6)


def test_many_joints_at_once_equal_one_by_one() -> None:
    generator = np.random.default_rng(3)
    q = Rotation.random(60, random_state=3).as_quat().reshape(20, 3, 4)
    previous = generator.uniform(-3, 3, (3, 3))
    together = nearest_euler("ZXY", q, previous)
    for joint in range(3):
        alone = nearest_euler("ZXY", q[:, joint], previous[joint])
        np.testing.assert_array_equal(together[:, joint], alone)


@pytest.mark.parametrize("order", ["X", "Z", "YZ", "ZX"])
def test_fewer_axes(order: str) -> None:
    angles = np.random.default_rng(1).uniform(-1.4, 1.4, (10, len(order)))
    q = Rotation.from_euler(order, angles).as_quat().reshape(-1, 4)
    found = nearest_euler(order, q, angles[0])
    np.testing.assert_allclose(found, angles, atol=1e-9)
    other = Rotation.from_euler("ZXY", [0.3, 0.4, 0.5]).as_quat()[None]
    with pytest.raises(MocapError, match="axis is missing"):
        nearest_euler(order, other, angles[0])


@pytest.mark.parametrize("order", ["", "XYX", "ZZ"])
def test_orders_that_cannot_hold_an_edit(order: str) -> None:
    with pytest.raises(MocapError):
        nearest_euler(order, np.array([[0.0, 0.0, 0.0, 1.0]]), np.zeros(len(order)))
