"""Alignment against definitions and other libraries."""

from __future__ import annotations

from unittest import mock

import naive_alignment as naive
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mocapstudio.motion.errors import ParameterError
from mocapstudio.motion.progress import run
from mocapstudio.similarity.alignment import dtw, kernels
from mocapstudio.similarity.alignment.costs import KnownCosts, PoseDistances, ReliableDistances
from mocapstudio.similarity.alignment.dtw import (
    CLOSED,
    Alignment,
    Ends,
    accumulated,
    align,
    align_in_band,
)
from mocapstudio.similarity.alignment.frugal import aligning_frugally

# Subsequence alignment: the whole reference somewhere in the source.
WITHIN_SOURCE = Ends("source", "source")
ENDS = [
    CLOSED,
    WITHIN_SOURCE,
    Ends("source", None),
    Ends(None, "source"),
    Ends("reference", "reference"),
    Ends("reference", "source"),
    Ends("source", "reference"),
]
# From a few rows at a time to all at once.
at_once = st.sampled_from([1, 200, dtw._CELLS])
sizes = st.tuples(st.integers(1, 40), st.integers(1, 40), st.integers(1, 7), st.integers(0, 999))


def wander(frames: int, dims: int, seed: int) -> np.ndarray:
    steps = np.random.default_rng(seed).normal(size=(frames, dims))
    return np.cumsum(steps, axis=0).astype(np.float32)


def pair(size: tuple[int, int, int, int]) -> tuple[np.ndarray, np.ndarray]:
    rows, columns, dims, seed = size
    return wander(rows, dims, seed), wander(columns, dims, seed + 1000)


def check_path(found: Alignment, shape: tuple[int, int], ends: Ends) -> None:
    steps = np.diff(found.path, axis=0)
    assert ((steps == 0) | (steps == 1)).all()
    assert (steps.sum(axis=1) > 0).all()
    first, last = found.path[0], found.path[-1]
    assert first[1] == 0 or ends.begin == "source"
    assert first[0] == 0 or ends.begin == "reference"
    assert last[1] == shape[1] - 1 or ends.end == "source"
    assert last[0] == shape[0] - 1 or ends.end == "reference"


@pytest.mark.parametrize(("rows", "columns"), [(1, 1), (1, 5), (4, 1), (3, 5), (5, 5)])
def test_the_oracle_knows_every_path(rows: int, columns: int) -> None:
    costs = np.random.default_rng(rows * columns).uniform(size=(rows, columns))
    every = [sum(costs[i, j] for i, j in path) for path in naive.paths(rows, columns)]
    assert naive.cheapest(costs) == pytest.approx(min(every))


@settings(max_examples=40)
@given(sizes)
def test_distances_are_those_of_the_definition(size: tuple[int, int, int, int]) -> None:
    reference, source = pair(size)
    out = np.empty((len(reference), len(source)), np.float32)
    PoseDistances(reference, source).fill(0, len(reference), out)
    np.testing.assert_allclose(out, naive.distances(reference, source), rtol=1e-5, atol=1e-5)


def test_distances_over_several_chunks_and_blocks_of_rows() -> None:
    reference, source = wander(150, 9, 1), wander(2 * kernels.CHUNK + 17, 9, 2)
    out = np.empty((150, len(source)), np.float32)
    PoseDistances(reference, source).fill(0, 150, out)
    np.testing.assert_allclose(out, naive.distances(reference, source), rtol=1e-5)


def test_equal_poses_cost_nothing() -> None:
    poses = wander(50, 6, 3) + 100
    found = align(PoseDistances(poses, poses))
    assert found.cost == 0.0
    np.testing.assert_array_equal(found.path[:, 0], found.path[:, 1])


@settings(max_examples=40)
@given(sizes, st.sampled_from(ENDS), at_once)
def test_the_accumulated_matrix_is_algorithm_1(
    size: tuple[int, int, int, int], ends: Ends, cells: int
) -> None:
    reference, source = pair(size)
    with mock.patch.object(dtw, "_CELLS", cells):
        blocks = accumulated(PoseDistances(reference, source), ends)
        found = np.concatenate([block.m.copy() for block in blocks])
    costs = naive.distances(reference, source)
    expected = naive.accumulated(costs, ends.begin == "reference", ends.begin == "source")
    np.testing.assert_allclose(found, expected, rtol=2e-5, atol=1e-4)


@settings(max_examples=60)
@given(sizes, st.sampled_from(ENDS), at_once)
def test_every_way_finds_a_cheapest_path(
    size: tuple[int, int, int, int], ends: Ends, cells: int
) -> None:
    costs = PoseDistances(*pair(size))
    expected = naive.cheapest(naive.distances(*pair(size)), ends.begin, ends.end)
    with mock.patch.object(dtw, "_CELLS", cells):
        every = (
            align(costs, ends),
            run(aligning_frugally(costs, ends, cells=30)),
            align_in_band(costs, 100, ends),
        )
    for found in every:
        check_path(found, costs.shape, ends)
        assert found.cost == pytest.approx(expected, rel=1e-4, abs=1e-4)


