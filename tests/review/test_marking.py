"""Edits over marker takes: what each does, what it leaves alone, and the file that comes of it."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from msgspec.structs import replace as changed

from mocapstudio import formats
from mocapstudio.formats import ReadOptions
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import FileError, MocapError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.progress import run
from mocapstudio.motion.runs import runs
from mocapstudio.review import journal, session_file, session_record
from mocapstudio.review.document import Document
from mocapstudio.review.marker_export import export_markers
from mocapstudio.review.marker_fills import METHODS, filling
from mocapstudio.review.protection import ProtectedError

FRAMES = 60
LABELS = ("LFHD", "RFHD", "LBHD", "RBHD", "FREE")


def head(frames: int = FRAMES, name: str = "head") -> MarkerTake:
    """Four markers on one rigid body that turns and travels, and one that goes its own way."""
    t = np.linspace(0, 2, frames)
    body = np.array([[0.1, 0, 0.1], [-0.1, 0, 0.1], [0.1, 0, -0.1], [-0.1, 0.02, -0.1]])
    cos, sin = np.cos(t), np.sin(t)
    x = cos[:, None] * body[:, 0] + sin[:, None] * body[:, 2] + t[:, None]
    z = -sin[:, None] * body[:, 0] + cos[:, None] * body[:, 2]
    y = np.broadcast_to(1.7 + body[:, 1], x.shape)
    free = np.stack([np.sin(3 * t), 0.5 + 0.1 * t, t], axis=1)[:, None]
    places = np.concatenate([np.stack([x, y, z], axis=2), free], axis=1)
    return MarkerTake(name, LABELS, places, Fraction(30))


def holed() -> MarkerTake:
    take = head()
    places = take.positions.copy()
    places[10:20, 0] = np.nan
    places[40:44, 4] = np.nan
    return replace(take, positions=places)


@pytest.fixture
def sitting() -> tuple[Document, str]:
    document = Document("ana")
    return document, document.open_markers(holed())


def fill(document: Document, name: str, method: str, *spans: Declared) -> None:
    take = document.unfilled(name, spans) if spans else document.marker_result(name)
    document.fill_gaps(name, run(filling(take, method, spans or None)), method)


def test_a_rigid_body_brings_a_marker_back_to_where_it_was(sitting) -> None:
    document, name = sitting
    fill(document, name, "rigid", Declared("LFHD", 12, 13))
    result, source = document.marker_result(name), document.marker_performer(name).take
    assert np.allclose(result.positions[10:20, 0], head().positions[10:20, 0], atol=1e-6)
    assert result.filled is not None
    assert runs(result.filled[:, 0]) == [(10, 20)]
    assert result.filled.sum() == 10
    assert document.marker_declared(name) == (Declared("LFHD", 10, 20),)
    others = ~result.filled
    assert np.array_equal(result.positions[others], source.positions[others], equal_nan=True)


@pytest.mark.parametrize("method", [one.name for one in METHODS])
def test_each_method_fills_only_what_is_missing(sitting, method: str) -> None:
    document, name = sitting
    fill(document, name, method)
    result, source = document.marker_result(name), document.marker_performer(name).take
    there = ~source.missing
    assert np.array_equal(result.positions[there], source.positions[there])
    assert not result.missing[10:20, 0].any()


def test_another_method_takes_the_place_of_the_first(sitting) -> None:
    document, name = sitting
    fill(document, name, "straight", Declared("LFHD", 10, 20))
    straight = document.marker_result(name).positions[15, 0]
    fill(document, name, "rigid", Declared("LFHD", 15, 16))
    assert [one.method for one in document.marker_edits(name)] == ["rigid body"]
    assert not np.allclose(document.marker_result(name).positions[15, 0], straight, atol=1e-3)
    document.undo()
    assert np.array_equal(document.marker_result(name).positions[15, 0], straight)


def test_an_exchange_swaps_courses_and_what_was_filled_goes_along(sitting) -> None:
    document, name = sitting
    fill(document, name, "rigid", Declared("LFHD", 10, 20))
    before = document.marker_result(name)
    document.exchange_markers(name, "LFHD", "RFHD", 15, 30)
    after = document.marker_result(name)
    assert np.array_equal(after.positions[15:30, 0], before.positions[15:30, 1])
    assert np.array_equal(after.positions[15:30, 1], before.positions[15:30, 0])
    assert after.filled is not None
    assert runs(after.filled[:, 0]) == [(10, 15)]
    assert runs(after.filled[:, 1]) == [(15, 20)]
    document.exchange_markers(name, "RFHD", "LFHD", 15, 30)
    again = document.marker_result(name)
    assert np.array_equal(again.positions, before.positions, equal_nan=True)


def test_a_fill_never_covers_a_measured_sample_whatever_is_taken_back_before_it(sitting) -> None:
    document, name = sitting
    cleared = document.clear_markers(name, ["FREE"], 20, 30)
    fill(document, name, "spline", Declared("FREE", 20, 30))
    assert not np.array_equal(document.marker_result(name).positions[:, 4], holed().positions[:, 4])
    document.mute_marker_edit(cleared)
    result = document.marker_result(name)
    assert np.array_equal(result.positions, holed().positions, equal_nan=True)
    assert result.filled is None or not result.filled.any()


def test_wrong_intents_are_refused_and_change_nothing(sitting) -> None:
    document, name = sitting
    before = document.state
    for intent in (
        lambda: document.exchange_markers(name, "LFHD", "LFHD", 0, 5),
        lambda: document.exchange_markers(name, "LFHD", "nobody", 0, 5),
        lambda: document.clear_markers(name, ["LFHD"], 5, FRAMES + 1),
        lambda: document.clear_markers(name, [], 5, 6),
        lambda: document.fill_gaps(name, (), "guessing"),
        lambda: document.delete_marker_edits(["none"]),
        lambda: document.marker_result("nobody"),
    ):
        with pytest.raises(MocapError):
            intent()
    assert document.state is before


def test_closing_a_marker_take_forgets_its_edits_in_the_history_too(sitting) -> None:
    document, name = sitting
    document.clear_markers(name, ["FREE"], 20, 30)
    other = document.open_markers(head())
    assert other != name
    document.clear_markers(other, ["FREE"], 1, 3)
    document.close_markers(name)
    assert [one.performer for one in document.state.sitting.marker_edits] == [other]
    document.undo()
    assert document.state.can_undo is None
    assert not document.state.sitting.marker_edits


def test_a_session_keeps_takes_with_and_without_a_file(tmp_path, sitting) -> None:
    document, name = sitting
    file = tmp_path / "marks.trc"
    formats.write(replace(holed(), name="marks"), file)
    options = ReadOptions(unit=0.002, forward="x")
    (read,), _ = formats.read_any(file, options)
    other = document.open_markers(read)
    fill(document, name, "rigid", Declared("LFHD", 10, 20))
    document.exchange_markers(other, "LFHD", "FREE", 5, 9)
    document.clear_markers(other, ["RBHD"], 50, FRAMES)
    session = tmp_path / "s.mocapstudio"
    session_file.save(document, session)
    loaded = session_file.load(session)
    assert not loaded.state.problems
    assert not loaded.state.dirty
    for one in (name, other):
        ours, theirs = document.marker_result(one), loaded.marker_result(one)
        assert ours.labels == theirs.labels
        assert np.array_equal(ours.positions, theirs.positions, equal_nan=True)
        assert np.array_equal(ours.filled, theirs.filled)
    assert loaded.marker_performer(other).take.source.options == options


def test_a_journal_brings_marker_edits_back(tmp_path, sitting) -> None:
    document, name = sitting
    kept = journal.Journal(document, folder=tmp_path)
    fill(document, name, "best")
    document.exchange_markers(name, "LFHD", "RFHD", 3, 8)
    document.undo()
    document.clear_markers(name, ["FREE"], 1, 2)
    kept.close(keep=True)
    found = journal.recover(kept.path)
    ours, theirs = document.marker_result(name), found.marker_result(name)
    assert np.array_equal(ours.positions, theirs.positions, equal_nan=True)
    assert np.array_equal(ours.filled, theirs.filled)
    assert found.state.can_undo == document.state.can_undo


def test_a_session_that_names_markers_that_are_not_there_is_refused(tmp_path, sitting) -> None:
    document, name = sitting
    document.clear_markers(name, ["FREE"], 1, 2)
    session = tmp_path / "s.mocapstudio"
    session_file.save(document, session)
    record, arrays = session_record.read(session)
    (edit,) = record.sitting.marker_edits
    odd = changed(edit, markers=("nobody",))
    broken = changed(record, sitting=changed(record.sitting, marker_edits=(odd,)))
    session.write_bytes(session_record.to_bytes(broken, arrays))
    with pytest.raises(FileError, match="damaged"):
        session_file.load(session)


@pytest.mark.parametrize("suffix", [".trc", ".c3d", ".csv"])
def test_an_export_changes_the_declared_cells_alone(tmp_path, suffix: str) -> None:
    file = tmp_path / f"source{suffix}"
    # A C3D can tell filled samples from measured ones where the measured ones have residuals.
    formats.write(replace(holed(), filled=np.zeros((FRAMES, len(LABELS)), dtype=bool)), file)
    (take,), _ = formats.read_any(file)
    document = Document("ana")
    name = document.open_markers(take)
    fill(document, name, "rigid", Declared("LFHD", 10, 20))
    document.exchange_markers(name, "RBHD", "FREE", 30, 35)
    document.clear_markers(name, ["RFHD"], 50, 52)
    out = tmp_path / f"out{suffix}"
    export_markers(document, name, out)
    (again,), _ = formats.read_any(out)
    declared = np.zeros((FRAMES, len(LABELS)), dtype=bool)
    declared[10:20, 0] = declared[30:35, 3:5] = declared[50:52, 1] = True
    assert np.array_equal(again.positions[~declared], take.positions[~declared], equal_nan=True)
    result = document.marker_result(name)
    assert np.allclose(again.positions, result.positions, atol=2e-6, equal_nan=True)
    assert again.missing[50:52, 1].all()
    told = json.loads((tmp_path / "out.provenance.json").read_text())
    assert told["filled"] == [{"marker": "LFHD", "start": 10, "end": 20}]
    assert [(one["kind"], one["marker"], one["start"], one["end"]) for one in told["changes"]] == [
        ("fill", "LFHD", 10, 20),
        ("exchange", "FREE", 30, 35),
        ("exchange", "RBHD", 30, 35),
        ("clear", "RFHD", 50, 52),
    ]
    assert told["changes"][0]["method"] == "rigid body"
    if suffix == ".c3d":
        assert again.filled is not None
        assert runs(again.filled[:, 0]) == [(10, 20)]
        assert again.filled.sum() == 10
    with pytest.raises(FileError):
        export_markers(document, name, file)


def test_what_is_protected_refuses_every_edit_and_says_where(sitting) -> None:
    document, name = sitting
    early = document.clear_markers(name, ["RFHD"], 2, 6)
    document.protect_markers(name, ["LFHD", "RFHD"], 4, 15)
    for change in (
        lambda: fill(document, name, "rigid", Declared("LFHD", 12, 13)),
        lambda: document.clear_markers(name, ["FREE", "LFHD"], 0, 5),
        lambda: document.exchange_markers(name, "LBHD", "RFHD", 14, 40),
        lambda: document.mute_marker_edit(early),
        lambda: document.delete_marker_edits([early]),
    ):
        before = document.state.sitting
        with pytest.raises(ProtectedError, match="FHD is protected in frames"):
            change()
        assert document.state.sitting is before
    # Beside it in time, and other markers, are free.
    document.clear_markers(name, ["LFHD"], 0, 4)
    document.exchange_markers(name, "LBHD", "RBHD", 0, 60)
    document.unprotect_markers(name, ["LFHD"], 10, 60)
    assert document.markers_protected(name) == (
        Declared("LFHD", 4, 10), Declared("RFHD", 4, 15),
    )  # fmt: skip
    fill(document, name, "rigid", Declared("LFHD", 12, 13))


def test_without_markers_all_are_protected_and_a_session_keeps_it(sitting, tmp_path) -> None:
    document, name = sitting
    document.protect_markers(name, [], 30, 50)
    with pytest.raises(ProtectedError, match="FREE is protected in frames 40 to 44"):
        fill(document, name, "straight", Declared("FREE", 40, 44))
    with pytest.raises(MocapError, match="no marker Hoof"):
        document.protect_markers(name, ["Hoof"], 0, 5)
    document.unprotect_markers(name, ["FREE"], 0, 60)
    kept = document.markers_protected(name)
    assert {one.row for one in kept} == set(LABELS) - {"FREE"}
    session_file.save(document, tmp_path / "a.mocapstudio")
    again = session_file.load(tmp_path / "a.mocapstudio")
    assert again.markers_protected(name) == kept
    document.undo()
    assert document.markers_protected(name) == tuple(
        Declared(one, 30, 50) for one in sorted(LABELS)
    )
