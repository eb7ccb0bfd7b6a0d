"""Events marked in two performances: carried over by every method, and scored in seconds."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from made_takes import paced, walking

from mocapstudio import formats
from mocapstudio.cli.app import run as command
from mocapstudio.cli.evaluate import label_files
from mocapstudio.comparison.labels import Labels, write_labels
from mocapstudio.comparison.model import Segment
from mocapstudio.evaluation.kata_events import METHODS, PLAIN, event_table, found_events
from mocapstudio.motion.errors import FileError, SkeletonMismatchError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.progress import run

MARKS = (10, 30, 45, 70, 85)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A walk, the same at another pace, and their marks; outside of them both stand about."""
    path = tmp_path_factory.mktemp("marked")
    one = replace(walking(3.0, seed=4), name="one")
    pace = 1.0 + 0.5 * np.sin(np.arange(one.frames) / 12.0)
    other = replace(paced(one, pace), name="other")
    truth = np.cumsum(pace)[: other.frames]
    marks = {"one": MARKS, "other": tuple(int(np.searchsorted(truth, at)) for at in MARKS)}
    for take in (one, other):
        formats.write(take, path / f"{take.name}.bvh")
    labels = []
    for name, own in marks.items():
        parts = tuple(Segment("abcd"[k], own[k], own[k + 1]) for k in range(4))
        labels.append(Labels(name, Fraction(30), parts))
    write_labels(labels, path / "marks.json")
    shifted = tuple(replace(s, start=s.start + 3, end=s.end + 3) for s in labels[1].segments[1:])
    first = replace(labels[1].segments[0], end=shifted[0].start)
    write_labels([labels[0], replace(labels[1], segments=(first, *shifted))], path / "late.json")
    return path


def test_events_of_the_same_walk_are_found_and_late_marks_count_as_misses(folder: Path) -> None:
    rows = run(found_events([folder], [folder / "marks.json", folder / "late.json"]))
    assert {(row.method, row.labels) for row in rows} == {
        (method, name) for method in (*METHODS, PLAIN) for name in ("marks", "late", "all")
    }
    for row in rows:
        assert (row.pairs, row.events) == ((4, 12) if row.labels == "all" else (2, 6))
        assert row.median <= row.high
        if row.labels == "marks":
            assert row.high < 2.5 / 30
        if row.labels == "late":
            assert 1.5 / 30 < row.median < 6 / 30
    lines = event_table(rows).rows
    assert len(lines) == len(rows)
    assert all(line[4].endswith(" s") for line in lines)


def test_performances_that_share_nothing_are_refused(folder: Path, tmp_path: Path) -> None:
    points = np.random.default_rng(0).normal(size=(90, 4, 3))
    takes = tuple("wxyz")
    stranger = MarkerTake("stranger", takes, points, Fraction(30))
    formats.write(stranger, tmp_path / "stranger.trc")
    parts = (Segment("a", 0, 40), Segment("b", 40, 90))
    labels = [Labels(name, Fraction(30), parts) for name in ("one", "stranger")]
    write_labels(labels, tmp_path / "strange.json")
    with pytest.raises(SkeletonMismatchError, match="cannot be compared"):
        run(found_events([folder, tmp_path], [tmp_path / "strange.json"]))


def test_events_are_for_alignment_alone(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["evaluate", "detection", "--data", str(folder), "--events", str(folder / "marks.json")]
    assert command(words) == 2
    said = capsys.readouterr().err
    assert said.startswith("error: ")
    assert "--events" in said
    assert said.count("\n") == 1


def test_a_folder_of_labels_stands_for_its_files(folder: Path, tmp_path: Path) -> None:
    write_labels(Labels("one", Fraction(30), (Segment("a", 0, 40),)), tmp_path / "b.json")
    (tmp_path / "README.md").write_text("not labels")
    assert label_files([tmp_path, folder / "x.json"]) == [tmp_path / "b.json", folder / "x.json"]
    (tmp_path / "none").mkdir()
    with pytest.raises(FileError, match="holds no labels"):
        label_files([tmp_path / "none"])
