"""Candidate spans and the second decision on them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocapstudio.cleaning.decision import features, spans
from mocapstudio.cleaning.decision.forest import Forest
from mocapstudio.cleaning.decision.spans import CANDIDATE, RARER, Candidate, candidates, judged

LIMB = np.array([0, 0, 1])
BRIDGED = 2


def always(odds: float) -> Forest:
    """Trees that give everything the same log-odds."""
    none = np.zeros(0, dtype=np.int32)
    empty = np.zeros(0, dtype=np.float32)
    return Forest(odds, none, none, empty, none, none, none.astype(np.uint8), empty)


def seen(frames: int, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return rng.random((frames, 3, len(features.NAMES))).astype(np.float32)


@given(st.data())
def test_candidates_are_runs_above_the_limit_with_small_gaps_closed(data: st.DataObject) -> None:
    frames = data.draw(st.integers(1, 25))
    value = st.sampled_from([0.0, CANDIDATE, 0.16, 0.9])
    p = np.array([[data.draw(value) for _ in range(2)] for _ in range(frames)], dtype=np.float32)
    expected = []
    for row in range(2):
        above = p[:, row] > CANDIDATE
        frame = 0
        while frame < frames:
            if not above[frame]:
                frame += 1
                continue
            end = frame + 1
            # Go on while the next frame above lies at most two frames away.
            while above[end : end + BRIDGED + 1].any():
                end += int(np.argmax(above[end : end + BRIDGED + 1])) + 1
            expected.append(Candidate(row, frame, end))
            frame = end
    assert candidates(p) == expected


def test_a_span_takes_the_verdict_of_the_second_decision() -> None:
    p = np.zeros((40, 5), dtype=np.float32)
    p[10:16, 1] = [0.2, 0.5, 0.8, 0.8, 0.4, 0.2]
    p[30, 2] = 0.3
    p[5:9, 3] = 0.6  # root rows: the first decision is enough
    before = p.copy()
    result = judged(p, seen(40), LIMB, always(2.0))
    np.testing.assert_array_equal(p, before)
    odds = np.exp(2.0) / RARER
    verdict = odds / (1 + odds)
    assert result[10:16, 1].max() == pytest.approx(verdict, rel=1e-5)
    np.testing.assert_allclose(result[10:16, 1], verdict * np.sqrt(p[10:16, 1] / 0.8), rtol=1e-5)
    assert result[30, 2] == pytest.approx(verdict, rel=1e-5)
    first = 0.6 / 0.4 / RARER
    np.testing.assert_allclose(result[5:9, 3], first / (1 + first), rtol=1e-5)
    untouched = np.ones_like(p, dtype=bool)
    untouched[10:16, 1] = untouched[30, 2] = untouched[5:9, 3] = False
    assert np.all(result[untouched] == 0.0)


def test_without_candidates_the_odds_are_corrected_alone() -> None:
    p = np.full((20, 5), 0.1, dtype=np.float32)
    odds = 0.1 / 0.9 / RARER
    np.testing.assert_allclose(judged(p, seen(20), LIMB, always(9.0)), odds / (1 + odds), rtol=1e-5)


def test_a_span_is_described_by_its_own_row() -> None:
    p = np.zeros((30, 3), dtype=np.float32)
    p[8:12, 0] = [0.3, 0.9, 0.6, 0.2]
    p[9:11, 1] = 0.5
    joints = seen(30)
    row = spans.span_features(p, joints, LIMB, [Candidate(0, 8, 12)])[0]
    named = dict(zip(spans.NAMES, row, strict=True))
    assert (named["length"], named["from start"], named["to end"]) == (4, 8, 18)
    assert named["highest"] == pytest.approx(0.9)
    assert named["total"] == pytest.approx(2.0)
    assert named["mean"] == pytest.approx(0.5)
    assert (named["limb highest"], named["limb rows"]) == (pytest.approx(0.5), 1)
    assert named["other rows"] == 0
    column = joints[8:12, 0, features.COLUMN["pop"]]
    assert named["pop highest"] == pytest.approx(column.max())
    speed = joints[8:12, 0, features.COLUMN["speed"]]
    assert named["speed mean"] == pytest.approx(speed.mean())


@pytest.mark.parametrize("at", [(0, 1), (0, 20), (19, 20), (5, 6)])
def test_a_span_may_lie_anywhere(at: tuple[int, int]) -> None:
    p = np.full((20, 3), 0.5, dtype=np.float32)
    rows = spans.span_features(p, seen(20), LIMB, [Candidate(2, *at)])
    assert rows.shape == (1, len(spans.NAMES))
    assert np.all(np.isfinite(rows))


def test_labels_of_spans() -> None:
    labels = np.zeros((40, 2), dtype=np.int8)
    labels[10:14, 0] = 1
    labels[9, 0] = labels[30, 0] = -1
    found = spans.labels_of(
        labels,
        [
            Candidate(0, 10, 14),  # all of it wrong
            Candidate(0, 8, 30),  # four of twenty-four: less than a fifth
            Candidate(0, 12, 20),  # two, and one beside it
            Candidate(0, 31, 35),  # next to a doubtful frame
            Candidate(0, 20, 25),  # clean
            Candidate(1, 10, 14),  # another row
        ],
    )
    assert found.tolist() == [1, -1, 1, -1, 0, 0]
