"""Constrained open-end DTW against all admissible paths (appendix of paper 1)."""

from __future__ import annotations

import naive
import numpy as np
import pytest

from mocapstudio.similarity import kernels


def run(distances: np.ndarray, m: int) -> tuple[np.ndarray, np.ndarray]:
    words = distances.shape[1] - m + 1
    out = np.full(words, np.nan, dtype=np.float32)
    ends = np.full((2, words), -1, dtype=np.int16)
    kernels.dtw_word(np.asarray(distances, dtype=np.float32), m, out, ends)
    return out, ends


def random(n: int, frames: int, seed: int) -> np.ndarray:
    """Costs without structure: no two paths cost the same."""
    return np.random.default_rng(seed).uniform(0.01, 1.0, (n, frames)).astype(np.float32)


def ridges(n: int, frames: int, seed: int, pace: float) -> np.ndarray:
    """Costs with a cheap valley wherever the source is met at another pace."""
    rng = np.random.default_rng(seed)
    source = np.cumsum(rng.normal(size=n + 1))[:n]
    beat = np.interp(np.arange(frames) * pace % (n - 1), np.arange(n), source)
    noise = rng.uniform(0.001, 0.01, (n, frames))
    return ((source[:, None] - beat[None]) ** 2 + noise).astype(np.float32)


def check(distances: np.ndarray, m: int) -> None:
    """The kernel's path is one of the cheapest: same cost, and its mean and end are those of it."""
    mean, ends = run(distances, m)
    oracle = naive.WarpingCosts(distances.astype(float), m)
    best = oracle.best()
    expected, expected_ends = oracle.means()
    np.testing.assert_allclose(mean, expected, rtol=2e-5)
    for t, (i, j) in enumerate(ends.T):
        # Where two ends are equally cheap but for rounding, either will do.
        assert oracle.cost[i - 1, j - 1][:, t].min() <= best[t] * (1 + 1e-5)
    assert np.mean(ends == expected_ends) > 0.99


@pytest.mark.parametrize(("n", "m"), [(4, 4), (4, 5), (4, 7), (5, 5), (5, 6)])
def test_the_oracle_knows_every_path(n: int, m: int) -> None:
    distances = random(n, m, n * m).astype(float)
    costs = [sum(distances[i, j] for i, j in path) for path in naive.paths(n, m)]
    path = min(naive.paths(n, m), key=lambda p: sum(distances[i, j] for i, j in p))
    oracle = naive.WarpingCosts(distances, m)
    mean, ends = oracle.means()
    assert oracle.best()[0] == pytest.approx(min(costs))
    assert mean[0] == pytest.approx(min(costs) / len(path))
    assert tuple(ends[:, 0]) == (path[-1][0] + 1, path[-1][1] + 1)


@pytest.mark.parametrize("n", range(4, 16))
@pytest.mark.parametrize("more", [0, 1, 3, 5])
def test_random_costs(n: int, more: int) -> None:
    m = n + more
    check(random(n, m + 60 + n, 100 * n + more), m)


@pytest.mark.parametrize(("n", "m"), [(4, 30), (15, 20), (15, 40), (6, 13)])
@pytest.mark.parametrize("pace", [0.4, 0.7, 1.0, 1.6, 2.5])
def test_costs_of_other_paces(n: int, m: int, pace: float) -> None:
    check(ridges(n, m + 90, n + m, pace), m)


@pytest.mark.parametrize("words", [1, 2, 127, 128, 129, 256, 300])
def test_every_number_of_words(words: int) -> None:
    distances = random(15, words + 19, words)
    check(distances, 20)
    # A word's distance does not depend on what lies around it.
    for at in {0, words // 2, words - 1}:
        alone = run(distances[:, at : at + 20], 20)
        whole = run(distances, 20)
        assert alone[0][0] == whole[0][at]
        np.testing.assert_array_equal(alone[1][:, 0], whole[1][:, at])


def test_the_same_motion_costs_nothing_along_the_diagonal() -> None:
    distances = np.abs(np.subtract.outer(np.arange(15.0), np.arange(20.0))).astype(np.float32)
    mean, ends = run(distances, 20)
    assert mean[0] == 0.0
    assert tuple(ends[:, 0]) == (15, 15)


def test_a_pace_beyond_the_slope_limit_is_not_followed() -> None:
    """At most three frames of one word go with one of the other; a fifth of the pace is less."""
    slow = np.abs(np.subtract.outer(np.arange(5.0), np.arange(25.0) / 5.0)).astype(np.float32)
    mean, ends = run(slow, 25)
    within = np.abs(np.subtract.outer(np.arange(5.0), np.arange(25.0) / 3.0)).astype(np.float32)
    assert mean[0] > run(within, 25)[0][0]
    assert ends[1, 0] <= 3 * 5


@pytest.mark.parametrize(("n", "m", "frames"), [(4, 4, 20), (15, 20, 140), (9, 13, 300)])
def test_nothing_outside_the_arrays_is_read_or_written(n: int, m: int, frames: int) -> None:
    distances = random(n, frames, 5)
    room = np.full((n + 8, frames + 400), np.nan, dtype=np.float32)
    view = room[4 : n + 4, 200 : frames + 200]
    view[:] = distances
    words = frames - m + 1
    out = np.full(words + 400, 77.0, dtype=np.float32)
    ends = np.full((4, words + 400), 77, dtype=np.int16)
    kernels.dtw_word(view, m, out[200 : words + 200], ends[1:3, 200 : words + 200])
    mean, expected = run(distances, m)
    np.testing.assert_array_equal(out[200 : words + 200], mean)
    np.testing.assert_array_equal(ends[1:3, 200 : words + 200], expected)
    out[200 : words + 200] = 77.0
    ends[1:3, 200 : words + 200] = 77
    assert np.all(out == 77.0)
    assert np.all(ends == 77)
