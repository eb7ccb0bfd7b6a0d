"""The contract of `mocapstudio inspect`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

FILE_KEYS = {"path", "format", "frames", "fps", "joints", "markers", "problems"}


def inspected(mocapstudio, *words, code: int = 0) -> list[dict]:
    done = mocapstudio("inspect", *words, "--json", "-")
    assert done.returncode == code, done.stderr
    return json.loads(done.stdout)["files"]


def test_json(mocapstudio, figure, tmp_path: Path) -> None:
    path = figure(seconds=2).write(tmp_path / "take.bvh")
    [file] = inspected(mocapstudio, path)
    assert set(file) >= FILE_KEYS
    assert file["path"] == str(path)
    assert (file["format"], file["frames"], file["fps"]) == ("bvh", 60, 30.0)
    assert file["joints"] == figure().names
    assert file["markers"] == []
    assert file["unit"] == 0.01
    for problem in file["problems"]:
        assert set(problem) >= {"line", "what", "done"}
        assert "guessed" in problem["done"]


def test_the_problems_name_their_lines(mocapstudio, figure, tmp_path: Path) -> None:
    lines = figure(seconds=2).lines()
    at = next(i for i, line in enumerate(lines) if line.startswith("Frame Time"))
    lines[at] = "Frame Time: 0.0"
    path = tmp_path / "take.bvh"
    path.write_text("\n".join(lines))
    [file] = inspected(mocapstudio, path)
    [problem] = [p for p in file["problems"] if "Frame Time" in p["what"]]
    assert problem["line"] == at + 1
    assert file["fps"] == 100.0
    [file] = inspected(mocapstudio, path, "--fps", "119.88", "--unit", "cm", "--up", "y")
    assert file["fps"] == pytest.approx(120_000 / 1001)
    # What the user decides is no guess any more; the root's OFFSET is left to the reader.
    assert [problem["what"].split()[0] for problem in file["problems"]] == ["root"]


def test_one_bad_file_among_several(mocapstudio, figure, tmp_path: Path) -> None:
    good = [figure(seconds=1).write(tmp_path / name) for name in ("a.bvh", "z.bvh")]
    bad = tmp_path / "bad.bvh"
    bad.write_text("\n".join(figure(seconds=1).lines()[:-1]) + "\n1 2 oops\n")
    out = tmp_path / "report.json"
    done = mocapstudio("inspect", good[0], bad, good[1], "--json", out)
    assert done.returncode == 2
    [line] = done.stderr.splitlines()
    assert line.startswith(
        f"error: {bad}: {len(figure(seconds=1).lines())}: 'oops' is not a number"
    )
    files = json.loads(out.read_text())["files"]
    assert [file["path"] for file in files] == [str(path) for path in good]


def test_lenient(mocapstudio, figure, tmp_path: Path) -> None:
    path = tmp_path / "short.bvh"
    path.write_text("\n".join(figure(seconds=1).lines()[:-3]) + "\n")
    assert inspected(mocapstudio, path, code=2) == []
    [file] = inspected(mocapstudio, path, "--lenient")
    assert file["frames"] == 27
    assert any("27 rows" in problem["what"] for problem in file["problems"])


def test_the_table_fits_a_terminal(mocapstudio, figure, tmp_path: Path) -> None:
    figure(seconds=1).write(tmp_path / "take.bvh")
    done = mocapstudio("inspect", tmp_path, COLUMNS="80")
    assert done.returncode == 0
    assert "11 joints" in done.stdout
    assert "30 frames at 30 fps" in done.stdout
    assert "--unit" in done.stdout
    assert max(map(len, done.stdout.splitlines())) <= max(80, len(str(tmp_path / "take.bvh")))


def test_real_takes(mocapstudio, data: Path) -> None:
    files = inspected(mocapstudio, data / "rokoko_animated_drawings_bvh_MIT")
    assert {Path(f["path"]).stem: (f["frames"], len(f["joints"])) for f in files} == {
        "dab": (339, 27),
        "jesse_dance": (1007, 60),
        "wave_hello": (839, 27),
    }


def marker_table(path: Path, rate: float | None = 50.0) -> Path:
    labels = ("Head", "Hips", "LeftToe")
    lines = ["Time," + ",".join(f"{label} {axis}" for label in labels for axis in "XYZ")]
    for i in range(10):
        time = 0.0 if rate is None else i / rate
        lines.append(f"{time:.3f},1,1700,2,3,{900 + i},4,0,{'0' if i < 2 else '20'},0")
    path.write_text("\n".join(lines) + "\n")
    return path


def test_markers(mocapstudio, tmp_path: Path) -> None:
    [file] = inspected(mocapstudio, marker_table(tmp_path / "take.csv"))
    assert set(file) >= FILE_KEYS
    assert (file["format"], file["frames"], file["fps"], file["unit"]) == ("csv", 10, 50.0, 0.001)
    assert (file["joints"], file["markers"]) == ([], ["Head", "Hips", "LeftToe"])
    assert file["missing"] == {"Head": 0, "Hips": 0, "LeftToe": 2}
    told = {problem["what"]: problem for problem in file["problems"]}
    assert told["2 positions are exactly 0 0 0"]["line"] == 2
    assert told["no unit stated"]["option"] == "--unit"
    assert told["no up axis stated"]["option"] == "--up"
    done = mocapstudio("inspect", tmp_path / "take.csv")
    assert "3 markers, 10 frames at 50 fps" in done.stdout


def test_a_rate_that_nothing_tells_is_asked_for(mocapstudio, tmp_path: Path) -> None:
    path = marker_table(tmp_path / "take.csv", rate=None)
    done = mocapstudio("inspect", path)
    assert done.returncode == 2
    assert done.stderr == f"error: {path}: -: no frame rate (all times are alike): --fps tells it\n"
    [file] = inspected(mocapstudio, path, "--fps", "100")
    assert file["fps"] == 100.0


def test_the_user_decides_what_was_guessed(mocapstudio, figure, tmp_path: Path) -> None:
    path = figure(seconds=1).write(tmp_path / "take.bvh")
    [file] = inspected(
        mocapstudio,
        *(path, "--unit", "0.02", "--up", "z", "--forward", "-x", "--root-offset", "add"),
        *("--angles", "radians", "--t-pose", "keep"),
    )
    assert file["unit"] == 0.02
    assert file["problems"] == []
    done = mocapstudio("inspect", path, "--up", "z", "--forward", "z")
    assert done.returncode == 2
    assert done.stderr == "error: forward z is along the up axis z\n"


@pytest.mark.parametrize("command", ["inspect", "convert", "detect", "clean", "review"])
def test_every_command_that_reads_takes_has_the_readers_options(mocapstudio, command: str) -> None:
    shown = mocapstudio(command, "--help", COLUMNS="200").stdout
    for option in ("--fps", "--unit", "--up", "--forward", "--angles", "--root-offset"):
        assert option in shown
    for option in ("--t-pose", "--lenient", "--joint-map"):
        assert option in shown
