"""What bad BVH gets: one line that names file, line and cause."""

from __future__ import annotations

import resource
from pathlib import Path

import numpy as np
import pytest
from bvh_text import COLUMNS, HEADER, HEADER_LINES, bvh, walk

from mocapstudio import formats
from mocapstudio.formats import bvh_motion
from mocapstudio.motion.errors import FileError

MOTION_LINE = HEADER_LINES + 1
FIRST_ROW = MOTION_LINE + 3
TEXT = bvh(walk())


@pytest.fixture(params=["plain parser", "compiled parser"])
def refused(tmp_path: Path, request, monkeypatch: pytest.MonkeyPatch):
    if request.param == "compiled parser":
        monkeypatch.setattr(bvh_motion, "KERNEL_FROM_BYTES", 0)

    def reader(text: str | bytes) -> FileError:
        path = tmp_path / "take.bvh"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        with pytest.raises(FileError) as caught:
            formats.read(path)
        assert caught.value.path == path
        assert str(caught.value).count("\n") == 0
        return caught.value

    return reader


def with_cell(row: int, column: int, cell: str) -> str:
    lines = TEXT.splitlines()
    cells = lines[FIRST_ROW - 1 + row].split()
    cells[column] = cell
    lines[FIRST_ROW - 1 + row] = " ".join(c for c in cells if c)
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("text", ["", "\n\n", "{}", "solid cube\n", "# comment\n" + TEXT])
def test_what_is_not_bvh(refused, text: str) -> None:
    assert "not BVH" in refused(text).cause


def test_binary_rubbish(refused) -> None:
    rubbish = np.random.default_rng(0).integers(0, 256, 5000, dtype=np.uint8).tobytes()
    assert "not BVH" in refused(rubbish).cause
    assert refused(b"HIERARCHY\n" + rubbish).line is not None


def test_cut_off_in_the_hierarchy(refused) -> None:
    error = refused(HEADER[: HEADER.index("RightUpLeg")])
    assert "cut off" in error.cause
    assert error.line == HEADER[: HEADER.index("RightUpLeg")].count("\n") + 1


def test_cut_off_in_the_last_row(refused) -> None:
    error = refused(TEXT[:-60])
    assert "cut off" in error.cause
    assert error.line == FIRST_ROW + 29


def test_cut_off_between_rows(refused) -> None:
    error = refused("\n".join(TEXT.splitlines()[:-5]) + "\n")
    assert error.line == MOTION_LINE + 1
    assert "30" in error.cause
    assert "25 rows" in error.cause


@pytest.mark.parametrize("cell", ["NaN", "nan", "-nan(ind)", "inf", "-Infinity", "1.#QNAN"])
def test_nan_and_infinity(refused, cell: str) -> None:
    error = refused(with_cell(7, 4, cell))
    assert error.line == FIRST_ROW + 7
    assert error.cause == f"{cell} instead of a number in column 5"


@pytest.mark.parametrize("cell", ["abc", "1.2.3", "--3", "1_000", "0x1F", "1e", ".", "é", "1;2"])
def test_what_is_no_number(refused, cell: str) -> None:
    error = refused(with_cell(3, 11, cell))
    assert error.line == FIRST_ROW + 3
    assert error.cause == f"{cell.encode().decode('latin-1')!r} is not a number, in column 12"


@pytest.mark.parametrize("cell", ["1e999", "9" * 400, "-1e13"])
def test_numbers_too_large_to_mean_anything(refused, cell: str) -> None:
    error = refused(with_cell(3, 11, cell))
    assert error.line == FIRST_ROW + 3
    assert "too large" in error.cause


def test_a_missing_value(refused) -> None:
    error = refused(with_cell(12, 5, ""))
    assert error.line == FIRST_ROW + 12
    assert f"{COLUMNS - 1} values" in error.cause
    assert str(COLUMNS) in error.cause


def test_a_value_too_many(refused) -> None:
    error = refused(with_cell(12, 5, "1 2"))
    assert error.line == FIRST_ROW + 12
    assert f"{COLUMNS + 1} values" in error.cause


