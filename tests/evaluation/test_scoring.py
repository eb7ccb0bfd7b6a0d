from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mocapstudio.cleaning.model import Flag, Kind
from mocapstudio.evaluation.scoring import Counts, Scores, score, word_spans
from mocapstudio.evaluation.truth import Truth

ROWS = ("a", "b", "c")


def flag(row: str, start: int, end: int, value: float = 0.9) -> Flag:
    return Flag(f"{row}:{start}", row, (row,), start, end, value, start, value, Kind.OFFSET)


@st.composite
def scenes(draw: st.DrawFn):
    frames = draw(st.integers(10, 200))
    rate = draw(st.sampled_from([24.0, 30.0, 60.0, 120.0, 119.88]))
    mask = np.zeros((frames, len(ROWS)), dtype=bool)
    truths = []
    for _ in range(draw(st.integers(0, 3))):
        start = draw(st.integers(0, frames - 2))
        end = draw(st.integers(start + 1, min(frames, start + 40)))
        rows = draw(st.lists(st.sampled_from(ROWS), min_size=1, unique=True))
        truths.append(Truth(Kind.OFFSET, tuple(rows), start, end))
        for row in rows:
            inner = draw(st.integers(start, end - 1))
            mask[inner:end, ROWS.index(row)] = True
    flags = []
    for _ in range(draw(st.integers(0, 5))):
        start = draw(st.integers(0, frames - 2))
        end = draw(st.integers(start + 1, min(frames, start + 40)))
        value = draw(st.floats(0, 1))
        flags.append(flag(draw(st.sampled_from((*ROWS, "other"))), start, end, value))
    ignore = np.zeros(frames, dtype=bool)
    if draw(st.booleans()):
        start = draw(st.integers(0, frames - 1))
        ignore[start : start + draw(st.integers(1, 30))] = True
    return frames, rate, mask, truths, flags, ignore


def words_by_hand(frames: int, rate: float) -> list[list[int]]:
    words, k = [], 0
    while True:
        begin, end = 5 * k / 24, (5 * k + 15) / 24
        if k > 0 and end * rate > frames + 1e-6:
            return words
        words.append([f for f in range(frames) if begin * rate - 1e-6 <= f < end * rate - 1e-6])
        k += 1


def scored_by_hand(frames, rate, mask, flags, ignore, least=0.0):
    counts = {"word": [0, 0, 0], "cell": [0, 0, 0]}
    for word in words_by_hand(frames, rate):
        left = [f for f in word if not ignore[f]]
        if len(left) * 2 < len(word):
            continue
        any_wrong = any_found = False
        for r, row in enumerate(ROWS):
            wrong = any(mask[f, r] for f in left)
            found = any(
                one.joint == row and one.score >= least and one.start <= f < one.end
                for one in flags
                for f in left
            )
            any_wrong, any_found = any_wrong or wrong, any_found or found
            tally(counts["cell"], found, wrong)
        tally(counts["word"], any_found, any_wrong)
    return {name: Counts(*three) for name, three in counts.items()}


def tally(three: list[int], found: bool, wrong: bool) -> None:
    three[0] += found and wrong
    three[1] += found and not wrong
    three[2] += wrong and not found


@settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))
@given(scenes())
def test_words_agree_with_counting_by_hand(scene) -> None:
    frames, rate, mask, truths, flags, ignore = scene
    got = score(flags, mask, truths, ROWS, rate, ignore=ignore)
    wanted = scored_by_hand(frames, rate, mask, flags, ignore)
    assert got.words == wanted["word"]
    assert got.word_joints == wanted["cell"]
    for threshold, (words, cells) in got.curve.items():
        over = scored_by_hand(frames, rate, mask, flags, ignore, threshold)
        assert (words, cells) == (over["word"], over["cell"])


@settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))
@given(scenes())
def test_events_agree_with_counting_by_hand(scene) -> None:
    frames, rate, mask, truths, flags, ignore = scene
    got = score(flags, mask, truths, ROWS, rate, ignore=ignore)
    near = round(5 * rate / 24)
    false = 0
    kept = [f for f in flags if any(not ignore[k] for k in range(f.start, f.end))]
    for one in kept:
        around = range(max(0, one.start - near), min(frames, one.end + near))
        false += one.joint not in ROWS or not any(
            mask[f, ROWS.index(one.joint)] and not ignore[f] for f in around
        )
    assert (got.flags, got.false_flags) == (len(kept), false)
    events = found = cells = hits = 0
    for truth in truths:
        shares, some = [], False
        for row in truth.joints:
            wrong = [
                f
                for f in range(truth.start, truth.end)
                if mask[f, ROWS.index(row)] and not ignore[f]
            ]
            hit = [f for f in wrong if any(o.joint == row and o.start <= f < o.end for o in flags)]
            cells, hits, some = cells + len(wrong), hits + len(hit), some or bool(wrong)
            shares += [len(hit) / len(wrong)] if wrong else []
        events += some
        found += any(share >= 0.3 for share in shares)
    total = got.events
    assert (total.events, total.events_found) == (events, found)
    assert (total.cells, total.cells_found) == (cells, hits)


def test_edges_are_measured_from_the_flag_around_the_event() -> None:
    mask = np.zeros((100, 3), dtype=bool)
    mask[40:60, 1] = True
    truths = [Truth(Kind.OFFSET, ("b",), 38, 62)]
    got = score([flag("b", 37, 50), flag("b", 50, 61)], mask, truths, ROWS, 30.0)
    assert sorted(got.edges) == [1, 3]
    assert got.edge == 2.0


def test_a_third_of_the_frames_decides_on_found() -> None:
    mask = np.zeros((100, 3), dtype=bool)
    mask[40:60, 1] = True
    truths = [Truth(Kind.SPIKE, ("b",), 40, 60)]
    assert score([flag("b", 40, 46)], mask, truths, ROWS, 30.0).events.events_found == 1
    assert score([flag("b", 40, 45)], mask, truths, ROWS, 30.0).events.events_found == 0
    assert score([flag("a", 40, 60)], mask, truths, ROWS, 30.0).events.events_found == 0


def test_a_flag_within_five_frames_of_truth_is_not_false() -> None:
    mask = np.zeros((200, 3), dtype=bool)
    mask[100:110, 0] = True
    for gap, false in ((5, 0), (6, 1)):
        got = score([flag("a", 110 + gap - 1, 120 + gap)], mask, [], ROWS, 24.0)
        assert got.false_flags == false


def test_a_sweep_gives_the_curve() -> None:
    mask = np.zeros((48, 3), dtype=bool)
    mask[10:20, 0] = True
    sweep = {0.2: [flag("a", 0, 48)], 0.8: [flag("a", 12, 14, 0.1)]}
    got = score([], mask, [], ROWS, 24.0, sweep=sweep)
    assert got.curve[0.2][0].recall == 1.0
    assert got.curve[0.2][0].false > got.curve[0.8][0].false == 0


def test_takes_add_up() -> None:
    mask = np.zeros((96, 3), dtype=bool)
    mask[40:60, 1] = True
    truths = [Truth(Kind.GAP, ("b",), 40, 60)]
    one = score([flag("b", 40, 60)], mask, truths, ROWS, 24.0)
    two = score([flag("a", 5, 9)], mask, truths, ROWS, 24.0)
    both = Scores() + one + two
    assert both.words == one.words + two.words
    assert both.events.event_recall == 0.5
    assert both.minutes == pytest.approx(8 / 60)
    assert both.false_flags_a_minute == pytest.approx(1 / (8 / 60))
    assert both.curve[0.5][0] == one.curve[0.5][0] + two.curve[0.5][0]


def test_nothing_wrong_and_nothing_found_is_not_a_number() -> None:
    assert math.isnan(Counts().recall)
    assert math.isnan(Counts().precision)
    assert math.isnan(Scores().edge)


def test_a_take_shorter_than_a_word_is_one_word() -> None:
    assert word_spans(10, 30.0).tolist() == [[0, 10]]
