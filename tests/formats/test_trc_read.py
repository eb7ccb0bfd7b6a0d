"""TRC files of the field, and one made file for each of their oddities."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from marker_text import LABELS, places, trc, trc_lines

from mocapstudio import formats
from mocapstudio.formats import ReadOptions
from mocapstudio.motion.errors import FileError, NoRateError, ParameterError
from mocapstudio.motion.markers import MarkerTake

PLACES = places()


def read(path: Path, text: str | bytes, **options) -> tuple[MarkerTake, list[str]]:
    """Read a text, check that it is written back as it was, and return its problems as lines."""
    data = text if isinstance(text, bytes) else text.encode()
    path.write_bytes(data)
    [take], report = formats.read_any(path, ReadOptions(**options))
    assert isinstance(take, MarkerTake)
    copy = path.with_stem("copy")
    formats.write(take, copy)
    assert copy.read_bytes() == data
    problems = [f"{p.line}: {p.what}; {p.done}" for p in report.problems]
    return take, problems


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "take.trc"


def test_a_plain_file(path: Path) -> None:
    take, problems = read(path, trc(PLACES))
    assert take.labels == LABELS
    assert (take.rate, take.first_frame, take.name) == (100, 1, "take")
    np.testing.assert_allclose(take.positions, PLACES / 1000, atol=0.51e-6)
    assert problems == ["None: no up axis stated; guessed Y up (the head is above the feet)"]
    assert read(path, trc(PLACES), up="y")[1] == []


def test_blank_cells_and_zeros_are_missing(path: Path) -> None:
    broken = PLACES.copy()
    broken[3:5, 1] = np.nan
    broken[7, 2] = 0.0
    broken[8, 0, 1] = np.nan
    take, problems = read(path, trc(broken), up="y")
    expected = np.zeros((12, 4), dtype=bool)
    expected[3:5, 1] = expected[7, 2] = expected[8, 0] = True
    np.testing.assert_array_equal(take.missing, expected)
    assert problems == [
        "10: 2 positions are blank; read as missing",
        "14: 1 positions are exactly 0 0 0; read as missing",
        "15: 1 positions lack a coordinate; read as missing",
    ]


def edited(**lines: str) -> str:
    """The plain file with lines replaced, by 1-based number; an empty word drops the line."""
    old = trc_lines(PLACES)
    for name, text in lines.items():
        old[int(name[1:]) - 1] = text
    return "\n".join(line for line in old if line != "drop") + "\n"


HEAD = "100.00\t100.00\t{}\t{}\tmm\t100.00\t1\t12"
ODDITIES = {
    "more frames stated": (edited(l3=HEAD.format(20, 4)), "3: NumFrames 20, but 12 rows"),
    "fewer frames stated": (edited(l3=HEAD.format(7, 4)), "3: NumFrames 7, but 12 rows"),
    "a billion frames": (edited(l3=HEAD.format(10**9, 4)), "3: NumFrames 1000000000"),
    "padded count": (edited(l3=HEAD.format("     12", 4)), None),
    "other markers stated": (edited(l3=HEAD.format(12, 66)), "3: NumMarkers 66, but 4 markers"),
    "counts are words": (edited(l3=HEAD.format("many", 4)), "NumFrames 'many' is no number"),
    "short head": (edited(l2="DataRate\tNumFrames\tUnits", l3="100.00\t12\tmm"), None),
    "no first line": (edited(l1="drop"), None),
    "no axes": (edited(l5="drop"), None),
    "no blank line": (edited(l6="drop"), None),
    "trailing tabs": (trc(PLACES).replace("\n", "\t\t\n"), None),
    "CRLF": (trc(PLACES).replace("\n", "\r\n"), None),
    "lone CR": (trc(PLACES).replace("\n", "\r"), None),
    "byte order mark": ("\ufeff" + trc(PLACES), "1: byte order mark"),
    "no last newline": (trc(PLACES).rstrip("\n"), None),
    "decimal commas": (trc(PLACES).replace(".", ","), "7: decimal commas"),
    "spaces for tabs": (
        "\n".join(" ".join(line.split()) for line in trc_lines(PLACES)) + "\n",
        "labels are set apart by spaces",
    ),
    "spaces in rows": (
        "\n".join(line.replace("\t", "  ") if line[:1].isdigit() and i > 3 else line
                  for i, line in enumerate(trc_lines(PLACES))) + "\n",
        "7: cells are set apart by spaces",
    ),
    "labels without gaps": (edited(l4="Frame#\tTime\t" + "\t".join(LABELS)), None),
    "labels three times": (
        edited(l4="Frame#\tTime\t" + "\t".join(label for label in LABELS for _ in "XYZ")), None,
    ),
    "text after the rows": (trc(PLACES) + "\nend of file\n", "20: text after the last row"),
    "blank lines between": (trc(PLACES).replace("\n5\t", "\n\n5\t"), None),
    "frames jump": (trc(PLACES).replace("\n9\t", "\n99\t"), "15: frame 99 follows frame 8"),
    "exponents": (trc(PLACES).replace("\n1\t0.000", "\n1\t0.0E+00"), None),
}  # fmt: skip


@pytest.mark.parametrize("name", ODDITIES)
def test_oddities_leave_the_motion_as_it_is(path: Path, name: str) -> None:
    text, says = ODDITIES[name]
    take, problems = read(path, text, up="y")
    assert take.labels == LABELS
    assert (take.rate, take.first_frame) == (100, 1)
    np.testing.assert_allclose(take.positions, PLACES / 1000, atol=0.51e-6)
    told = [problem for problem in problems if says and says in problem]
    assert len(told) == (says is not None), problems
    if name not in ("spaces for tabs", "text after the rows"):
        assert len(problems) == (says is not None), problems


def test_names_that_repeat_are_empty_or_foreign(path: Path) -> None:
    labels = ("Tête", "Tête", "", "")
    take, problems = read(path, trc(PLACES, labels).encode("latin-1"), up="y")
    assert take.labels == ("Tête", "Tête#2", "unnamed", "unnamed#2")
    assert problems == [
        "4: bytes that are not UTF-8; read as Latin-1, kept in the file",
        "4: 2 markers have no label; named unnamed",
        "4: labels repeat; named Tête#2",
    ]


def test_labels_may_be_absent(path: Path) -> None:
    take, problems = read(path, edited(l4="Frame#\tTime"), up="y")
    assert take.labels == ("unnamed", "unnamed#2", "unnamed#3", "unnamed#4")
    assert problems == ["4: 4 markers have no label; named unnamed"]


def test_without_a_rate_the_times_tell_it(path: Path) -> None:
    text = edited(l2="NumFrames\tUnits", l3="12\tmm")
    assert read(path, text)[0].rate == 100
    rows = [line.split("\t") for line in text.splitlines()]
    still = "\n".join(
        "\t".join([row[0], "0.0", *row[2:]] if i >= 6 else row) for i, row in enumerate(rows)
    )
    with pytest.raises(NoRateError, match=r"all times are alike.*--fps"):
        read(path, still)
    assert read(path, still, fps=Fraction(50))[0].rate == 50


def test_units(path: Path) -> None:
    for name, metres in (("m", 1.0), ("cm", 0.01), ("Millimeters", 0.001), ("inch", 0.0254)):
        take, _ = read(path, trc(PLACES).replace("\tmm\t", f"\t{name}\t"))
        assert take.source is not None
        assert take.source.unit == metres
    take, problems = read(path, trc(PLACES).replace("\tmm\t", "\tfurlong\t"))
    assert take.source is not None
    assert take.source.unit == 0.001
    assert any("'furlong' is no unit" in problem for problem in problems)
    assert any("guessed 1 unit = 0.001 m" in problem for problem in problems)


def test_axes(path: Path) -> None:
    standing_on_z = PLACES[..., [2, 0, 1]]
    take, problems = read(path, trc(standing_on_z))
    assert problems == ["None: no up axis stated; guessed Z up (the head is above the feet)"]
    np.testing.assert_allclose(take.positions[..., 1], PLACES[..., 1] / 1000, atol=1e-6)
    # What was forward, the file's X, is our Z; to the left, the file's Y, is our X.
    take, _ = read(path, trc(standing_on_z), forward="x")
    np.testing.assert_allclose(take.positions, PLACES / 1000, atol=1e-6)
    with pytest.raises(ParameterError, match="forward z is along the up axis"):
        read(path, trc(standing_on_z), forward="z")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (trc(PLACES).replace("Frame#", "Row"), "1: not TRC"),
        ("Frame#\tTime\n1\t0.0\n2\t0.1\n", "1: no markers"),
        ("\n".join(trc_lines(PLACES)[:6]), "no rows of numbers"),
        (trc(PLACES).replace("\n4\t0.030", "\n4\toops"), "10: 'oops' is not a number, in column 2"),
        (trc(PLACES).replace("\n4\t0.030", "\n4\t1e300"), "10: a value is too large"),
        (trc(PLACES).replace("\n4\t", "\n4\t9\t"), "10: the row has 15 cells, its labels need 14"),
        (trc(PLACES)[:-40], "18: cut off: the last row has"),
        (trc(PLACES).encode("utf-16").decode("latin-1"), "1: UTF-16"),
        ("", "not TRC"),
    ],
)  # fmt: skip
def test_what_cannot_be_read_is_refused_with_its_line(path: Path, text: str, says: str) -> None:
    with pytest.raises(FileError, match=says):
        read(path, text.encode("latin-1"))


def test_a_row_that_is_cut_off_can_be_left_out(path: Path) -> None:
    take, problems = read(path, trc(PLACES)[:-40], up="y", lenient=True)
    assert take.frames == 11
    assert "18: the last row is cut off; left out" in problems


@pytest.mark.parametrize(
    ("name", "frames", "rate", "markers", "unit", "missing"),
    [
        ("gaps_c3d_btk_BSD/Knee.trc", 200, 200, 71, 0.001, 0.244),
        ("gaps_c3d_btk_BSD/ballet_reduced.trc", 100, 30, 41, 0.001, 0.0),
        ("gaps_trc_bmc_CCBY4/motion_capture_run.trc", 123, 150, 78, 0.001, 0.256),
        ("markerless_opencap_trc_MIT/Squats_0.trc", 832, 60, 63, 1.0, 0.0),
    ],
)
def test_real_takes(
    data: Path, path: Path, name: str, frames: int, rate: int, markers: int, unit: float, missing
) -> None:
    take, problems = read(path, (data / name).read_bytes())
    assert (take.frames, take.rate, len(take.labels)) == (frames, rate, markers)
    assert take.source is not None
    assert take.source.unit == unit
    assert take.missing.mean() == pytest.approx(missing, abs=5e-4)
    assert any("Y up" in problem for problem in problems)
    numbers = np.genfromtxt(data / name, delimiter="\t", skip_header=6, usecols=range(2, 5))
    np.testing.assert_allclose(take.positions[:, 0] / unit, numbers, atol=1e-9)
