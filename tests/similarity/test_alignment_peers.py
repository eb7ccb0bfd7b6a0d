"""Alignment against other libraries, where they compute the same."""

from __future__ import annotations

import naive_alignment as naive
import numpy as np
import pytest

from mocapstudio.evaluation.kata_peers import dtaidistance, dtw_python
from mocapstudio.motion.progress import run
from mocapstudio.similarity.alignment.costs import KnownCosts, PoseDistances
from mocapstudio.similarity.alignment.dtw import (
    Ends,
    accumulated,
    align,
    align_in_band,
)
from mocapstudio.similarity.alignment.frugal import aligning_frugally

WHY = "pip install mocapstudio[peers]"


def wander(frames: int, dims: int, seed: int) -> np.ndarray:
    return np.cumsum(np.random.default_rng(seed).normal(size=(frames, dims)), axis=0)


def squares(reference: np.ndarray, source: np.ndarray) -> KnownCosts:
    return KnownCosts((naive.distances(reference, source) ** 2).astype(np.float32))


def whole(costs: KnownCosts, ends: Ends) -> np.ndarray:
    return np.concatenate([block.m.copy() for block in accumulated(costs, ends)])


def test_cost_and_path_are_those_of_dtw_python() -> None:
    pytest.importorskip("dtw", reason=WHY)
    reference, source = (wander(n, 12, n).astype(np.float32) for n in (90, 120))
    cost, path = dtw_python(reference.astype(float), source.astype(float))
    costs = PoseDistances(reference, source)
    for found in (align(costs), run(aligning_frugally(costs, cells=500))):
        assert found.cost == pytest.approx(cost, rel=1e-5)
        np.testing.assert_array_equal(found.path, path)


@pytest.mark.parametrize("band", [2, 5, 11])
def test_a_band_is_that_of_dtw_python(band: int) -> None:
    dtw = pytest.importorskip("dtw", reason=WHY)
    matrix = np.random.default_rng(band).random((40, 40))
    limits = {"window_type": "sakoechiba", "window_args": {"window_size": band}}
    peer = dtw.dtw(matrix, step_pattern="symmetric1", **limits)
    found = align_in_band(KnownCosts(matrix.astype(np.float32)), band)
    assert found.cost == pytest.approx(peer.distance, rel=1e-5)
    np.testing.assert_array_equal(found.path, np.stack([peer.index1, peer.index2], axis=1))


@pytest.mark.parametrize("end", ["reference", "source"])
def test_an_open_end_lies_where_dtw_python_accumulates_least(end: str) -> None:
    dtw = pytest.importorskip("dtw", reason=WHY)
    matrix = np.random.default_rng(3).random((50, 70))
    peer = dtw.dtw(matrix, step_pattern="symmetric1", keep_internals=True).costMatrix
    edge = peer[:, -1] if end == "reference" else peer[-1]
    found = align(KnownCosts(matrix.astype(np.float32)), Ends(None, end))
    assert found.path[-1, 0 if end == "reference" else 1] == np.argmin(edge)
    assert found.cost == pytest.approx(edge.min(), rel=1e-5)


def test_squared_costs_are_those_of_dtaidistance() -> None:
    pytest.importorskip("dtaidistance", reason=WHY)
    reference, source = wander(60, 4, 11), wander(80, 4, 12)
    cost, _ = dtaidistance(reference, source)
    assert np.sqrt(align(squares(reference, source)).cost) == pytest.approx(cost, rel=1e-5)


@pytest.mark.parametrize("band", [2, 6])
def test_a_band_is_that_of_dtaidistance(band: int) -> None:
    peer = pytest.importorskip("dtaidistance.dtw", reason=WHY)
    reference, source = wander(50, 1, 1), wander(50, 1, 2)
    # Its window counts the diagonal too.
    cost = peer.distance(reference[:, 0], source[:, 0], window=band + 1)
    found = align_in_band(squares(reference, source), band)
    assert np.sqrt(found.cost) == pytest.approx(cost, rel=1e-5)


def test_a_subsequence_is_that_of_dtaidistance() -> None:
    peer = pytest.importorskip("dtaidistance.subsequence.dtw", reason=WHY)
    query, series = wander(20, 1, 0), wander(150, 1, 1)
    found = peer.subsequence_alignment(query[:, 0], series[:, 0], penalty=0.0)
    costs = squares(query, series)
    ours = np.sqrt(whole(costs, Ends("source", "source"))[-1]) / len(query)
    np.testing.assert_allclose(ours, found.matching, rtol=1e-5)
    path = align(costs, Ends("source", "source")).path
    assert [path[0, 1], path[-1, 1]] == list(found.best_match().segment)
