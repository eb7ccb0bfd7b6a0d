from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from mocapstudio.cli.output import STANDARD_OUTPUT, check_writable, write_json, write_npz
from mocapstudio.motion.errors import FileError


def test_numbers_of_numpy_and_fractions(tmp_path: Path) -> None:
    result = {
        "a": np.float32(0.5),
        "b": np.int64(3),
        "c": np.arange(3),
        "d": Fraction(120000, 1001),
        "e": Path("a/b"),
    }
    write_json(result, tmp_path / "x.json")
    assert json.loads((tmp_path / "x.json").read_text()) == {
        "a": 0.5,
        "b": 3,
        "c": [0, 1, 2],
        "d": 120000 / 1001,
        "e": str(Path("a/b")),
    }


def test_dash_is_standard_output(capsys) -> None:
    write_json({"takes": []}, STANDARD_OUTPUT)
    assert json.loads(capsys.readouterr().out) == {"takes": []}


def test_nowhere(capsys) -> None:
    write_json({"takes": []}, None)
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize("value", [float("nan"), float("inf"), object()])
def test_what_json_does_not_know_leaves_the_old_file(tmp_path: Path, value: object) -> None:
    path = tmp_path / "x.json"
    path.write_text("old")
    with pytest.raises((ValueError, TypeError)):
        write_json({"a": value}, path)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_npz_comes_back(tmp_path: Path) -> None:
    write_npz({"a": np.eye(3), "b": np.array(["x", "yy"])}, tmp_path / "x.npz")
    with np.load(tmp_path / "x.npz", allow_pickle=False) as stored:
        assert (stored["a"] == np.eye(3)).all()
        assert list(stored["b"]) == ["x", "yy"]


def test_folders_and_missing_folders_are_refused(tmp_path: Path) -> None:
    for path in (tmp_path, tmp_path / "absent" / "x.json"):
        with pytest.raises(FileError, match=str(path)):
            check_writable(path)
    check_writable(None)
    check_writable(STANDARD_OUTPUT)
    check_writable(tmp_path / "x.json")
    assert list(tmp_path.iterdir()) == []
