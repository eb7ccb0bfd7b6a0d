"""Paths at own rates, warping function, misalignment, slopes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mocapstudio.comparison import timing
from mocapstudio.comparison.resampling import lanczos

paths = st.lists(st.sampled_from([(1, 1), (1, 0), (0, 1)]), min_size=0, max_size=60)


def walked(steps: list[tuple[int, int]]) -> np.ndarray:
    return np.cumsum([(0, 0), *steps], axis=0).astype(np.int32)


@settings(max_examples=80)
@given(paths, st.integers(1, 300), st.integers(1, 300))
def test_a_path_at_other_rates_is_a_path(
    steps: list[tuple[int, int]], rows: int, columns: int
) -> None:
    path = walked(steps)
    own = timing.at_own_rates(
        path,
        np.linspace(0, rows - 1, path[-1, 0] + 1),
        np.linspace(0, columns - 1, path[-1, 1] + 1),
    )
    moves = np.diff(own, axis=0)
    assert set(map(tuple, moves.tolist())) <= {(1, 1), (1, 0), (0, 1)}
    if path[-1].all():
        assert own[0].tolist() == [0, 0]
        assert own[-1].tolist() == [rows - 1, columns - 1]


@settings(max_examples=60)
@given(paths)
def test_at_the_same_rate_a_path_stays_what_it_is(steps: list[tuple[int, int]]) -> None:
    path = walked(steps)
    rows, columns = path[-1] + 1
    own = timing.at_own_rates(path, np.arange(rows, dtype=float), np.arange(columns, dtype=float))
    np.testing.assert_array_equal(own, path)


@settings(max_examples=60)
@given(paths, st.booleans())
def test_the_warping_function_is_equation_1(steps: list[tuple[int, int]], rounded: bool) -> None:
    path = walked(steps)
    frames = int(path[-1, 1]) + 1
    found = timing.warping_function(path, frames, rounded=rounded)
    for frame in range(frames):
        mean = np.mean([i for i, j in path if j == frame])
        expected = np.floor(mean + 0.5) if rounded else mean
        assert found[frame] == pytest.approx(expected)


def test_misalignment_is_counted_in_seconds_and_goes_on_beyond_the_path() -> None:
    warp = np.array([np.nan, np.nan, 10.0, 12.0, 14.0, np.nan])
    gap = timing.misalignment(warp, (10.0, 5.0))
    # Source frame 2 is at 0.4 s and answers to 1.0 s of the reference.
    np.testing.assert_allclose(gap, [0.6, 0.6, 0.6, 0.6, 0.6, 0.6])
    back = timing.warp_of(gap, (10.0, 5.0), (0, 0), 100)
    np.testing.assert_allclose(back, [6, 8, 10, 12, 14, 16])
    np.testing.assert_allclose(timing.misalignment(warp, (10.0, 5.0), 2.0)[2:5], [0.2, 0.0, -0.2])


def test_slopes_within_the_tolerance_are_on_time() -> None:
    seconds = np.arange(300) / 30
    for slope, expected in ((0.0, 0), (0.1, 0), (0.5, 1), (-0.1, 0), (-0.5, -1)):
        found = timing.slopes(slope * seconds, 30, window=0.5, tolerance=0.1)
        assert (found[10:-10] == expected).all()


@settings(max_examples=30)
@given(st.integers(2, 200), st.integers(2, 200), st.floats(-5, 5), st.floats(-5, 5))
def test_lanczos_keeps_ends_and_bends_lines_by_little(
    frames: int, wanted: int, start: float, end: float
) -> None:
    line = np.linspace(start, end, frames)[:, None]
    found = lanczos(line, wanted)[:, 0]
    np.testing.assert_allclose(found[[0, -1]], [start, end], atol=1e-9)
    bend = 0.03 * abs(end - start) / (min(frames, wanted) - 1)
    np.testing.assert_allclose(found, np.linspace(start, end, wanted), atol=bend + 1e-9)


def test_lanczos_keeps_what_the_lower_rate_holds_and_drops_the_rest() -> None:
    time = np.arange(1001) / 100
    slow, fast = np.sin(2 * np.pi * 1.0 * time), np.sin(2 * np.pi * 40.0 * time)
    found = lanczos(np.stack([slow, fast], axis=1), 251)
    np.testing.assert_allclose(found[10:-10, 0], slow[::4][10:-10], atol=0.01)
    assert np.abs(found[10:-10, 1]).max() < 0.05


def test_lanczos_is_the_sum_of_its_definition() -> None:
    values = np.random.default_rng(0).normal(size=(60, 1))
    found = lanczos(values, 25)
    step = 59 / 24
    for k in (8, 12, 15):
        at = k * step
        near = np.arange(60)
        x = (near - at) / step
        weight = np.where(np.abs(x) < 3, np.sinc(x) * np.sinc(x / 3), 0)
        assert found[k, 0] == pytest.approx((weight * values[:, 0]).sum() / weight.sum())
