"""The solver on random chains, some of whose bones have no length, against an independent one."""

from __future__ import annotations

from fractions import Fraction

import naive_ik
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_takes import build
from scipy.optimize import least_squares

from mocapstudio.cleaning.ik.freedom import freedom
from mocapstudio.cleaning.ik.objectives.orientation import Orientation
from mocapstudio.cleaning.ik.objectives.over_time import KeepPose, Smoothness
from mocapstudio.cleaning.ik.objectives.position import PointAtTarget
from mocapstudio.cleaning.ik.posed import Posed, window
from mocapstudio.cleaning.ik.ranges import joint_ranges
from mocapstudio.cleaning.ik.solve import Problem, cost, gradient, solve
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.take import Take

FRAMES, WEIGHT, TURN = 2, 20.0, 0.5


class Chained:
    """A chain of up to five joints in random poses, its tip drawn to a target in every frame."""

    def __init__(self, lengths: list[float], seed: int, far: float) -> None:
        rng = np.random.default_rng(seed)
        names = [f"j{i}" for i in range(len(lengths) + 1)]
        bones = [(names[0], "", (0.0, 0.0, 0.0))]
        for i, length in enumerate(lengths):
            way = rng.normal(size=3)
            way *= length / np.linalg.norm(way)
            bones.append((names[i + 1], names[i], tuple(way.tolist())))
        pose = rot.from_rotation_vector(rng.normal(size=(FRAMES, len(names), 3)) * 0.5)
        root = rng.normal(size=(FRAMES, 1, 3)) * 0.1
        self.take = Take("chain", build(bones), rot.continuous(pose), root, Fraction(30))
        self.tip = len(names) - 1
        self.offset = rng.normal(size=3) * 0.05
        self.free = freedom(range(len(names)), joint_ranges([self.take]), reach=0.05)
        view = window(self.take, 0, FRAMES, range(len(names)))
        asis = Posed(view, self.free, np.zeros((FRAMES, self.free.size)))
        frames = np.arange(FRAMES)
        self.target = asis.point(self.tip, self.offset, frames) + far * rng.normal(size=(FRAMES, 3))
        self.turned = asis.rotations[:, asis.at(self.tip)].copy()
        self.smooth = np.full(self.free.size, 0.8)
        self.problem = Problem(
            view,
            self.free,
            [
                PointAtTarget(self.tip, self.offset, frames, self.target, WEIGHT, np.eye(3)),
                Orientation(self.tip, frames, self.turned, np.full(FRAMES, TURN)),
            ],
            [
                KeepPose(FRAMES, self.free.stiffness),
                Smoothness(FRAMES, self.smooth, 2),
            ],
        )

    def residual(self, flat: np.ndarray) -> np.ndarray:
        unknowns = flat.reshape(FRAMES, -1)
        where = (self.take, self.free, unknowns, self.tip)
        return np.concatenate(
            [
                naive_ik.point_residual(*where, self.offset, dict(enumerate(self.target)), WEIGHT),
                naive_ik.orientation_residual(*where, dict(enumerate(self.turned)), TURN),
                (unknowns * self.free.stiffness).ravel(),
                naive_ik.smoothness_residual(unknowns, self.smooth, 2),
            ]
        )


chains = st.builds(
    Chained,
    st.lists(st.sampled_from([0.0, 0.0, 0.1, 0.4]), min_size=1, max_size=4),
    st.integers(0, 2**32 - 1),
    st.sampled_from([0.01, 0.1]),
)


@settings(max_examples=8, deadline=None)
@given(chains, st.integers(0, 2**32 - 1))
def test_cost_and_gradient_by_definition(chained: Chained, seed: int) -> None:
    rng = np.random.default_rng(seed)
    unknowns = rng.normal(size=(FRAMES, chained.free.size)) * 0.3
    defined = 0.5 * np.sum(chained.residual(unknowns.ravel()) ** 2)
    assert cost(chained.problem, unknowns) == pytest.approx(defined, rel=1e-9)
    direction = rng.normal(size=unknowns.shape)
    step = 1e-5
    ahead, behind = (
        0.5 * np.sum(chained.residual((unknowns + s * step * direction).ravel()) ** 2)
        for s in (1, -1)
    )
    slope = np.sum(gradient(chained.problem, unknowns) * direction)
    assert slope == pytest.approx((ahead - behind) / (2 * step), rel=1e-5, abs=1e-5)


@settings(max_examples=4, deadline=None)
@given(chains)
def test_same_minimum_as_an_independent_solver(chained: Chained) -> None:
    """Within a percent of scipy's least squares with numeric derivatives."""
    solution = solve(chained.problem)
    oracle = least_squares(chained.residual, np.zeros(FRAMES * chained.free.size), max_nfev=60)
    assert solution.cost == pytest.approx(
        0.5 * np.sum(chained.residual(solution.unknowns.ravel()) ** 2)
    )
    assert solution.cost <= 1.01 * oracle.cost + 1e-12