@settings(max_examples=60)
@given(sizes, st.sampled_from(ENDS), at_once)
def test_of_equally_cheap_steps_the_diagonal_one_is_taken(
    size: tuple[int, int, int, int], ends: Ends, cells: int
) -> None:
    rows, columns, most, seed = size
    # Small whole numbers: sums are exact, and ties abound.
    matrix = np.random.default_rng(seed).integers(0, most + 1, (rows, columns)).astype(np.float32)
    with mock.patch.object(dtw, "_CELLS", cells):
        found = align(KnownCosts(matrix), ends)
    assert found.path.tolist() == naive.path(matrix, ends.begin, ends.end)
    banded = align_in_band(KnownCosts(matrix), 100, ends)
    assert banded.path.tolist() == found.path.tolist()


@settings(max_examples=60)
@given(sizes, st.integers(0, 12), st.sampled_from(ENDS), st.booleans())
def test_a_band_forbids_what_lies_outside(
    size: tuple[int, int, int, int], band: int, ends: Ends, known: bool
) -> None:
    rows, columns = size[0], size[1]
    matrix = naive.distances(*pair(size))
    costs = KnownCosts(matrix.astype(np.float32)) if known else PoseDistances(*pair(size))
    slope = (columns - 1) / max(rows - 1, 1)
    half = max(band, int(np.ceil(slope)))
    off = np.arange(columns)[None] - np.round(np.arange(rows) * slope)[:, None]
    expected = naive.cheapest(matrix, ends.begin, ends.end, np.abs(off) <= half)
    if not np.isfinite(expected):
        with pytest.raises(ParameterError, match="band"):
            align_in_band(costs, band, ends)
        return
    found = align_in_band(costs, band, ends)
    check_path(found, costs.shape, ends)
    assert found.cost == pytest.approx(expected, rel=1e-4, abs=1e-4)


def test_a_subsequence_is_found_where_it_was_hidden() -> None:
    stream = wander(400, 5, 4)
    found = align(PoseDistances(stream[123:171], stream), WITHIN_SOURCE)
    assert found.path[0].tolist() == [0, 123]
    assert found.path[-1].tolist() == [47, 170]
    assert found.cost == 0.0


def test_the_frugal_way_holds_only_the_cells_it_may(monkeypatch: pytest.MonkeyPatch) -> None:
    largest = 0

    class Watched(PoseDistances):
        def fill(self, start: int, end: int, out: np.ndarray) -> None:
            nonlocal largest
            base = out if out.base is None else out.base
            largest = max(largest, base.size)
            super().fill(start, end, out)

        def part(self, rows: slice, columns: slice) -> Watched:
            return Watched(self.reference[rows], self.source[columns])

    monkeypatch.setattr(dtw, "_CELLS", 40_000)
    costs = Watched(wander(700, 4, 5), wander(900, 4, 6))
    found = run(aligning_frugally(costs, cells=20_000))
    assert found.cost == pytest.approx(align(PoseDistances(costs.reference, costs.source)).cost)
    assert largest <= 3 * 40_000 < 700 * 900 / 4


@settings(max_examples=30)
@given(sizes)
def test_unreliable_rows_do_not_count(size: tuple[int, int, int, int]) -> None:
    rows, columns, count, seed = size
    rng = np.random.default_rng(seed)
    one, other = rng.normal(size=(rows, count, 3)), rng.normal(size=(columns, count, 3))
    a, b = (rng.random((n, count)) > 0.3 for n in (rows, columns))
    out = np.empty((rows, columns), np.float32)
    costs = ReliableDistances(one, other, a.astype(float), b.astype(float))
    costs.fill(0, rows, out)
    both = a[:, None] & b[None]
    squares = ((one[:, None] - other[None]) ** 2).sum(axis=3)
    known = both.sum(axis=2)
    seen = known > 0
    expected = np.sqrt((squares * both).sum(axis=2) * count / np.maximum(known, 1))
    np.testing.assert_allclose(out[seen], expected[seen], rtol=1e-4, atol=1e-4)
    low = np.arange(rows, dtype=np.int32) - 3
    banded = np.empty((rows, 7), np.float32)
    costs.fill_within(low, banded)
    for i, j in np.ndindex(rows, columns):
        if seen[i, j] and 0 <= j - low[i] < 7:
            assert banded[i, j - low[i]] == pytest.approx(out[i, j], rel=1e-4, abs=1e-4)
    path = np.argwhere(seen).astype(np.int32)
    if len(path):
        np.testing.assert_allclose(costs.pairs(path), out[seen], rtol=1e-4, atol=1e-4)


@pytest.mark.parametrize(
    ("reference", "source", "what"),
    [
        (np.zeros((0, 3)), np.zeros((4, 3)), "empty"),
        (np.zeros((4, 3)), np.zeros((4, 2)), "dimension"),
    ],
)
def test_what_cannot_be_aligned_is_refused(
    reference: np.ndarray, source: np.ndarray, what: str
) -> None:
    with pytest.raises(ParameterError, match=what):
        PoseDistances(reference, source)
