"""Segment labels: what is written is read, and what is wrong is said."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocapstudio.comparison.labels import Labels, labels_of, read_labels, write_labels
from mocapstudio.comparison.model import Segment
from mocapstudio.motion.errors import FileError, MocapError

SQUAT = Labels(
    "squat_01",
    Fraction(30),
    (Segment("down", 3, 20), Segment("hold", 20, 28), Segment("up", 30, 50)),
)


def test_what_is_written_is_read(tmp_path: Path) -> None:
    write_labels(SQUAT, tmp_path / "one.json")
    assert read_labels(tmp_path / "one.json") == [SQUAT]
    assert json.loads((tmp_path / "one.json").read_text())["segments"][0] == {
        "name": "down",
        "start": 3,
        "end": 20,
    }
    other = Labels("b", Fraction(120000, 1001), ())
    write_labels([SQUAT, other], tmp_path / "two.json")
    assert read_labels(tmp_path / "two.json") == [SQUAT, other]


def test_a_frame_belongs_to_the_segment_that_holds_it() -> None:
    named = [SQUAT.at(f) for f in (0, 3, 19, 20, 27, 28, 29, 30, 49, 50)]
    assert named == [None, "down", "down", "hold", "hold", None, None, "up", "up", None]
    codes = SQUAT.codes(("up", "down", "hold"), 52)
    assert [codes[f] for f in (0, 3, 20, 28, 30, 51)] == [-1, 1, 2, -1, 0, -1]


@given(
    st.lists(st.integers(1, 40), min_size=1, max_size=8),
    st.sampled_from([Fraction(24), Fraction(120), Fraction(120000, 1001), Fraction(1)]),
)
def test_another_rate_keeps_the_times(lengths: list[int], rate: Fraction) -> None:
    starts = [sum(lengths[:i]) for i in range(len(lengths))]
    segments = [
        Segment(str(i), s, s + n) for i, (s, n) in enumerate(zip(starts, lengths, strict=True))
    ]
    labels = Labels("t", Fraction(30), tuple(segments))
    moved = labels.at_rate(rate)
    assert [s.name for s in moved.segments] == [s.name for s in segments]
    if rate >= 30:
        for before, after in zip(segments, moved.segments, strict=True):
            assert abs(before.start / 30 - after.start / rate) <= 1 / (2 * rate) + 1e-9
            assert abs(before.end / 30 - after.end / rate) <= 1 / (2 * rate) + 1e-9


def test_labels_are_found_by_the_name_of_the_take() -> None:
    assert labels_of("squat_01", [SQUAT]) is SQUAT
    assert labels_of("folder/squat_01.bvh", [SQUAT]) is SQUAT
    assert labels_of("squat_02", [SQUAT]) is None
    kick = Labels("mawashi.geri.left.1", Fraction(100), ())
    assert labels_of("mawashi.geri.left.1", [SQUAT, kick]) is kick
    assert labels_of("mawashi.geri.left.2", [SQUAT, kick]) is None


@pytest.mark.parametrize(
    "segments",
    [(Segment("a", 5, 5),), (Segment("a", -1, 5),), (Segment("a", 0, 9), Segment("b", 8, 12))],
)
def test_segments_that_make_no_sense_are_refused(segments: tuple[Segment, ...]) -> None:
    with pytest.raises(MocapError, match="segment"):
        Labels("t", Fraction(30), segments)


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ('{"take": "a",\n"fps": 30\n"segments": []}', "3: is not JSON"),
        ("[1]", "an object"),
        ('{"take": "a", "fps": "x", "segments": []}', "fps"),
        ('{"take": "a", "fps": 0, "segments": []}', "0 is not in"),
        ('{"take": "a", "fps": 1e400, "segments": []}', "inf"),
        ('{"take": "a", "fps": 30, "segments": 3}', "segments must be a list"),
        ('{"take": "a", "fps": 30, "segments": [{"name": "x", "start": 1.5, "end": 3}]}', "start"),
        ('{"take": "a", "fps": 30, "segments": [{"start": 1, "end": 3}]}', "segment 0 has no name"),
        ("[" * 100_000, "nested too deeply"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(tmp_path: Path, text: str, place: str) -> None:
    file = tmp_path / "bad.json"
    file.write_text(text)
    with pytest.raises(FileError, match=place) as error:
        read_labels(file)
    assert "bad.json" in str(error.value)
    assert "\n" not in str(error.value)


def test_a_missing_file_is_said(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="no such file"):
        read_labels(tmp_path / "none.json")
