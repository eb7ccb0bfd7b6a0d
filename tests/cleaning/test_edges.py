"""Edges of flags at the take's own rate."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from made_takes import turned, walking

from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.edges import refined
from mocapstudio.motion.progress import run


def test_edges_move_to_where_the_departure_rises_and_falls() -> None:
    fine = np.full(400, 2.0, dtype=np.float32)
    fine[203:251] = 40.0
    for start, end in ((198, 256), (203, 251), (206, 245), (194, 260)):
        assert refined(fine, start, end, 60.0, (0, 400)) == (
            max(203, start - 2), min(251, end + 2)
        )  # fmt: skip


@given(st.data())
def test_edges_stay_within_their_limits(data: st.DataObject) -> None:
    fine = np.random.default_rng(data.draw(st.integers(0, 10**6))).uniform(0, 60, 200)
    start = data.draw(st.integers(20, 150))
    end = data.draw(st.integers(start + 1, 180))
    low, high = data.draw(st.integers(0, start)), data.draw(st.integers(end, 200))
    rate = data.draw(st.sampled_from([24.0, 30.0, 120.0]))
    first, last = refined(fine.astype(np.float32), start, end, rate, (low, high))
    assert low <= first < last <= high
    assert first >= start - round(rate / 24) and last <= end + round(rate / 24)


def test_where_nothing_stands_out_edges_stay() -> None:
    calm = np.full(200, 3.0, dtype=np.float32)
    assert refined(calm, 50, 80, 30.0, (0, 200)) == (50, 80)


@pytest.mark.parametrize("rate", [24, 30, 60, 120])
def test_edges_of_an_offset_are_found_to_the_frame(rate: int) -> None:
    start, end = round(3.37 * rate), round(4.21 * rate)
    bad = turned(walking(12.0, rate), "LeftForeArm", start, end, 45)
    flags = [f for f in run(detect(bad)).flags if f.joint == "LeftForeArm"]
    assert len(flags) == 1
    assert abs(flags[0].start - start) <= max(1, rate // 24)
    assert abs(flags[0].end - end) <= max(1, rate // 24)
