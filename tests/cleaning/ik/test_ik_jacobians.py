"""Analytic Jacobians against finite differences, residuals against their definition."""

from __future__ import annotations

import naive_ik
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_takes import below_a_reference, walking
from scipy.spatial.transform import Rotation

from mocapstudio.cleaning.ik import turns
from mocapstudio.cleaning.ik.freedom import Freedom, freedom
from mocapstudio.cleaning.ik.limits import RangeLimit
from mocapstudio.cleaning.ik.objectives.orientation import Orientation
from mocapstudio.cleaning.ik.objectives.over_time import KeepPose, Smoothness
from mocapstudio.cleaning.ik.objectives.position import PointAtTarget, across
from mocapstudio.cleaning.ik.posed import Posed, window
from mocapstudio.cleaning.ik.ranges import joint_ranges
from mocapstudio.cleaning.ik.solve import Problem, cost, gradient
from mocapstudio.motion import rotations as rot

seeds = st.integers(0, 2**32 - 1)
FRAMES = 4
STEP = 1e-6


@pytest.fixture(scope="module")
def take():
    walk = walking(2.0)
    return walk.with_motion(walk.rotations[:FRAMES], walk.translations[:FRAMES])


@pytest.fixture(scope="module")
def free(take) -> Freedom:
    names = ("LeftUpLeg", "LeftLeg", "LeftFoot")
    joints = [take.skeleton.index[name] for name in names]
    return freedom(joints, joint_ranges([walking(2.0)]), reach=0.08)


def posed(take, free, unknowns) -> Posed:
    foot = take.skeleton.index["LeftFoot"]
    return Posed(window(take, 0, take.frames, [foot]), free, unknowns)


def agrees(objective, take, free, unknowns) -> None:
    rows = objective.rows(posed(take, free, unknowns))
    for column in range(free.size):
        step = np.zeros_like(unknowns)
        step[:, column] = STEP
        ahead = objective.rows(posed(take, free, unknowns + step)).residual
        behind = objective.rows(posed(take, free, unknowns - step)).residual
        measured = (ahead - behind) / (2 * STEP)
        scale = np.abs(rows.jacobian).max() + 1e-9
        np.testing.assert_allclose(rows.jacobian[:, :, column], measured, atol=1e-6 * scale)


def drawn(seed: int, size: int, spread: float = 0.4) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(FRAMES, size)) * spread


@given(seed=seeds)
@settings(max_examples=10)
@pytest.mark.parametrize("held", ["place", "plane", "line"])
def test_point_at_target(take, free, held, seed):
    unknowns = drawn(seed, free.size)
    direction = np.array([0.6, 0.0, 0.8])
    projection = {"place": np.eye(3), "plane": direction[None], "line": across(direction)}[held]
    joint = take.skeleton.index["LeftFoot"]
    frames = np.array([0, 2, 3])
    target = drawn(seed + 1, 3)[:3]
    offset = np.array([0.0, -0.05, 0.1])
    objective = PointAtTarget(joint, offset, frames, target, 7.0, projection)
    agrees(objective, take, free, unknowns)
    away = naive_ik.point_residual(
        take, free, unknowns, joint, offset, dict(zip(frames.tolist(), target, strict=True)), 7.0
    )
    expected = away.reshape(-1, 3) @ projection.T
    rows = objective.rows(posed(take, free, unknowns))
    np.testing.assert_allclose(rows.residual, expected, atol=1e-9)


@given(seed=seeds)
@settings(max_examples=10)
def test_orientation(take, free, seed):
    unknowns = drawn(seed, free.size)
    joint = take.skeleton.index["LeftFoot"]
    target, _ = turns.exp(drawn(seed + 1, 3))
    objective = Orientation(joint, np.arange(FRAMES), target, np.full(FRAMES, 3.0))
    agrees(objective, take, free, unknowns)
    expected = naive_ik.orientation_residual(
        take, free, unknowns, joint, dict(enumerate(target)), 3.0
    )
    rows = objective.rows(posed(take, free, unknowns))
    np.testing.assert_allclose(rows.residual.ravel(), expected, atol=1e-8)


