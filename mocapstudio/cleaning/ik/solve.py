"""Damped least squares over a window of frames (Levenberg-Marquardt).

Unknowns of one frame meet those of other frames only through differences in time, so the normal
matrix is banded: one Cholesky factorisation costs as much time as there are frames. Damping after
Marquardt, with Nielsen's rule (Madsen, Nielsen and Tingleff, *Methods for Non-Linear Least Squares
Problems*, 2004, algorithm 3.16).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import LinAlgError, cho_solve_banded, cholesky_banded
from threadpoolctl import ThreadpoolController

from mocapstudio.cleaning.ik import kernels
from mocapstudio.cleaning.ik.freedom import Freedom
from mocapstudio.cleaning.ik.objectives.rows import Objective, Rows, TimeObjective
from mocapstudio.cleaning.ik.posed import Posed, Window

Array = NDArray[np.float64]

_FIRST_DAMPING = 1e-6
_BLAS = ThreadpoolController()
"""Knows scipy's libraries, which are loaded by now; asking for them anew takes milliseconds."""


@dataclass(frozen=True, eq=False)
class Problem:
    """What is wanted of a window.

    Parameters
    ----------
    window
        F frames of the motion as it was.
    freedom
        n unknowns a frame.
    objectives
        Wishes on single frames.
    over_time
        Wishes on the unknowns over time.
    """

    window: Window
    freedom: Freedom
    objectives: Sequence[Objective]
    over_time: Sequence[TimeObjective]

    def posed(self, unknowns: Array) -> Posed:
        """Pose the window's body."""
        return Posed(self.window, self.freedom, unknowns)


@dataclass(frozen=True, eq=False)
class Solution:
    """Where the search ended.

    Attributes
    ----------
    unknowns
        (F, n).
    cost
        Half the sum of squares.
    steps
        How many linear systems were solved.
    settled
        Whether the cost had stopped falling.
    """

    unknowns: Array
    cost: float
    steps: int
    settled: bool


def cost(problem: Problem, unknowns: Array) -> float:
    """Half the sum of squared residuals."""
    return _cost(problem, unknowns, _rows(problem, unknowns))


def gradient(problem: Problem, unknowns: Array) -> Array:
    """(F, n): derivative of `cost` by the unknowns."""
    rows = _rows(problem, unknowns)
    return _normal(problem, _time_band(problem), unknowns, rows)[1]


def solve(
    problem: Problem,
    start: Array | None = None,
    most_steps: int = 30,
    tolerance: float = 1e-5,
    smallest: float = 0.0,
) -> Solution:
    """Minimise the sum of squares.

    Parameters
    ----------
    problem
        F frames, n unknowns each.
    start
        (F, n) first guess: warm start; by default the motion as it was.
    most_steps
        Bound on the linear systems solved.
    tolerance
        Relative fall of the cost below which it is settled.
    smallest
        Radians and metres: a step in which no unknown changes by more is the last.
    """
    frames, size = problem.window.frames, problem.freedom.size
    unknowns = np.zeros((frames, size)) if start is None else start
    rows = _rows(problem, unknowns)
    now = _cost(problem, unknowns, rows)
    if size == 0:
        return Solution(unknowns, now, 0, True)
    fixed = _time_band(problem)
    damping, growth = _FIRST_DAMPING, 2.0
    band, slope = _normal(problem, fixed, unknowns, rows)
    for step in range(1, most_steps + 1):
        # Blocks are small: threads waiting for each other are slow where others want the cores.
        with _BLAS.limit(limits=1, user_api="blas"):
            move = _damped_step(band, slope, damping)
        if move is None:
            damping, growth = damping * growth, growth * 2
            continue
        expected = 0.5 * float(np.sum(move * (damping * band[:, :, 0] * move - slope)))
        rows = _rows(problem, unknowns + move)
        fall = now - _cost(problem, unknowns + move, rows)
        if fall < 0 and expected > tolerance * now:
            damping, growth = max(damping, 1e-6) * growth, growth * 2
            continue
        if fall < 0:
            return Solution(unknowns, now, step, True)
        unknowns, now = unknowns + move, now - fall
        if fall <= tolerance * now or np.abs(move).max() <= smallest:
            return Solution(unknowns, now, step, True)
        damping *= max(1.0 / 3.0, 1.0 - (2.0 * fall / expected - 1.0) ** 3)
        growth = 2.0
        band, slope = _normal(problem, fixed, unknowns, rows)
    return Solution(unknowns, now, most_steps, False)


