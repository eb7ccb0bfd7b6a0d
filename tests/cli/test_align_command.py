"""`mocapstudio align`: a line of JSON a frame, from a take and from standard input."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from mocapstudio import formats
from mocapstudio.cli.app import run
from mocapstudio.motion.take import Take


@pytest.fixture
def reference(tmp_path: Path, figure: type) -> Path:
    return figure(4.0, seed=3).write(tmp_path / "reference.bvh")


@pytest.fixture
def warped(tmp_path: Path, figure: type) -> tuple[Path, np.ndarray]:
    """The reference at another pace, and the true frame of each of its frames."""
    same = figure(4.0, seed=3)
    pace = 1.0 + 0.4 * np.sin(np.arange(200) / 20.0)
    truth = np.cumsum(pace) - pace[0]
    truth = truth[truth < len(same.values) - 1]
    frames = np.arange(len(same.values))
    same.values = np.column_stack([np.interp(truth, frames, column) for column in same.values.T])
    return same.write(tmp_path / "warped.bvh"), truth


def labels(path: Path, take: str = "reference") -> Path:
    parts = [("first", 0, 40), ("second", 40, 90), ("third", 95, 120)]
    segments = [{"name": name, "start": a, "end": b} for name, a, b in parts]
    path.write_text(json.dumps({"take": take, "fps": 30, "segments": segments}))
    return path


def lines(text: str) -> list[dict]:
    return [json.loads(line) for line in text.splitlines()]


def as_lines(path: Path) -> list[str]:
    """A take as a stream would send it."""
    take = formats.read(path)[0][0]
    return [json.dumps(one) for one in as_frames(take)]


def as_frames(take: Take) -> list[dict]:
    names = take.skeleton.names
    return [
        {
            "time": i / float(take.rate),
            "joints": dict(zip(names, pose.tolist(), strict=True)),
            "root": take.translations[i, 0].tolist(),
        }
        for i, pose in enumerate(take.rotations)
    ]


Align = Callable[..., tuple[int, str, str]]


@pytest.fixture
def align(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Align:
    """Run the command in this process; return exit code, standard output and standard error."""

    def run_it(*words: object, sent: str = "") -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "stdin", io.StringIO(sent))
        code = run(["align", *map(str, words)])
        return (code, *capfd.readouterr())

    return run_it


def test_a_take_is_followed_line_by_line(
    align: Align, reference: Path, warped: tuple[Path, np.ndarray], tmp_path: Path
) -> None:
    stream, truth = warped
    code, out, err = align(reference, stream, "--labels", labels(tmp_path / "labels.json"))
    assert code == 0, err
    found = lines(out)
    assert [line["frame"] for line in found] == list(range(len(truth)))
    frames = np.array([line["reference_frame"] for line in found])
    assert np.median(np.abs(frames - truth)) <= 1
    assert np.abs(frames - truth)[10:].max() <= 6
    for line in found:
        at = line["reference_frame"]
        named = "first" if at < 40 else "second" if at < 90 else None if at < 95 else "third"
        assert line["label"] == named
        assert line["misalignment"] == pytest.approx((at - line["frame"]) / 30, abs=1e-5)
        assert line["cost"] >= 0


def test_standard_input_gives_what_the_take_gives(
    align: Align, reference: Path, warped: tuple[Path, np.ndarray]
) -> None:
    stream, _ = warped
    wanted = lines(align(reference, stream)[1])
    code, out, err = align(reference, "-", sent="\n".join(as_lines(stream)) + "\n")
    assert code == 0, err
    found = lines(out)
    assert [line["reference_frame"] for line in found] == [one["reference_frame"] for one in wanted]
    np.testing.assert_allclose(
        [line["cost"] for line in found], [one["cost"] for one in wanted], atol=1e-5
    )


def test_missing_repeated_and_broken_lines_are_told(align: Align, reference: Path) -> None:
    sent = as_lines(reference)
    text = [*sent[:30], sent[29], *sent[30:50], "{broken", *sent[56:]]
    empty = json.dumps({"time": 50 / 30, "joints": {}, "root": [0, 0, 0]})
    text.insert(52, empty)
    code, out, err = align(reference, "-", sent="\n".join(text))
    assert code == 2
    assert err.splitlines() == [
        "error: standard input: 52: is not JSON: Expecting property name enclosed in double quotes"
    ]
    found = lines(out)
    assert len(found) == len(text) - 1
    notes = {line["frame"]: line["note"] for line in found if "note" in line}
    assert notes == {30: "repeated", 51: "unseen", 52: "bridged"}
    assert found[51]["reference_frame"] is None
    assert abs(found[-1]["reference_frame"] - 119) <= 1


def test_each_line_is_answered_before_the_next_is_sent(
    caches: dict[str, str], reference: Path
) -> None:
    sent = as_lines(reference)[:5]
    process = subprocess.Popen(
        [sys.executable, "-m", "mocapstudio", "align", str(reference), "-"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, **caches},
    )
    assert process.stdin is not None
    assert process.stdout is not None
    for i, line in enumerate(sent):
        process.stdin.write(line + "\n")
        process.stdin.flush()
        assert json.loads(process.stdout.readline())["frame"] == i
    process.stdin.close()
    assert process.wait(60) == 0


def test_bad_input_is_one_line(align: Align, reference: Path, tmp_path: Path, figure: type) -> None:
    other = figure(2.0, prefix="x_").write(tmp_path / "other.bvh")
    (tmp_path / "w.json").write_text('{"weights": {"tail": 1}}')
    cases = [
        ([reference, tmp_path / "none.bvh"], "none.bvh"),
        ([reference, other], "another skeleton"),
        ([reference, reference, "--weights", tmp_path / "w.json"], "weights are not for"),
        ([reference, reference, "--labels", labels(tmp_path / "l.json", "x")], "l.json"),
    ]
    for words, cause in cases:
        code, out, err = align(*words)
        assert (code, out) == (2, "")
        assert len(err.splitlines()) == 1
        assert err.startswith("error: ")
        assert cause in err


def test_a_stream_of_another_skeleton_is_refused(align: Align, reference: Path) -> None:
    stranger = json.dumps({"time": 0, "joints": {"tail": [0, 0, 0, 1]}})
    code, _, err = align(reference, "-", sent=stranger)
    assert code == 2
    assert "standard input: 1: another skeleton" in err


def test_what_is_waited_for_is_found(align: Align, reference: Path) -> None:
    frames = as_frames(formats.read(reference)[0][0])
    still = [dict(frames[0], time=i / 30) for i in range(60)]
    moving = [dict(frame, time=2 + frame["time"]) for frame in frames]
    text = "\n".join(json.dumps(frame) for frame in [*still, *moving])
    found = lines(align(reference, "-", "--wait", sent=text)[1])
    assert all(line["reference_frame"] is None for line in found[:55])
    begun = next(line["frame"] for line in found if line["reference_frame"] is not None)
    # It takes some frames to tell a beginning from a twitch.
    assert abs(begun - 60) <= 12
    followed = [line for line in found[80:] if line["reference_frame"] is not None]
    assert len(followed) >= 60
    off = [abs(line["reference_frame"] - (line["frame"] - 60)) for line in followed]
    assert np.median(off) <= 4
