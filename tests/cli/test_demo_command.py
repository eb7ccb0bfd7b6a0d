"""`mocapstudio demo` does the whole job without a display."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from mocapstudio import formats
from mocapstudio.evaluation.demo import demo_take, demo_with_errors
from mocapstudio.evaluation.truth import analysed_rows, departure, erroneous


def mocapstudio(*words: str) -> subprocess.CompletedProcess[str]:
    blind = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    return subprocess.run(
        [sys.executable, "-m", "mocapstudio", *words],
        env=blind,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, subprocess.CompletedProcess[str]]:
    folder = tmp_path_factory.mktemp("demo") / "out"
    return folder, mocapstudio("demo", "--out", str(folder))


def test_it_ends_well_and_writes_everything(
    done: tuple[Path, subprocess.CompletedProcess[str]],
) -> None:
    folder, ended = done
    assert ended.returncode == 0, ended.stderr
    names = {path.name for path in folder.iterdir()}
    wanted = {"demo.bvh", "demo_clean.bvh", "demo_clean.provenance.json", "report.html"}
    assert wanted | {"truth.json", "map.png", "pose-1.png", "curve-1.png"} <= names
    assert all((folder / name).stat().st_size > 500 for name in wanted)


def test_it_says_how_many_known_errors_were_found(
    done: tuple[Path, subprocess.CompletedProcess[str]],
) -> None:
    _, ended = done
    found = re.search(r"(\d+) of (\d+) known errors found", ended.stdout)
    assert found is not None, ended.stdout
    assert int(found[2]) == 14
    assert int(found[1]) >= 12
    assert ended.stdout.count(" found (") == int(found[1])
    flags = re.search(r"(\d+) flags, (\d+) of them false", ended.stdout)
    assert flags is not None
    assert int(flags[2]) < int(flags[1]) / 2


def test_the_cleaned_take_is_closer_to_the_truth(
    done: tuple[Path, subprocess.CompletedProcess[str]],
) -> None:
    folder, _ = done
    (cleaned,), _ = formats.read(folder / "demo_clean.bvh")
    spoilt, truths = demo_with_errors()
    clean = demo_take()
    rows = analysed_rows(clean.skeleton)[:-2]
    wrong = erroneous(clean, spoilt, truths, rows)
    before, after = (departure(clean, one, rows)[wrong].mean() for one in (spoilt, cleaned))
    assert after < before / 2


def test_nothing_but_the_declared_changes_is_in_the_cleaned_take(
    done: tuple[Path, subprocess.CompletedProcess[str]],
) -> None:
    folder, _ = done
    (before,), _ = formats.read(folder / "demo.bvh")
    (after,), _ = formats.read(folder / "demo_clean.bvh")
    text = (folder / "demo_clean.provenance.json").read_text("utf-8")
    allowed = np.zeros(before.rotations.shape[:2], dtype=bool)
    for change in json.loads(text)["changes"]:
        row = change["joint"]
        joint = before.skeleton.index.get(row, 0)
        allowed[change["start"] : change["end"], joint] = True
    differs = (before.rotations != after.rotations).any(axis=-1)
    moves = (before.translations != after.translations).any(axis=(1, 2))
    assert differs.any()
    assert not (differs & ~allowed).any()
    assert not (moves & ~allowed[:, 0]).any()


def test_a_folder_that_cannot_be_made_is_one_line_and_exit_2(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("a file")
    ended = mocapstudio("demo", "--out", str(tmp_path / "taken"))
    assert ended.returncode == 2
    assert ended.stderr.startswith("error:")
    assert "taken" in ended.stderr
    assert len(ended.stderr.splitlines()) == 1
