"""Quaternion functions against SciPy's rotations, and the laws they must obey."""

from __future__ import annotations

from itertools import permutations, product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation, Slerp

from mocapstudio.motion import rotations as rot

ORDERS = ["".join(letters) for letters in permutations("XYZ")]
IDENTITY = np.array([0.0, 0.0, 0.0, 1.0])


def some(n: int, seed: int = 0) -> np.ndarray:
    return Rotation.random(n, rng=seed).as_quat()


@st.composite
def quaternion(draw: st.DrawFn) -> np.ndarray:
    part = st.floats(-1, 1)
    q = np.array([draw(part), draw(part), draw(part), draw(part)])
    norm = np.linalg.norm(q)
    return q / norm if norm > 0.05 else IDENTITY.copy()


def apart(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Angle between rotations, accurate near zero."""
    return (Rotation.from_quat(a).inv() * Rotation.from_quat(b)).magnitude()


def test_product_applies_the_second_factor_first() -> None:
    a, b, v = some(50, 1), some(50, 2), np.random.default_rng(3).normal(size=(50, 3))
    expected = (Rotation.from_quat(a) * Rotation.from_quat(b)).apply(v)
    np.testing.assert_allclose(rot.rotate(rot.multiply(a, b), v), expected, atol=1e-12)
    np.testing.assert_allclose(rot.rotate(a, rot.rotate(b, v)), expected, atol=1e-12)


@given(quaternion(), quaternion(), quaternion())
def test_rotations_form_a_group(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> None:
    left, right = rot.multiply(rot.multiply(a, b), c), rot.multiply(a, rot.multiply(b, c))
    np.testing.assert_allclose(left, right, atol=1e-12)
    np.testing.assert_allclose(rot.multiply(a, rot.conjugate(a)), IDENTITY, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(left), 1.0, atol=1e-12)


def test_matrices_agree_with_scipy_and_lead_back() -> None:
    half_turns = np.vstack([np.eye(4), np.array([[1, 1, 0, 0], [0, 1, 1, 0], [1, 0, 1, 0]])])
    q = rot.normalize(np.vstack([some(100), half_turns]))
    matrices = rot.to_matrix(q)
    np.testing.assert_allclose(matrices, Rotation.from_quat(q).as_matrix(), atol=1e-12)
    back = rot.from_matrix(matrices)
    assert np.all(back[:, 3] >= 0)
    assert apart(back, q).max() < 1e-12


@pytest.mark.parametrize("order", ["X", "Y", "Z", *(a + b for a, b in product("XYZ", repeat=2))])
def test_one_and_two_euler_angles_agree_with_scipy(order: str) -> None:
    angles = np.random.default_rng(0).uniform(-np.pi, np.pi, (40, len(order)))
    expected = Rotation.identity(40)
    for letter, column in zip(order, angles.T, strict=True):
        expected = expected * Rotation.from_euler(letter, column[:, None])
    assert apart(rot.from_euler(order, angles), expected.as_quat()).max() < 1e-12


@pytest.mark.parametrize("order", ORDERS)
def test_three_euler_angles_agree_with_scipy_both_ways(order: str) -> None:
    angles = np.random.default_rng(1).uniform(-3.1, 3.1, (200, 3))
    q = rot.from_euler(order, angles)
    assert apart(q, Rotation.from_euler(order, angles).as_quat()).max() < 1e-12
    expected = Rotation.from_quat(q).as_euler(order)
    free = np.abs(np.abs(expected[:, 1]) - np.pi / 2) > 1e-3
    assert free.sum() > 190
    np.testing.assert_allclose(rot.to_euler(order, q[free]), expected[free], atol=1e-9)


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("middle", [90.0, -90.0])
def test_gimbal_lock_keeps_the_rotation(order: str, middle: float) -> None:
    outer = np.deg2rad(np.random.default_rng(2).uniform(-180, 180, (50, 2)))
    angles = np.stack([outer[:, 0], np.full(50, np.deg2rad(middle)), outer[:, 1]], axis=-1)
    q = rot.from_euler(order, angles)
    found = rot.to_euler(order, q)
    np.testing.assert_array_equal(found[:, 2], 0.0)
    assert apart(rot.from_euler(order, found), q).max() < 3e-6


@pytest.mark.parametrize("order", ORDERS)
@given(q=quaternion(), nearly=st.floats(-1e-4, 1e-4))
def test_euler_angles_lead_back_to_the_rotation(order: str, q: np.ndarray, nearly: float) -> None:
    found = rot.to_euler(order, q)
    assert abs(found[1]) <= np.pi / 2
    assert apart(rot.from_euler(order, found), q) < 3e-6
    near_lock = rot.from_euler(order, np.array([0.3, np.pi / 2 + nearly, -1.1]))
    assert apart(rot.from_euler(order, rot.to_euler(order, near_lock)), near_lock) < 3e-6


@pytest.mark.parametrize("order", ["XYX", "XY", "xyz", "", "XXYZ"])
def test_an_order_without_three_axes_is_refused(order: str) -> None:
    with pytest.raises(ValueError, match="three different axes"):
        rot.to_euler(order, IDENTITY)


def test_logarithm_is_half_the_rotation_vector() -> None:
    q = some(100)
    expected = Rotation.from_quat(q).as_rotvec()
    np.testing.assert_allclose(2 * rot.log(q), expected, atol=1e-12)
    np.testing.assert_allclose(rot.to_rotation_vector(q), expected, atol=1e-12)
    np.testing.assert_allclose(rot.log(-q), rot.log(q), atol=1e-15)


@given(st.tuples(*[st.floats(-1.0, 1.0)] * 3), st.sampled_from([1e-300, 1e-12, 1e-7, 1e-3, 1.0]))
def test_exponential_inverts_the_logarithm(direction: tuple[float, ...], size: float) -> None:
    vector = size * 0.9 * np.array(direction)  # half vectors below pi / 2
    np.testing.assert_allclose(rot.log(rot.exp(vector)), vector, rtol=1e-9, atol=1e-300)
    expected = Rotation.from_rotvec(2 * vector).as_quat()
    np.testing.assert_allclose(rot.from_rotation_vector(2 * vector), expected, atol=1e-12)


def test_half_turns_and_the_identity_have_logarithms() -> None:
    half = np.eye(4)[:3]
    np.testing.assert_allclose(np.linalg.norm(rot.to_rotation_vector(half), axis=1), np.pi)
    np.testing.assert_array_equal(rot.log(IDENTITY), 0.0)


@given(quaternion(), quaternion())
def test_angle_is_geodesic_and_blind_to_signs(a: np.ndarray, b: np.ndarray) -> None:
    assert abs(rot.angle(a, b) - apart(a, b)) < 1e-7
    assert rot.angle(a, -b) == rot.angle(a, b)


def test_slerp_agrees_with_scipy_on_the_shorter_arc() -> None:
    a, b = some(30, 5), some(30, 6)
    t = np.linspace(0, 1, 30)
    for one, other, at in zip(a, b, t, strict=True):
        expected = Slerp([0, 1], Rotation.from_quat([one, other]))([at]).as_quat()[0]
        assert apart(rot.slerp(one, other, at), expected) < 1e-10
        assert apart(rot.slerp(one, -other, at), expected) < 1e-10


@given(quaternion(), quaternion())
def test_the_mean_of_two_lies_half_way(a: np.ndarray, b: np.ndarray) -> None:
    mean = rot.mean(np.stack([a, b]))
    assert abs(apart(mean, a) - apart(mean, b)) < 1e-6
    if apart(a, b) < 3.0:
        assert apart(mean, rot.slerp(a, b, 0.5)) < 1e-6


@given(st.integers(0, 10**6), quaternion(), st.integers(2, 7))
def test_mean_turns_with_its_rotations_and_is_blind_to_signs(
    seed: int, turn: np.ndarray, count: int
) -> None:
    rng = np.random.default_rng(seed)
    q = rot.from_rotation_vector(rng.normal(0, 0.3, (count, 3)))
    signs = rng.choice([-1.0, 1.0], (count, 1))
    mean = rot.mean(q)
    assert apart(rot.mean(signs * q), mean) < 1e-9
    assert apart(rot.mean(rot.multiply(turn, q)), rot.multiply(turn, mean)) < 1e-9


def test_mean_of_rotations_near_each_other_is_scipys() -> None:
    rng = np.random.default_rng(7)
    centre = some(20, 8)
    q = rot.multiply(centre, rot.from_rotation_vector(rng.normal(0, 0.05, (9, 20, 3))))
    expected = [Rotation.from_quat(q[:, i]).mean().as_quat() for i in range(20)]
    assert apart(rot.mean(q), np.array(expected)).max() < 1e-4
    np.testing.assert_array_equal(rot.mean(q.swapaxes(0, 1), axis=1), rot.mean(q))


def test_continuous_changes_signs_only() -> None:
    path = rot.from_rotation_vector(np.cumsum(np.full((400, 2, 3), 0.04), axis=0))
    signs = np.random.default_rng(9).choice([-1.0, 1.0], (400, 2, 1))
    found = rot.continuous(signs * path)
    np.testing.assert_array_equal(np.abs(found), np.abs(path))
    np.testing.assert_array_equal(found[0], (signs * path)[0])
    assert np.all(np.sum(found[1:] * found[:-1], axis=-1) > 0)
    assert rot.continuous(path[:1]).shape == (1, 2, 4)


@given(st.integers(0, 2), st.floats(-3.1, 3.1), st.floats(-3.0, 3.0), st.floats(0, 6.3))
def test_twist_is_what_turns_about_the_axis(
    axis: int, twist: float, swing: float, direction: float
) -> None:
    across = np.insert(np.array([np.cos(direction), np.sin(direction)]), axis, 0.0)
    q = rot.multiply(
        rot.about_axis(axis, np.array(twist)), rot.from_rotation_vector(swing * across)
    )
    assert abs(rot.twist_angle(q, axis) - twist) < 1e-9
    assert abs(rot.twist_angle(-q, axis) - twist) < 1e-9


def test_nothing_becomes_the_identity() -> None:
    np.testing.assert_array_equal(rot.normalize(np.zeros((2, 4))), np.stack([IDENTITY, IDENTITY]))
    np.testing.assert_allclose(rot.normalize(np.array([0, 0, 3.0, 4.0])), [0, 0, 0.6, 0.8])