def test_a_value_missing_here_and_one_too_many_there(refused) -> None:
    lines = with_cell(12, 5, "").splitlines()
    lines[FIRST_ROW + 19] += " 1.0"
    assert refused("\n".join(lines)).line == FIRST_ROW + 12


@pytest.mark.parametrize("stated", [29, 31, 1_000_000_000, 10**17])
def test_a_wrong_number_of_frames(refused, stated: int) -> None:
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    error = refused(TEXT.replace("Frames: 30", f"Frames: {stated}"))
    assert error.line == MOTION_LINE + 1
    assert error.cause == f"'Frames: {stated}', but there are 30 rows"
    # Kilobytes: what a file claims is not allocated.
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 100_000


def test_no_frames(refused) -> None:
    empty = bvh(np.zeros((0, COLUMNS)))
    error = refused(empty)
    assert error.line == MOTION_LINE + 1
    assert "Frames: 0" in error.cause
    assert "0 rows" in refused(empty.replace("Frames: 0", "Frames: 3")).cause


@pytest.mark.parametrize("stated", ["-3", "many", "", "1e3", "30.5", "NaN"])
def test_a_number_of_frames_that_is_none(refused, stated: str) -> None:
    error = refused(TEXT.replace("Frames: 30", f"Frames: {stated}"))
    assert error.line == MOTION_LINE + 1
    assert "not a number of frames" in error.cause


def test_a_frame_time_that_is_no_number(refused) -> None:
    error = refused(TEXT.replace("0.0333333\n", "fast\n"))
    assert error.line == MOTION_LINE + 2
    assert "'Frame Time: fast'" in error.cause


@pytest.mark.parametrize(
    ("old", "new", "at", "cause"),
    [
        ("CHANNELS 6", "CHANNELS 5", "ROOT", "CHANNELS states 5"),
        ("\t\t\t\tEnd Site", "\t\t\t\tEnd", None, None),
        ("ROOT Hips\n{", "ROOT Hips\n", None, "OFFSET outside a joint"),
        ("Zposition", "Zscale", None, "CHANNELS states 6"),
        ("Yposition", "Xposition", None, "channel Xposition"),
        ("10.0 -5.0 0.0", "10.0 NaN 0.0", None, "'NaN' in an OFFSET"),
        ("10.0 -5.0 0.0", "10.0 -5.0", None, "in an OFFSET"),
        ("\tJOINT Spine", "\tBONE Spine", None, "'BONE Spine'"),
        ("ROOT Hips", "JOINT Hips", None, "not inside a joint"),
        ("\tJOINT Spine", "\tROOT Spine", None, "inside another joint"),
    ],
)
def test_broken_hierarchies(tmp_path: Path, old: str, new: str, at, cause: str | None) -> None:
    path = tmp_path / "take.bvh"
    path.write_text(TEXT.replace(old, new, 1))
    if cause is None:
        formats.read(path)
        return
    with pytest.raises(FileError, match=r"take\.bvh: [0-9]+: ") as caught:
        formats.read(path)
    assert cause in caught.value.cause
    line = TEXT[: TEXT.index(old)].count("\n") + 1
    assert line <= caught.value.line <= line + 2


def test_a_missing_brace(refused) -> None:
    assert "not closed" in refused(TEXT.replace("}\nMOTION", "MOTION")).cause
    assert "closes nothing" in refused(TEXT.replace("}\nMOTION", "}\n}\nMOTION")).cause


def test_a_hierarchy_without_channels(refused) -> None:
    header = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 0\n}\n"
    assert "no joint has channels" in refused(header + "MOTION\nFrames: 1\nFrame Time: 1\n").cause


def test_files_that_cannot_be_opened(tmp_path: Path) -> None:
    for path, cause in (
        (tmp_path / "absent.bvh", "no such file"),
        (tmp_path, "directory"),
        (tmp_path / "nul\0.bvh", "null byte"),
    ):
        with pytest.raises(FileError) as caught:
            formats.read(path)
        assert cause in caught.value.cause
