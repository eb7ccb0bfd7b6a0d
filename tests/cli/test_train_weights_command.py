"""`mocapstudio train-weights`: from labelled takes to a file that `align` reads."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from mocapstudio.cli.app import run
from mocapstudio.comparison.weights import read_weights

CUTS = (0, 20, 45, 70, 90)


@pytest.fixture
def takes(tmp_path: Path, figure: type) -> list[Path]:
    """One performance at four paces; 0 is the reference."""
    paths, known = [], []
    for k in range(4):
        same = figure(3.0, seed=3)
        at = np.linspace(0, 1, 90 + 9 * k) ** (1 + 0.1 * k) * 89
        same.values = np.column_stack(
            [np.interp(at, np.arange(90), column) for column in same.values.T]
        )
        folder = tmp_path / ("ann" if k < 3 else "bob")
        folder.mkdir(exist_ok=True)
        paths.append(same.write(folder / f"take_{k}.bvh"))
        cuts = [*np.searchsorted(at, CUTS[:-1]), len(at)]
        segments = [
            {"name": "abcd"[i], "start": int(cuts[i]), "end": int(cuts[i + 1])} for i in range(4)
        ]
        known.append({"take": f"take_{k}", "fps": 30, "segments": segments})
    (tmp_path / "labels.json").write_text(json.dumps(known))
    return paths


def words(takes: list[Path], tmp_path: Path, *more: object) -> list[str]:
    out = tmp_path / "weights.json"
    labels = tmp_path / "labels.json"
    used = [*takes, "--labels", labels, "-o", out, "--iterations", 2, *more]
    return ["train-weights", *map(str, used)]


def test_weights_and_the_quality_of_every_fold_are_written(
    takes: list[Path], tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert run(words(takes, tmp_path, "--folds", 3, "--json", tmp_path / "out.json")) == 0
    learnt = read_weights(tmp_path / "weights.json")
    assert learnt.reference == "take_0"
    # Takes of two folders: two performers, two folds.
    assert {fold.performers for fold in learnt.folds} == {("ann",), ("bob",)}
    assert all(0.5 < fold.test <= 1 for fold in learnt.folds)
    assert np.mean(list(learnt.weights.values())) == pytest.approx(1.0, abs=1e-5)
    told = json.loads((tmp_path / "out.json").read_text())
    assert told["weights"] == dict(learnt.weights)
    assert 0.5 < told["quality"] <= 1
    assert told["provenance"]["takes"] == [str(path) for path in takes[1:]]
    capfd.readouterr()
    both = [str(takes[0]), str(takes[1]), "--weights", str(tmp_path / "weights.json")]
    assert run(["align", *both]) == 0
    last = json.loads(capfd.readouterr().out.splitlines()[-1])
    assert abs(last["reference_frame"] - 89) <= 1


def test_who_performs_can_be_told_from_names(takes: list[Path], tmp_path: Path) -> None:
    assert run(words(takes, tmp_path, "--performer", r"_(\d)", "--paper", "--folds", 3)) == 0
    learnt = read_weights(tmp_path / "weights.json")
    assert {fold.performers for fold in learnt.folds} == {("1",), ("2",), ("3",)}
    assert not learnt.motion


def test_a_bad_take_does_not_keep_the_others_from_being_learnt(
    takes: list[Path], tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    takes[1].write_text("no motion at all")
    assert run(words(takes, tmp_path, "--folds", 0)) == 2
    assert "take_1.bvh" in capfd.readouterr().err
    assert read_weights(tmp_path / "weights.json").folds == ()


def test_wrong_use_is_one_line_and_nothing_is_written(
    takes: list[Path], tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "none.json").write_text('{"take": "x", "fps": 30, "segments": []}')
    labels = ["--labels", str(tmp_path / "none.json")]
    out = ["-o", str(tmp_path / "w.json")]
    cases = [
        ([*map(str, takes), *labels, *out], "has no labels of take_0.bvh"),
        (words([takes[0], takes[0]], tmp_path)[1:], "has no labels of any of the takes"),
        (words(takes, tmp_path, "--performer", "(")[1:], "no regular expression"),
        (words(takes, tmp_path, "--performer", "zz")[1:], "tells no performer"),
    ]
    for arguments, cause in cases:
        assert run(["train-weights", *arguments]) == 2
        err = capfd.readouterr().err
        assert cause in err
        assert len(err.splitlines()) == 1
    assert not (tmp_path / "w.json").exists()
