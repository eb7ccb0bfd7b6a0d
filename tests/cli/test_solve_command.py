"""The contract of `mocapstudio solve`, and of markers given to commands that need joints."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from mocapstudio import formats
from tests.made_markers import markers_on
from tests.made_takes import walking


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("markers")
    take = walking(seconds=4)
    formats.write(take, folder / "body.bvh")
    formats.write(markers_on(take).take, folder / "markers.trc")
    return folder


def test_solve(mocapstudio, files: Path, tmp_path: Path) -> None:
    done = mocapstudio(
        "solve", files / "markers.trc", "--template", files / "body.bvh", "-o", "out.bvh",
        "--json", "out.json",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    told = json.loads((tmp_path / "out.json").read_text())
    (take,), _ = formats.read(tmp_path / "out.bvh")
    (body,), _ = formats.read(files / "body.bvh")
    assert take.skeleton.names == body.skeleton.names == tuple(told["bones"])
    assert take.frames == told["frames"] == body.frames
    assert told["output"] == "out.bvh"
    residual = told["residual"]
    assert 0 < residual["mean"] < 0.005 < 0.1 > residual["max"] > residual["mean"]
    means = [one["mean"] for one in residual["markers"].values()]
    assert np.mean(means) == pytest.approx(residual["mean"], rel=1e-3)
    assert np.mean(residual["frames"]) == pytest.approx(residual["mean"], rel=1e-3)


def test_markers_without_a_template_say_what_to_do(mocapstudio, files: Path) -> None:
    done = mocapstudio("detect", files / "markers.trc", "--json", "-")
    assert done.returncode == 2
    assert "solve it to a skeleton first" in done.stderr


def test_detect_solves_markers_first(mocapstudio, files: Path) -> None:
    done = mocapstudio(
        "detect", files / "markers.trc", "--template", files / "body.bvh", "--quick", "--json", "-"
    )
    assert done.returncode == 0, done.stderr
    (take,) = json.loads(done.stdout)["takes"]
    (body,), _ = formats.read(files / "body.bvh")
    assert take["joints"] == list(body.skeleton.names)


def test_joints_are_no_markers(mocapstudio, files: Path) -> None:
    done = mocapstudio("solve", files / "body.bvh", "--template", files / "body.bvh", "-o", "o.bvh")
    assert done.returncode == 2
    assert done.stderr.startswith("error: ") and "holds joints already" in done.stderr
