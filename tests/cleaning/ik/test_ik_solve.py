"""The banded solver against an independent one on the same problem."""

from __future__ import annotations

import naive_ik
import numpy as np
import pytest
from made_takes import walking
from scipy.optimize import least_squares

from mocapstudio.cleaning.ik.freedom import freedom
from mocapstudio.cleaning.ik.limits import RangeLimit
from mocapstudio.cleaning.ik.objectives.orientation import Orientation
from mocapstudio.cleaning.ik.objectives.over_time import KeepPose, Smoothness
from mocapstudio.cleaning.ik.objectives.position import PointAtTarget
from mocapstudio.cleaning.ik.posed import Posed, window
from mocapstudio.cleaning.ik.ranges import joint_ranges
from mocapstudio.cleaning.ik.solve import Problem, cost, solve

FRAMES = 3


@pytest.fixture(scope="module")
def short():
    walk = walking(2.0)
    return walk.with_motion(walk.rotations[10 : 10 + FRAMES], walk.translations[10 : 10 + FRAMES])


@pytest.mark.parametrize("away", [0.02, 0.6])
def test_same_minimum_as_scipy_with_numeric_jacobian(short, away):
    """Within reach and out of it; residuals of the oracle are computed by definition."""
    skeleton = short.skeleton
    joints = [skeleton.index[n] for n in ("LeftUpLeg", "LeftLeg", "LeftFoot")]
    foot = joints[-1]
    free = freedom(joints, joint_ranges([walking(2.0)]), reach=0.05)
    view = window(short, 0, FRAMES, joints)
    asis = Posed(view, free, np.zeros((FRAMES, free.size)))
    offset = np.array([0.0, -0.05, 0.1])
    frames = np.array([0, 1, 2])
    target = asis.point(foot, offset, frames)[[0] * 3] + np.array([away, -0.01, 0.0])
    turned = asis.rotations[:, asis.at(foot)].copy()
    weights = np.full(free.size, 0.8)
    problem = Problem(
        view,
        free,
        [
            PointAtTarget(foot, offset, frames, target, 20.0, np.eye(3)),
            Orientation(foot, np.arange(FRAMES), turned, np.full(FRAMES, 0.5)),
        ],
        [KeepPose(FRAMES, free.stiffness), Smoothness(FRAMES, weights, 2)],
    )

    def residual(flat: np.ndarray) -> np.ndarray:
        unknowns = flat.reshape(FRAMES, -1)
        at = dict(zip(frames.tolist(), target, strict=True))
        return np.concatenate(
            [
                naive_ik.point_residual(short, free, unknowns, foot, offset, at, 20.0),
                naive_ik.orientation_residual(
                    short, free, unknowns, foot, dict(enumerate(turned)), 0.5
                ),
                (unknowns * free.stiffness).ravel(),
                naive_ik.smoothness_residual(unknowns, weights, 2),
            ]
        )

    start = np.zeros(FRAMES * free.size)
    assert cost(problem, start.reshape(FRAMES, -1)) == pytest.approx(
        0.5 * np.sum(residual(start) ** 2)
    )
    solution = solve(problem)
    oracle = least_squares(residual, start, max_nfev=40)
    assert oracle.success
    assert solution.settled
    assert solution.cost == pytest.approx(0.5 * np.sum(residual(solution.unknowns.ravel()) ** 2))
    assert solution.cost == pytest.approx(oracle.cost, rel=0.01)


def test_a_warm_start_at_the_solution_ends_at_once(short):
    joints = [short.skeleton.index["LeftLeg"]]
    foot = short.skeleton.index["LeftFoot"]
    free = freedom(joints, joint_ranges([walking(2.0)]))
    view = window(short, 0, FRAMES, [foot])
    target = np.zeros((FRAMES, 3))
    wishes = [PointAtTarget(foot, np.zeros(3), np.arange(FRAMES), target, 1.0, np.eye(3))]
    problem = Problem(view, free, wishes, [KeepPose(FRAMES, free.stiffness)])
    first = solve(problem)
    again = solve(problem, first.unknowns)
    assert again.steps <= 2
    assert again.cost <= first.cost


def test_nothing_free_is_solved_by_nothing(short):
    free = freedom([], joint_ranges([walking(2.0)]))
    view = window(short, 0, FRAMES, [0])
    solution = solve(Problem(view, free, [], []))
    assert solution.settled
    assert solution.unknowns.shape == (FRAMES, 0)


def test_a_hard_range_keeps_the_knee(short):
    """Pulled far behind the back, the knee stops at its bound; a soft range gives way."""
    skeleton = short.skeleton
    knee, foot = skeleton.index["LeftLeg"], skeleton.index["LeftFoot"]
    ranges = joint_ranges([walking(2.0)])
    free = freedom([knee], ranges)
    view = window(short, 0, FRAMES, [foot])
    at = Posed(view, free, np.zeros((FRAMES, 3))).positions[:, 0]
    pull = PointAtTarget(foot, np.zeros(3), np.arange(FRAMES), at, 5.0, np.eye(3))

    def excess(weight: float) -> float:
        bound = RangeLimit(
            knee, ranges.mean[knee], ranges.axes[knee], ranges.low[knee], ranges.high[knee], weight
        )
        problem = Problem(view, free, [pull, bound], [KeepPose(FRAMES, free.stiffness)])
        solution = solve(problem)
        rows = bound.rows(problem.posed(solution.unknowns))
        return float(np.abs(rows.residual).max(initial=0.0)) / weight

    assert np.degrees(excess(1.0)) > 10
    assert np.degrees(excess(1e3)) < 0.05
