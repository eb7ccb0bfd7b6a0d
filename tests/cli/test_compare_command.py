"""The contract of `mocapstudio compare`: other programs script against it."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from mocapstudio import formats
from mocapstudio.cli.app import run

SOURCE_KEYS = {
    "path",
    "fps",
    "path_pairs",
    "misalignment",
    "misalignment_relative",
    "pose_difference",
    "dissimilarity",
}


@pytest.fixture(scope="module")
def kata(tmp_path_factory: pytest.TempPathFactory, figure) -> dict[str, Path]:
    """A figure that does not repeat itself; the same with a pause; and slower, at half the rate."""
    folder = tmp_path_factory.mktemp("kata")
    whole = figure(seconds=8)
    time = np.arange(240)[:, None] / 30
    rng = np.random.default_rng(5)
    size = rng.uniform(10, 30, whole.values.shape[1] - 3)
    for frequency in (0.17, 0.41):
        phase = rng.uniform(0, 6.28, size.size)
        whole.values[:, 3:] += size * np.sin(2 * np.pi * frequency * time + phase)
    paths = {"reference": whole.write(folder / "teacher.bvh")}
    values = whole.values
    whole.values = np.concatenate([values[:120], np.repeat(values[120:121], 45, 0), values[120:]])
    paths["pause"] = whole.write(folder / "pause.bvh")
    whole.values = values
    paths["twin"] = whole.write(folder / "twin.bvh")
    return paths


@dataclass(frozen=True)
class Done:
    returncode: int
    stdout: str
    stderr: str


@pytest.fixture
def command(capsys: pytest.CaptureFixture[str]) -> Callable[..., Done]:
    """Run a command in this process: most of the time goes into starting another."""

    def call(*words: object) -> Done:
        capsys.readouterr()
        code = run([str(word) for word in words])
        said = capsys.readouterr()
        return Done(code, said.out, said.err)

    return call


def compared(mocapstudio, *words) -> dict:
    done = mocapstudio("compare", *words, "--json", "-")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_json_tells_where_the_source_pauses(mocapstudio, kata) -> None:
    found = compared(mocapstudio, kata["reference"], kata["pause"], kata["twin"])
    assert {"path", "fps"} <= set(found["reference"])
    assert found["reference"]["path"] == str(kata["reference"])
    pause, twin = found["sources"]
    for one, frames in ((pause, 285), (twin, 240)):
        assert set(one) >= SOURCE_KEYS
        assert one["fps"] == 30.0
        for key in ("misalignment", "misalignment_relative", "pose_difference"):
            assert len(one[key]) == frames
        pairs = np.array(one["path_pairs"])
        assert pairs[0].tolist() == [0, 0]
        assert pairs[-1].tolist() == [239, frames - 1]
        steps = np.diff(pairs, axis=0)
        assert steps.min() >= 0
        assert steps.max() == 1
    gap = np.array(pause["misalignment"])
    assert np.abs(gap[:110]).max() < 0.1
    np.testing.assert_allclose(gap[175:], -1.5, atol=0.1)
    relative = np.array(pause["misalignment_relative"])
    assert relative[0] == pytest.approx(0, abs=1e-9)
    assert relative[-1] == pytest.approx(0, abs=1e-9)
    assert not np.any(twin["misalignment"])
    assert twin["dissimilarity"] == 0
    assert found["ranking"] == [str(kata["twin"]), str(kata["pause"])]


def test_labels_are_carried_over(command, kata, tmp_path: Path) -> None:
    labels = tmp_path / "labels.json"
    segments = [
        {"name": "step", "start": 30, "end": 90},
        {"name": "turn", "start": 140, "end": 200},
    ]
    theirs = [{"name": "turn", "start": 185, "end": 245}]
    content = [
        {"take": "teacher.bvh", "fps": 30, "segments": segments},
        {"take": "pause", "fps": 30, "segments": theirs},
    ]
    labels.write_text(json.dumps(content))
    words = (kata["reference"], kata["pause"], "--true-speed", "--labels", labels)
    [source] = compared(command, *words)["sources"]
    step, turn = source["segments"]
    assert (step["name"], turn["name"]) == ("step", "turn")
    assert step["start"] == pytest.approx(30, abs=2)
    assert step["delay"] == pytest.approx(0, abs=0.07)
    assert turn["start"] == pytest.approx(185, abs=3)
    assert turn["end"] == pytest.approx(245, abs=3)
    assert turn["delay"] == pytest.approx(1.5, abs=0.1)
    assert turn["duration"] == pytest.approx(2.0, abs=0.15)
    assert source["label_error"]["largest"] < 0.1
    shown = command("compare", *words)
    assert shown.returncode == 0
    assert "turn" in shown.stdout
    assert "1.5" in shown.stdout


def test_pictures_and_warped_takes_are_written(command, kata, tmp_path: Path) -> None:
    picture, folder = tmp_path / "out.png", tmp_path / "warped"
    done = command(
        "compare", kata["reference"], kata["pause"], "--figure", picture, "--warped", folder
    )
    assert done.returncode == 0, done.stderr
    assert picture.read_bytes().startswith(b"\x89PNG")
    [take], _ = formats.read(folder / "pause.bvh")
    [reference], _ = formats.read(kata["reference"])
    assert (take.frames, take.rate) == (reference.frames, reference.rate)
    dots = np.abs(np.sum(take.rotations * reference.rotations, axis=-1))
    assert np.degrees(2 * np.arccos(np.clip(dots, 0, 1))).mean() < 2
    several = command(
        "compare", kata["reference"], kata["pause"], kata["twin"], "--figure", tmp_path / "a.svg"
    )
    assert several.returncode == 0
    for name in ("a-pause.svg", "a-twin.svg"):
        assert "<svg" in (tmp_path / name).read_text()[:1000]
    everyone = (tmp_path / "a.svg").read_text()
    assert "1  twin" in everyone and "2  pause" in everyone


def test_a_bad_source_is_one_line_and_the_others_are_compared(
    command, kata, tmp_path: Path
) -> None:
    bad = tmp_path / "bad.bvh"
    bad.write_text("HIERARCHY\nnonsense\n")
    out = tmp_path / "out.json"
    done = command("compare", kata["reference"], bad, kata["twin"], "--json", out)
    assert done.returncode == 2
    [line] = [one for one in done.stderr.splitlines() if one.startswith("error:")]
    assert line.startswith(f"error: {bad}: 2: ")
    assert [one["path"] for one in json.loads(out.read_text())["sources"]] == [str(kata["twin"])]


@pytest.mark.parametrize(
    "words",
    [
        ("--figure", "out.jpg"),
        ("--labels", "nowhere.json"),
        ("--figure", "no/such/folder/out.png"),
        ("--features", "smell"),
    ],
)
def test_wrong_use_exits_2_before_any_work(command, kata, words) -> None:
    done = command("compare", kata["reference"], kata["twin"], *words)
    assert done.returncode == 2
    assert len(done.stderr.strip().splitlines()) == 1
    assert done.stderr.startswith("error: ")


def test_labels_of_another_take_are_refused(command, kata, tmp_path: Path) -> None:
    labels = tmp_path / "labels.json"
    labels.write_text(json.dumps({"take": "other", "fps": 30, "segments": []}))
    done = command("compare", kata["reference"], kata["twin"], "--labels", labels)
    assert done.returncode == 2
    assert "holds no labels of teacher" in done.stderr


def test_open_ends_bands_and_masks_are_options(mocapstudio, kata, tmp_path: Path) -> None:
    flag = {"joint": "LeftArm", "joints": ["LeftArm"], "start": 0, "end": 9}
    mask = tmp_path / "flags.json"
    mask.write_text(json.dumps({"takes": [{"path": "twin.bvh", "flags": [flag]}]}))
    arm = ("--mask", mask, "--band", "1.5", "--tolerance", "0.2", "--features", "rotations")
    found = compared(mocapstudio, kata["reference"], kata["twin"], *arm)
    assert found["sources"][0]["dissimilarity"] < 1e-5
    assert found["parameters"]["masked"]
    assert found["parameters"]["band"] == 1.5
    done = mocapstudio("compare", kata["reference"], kata["pause"], "--mask", mask)
    assert "twin is not compared" in done.stderr
    part = compared(mocapstudio, kata["reference"], kata["twin"], "--subsequence", "reference")
    assert part["sources"][0]["path_pairs"][0] == [0, 0]


def test_options_that_contradict_each_other_exit_2(command, kata, tmp_path: Path) -> None:
    for words, what in (
        (("--subsequence", "source", "--open-end", "source"), "--subsequence"),
        (("--open-end", "source", "--band", "2"), "band"),
        (("--mask", tmp_path / "none.json"), "none.json"),
    ):
        done = command("compare", kata["reference"], kata["twin"], *words)
        assert done.returncode == 2, done.stdout
        assert done.stderr.startswith("error: ")
        assert what in done.stderr
        assert len(done.stderr.splitlines()) == 1
