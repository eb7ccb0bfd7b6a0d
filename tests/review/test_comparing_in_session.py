"""A comparison in session file and journal: saved, journalled, restored, relocated."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from made_comparison import shortened
from made_takes import walking

from mocapstudio import formats
from mocapstudio.comparison.parameters import ComparisonParameters
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.review import session_file
from mocapstudio.review.comparing import Comparing
from mocapstudio.review.document import Document
from mocapstudio.review.journal import Journal, recover, unfinished

CHOSEN = ComparisonParameters(features="root", true_speed=True, tolerance=0.2, band=3.0)


@pytest.fixture(scope="module")
def walk():
    return walking(seconds=2.0, rate=60)


@pytest.fixture
def files(walk, tmp_path: Path) -> list[Path]:
    """A teacher and two pupils of joints, and one of markers, each in a file."""
    folder = tmp_path / "takes"
    folder.mkdir()
    made = []
    for number, name in enumerate(("teacher", "ana", "ben")):
        made.append(folder / f"{name}.bvh")
        formats.write(shortened(walk, 120 - 10 * number, name), made[-1])
    markers = MarkerTake("marked", walk.skeleton.names, take_pose(walk)[0], walk.rate)
    made.append(folder / "marked.trc")
    formats.write(markers, made[-1])
    return made


def compared(files: list[Path]) -> Comparing:
    """A comparison of them, with parameters, segments and a selection."""
    takes = [formats.read_any(path)[0][0] for path in files]
    sitting = Comparing()
    sitting.set_reference(takes[0])
    sitting.add_sources(takes[1:])
    sitting.set_parameters(CHOSEN)
    sitting.add_segment(10, 40, "bow")
    sitting.add_segment(50, 90, "kick")
    sitting.choose("ben")
    sitting.select_segment(1)
    sitting.select_row("LeftHand")
    sitting.show(5.0, 60.0)
    sitting.go_both(51, 33)
    return sitting


def restored(document: Document) -> Comparing:
    sitting = Comparing()
    sitting.restore(document.state.comparison)
    return sitting


def saved(sitting: Comparing, path: Path) -> Document:
    document = Document("ana")
    document.keep_comparison(sitting.kept())
    session_file.save(document, path)
    return document


def assert_same(one: Comparing, other: Comparing) -> None:
    ours, theirs = one.kept(), other.kept()
    for name in ("parameters", "segments", "labels", "unsaved", "chosen", "row", "segment",
                 "frame", "source_frame", "shown"):  # fmt: skip
        assert getattr(theirs, name) == getattr(ours, name), name
    assert [one for one, _ in theirs.sources] == [one for one, _ in ours.sources]
    takes = zip([*dict(ours.sources).values(), ours.reference],
                [*dict(theirs.sources).values(), theirs.reference], strict=True)  # fmt: skip
    for mine, found in takes:
        assert type(mine) is type(found)
        assert mine.name == found.name
        parts = ("positions",) if isinstance(mine, MarkerTake) else ("rotations", "translations")
        for part in parts:
            np.testing.assert_array_equal(getattr(found, part), getattr(mine, part))


def test_a_comparison_comes_back_as_it_was(files, tmp_path: Path) -> None:
    sitting = compared(files)
    document = saved(sitting, tmp_path / "one.mocapstudio")
    assert not document.state.dirty
    loaded = session_file.load(tmp_path / "one.mocapstudio")
    assert loaded.state.problems == ()
    assert not loaded.state.dirty
    again = restored(loaded)
    assert_same(sitting, again)
    assert len(again.pending()) == 3, "everything is compared anew"
    assert again.state.can_undo is None
    again.delete_segment(0)
    again.undo()
    assert_same(sitting, replace_selection(again, 1))


def replace_selection(sitting: Comparing, segment: int) -> Comparing:
    frame, source = sitting.state.frame, sitting.state.source_frame
    sitting.select_segment(segment)
    sitting.go_both(frame, source)
    return sitting


def test_what_lasts_makes_a_session_dirty_and_looking_does_not(files, tmp_path: Path) -> None:
    sitting = compared(files)
    document = saved(sitting, tmp_path / "one.mocapstudio")
    sitting.go_both(3, 3)
    sitting.choose("ana")
    document.keep_comparison(sitting.kept())
    assert not document.state.dirty
    sitting.set_parameters(replace(CHOSEN, tolerance=0.3))
    document.keep_comparison(sitting.kept())
    assert document.state.dirty
    sitting.undo()
    document.keep_comparison(sitting.kept())
    assert not document.state.dirty


def test_takes_without_a_file_lie_in_the_session(walk, tmp_path: Path) -> None:
    sitting = Comparing()
    markers = MarkerTake("made", walk.skeleton.names, take_pose(walk)[0], walk.rate)
    sitting.set_reference(replace(walk, source=None))
    sitting.add_sources([replace(shortened(walk, 80, "cut"), source=None), markers])
    saved(sitting, tmp_path / "one.mocapstudio")
    assert_same(sitting, restored(session_file.load(tmp_path / "one.mocapstudio")))


def test_takes_that_were_moved_are_found_by_one_answer(files, tmp_path: Path) -> None:
    sitting = compared(files)
    saved(sitting, tmp_path / "one.mocapstudio")
    there = tmp_path / "elsewhere"
    shutil.move(tmp_path / "takes", there)
    asked: list[Path] = []

    def relocate(path: Path) -> Path:
        asked.append(path)
        return there

    loaded = session_file.load(tmp_path / "one.mocapstudio", relocate)
    assert_same(sitting, restored(loaded))
    assert len(asked) == 1


def test_a_session_moves_together_with_its_takes(files, tmp_path: Path) -> None:
    sitting = compared(files)
    saved(sitting, tmp_path / "one.mocapstudio")
    there = tmp_path / "all"
    there.mkdir()
    shutil.move(tmp_path / "takes", there / "takes")
    shutil.move(tmp_path / "one.mocapstudio", there)
    assert_same(sitting, restored(session_file.load(there / "one.mocapstudio")))


def test_a_missing_source_is_told_and_kept(files, tmp_path: Path) -> None:
    sitting = compared(files)
    saved(sitting, tmp_path / "one.mocapstudio")
    aside = files[1].rename(tmp_path / "aside.bvh")
    loaded = session_file.load(tmp_path / "one.mocapstudio")
    assert [one.what for one in loaded.state.problems] == [f"compared: {files[1]} is missing"]
    again = restored(loaded)
    assert [one.id for one in again.state.sources] == ["ben", "marked"]
    loaded.keep_comparison(again.kept())
    session_file.save(loaded, tmp_path / "one.mocapstudio")
    aside.rename(files[1])
    third = restored(session_file.load(tmp_path / "one.mocapstudio"))
    assert [one.id for one in third.state.sources] == ["ben", "marked", "ana"]


def test_without_its_reference_a_comparison_waits(files, tmp_path: Path) -> None:
    sitting = compared(files)
    saved(sitting, tmp_path / "one.mocapstudio")
    aside = files[0].rename(tmp_path / "aside.bvh")
    loaded = session_file.load(tmp_path / "one.mocapstudio")
    again = restored(loaded)
    assert again.state.reference is None
    assert again.state.segments == ()
    loaded.keep_comparison(again.kept())
    session_file.save(loaded, tmp_path / "one.mocapstudio")
    aside.rename(files[0])
    assert_same(sitting, restored(session_file.load(tmp_path / "one.mocapstudio")))


def test_a_crash_costs_nothing_of_a_comparison(files, walk, tmp_path: Path) -> None:
    path = tmp_path / "one.mocapstudio"
    sitting = compared(files)
    document = saved(sitting, path)
    journal = Journal(document)
    sitting.add_sources([replace(shortened(walk, 70, "held"), source=None)])
    for tolerance in (0.3, 0.4):
        sitting.set_parameters(replace(CHOSEN, tolerance=tolerance))
        document.keep_comparison(sitting.kept())
    grown = journal.path.stat().st_size
    sitting.rename_segment(0, "greeting")
    document.keep_comparison(sitting.kept())
    assert journal.path.stat().st_size - grown < 8000, "samples are written once"
    journal.close(keep=True)
    loaded = session_file.load(path)
    assert_same(sitting, restored(loaded))
    assert loaded.state.dirty


def test_an_unsaved_comparison_with_segments_is_offered_again(files, tmp_path: Path) -> None:
    document = Document("ana")
    journal = Journal(document, folder=tmp_path / "unsaved")
    sitting = compared(files)
    document.keep_comparison(sitting.kept())
    journal.close(keep=True)
    left = unfinished(tmp_path / "unsaved")
    assert len(left) == 1
    assert_same(sitting, restored(recover(left[0])))


def test_segments_that_cannot_be_are_damage(files, tmp_path: Path) -> None:
    path = tmp_path / "one.mocapstudio"
    sitting = compared(files)
    kept = replace(sitting.kept(), segments=(replace(sitting.state.segments[0], end=9000),))
    document = Document("ana")
    document.keep_comparison(kept)
    session_file.save(document, path)
    with pytest.raises(FileError, match="is damaged: segment 'bow'"):
        session_file.load(path)