@given(seed=seeds)
@settings(max_examples=10)
def test_range_limit(take, free, seed):
    unknowns = drawn(seed, free.size, 0.8)
    ranges = joint_ranges([walking(2.0)])
    joint = take.skeleton.index["LeftLeg"]
    low, high = ranges.low[joint], ranges.high[joint]
    limit = RangeLimit(joint, ranges.mean[joint], ranges.axes[joint], low, high, 5.0)
    rows = limit.rows(posed(take, free, unknowns))
    turn = unknowns[:, free.columns(joint)] @ free.axes[free.joints.index(joint)].T
    local = rot.multiply(take.rotations[:, joint], rot.from_rotation_vector(turn))
    away = rot.to_rotation_vector(rot.multiply(rot.conjugate(ranges.mean[joint]), local))
    along = away @ ranges.axes[joint]
    expected = 5.0 * (np.maximum(along - high, 0) - np.maximum(low - along, 0))
    full = np.zeros((FRAMES, 3))
    full[rows.frames] = rows.residual
    np.testing.assert_allclose(full, expected, atol=1e-9)
    # Bounds make kinks; elsewhere the derivative has to agree.
    if np.abs(np.concatenate([along - low, along - high])).min() > 1e-4:
        agrees(limit, take, free, unknowns)


@given(seed=seeds, order=st.sampled_from([1, 2, 3]))
@settings(max_examples=10)
def test_cost_and_gradient_of_wishes_over_time(take, free, seed, order):
    unknowns = drawn(seed, free.size)
    rng = np.random.default_rng(seed)
    weights = rng.random(free.size)
    reference = rng.normal(size=unknowns.shape)
    wishes = (
        KeepPose(FRAMES, free.stiffness, reference),
        Smoothness(FRAMES, weights, order),
    )
    view = window(take, 0, FRAMES, free.joints)
    problem = Problem(view, free, (), wishes)
    residual = np.concatenate(
        [
            ((unknowns - reference) * free.stiffness).ravel(),
            naive_ik.smoothness_residual(unknowns, weights, order),
        ]
    )
    assert cost(problem, unknowns) == pytest.approx(0.5 * residual @ residual)
    direction = rng.normal(size=unknowns.shape)
    ahead, behind = (cost(problem, unknowns + s * 1e-4 * direction) for s in (1, -1))
    slope = (ahead - behind) / 2e-4
    assert np.sum(gradient(problem, unknowns) * direction) == pytest.approx(slope, rel=1e-6)


def test_free_ends_leave_out_the_rows_that_join(take, free):
    unknowns = np.ones((FRAMES, free.size))
    view = window(take, 0, FRAMES, free.joints)
    ones = np.ones(free.size)

    def of(**ends: bool) -> float:
        return cost(Problem(view, free, (), (Smoothness(FRAMES, ones, 2, **ends),)), unknowns)

    assert of(joins_before=False, joins_after=False) == 0
    # A step from 0 to 1 is 1, then -1, in second differences.
    assert of(joins_after=False) == pytest.approx(0.5 * 2 * free.size)
    assert of() == pytest.approx(0.5 * 4 * free.size)


@given(seed=seeds, size=st.sampled_from([1e-7, 1e-3, 0.5, 1.5]))
@settings(max_examples=20)
def test_turns(seed, size):
    v = np.random.default_rng(seed).normal(size=(5, 3))
    v *= size / np.abs(v).max(axis=1, keepdims=True)
    turn, jacobian = turns.exp(v)
    np.testing.assert_allclose(turn, Rotation.from_rotvec(v).as_matrix(), atol=1e-12)
    back, inverse = turns.log(turn)
    np.testing.assert_allclose(back, v, atol=1e-9)
    np.testing.assert_allclose(inverse @ jacobian, np.tile(np.eye(3), (5, 1, 1)), atol=1e-9)
    step = np.random.default_rng(seed + 1).normal(size=(5, 3)) * 1e-6
    ahead, _ = turns.log(np.swapaxes(turn, 1, 2) @ turns.exp(v + step)[0])
    np.testing.assert_allclose(ahead, (jacobian @ step[..., None])[..., 0], atol=1e-10)


@pytest.mark.parametrize("axis", [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.6, 0, 0.8]])
def test_half_turns(axis):
    v = (np.pi - 1e-7) * np.array([axis], dtype=float)
    back, _ = turns.log(turns.exp(v)[0])
    np.testing.assert_allclose(back, v, atol=1e-6)


def test_body_below_a_turned_reference_moves_in_the_world(take):
    turn = rot.about_axis(0, np.float64(1.2))
    hung = below_a_reference(take, turn)
    free = freedom([], joint_ranges([hung]), reach=0.1)
    view = window(hung, 0, FRAMES, [hung.skeleton.index["LeftFoot"]])
    foot = hung.skeleton.index["LeftFoot"]
    still = Posed(view, free, np.zeros((FRAMES, 3))).point(foot, np.zeros(3))
    moved = Posed(view, free, np.tile([0.01, 0.0, 0.0], (FRAMES, 1))).point(foot, np.zeros(3))
    expected = 0.01 / np.sqrt(1.01)
    np.testing.assert_allclose(moved - still, [[expected, 0, 0]] * FRAMES, atol=1e-12)
