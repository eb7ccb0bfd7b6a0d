"""Performances of which the true timing is known, and what is measured on them."""

from __future__ import annotations

import numpy as np
import pytest
from made_takes import walking

from mocapstudio.comparison.model import Segment
from mocapstudio.comparison.segments import boundary_errors
from mocapstudio.evaluation.kata_benchmark import (
    BoundaryRow,
    PeerRow,
    WarpRow,
    kata_speed,
    kata_tables,
)
from mocapstudio.evaluation.kata_peers import peers
from mocapstudio.evaluation.kata_warps import Disturbance, perform_again
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.progress import run


def test_without_disturbance_the_pace_alone_differs() -> None:
    take = walking(8.0)
    how = Disturbance(pace=1.5, pauses=0, noise_degrees=0, style_degrees=0)
    again = perform_again(take, how, 1)
    steps = np.diff(again.truth)
    assert steps.min() >= 1 / 1.5 - 1e-9
    assert steps.max() <= 1.5 + 1e-9
    assert steps.std() > 0.05
    assert again.truth[0] == 0
    assert again.truth[-1] > take.frames - 3
    low = again.truth.astype(int)
    expected = rot.slerp(
        take.rotations[low],
        take.rotations[np.minimum(low + 1, take.frames - 1)],
        (again.truth - low)[:, None],
    )
    assert np.degrees(rot.angle(again.take.rotations, expected)).max() < 1e-4


def test_pauses_hold_the_pose() -> None:
    how = Disturbance(pace=1.0001, pauses=2, pause_seconds=1.0, noise_degrees=0, style_degrees=0)
    again = perform_again(walking(8.0), how, 2)
    still = np.diff(again.truth) == 0
    assert 2 * 10 <= still.sum() <= 2 * 30
    held = np.abs(np.diff(again.take.rotations, axis=0)).max(axis=(1, 2))[still]
    assert held.max() < 1e-9


@pytest.mark.parametrize(("noise", "style"), [(5.0, 0.0), (0.0, 10.0), (5.0, 10.0)])
def test_angles_are_off_by_what_is_asked(noise: float, style: float) -> None:
    take = walking(8.0)
    how = Disturbance(pace=1.0, pauses=0, noise_degrees=noise, style_degrees=style)
    again = perform_again(take, how, 3)
    away = rot.multiply(rot.conjugate(take.rotations[: again.take.frames]), again.take.rotations)
    turned = np.degrees(rot.to_rotation_vector(away))
    assert turned.std(axis=0).mean() * np.sqrt(3) == pytest.approx(noise, rel=0.1, abs=0.1)
    lasting = np.sqrt((turned.mean(axis=0) ** 2).sum(axis=-1).mean())
    assert lasting == pytest.approx(style, rel=0.35, abs=0.4)


def test_the_same_seed_is_the_same_performance() -> None:
    take = walking(5.0)
    one, other = (perform_again(take, Disturbance(), 9) for _ in range(2))
    np.testing.assert_array_equal(one.take.rotations, other.take.rotations)
    assert len(perform_again(take, Disturbance(), 10).truth) != len(one.truth)


def test_boundary_errors_are_distances_to_the_nearest() -> None:
    given = [Segment("a", 10, 20), Segment("b", 20, 40)]
    found = [Segment("1", 12, 38)]
    np.testing.assert_allclose(boundary_errors(found, given, 10.0), [0.2, 0.8, 0.2])
    assert np.isinf(boundary_errors([], given, 10.0)).all()


def test_libraries_agree_on_the_cost_and_tables_name_them() -> None:
    # tslearn takes a minute to import; the benchmark has it.
    beside = {name: peer for name, peer in peers().items() if name == "dtw-python"}
    rows = run(kata_speed(frames=60, times=1, beside=beside))
    assert [row.name for row in rows] == ["ours", *beside]
    for row in rows:
        assert row.seconds > 0
        assert row.cost == pytest.approx(rows[0].cost, rel=1e-4)
    warps = [WarpRow("ours", "noise", 3, 0.5, 0.7, 2.0)]
    boundaries = [BoundaryRow("squats", 1, 10, 0.1, 0.3, 0.8)]
    tables = kata_tables(
        warps, [PeerRow("ours", 0.02, 0.03, 1.0), PeerRow("x", 0.2, 0.2, 1.0)], boundaries
    )
    assert [len(table.rows) for table in tables] == [1, 2, 1]
    assert "10.0 ×" in tables[1].rows[1]