def _rows(problem: Problem, unknowns: Array) -> list[Rows]:
    posed = problem.posed(unknowns)
    return [one.rows(posed) for one in problem.objectives]


def _cost(problem: Problem, unknowns: Array, rows: Sequence[Rows]) -> float:
    total = sum(float(np.sum(one.residual**2)) for one in rows)
    for wish in problem.over_time:
        total += float(np.sum(_differences(wish, unknowns) ** 2))
    return 0.5 * total


def _differences(wish: TimeObjective, unknowns: Array) -> Array:
    """(F + k, n) weighted residuals of one wish over time."""
    away = unknowns if wish.reference is None else unknowns - wish.reference
    order = len(wish.difference) - 1
    padded = np.pad(away, ((order, order), (0, 0)))
    rows = len(away) + order
    total = sum(wish.difference[i][:, None] * padded[i : i + rows] for i in range(order + 1))
    return np.asarray(total * wish.weights)


def _time_gradient(wish: TimeObjective, unknowns: Array) -> Array:
    residual = _differences(wish, unknowns) * wish.weights
    frames = len(unknowns)
    order = len(wish.difference) - 1
    # Row j of the residual weighs frame j - k + i by difference[i, j].
    total = np.zeros_like(unknowns)
    for i in range(order + 1):
        at = slice(order - i, order - i + frames)
        total += wish.difference[i, at, None] * residual[at]
    return total


def _time_band(problem: Problem) -> Array:
    """(F, n, b) lower band of what wishes over time add: it never changes.

    Element (f, i, k) is row ``i + k`` of column i of frame f, counted on into later frames.
    """
    frames, size = problem.window.frames, problem.freedom.size
    most = max((len(wish.difference) - 1 for wish in problem.over_time), default=0)
    band = np.zeros((frames, size, max(most * size, size - 1) + 1))
    for wish in problem.over_time:
        d = wish.difference
        order = len(d) - 1
        for apart in range(order + 1):
            gram = np.zeros(frames)
            for i in range(order + 1 - apart):
                at = slice(order - i, order - i + frames)
                gram += d[i, at] * d[i + apart, at]
            gram[frames - apart :] = 0.0
            band[:, :, apart * size] += gram[:, None] * wish.weights**2
    return band


def _normal(
    problem: Problem, fixed: Array, unknowns: Array, rows: Sequence[Rows]
) -> tuple[Array, Array]:
    """Lower band of the normal matrix (F, n, b), and the gradient (F, n)."""
    slope = np.zeros_like(unknowns)
    band = fixed.copy()
    for wish in problem.over_time:
        slope += _time_gradient(wish, unknowns)
    for one in rows:
        kernels.add_squares(one.frames, one.residual, one.jacobian, slope, band)
    return band, slope


def _damped_step(band: Array, slope: Array, damping: float) -> Array | None:
    system = band.reshape(slope.size, -1).copy()
    system[:, 0] *= 1.0 + damping
    try:
        # Transposed it is laid out as LAPACK wants it, so that nothing is copied again.
        factor = cholesky_banded(system.T, overwrite_ab=True, lower=True, check_finite=False)
    except LinAlgError:
        return None
    step = cho_solve_banded((factor, True), -slope.ravel(), check_finite=False)
    return np.asarray(step.reshape(slope.shape))
