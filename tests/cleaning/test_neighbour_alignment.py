"""The path behind a neighbour's distance."""

from __future__ import annotations

import naive
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_takes import turned

from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.distance_profile import distance_profile
from mocapstudio.cleaning.neighbour_alignment import arrivals, neighbour_alignment, traced
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.progress import run


@settings(max_examples=30, deadline=None)
@given(st.integers(4, 6), st.integers(4, 6), st.integers(0, 999))
def test_paths_are_the_cheapest_that_are_allowed(rows: int, columns: int, seed: int) -> None:
    distances = np.random.default_rng(seed).uniform(0.1, 1, (rows, columns)).astype(np.float32)
    ways: dict[tuple[int, int], list[tuple[float, list[tuple[int, int]]]]] = {}
    for path in naive.paths(rows, columns):
        cost = float(sum(distances[cell] for cell in path))
        ways.setdefault(path[-1], []).append((cost, path))
    arrived = arrivals(distances)
    for end, known in ways.items():
        cost, path = min(known)
        found = traced(distances, arrived, end)
        assert float(distances[tuple(found.T)].sum()) == pytest.approx(cost, rel=1e-5)
        assert [tuple(cell) for cell in found.tolist()] == path


def test_the_path_costs_what_the_neighbour_is_said_to(take, context) -> None:
    bad = turned(take, "LeftArm", 120, 150, 60)
    analysis = run(detect(bad, context))
    flag = next(one for one in analysis.flags if "LeftArm" in one.joints)
    profile = distance_profile(analysis, flag)
    assert profile is not None
    assert len(profile.minima) > 1
    for which, at in enumerate(profile.minima):
        found = neighbour_alignment(analysis, flag, profile, which)
        on_path = found.distances[tuple(found.path.T)]
        degrees = float(np.sqrt(np.mean(on_path**2)))
        assert degrees == pytest.approx(float(profile.degrees[at]), rel=1e-3, abs=1e-3)
        assert found.path[-1].tolist() == [int(one) - 1 for one in profile.ends[:, at]]
        first = found.own[0] + found.flagged[0] * found.own[1]
        assert first <= flag.start + 1
    with pytest.raises(MocapError, match="no neighbour"):
        neighbour_alignment(analysis, flag, profile, len(profile.minima))
