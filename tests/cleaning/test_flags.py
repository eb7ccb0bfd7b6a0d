"""From map to flags: spans and scores."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from made_takes import walking

from mocapstudio.cleaning.flags import find_flags, score_of, spans_above
from mocapstudio.cleaning.model import DigressionMap, Kind
from mocapstudio.cleaning.own_rate import OwnRate
from mocapstudio.motion.facing import ROOT_ROWS

TAKE = walking(8.0, 60)
JOINTS = TAKE.skeleton.names
ROWS = (*JOINTS, *ROOT_ROWS)


@given(st.data())
def test_spans_are_runs_above_the_threshold_with_small_gaps_closed(data: st.DataObject) -> None:
    count = data.draw(st.integers(0, 30))
    value = st.sampled_from([0.0, 0.3, 0.5, 0.6, 1.0])
    values = np.array([data.draw(value) for _ in range(count)], dtype=np.float32)
    bridge = data.draw(st.integers(0, 4))
    found = spans_above(values, 0.5, bridge)
    covered = np.zeros(count, dtype=bool)
    for start, end in found:
        assert values[start] > 0.5 and values[end - 1] > 0.5
        covered[start:end] = True
    assert np.all(covered[values > 0.5])
    # What is covered and not above is a gap no longer than allowed, without a 0 in it.
    gap = 0
    for t in range(count):
        gap = gap + 1 if covered[t] and values[t] <= 0.5 else 0
        assert gap <= bridge
        assert not (covered[t] and values[t] == 0.0)
    for (_, end), (start, _) in pairwise(found):
        between = values[end:start]
        assert len(between) > bridge or np.any(between == 0.0)


def test_a_score_grows_with_its_peak_and_its_length() -> None:
    low, high = np.full(9, 0.6, np.float32), np.full(9, 0.9, np.float32)
    peak = np.where(np.arange(9) == 4, 0.9, 0.55).astype(np.float32)
    assert 0.5 < score_of(low, 0.5) < score_of(peak, 0.5) < score_of(high, 0.5) <= 1.0


def test_flags_are_read_off_the_map() -> None:
    values = np.zeros((TAKE.frames, len(ROWS)), dtype=np.float32)
    values[100:130, 6] = 0.8
    values[120, 6] = 0.95
    values[110:140, 7] = 0.7
    values[300:302, ROWS.index(ROOT_ROWS[0])] = 0.6
    values[10:20, 0] = 0.5  # not above the threshold
    none = OwnRate(np.zeros_like(values), np.zeros_like(values))
    flags = find_flags(TAKE, DigressionMap(ROWS, values, 50 * values), none, 0.5)
    arm, fore, root = flags
    assert (arm.id, arm.joint, arm.start, arm.end) == (f"{ROWS[6]}@100", ROWS[6], 100, 130)
    assert (arm.peak_frame, arm.peak) == (120, pytest.approx(0.95))
    assert arm.joints == fore.joints == (ROWS[6], ROWS[7])
    assert (root.joint, root.joints, root.kind) == (ROOT_ROWS[0], (ROOT_ROWS[0],), Kind.ROOT_POP)
    assert find_flags(TAKE, DigressionMap(ROWS, values, values), none, 0.96) == ()


def _flagged(spans: dict[str, tuple[int, int]]) -> dict[str, tuple[Kind, frozenset[str]]]:
    values = np.zeros((TAKE.frames, len(ROWS)), dtype=np.float32)
    for name, (start, end) in spans.items():
        values[start:end, ROWS.index(name)] = 0.9
    none = OwnRate(np.zeros_like(values), np.zeros_like(values))
    flags = find_flags(TAKE, DigressionMap(ROWS, values, 40 * values), none, 0.5)
    return {flag.joint: (flag.kind, frozenset(flag.joints)) for flag in flags}


def test_two_sides_flagged_together_are_a_swap() -> None:
    legs = ("LeftUpLeg", "LeftLeg", "RightUpLeg", "RightLeg")
    found = _flagged(dict.fromkeys(legs, (100, 130)))
    assert found == dict.fromkeys(legs, (Kind.SWAP, frozenset(legs)))


def test_sides_flagged_at_other_times_are_none() -> None:
    left, right = ("LeftUpLeg", "LeftLeg"), ("RightUpLeg", "RightLeg")
    found = _flagged({**dict.fromkeys(left, (100, 130)), **dict.fromkeys(right, (120, 190))})
    assert Kind.SWAP not in {kind for kind, _ in found.values()}
    assert found["LeftLeg"][1] == frozenset(left)


def test_three_joints_of_a_limb_are_bent_as_one() -> None:
    arm = ("LeftShoulder", "LeftArm", "LeftForeArm")
    found = _flagged(dict.fromkeys(arm, (100, 130)))
    assert found == dict.fromkeys(arm, (Kind.LIMB, frozenset(arm)))
