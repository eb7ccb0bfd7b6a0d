"""What bad input gets: one line that names file, line and cause, exit 2, nothing left behind."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest

Lines = list[str]


def _row(lines: Lines, frame: int) -> int:
    return next(at for at, line in enumerate(lines) if line.startswith("Frame Time")) + 1 + frame


def _not_bvh(lines: Lines) -> int:
    lines[:] = ["Dear diary,", "today I danced."]
    return 1


def _empty(lines: Lines) -> None:
    lines.clear()


def _cut_in_a_row(lines: Lines) -> int:
    at = _row(lines, 40)
    del lines[at + 1 :]
    lines[at] = lines[at][: len(lines[at]) // 2].rsplit(" ", 1)[0]
    return at + 1


def _cut_in_the_hierarchy(lines: Lines) -> int:
    del lines[12:]
    return 12


def _word(lines: Lines) -> int:
    at = _row(lines, 7)
    lines[at] = lines[at].replace(lines[at].split()[5], "fast", 1)
    return at + 1


def _nan(lines: Lines) -> int:
    at = _row(lines, 9)
    lines[at] = " ".join(["nan", *lines[at].split()[1:]])
    return at + 1


def _value_missing(lines: Lines) -> int:
    at = _row(lines, 11)
    lines[at] = lines[at].rsplit(" ", 1)[0]
    return at + 1


def _more_frames_than_rows(lines: Lines) -> None:
    at = next(at for at, line in enumerate(lines) if line.startswith("Frames:"))
    lines[at] = "Frames: 9999"


def _fewer_frames_than_rows(lines: Lines) -> None:
    at = next(at for at, line in enumerate(lines) if line.startswith("Frames:"))
    lines[at] = "Frames: 10"


def _no_frames(lines: Lines) -> None:
    at = next(at for at, line in enumerate(lines) if line.startswith("Frames:"))
    lines[at] = "Frames: 0"
    del lines[at + 2 :]


BAD: list[Callable[[Lines], int | None]] = [
    _not_bvh,
    _empty,
    _cut_in_a_row,
    _cut_in_the_hierarchy,
    _word,
    _nan,
    _value_missing,
    _more_frames_than_rows,
    _fewer_frames_than_rows,
    _no_frames,
]


def told(stderr: str, path: Path) -> tuple[int | None, str]:
    """Line and cause of the one complaint."""
    [line] = stderr.splitlines()
    match = re.fullmatch(rf"error: {re.escape(str(path))}: (-|\d+): (\S.*)", line)
    assert match, line
    return (None if match[1] == "-" else int(match[1])), match[2]


@pytest.mark.parametrize("spoil", BAD, ids=lambda spoil: spoil.__name__.strip("_"))
def test_bad_take(mocapstudio, tmp_path: Path, figure, spoil) -> None:
    lines = figure(seconds=4).lines()
    expected = spoil(lines)
    path = tmp_path / "bad.bvh"
    path.write_text("\n".join(lines) + "\n" if lines else "")
    done = mocapstudio("detect", "--quick", path, "--json", "-")
    assert done.returncode == 2
    assert json.loads(done.stdout) == {"takes": []}
    line, _ = told(done.stderr, path)
    if expected is not None:
        assert line == expected


@pytest.mark.parametrize("command", ["detect", "inspect"])
def test_one_bad_file_among_several(mocapstudio, broken, tmp_path, figure, command) -> None:
    bad = tmp_path / "bad.bvh"
    bad.write_text("HIERARCHY\nROOT\n")
    good = figure(seed=1).write(tmp_path / "good.bvh")
    words = [command, *(["--quick"] if command == "detect" else [])]
    done = mocapstudio(*words, broken, bad, tmp_path / "absent.bvh", good, "--json", "out.json")
    assert done.returncode == 2
    first, second = sorted(done.stderr.splitlines())
    assert first.startswith(f"error: {tmp_path / 'absent.bvh'}: -: ")
    assert second.startswith(f"error: {bad}: ")
    result = json.loads((tmp_path / "out.json").read_text())
    [entries] = result.values()
    assert [entry["path"] for entry in entries] == [str(broken), str(good)]


def test_context_of_another_skeleton(mocapstudio, broken, tmp_path, figure) -> None:
    """Refused before anything is learnt from it."""
    other = figure(prefix="someone:").write(tmp_path / "other.bvh")
    cache = tmp_path / "cache"
    words = ("detect", broken, "--context", other, "--json", "-")
    done = mocapstudio(*words, XDG_CACHE_HOME=str(cache))
    assert done.returncode == 2
    told(done.stderr, other)
    assert json.loads(done.stdout) == {"takes": []}
    assert not list(cache.rglob("*.npz"))


@pytest.mark.parametrize("option", ["--json", "--map"])
def test_unwritable_output_is_refused_before_the_work(
    mocapstudio, tmp_path: Path, figure, option: str
) -> None:
    take = figure().write(tmp_path / "take.bvh")
    target = tmp_path / "no such folder" / "out.npz"
    done = mocapstudio("detect", take, option, target)
    assert done.returncode == 2
    told(done.stderr, target)
    assert sorted(tmp_path.iterdir()) == [take]


def test_output_below_a_file(mocapstudio, tmp_path: Path, figure) -> None:
    take = figure().write(tmp_path / "take.bvh")
    done = mocapstudio("clean", take, "-o", take / "out.bvh")
    assert done.returncode == 2
    told(done.stderr, take / "out.bvh")
    assert sorted(tmp_path.iterdir()) == [take]


@pytest.mark.parametrize(
    ("words", "named"),
    [
        ([], "TAKE"),
        (["x.bvh", "--threshold", "much"], "--threshold"),
        (["x.bvh", "--threshold", "7"], "hreshold"),
        (["x.bvh", "--mode", "guess"], "--mode"),
        (["x.bvh", "--fps", "quick"], "quick"),
        (["x.bvh", "--fps", "0"], "0"),
        (["x.bvh", "--unit", "parsec"], "parsec"),
        (["x.bvh", "--up", "w"], "--up"),
        (["x.bvh", "--faster"], "--faster"),
    ],
)
def test_wrong_use(mocapstudio, tmp_path: Path, figure, words: list[str], named: str) -> None:
    figure(seconds=2).write(tmp_path / "x.bvh")
    done = mocapstudio("detect", *words)
    assert done.returncode == 2
    [line] = done.stderr.splitlines()
    assert line.startswith("error: ")
    assert named in line
    assert done.stdout == ""


@pytest.mark.parametrize("text", ["{", "[1, 2]", '{"a": 1}', '{"a": "Hips", "b": "Hips"}'])
def test_bad_joint_map(mocapstudio, broken: Path, tmp_path: Path, text: str) -> None:
    names = tmp_path / "names.json"
    names.write_text(text)
    done = mocapstudio("detect", broken, "--context", broken, "--joint-map", names)
    assert done.returncode == 2
    told(done.stderr, names)


MARKERS = "Frame,LFHD X,LFHD Y,LFHD Z,RTOE X,RTOE Y,RTOE Z\n" + "".join(
    f"{frame},0.1,1.7,0.{frame},0.1,0.1,0.{frame}\n" for frame in range(1, 9)
)


def test_markers_in_a_folder_of_takes_are_left_out(mocapstudio, figure, tmp_path: Path) -> None:
    folder = tmp_path / "takes"
    folder.mkdir()
    take = figure(seconds=2.0).write(folder / "joints.bvh")
    markers = folder / "markers.csv"
    markers.write_text(MARKERS)
    words = ("--fps", 100, "--json", "-")
    done = mocapstudio("detect", folder, *words)
    assert done.returncode == 0
    assert [one["path"] for one in json.loads(done.stdout)["takes"]] == [str(take)]
    assert f"warning: {markers}: -: left out: it holds markers" in done.stderr
    assert "error:" not in done.stderr
    # By name it is bad input, also beside its folder.
    done = mocapstudio("detect", folder, markers, *words)
    assert done.returncode == 2
    assert [one["path"] for one in json.loads(done.stdout)["takes"]] == [str(take)]
    assert f"error: {markers}: -: holds markers" in done.stderr


def test_a_folder_of_nothing_but_markers_is_bad_input(mocapstudio, figure, tmp_path: Path) -> None:
    folder = tmp_path / "takes"
    folder.mkdir()
    (folder / "markers.csv").write_text(MARKERS)
    context = figure(seconds=2.0).write(tmp_path / "joints.bvh")
    done = mocapstudio("detect", folder, "--context", context, "--fps", 100, "--json", "-")
    assert done.returncode == 2
    assert json.loads(done.stdout)["takes"] == []
    assert f"error: {folder / 'markers.csv'}: -: holds markers" in done.stderr
