"""What is written as TRC differs from its source only where it was declared."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from marker_text import LABELS, places, trc

from mocapstudio import formats
from mocapstudio.formats import Declared, ReadOptions, WriteOptions
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.markers import MarkerTake

FIRST_ROW = 6
PLACES = places()


def taken(path: Path, text: str, **options) -> MarkerTake:
    path.write_text(text, newline="")
    [take], _ = formats.read_any(path, ReadOptions(**{"up": "y", **options}))
    assert isinstance(take, MarkerTake)
    return take


def moved(take: MarkerTake, marker: int, frame: int, to: object) -> MarkerTake:
    positions = take.positions.copy()
    positions[frame, marker] = to
    return take.with_positions(positions)


def changed_cells(before: Path, after: Path) -> dict[tuple[int, int], str]:
    """Cells that differ, by 0-based row and column, with what stands there now."""
    old = [line.split("\t") for line in before.read_text().splitlines()]
    new = [line.split("\t") for line in after.read_text().splitlines()]
    assert list(map(len, old)) == list(map(len, new))
    return {
        (i - FIRST_ROW, c): b
        for i, (x, y) in enumerate(zip(old, new, strict=True))
        for c, (a, b) in enumerate(zip(x, y, strict=True))
        if a != b
    }


@given(
    marker=st.integers(0, 3),
    frame=st.integers(0, 11),
    to=st.tuples(*[st.floats(-5, 5)] * 3),
    up=st.sampled_from("xyz"),
    unit=st.sampled_from([None, 1.0, 0.01]),
)
@example(marker=0, frame=0, to=(0.0, 0.0, 0.0), up="y", unit=None)
@settings(max_examples=25)
def test_only_declared_cells_change(tmp_path_factory, marker, frame, to, up, unit) -> None:
    folder = tmp_path_factory.mktemp("patch")
    source, target = folder / "source.trc", folder / "target.trc"
    take = taken(source, trc(PLACES), up=up, unit=unit)
    edited = moved(take, marker, frame, to)
    formats.write(edited, target, declared=[Declared(LABELS[marker], frame, frame + 1)])
    assert set(changed_cells(source, target)) <= {
        (frame, c) for c in range(2 + 3 * marker, 5 + 3 * marker)
    }
    [again], _ = formats.read_any(target, ReadOptions(up=up, unit=unit))
    np.testing.assert_allclose(again.positions, edited.positions, atol=2e-6, rtol=0)


def test_what_was_not_declared_is_refused(tmp_path: Path) -> None:
    take = moved(taken(tmp_path / "a.trc", trc(PLACES)), 1, 4, (0, 0.5, 0))
    target = tmp_path / "b.trc"
    for declared in ((), [Declared("C7", 5, 9)], [Declared("LFHD", 0, 12)]):
        with pytest.raises(MocapError, match="C7 at frame 4"):
            formats.write(take, target, declared=declared)
    with pytest.raises(MocapError, match="RTOE is none"):
        formats.write(take, target, declared=[Declared("RTOE", 0, 12)])
    assert not target.exists()


def test_gaps_are_filled_and_made_in_their_cells(tmp_path: Path) -> None:
    broken = PLACES.copy()
    broken[3, 3] = np.nan
    source, target = tmp_path / "a.trc", tmp_path / "b.trc"
    text = "\n".join(line.rstrip("\t") for line in trc(broken).splitlines()) + "\n"
    take = taken(source, text)
    assert take.missing.sum() == 1
    edited = moved(moved(take, 3, 3, (0.1, 0.2, 0.3)), 0, 5, np.nan)
    formats.write(edited, target, declared=[Declared("LTOE", 3, 4), Declared("LFHD", 5, 6)])
    rows = [line.split("\t") for line in target.read_text().splitlines()[FIRST_ROW:]]
    assert rows[3][-3:] == ["100.000", "200.000", "300.000"]
    assert rows[5][2:5] == ["", "", ""]
    [again], _ = formats.read_any(target)
    np.testing.assert_allclose(again.positions, edited.positions, atol=1e-6)


def test_zeros_stay_the_sign_of_a_gap_where_the_file_has_them(tmp_path: Path) -> None:
    broken = PLACES.copy()
    broken[0, 2] = 0.0
    source, target = tmp_path / "a.trc", tmp_path / "b.trc"
    take = moved(taken(source, trc(broken)), 1, 7, np.nan)
    formats.write(take, target, declared=[Declared("C7", 7, 8)])
    assert set(changed_cells(source, target).values()) == {"0.000"}


def test_decimal_commas_stay(tmp_path: Path) -> None:
    source, target = tmp_path / "a.trc", tmp_path / "b.trc"
    take = moved(taken(source, trc(PLACES).replace(".", ",")), 0, 0, (1.5, 1.25, -0.5))
    formats.write(take, target, declared=[Declared("LFHD", 0, 1)])
    assert list(changed_cells(source, target).values()) == ["1500,000", "1250,000", "-500,000"]


def test_another_rate_changes_what_states_it_alone(tmp_path: Path) -> None:
    source, target = tmp_path / "a.trc", tmp_path / "b.trc"
    take = taken(source, trc(PLACES), fps=Fraction(120_000, 1001))
    formats.write(take, target)
    changed = changed_cells(source, target)
    assert changed.pop((2 - FIRST_ROW, 0)) == "119.8801199"
    assert {column for _, column in changed} == {1}
    [again], _ = formats.read_any(target)
    assert again.rate == Fraction(120_000, 1001)


@pytest.mark.parametrize(
    ("options", "unit", "up"),
    [
        (WriteOptions(anew=True), None, "y"),
        (WriteOptions(unit=0.01, up="z"), 0.01, "z"),
        (WriteOptions(unit=1.0, up="x"), 1.0, "x"),
    ],
)
def test_anew_it_holds_the_same_motion(tmp_path: Path, options, unit, up) -> None:
    broken = PLACES.copy()
    broken[2:4, 1] = np.nan
    take = replace(
        taken(tmp_path / "a.trc", trc(broken)), rate=Fraction(30_000, 1001), first_frame=-7
    )
    formats.write(take, tmp_path / "b.trc", options=options)
    [again], report = formats.read_any(tmp_path / "b.trc", ReadOptions(up=up))
    assert [problem.what for problem in report.problems] == ["2 positions are blank"]
    assert (again.labels, again.rate, again.first_frame) == (LABELS, take.rate, -7)
    assert again.source is not None
    assert again.source.unit == (unit or 0.001)
    np.testing.assert_allclose(again.positions, take.positions, atol=1e-7)


def test_trim(tmp_path: Path) -> None:
    take = replace(taken(tmp_path / "a.trc", trc(PLACES)), trim=(2, 9))
    formats.write(take, tmp_path / "b.trc", options=WriteOptions(trim=True))
    [again], report = formats.read_any(tmp_path / "b.trc", ReadOptions(up="y"))
    assert (again.frames, again.first_frame) == (7, 3)
    assert report.problems == ()
    np.testing.assert_allclose(again.positions, take.positions[2:9], atol=1e-7)


def test_a_unit_that_no_table_can_name_is_refused(tmp_path: Path) -> None:
    take = taken(tmp_path / "a.trc", trc(PLACES))
    with pytest.raises(MocapError, match="cannot name a unit"):
        formats.write(take, tmp_path / "b.trc", options=WriteOptions(unit=0.0564))
