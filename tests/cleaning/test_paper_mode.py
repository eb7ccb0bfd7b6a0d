"""The paper's literal mode against an oracle written from its equations."""

from __future__ import annotations

import numpy as np
import paper_oracle
import pytest
from made_takes import turned, walking

from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.mean_texture import paper_map
from mocapstudio.cleaning.parameters import PAPER, DetectionParameters
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take


@pytest.mark.parametrize("others", [0, 1])
def test_the_map_is_the_papers(others: int) -> None:
    take = turned(walking(2.9, rate=24, seed=0, variation=0.3), "LeftArm", 30, 40, 35)
    context: list[Take] = [walking(2.2, rate=24, seed=1, variation=0.3)][:others]
    found = run(detect(take, context, DetectionParameters(mode=PAPER)))
    assert found.map.rows == (*take.skeleton.names, *ROOT_ROWS)
    joints = len(take.skeleton)
    away = paper_oracle.departures(take, context)
    np.testing.assert_allclose(
        found.map.residuals[:, :joints], np.rad2deg(away), atol=0.05, rtol=1e-3
    )
    expected = paper_oracle.literal_map(away)
    np.testing.assert_allclose(found.map.values[:, :joints], expected, atol=1e-3)
    # The paper's map has no root rows, no pops and no calibration.
    assert np.all(found.map.values[:, joints:] == 0.0)


def test_its_threshold_lies_at_a_fixed_share_of_the_rows_mean() -> None:
    """`1 - exp(-M^2) > 0.5` is `M > sqrt(ln 2)`: why the literal map flags half of a clean take."""
    departures = np.linspace(0.01, 1.0, 50, dtype=np.float32)[:, None]
    values = paper_map(departures)
    above = departures[:, 0] / departures.mean() > np.sqrt(np.log(2.0))
    np.testing.assert_array_equal(values[:, 0] > 0.5, above)


def test_a_row_that_never_departs_is_zero() -> None:
    values = paper_map(np.zeros((20, 3), dtype=np.float32))
    np.testing.assert_array_equal(values, 0.0)
