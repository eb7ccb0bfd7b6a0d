from __future__ import annotations

import io
import json
import shutil
import zipfile
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from review_pieces import analyse, document_with, flag, read_bvh, small_take, write_bvh

from mocapstudio import formats
from mocapstudio.formats import ReadOptions
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.facing import ROOT_POSITION
from mocapstudio.review import session_file
from mocapstudio.review.document import Document
from mocapstudio.review.lock import Holder, lock_path

A, B, C = flag("Spine", 10, 20, 0.9), flag(ROOT_POSITION, 40, 50, 0.7), flag("Hips", 80, 95, 0.5)


def _worked(folder: Path) -> Document:
    """Two takes on disk, of which one was worked on."""
    folder.mkdir(parents=True, exist_ok=True)
    document = Document("ana")
    for name, seed in (("walk", 0), ("partner", 1)):
        take = read_bvh(write_bvh(folder / f"{name}.bvh", small_take(name, seed=seed)))
        document.open_take(take, partner=name == "partner", offset=0.25 * seed)
    analyse(document, (A, B, C))
    document.accept([A.id, B.id])
    document.reject(C.id)
    document.protect([], 100, 110)
    document.trim(2, 118)
    document.set_context([folder, folder / "partner.bvh"])
    document.set_threshold(0.4)
    document.select(joints=["Hips"], span=(3, 9), flag=C.id)
    document.set_frame(7)
    return document


def test_what_is_saved_comes_back(tmp_path: Path) -> None:
    document = _worked(tmp_path)
    path = tmp_path / "one.mocapstudio"
    session_file.save(document, path)
    assert not document.state.dirty
    assert document.state.path == path
    loaded = session_file.load(path, author="ben")
    ours, theirs = document.state, loaded.state
    for name in ("active", "frame", "selection", "parameters", "context", "queue", "choices"):
        assert getattr(theirs, name) == getattr(ours, name), name
    assert theirs.sitting.decisions == ours.sitting.decisions
    assert [(p.id, p.offset, p.partner) for p in theirs.scene.performers] == [
        ("walk", 0.0, False),
        ("partner", 0.25, True),
    ]
    assert loaded.declared("walk") == document.declared("walk")
    assert np.array_equal(loaded.result("walk").rotations, document.result("walk").rotations)
    assert np.array_equal(loaded.result("walk").translations, document.result("walk").translations)
    assert loaded.result("walk").trim == (2, 118)
    assert (theirs.dirty, theirs.can_undo, theirs.problems) == (False, None, ())
    assert loaded.author == "ben"


def test_a_take_without_a_file_is_kept_inside(tmp_path: Path) -> None:
    document = document_with(A)
    take = replace(small_take("made"), first_frame=7, timecode="01:00:00:00", trim=(1, 50))
    document.open_take(replace(take, rate=Fraction(120000, 1001)))
    session_file.save(document, tmp_path / "one.mocapstudio")
    back = session_file.load(tmp_path / "one.mocapstudio").source("made")
    assert (back.rate, back.first_frame, back.timecode, back.trim) == (
        Fraction(120000, 1001),
        7,
        "01:00:00:00",
        (1, 50),
    )
    assert np.array_equal(back.rotations, take.rotations)
    assert np.array_equal(back.translations, take.translations)
    assert back.skeleton.names == take.skeleton.names
    assert np.array_equal(back.skeleton.offsets, take.skeleton.offsets)


def test_a_session_moves_together_with_its_takes(tmp_path: Path) -> None:
    session_file.save(_worked(tmp_path / "here"), tmp_path / "here" / "one.mocapstudio")
    shutil.move(tmp_path / "here", tmp_path / "there")
    loaded = session_file.load(tmp_path / "there" / "one.mocapstudio")
    assert loaded.state.problems == ()
    assert loaded.source("walk").source.path == tmp_path / "there" / "walk.bvh"
    assert loaded.state.context == (tmp_path / "there", tmp_path / "there" / "partner.bvh")


def test_a_session_finds_takes_that_stayed_where_they_were(tmp_path: Path) -> None:
    session_file.save(_worked(tmp_path / "takes"), tmp_path / "one.mocapstudio")
    (tmp_path / "far" / "away").mkdir(parents=True)
    shutil.move(tmp_path / "one.mocapstudio", tmp_path / "far" / "away" / "one.mocapstudio")
    loaded = session_file.load(tmp_path / "far" / "away" / "one.mocapstudio")
    assert loaded.state.problems == ()


def test_of_two_places_the_one_with_the_known_content_is_taken(tmp_path: Path) -> None:
    session_file.save(_worked(tmp_path / "here"), tmp_path / "here" / "one.mocapstudio")
    (tmp_path / "there").mkdir()
    shutil.copy(tmp_path / "here" / "one.mocapstudio", tmp_path / "there")
    write_bvh(tmp_path / "there" / "walk.bvh", small_take("walk", seed=9))
    loaded = session_file.load(tmp_path / "there" / "one.mocapstudio")
    assert loaded.state.problems == ()
    assert loaded.source("walk").source.path == tmp_path / "here" / "walk.bvh"


@pytest.mark.parametrize("answers", ["file", "folder"])
def test_one_answer_relocates_the_whole_folder(tmp_path: Path, answers: str) -> None:
    path = tmp_path / "one.mocapstudio"
    session_file.save(_worked(tmp_path / "old" / "takes"), path)
    (tmp_path / "new").mkdir()
    shutil.move(tmp_path / "old" / "takes", tmp_path / "new" / "takes")
    asked: list[Path] = []

    def relocate(missing: Path) -> Path:
        asked.append(missing)
        folder = tmp_path / "new" / "takes"
        return folder / missing.name if answers == "file" else folder

    loaded = session_file.load(path, relocate)
    assert asked == [tmp_path / "old" / "takes" / "walk.bvh"]
    assert [p.id for p in loaded.state.scene.performers] == ["walk", "partner"]
    assert loaded.source("partner").source.path == tmp_path / "new" / "takes" / "partner.bvh"


def test_what_was_decided_about_a_missing_take_is_kept(tmp_path: Path) -> None:
    path, hidden = tmp_path / "one.mocapstudio", tmp_path / "hidden.bvh"
    document = _worked(tmp_path)
    session_file.save(document, path)
    (tmp_path / "walk.bvh").rename(hidden)
    loaded = session_file.load(path, lambda _: None)
    assert [p.what for p in loaded.state.problems] == [f"{tmp_path / 'walk.bvh'} is missing"]
    assert loaded.state.active == "partner"
    assert loaded.open_take(small_take("walk")) == "walk#2", "the id is spoken for"
    session_file.save(loaded, path)
    hidden.rename(tmp_path / "walk.bvh")
    again = session_file.load(path)
    assert again.queue("walk") == document.queue("walk")
    assert np.array_equal(again.result("walk").rotations, document.result("walk").rotations)
    assert again.state.sitting.decisions == document.state.sitting.decisions


def test_changed_content_is_told(tmp_path: Path) -> None:
    path = tmp_path / "one.mocapstudio"
    document = _worked(tmp_path)
    session_file.save(document, path)
    write_bvh(tmp_path / "walk.bvh", small_take("walk", seed=9))
    loaded = session_file.load(path)
    assert [p.performer for p in loaded.state.problems] == ["walk"]
    assert "has changed since" in loaded.state.problems[0].what
    assert loaded.declared("walk") == document.declared("walk")


def test_a_take_of_another_length_is_not_taken_for_the_old_one(tmp_path: Path) -> None:
    path = tmp_path / "one.mocapstudio"
    session_file.save(_worked(tmp_path), path)
    write_bvh(tmp_path / "walk.bvh", small_take("walk", frames=50))
    loaded = session_file.load(path)
    assert "another take" in loaded.state.problems[0].what
    assert [p.id for p in loaded.state.scene.performers] == ["partner"]
    assert len(loaded.state.sitting.edits) == 2


def test_a_take_comes_back_as_it_was_read(tmp_path: Path) -> None:
    write_bvh(tmp_path / "walk.bvh", small_take())
    options = ReadOptions(fps=Fraction(120000, 1001), unit=0.01, up="z")
    take = formats.read(tmp_path / "walk.bvh", options)[0][0]
    names = tuple(f"my {name}" for name in take.skeleton.names)
    renamed = replace(take, name="other", skeleton=replace(take.skeleton, names=names))
    document = Document("ana")
    document.open_take(renamed)
    session_file.save(document, tmp_path / "one.mocapstudio")
    loaded = session_file.load(tmp_path / "one.mocapstudio")
    assert loaded.state.problems == ()
    back = loaded.source("other")
    assert back.rate == take.rate
    assert back.skeleton.names == names
    assert np.array_equal(back.rotations, take.rotations)
    assert np.array_equal(back.translations, take.translations)


def test_radians_come_back_as_radians(tmp_path: Path) -> None:
    write_bvh(tmp_path / "walk.bvh", small_take())
    take = formats.read(tmp_path / "walk.bvh", ReadOptions(angles="radians"))[0][0]
    document = Document("ana")
    document.open_take(take)
    session_file.save(document, tmp_path / "one.mocapstudio")
    back = session_file.load(tmp_path / "one.mocapstudio").source("walk")
    assert np.array_equal(back.rotations, take.rotations)


def test_a_session_of_a_newer_version_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "one.mocapstudio"
    session_file.save(_worked(tmp_path), path)
    _rewrite(path, version=99)
    with pytest.raises(FileError, match="newer version"):
        session_file.load(path)


def test_unknown_fields_are_ignored(tmp_path: Path) -> None:
    path = tmp_path / "one.mocapstudio"
    session_file.save(_worked(tmp_path), path)
    _rewrite(path, mood="good", parameters={"threshold": 0.3, "colour": "blue"})
    loaded = session_file.load(path)
    assert loaded.state.problems == ()
    assert loaded.state.threshold == 0.3


@pytest.mark.parametrize(
    ("change", "cause"),
    [
        ({"format": "recipe"}, "is no session"),
        ({"active": "nobody"}, "performer nobody is unknown"),
        ({"takes": "none"}, "is damaged"),
        ({"frame": "seven"}, "is damaged"),
        ({"span": [90, 500]}, "do not exist"),
        ({"joints": ["Tail"]}, "no joint Tail"),
    ],
)
def test_nonsense_inside_is_a_clear_error(tmp_path: Path, change, cause: str) -> None:
    path = tmp_path / "one.mocapstudio"
    session_file.save(_worked(tmp_path), path)
    _rewrite(path, **change)
    with pytest.raises(FileError, match=cause) as caught:
        session_file.load(path)
    assert str(caught.value).startswith(f"{path}: -: ")


def test_edits_that_leave_their_take_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "one.mocapstudio"
    session_file.save(_worked(tmp_path), path)
    sitting = json.loads(_text(path))["sitting"]
    sitting["edits"][0]["end"] = 130
    _rewrite(path, sitting=sitting)
    with pytest.raises(FileError, match="do not exist"):
        session_file.load(path)
    sitting["edits"][0]["end"] = sitting["edits"][0]["start"] + 1
    _rewrite(path, sitting=sitting)
    with pytest.raises(FileError, match="missing or damaged"):
        session_file.load(path)


def test_a_file_that_is_not_there_or_no_zip(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="no such file"):
        session_file.load(tmp_path / "none.mocapstudio")
    (tmp_path / "text").write_text("hello")
    with pytest.raises(FileError, match="is no session"):
        session_file.load(tmp_path / "text")
    with zipfile.ZipFile(tmp_path / "zip", "w") as file:
        file.writestr("a.txt", "hello")
    with pytest.raises(FileError, match="is no session"):
        session_file.load(tmp_path / "zip")


def test_pickled_samples_are_never_unpickled(tmp_path: Path) -> None:
    path = tmp_path / "one.mocapstudio"
    session_file.save(_worked(tmp_path), path)
    buffer = io.BytesIO()
    np.savez(buffer, trap=np.array([object()], dtype=object))
    _rewrite(path, samples=buffer.getvalue())
    with pytest.raises(FileError, match="allow_pickle"):
        session_file.load(path)


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("damage")
    session_file.save(_worked(folder), folder / "one.mocapstudio")
    return folder / "one.mocapstudio"


@settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(st.data())
def test_damage_anywhere_is_a_file_error_or_harmless(saved: Path, data) -> None:
    good = saved.read_bytes()
    bad = bytearray(good)
    if data.draw(st.booleans()):
        del bad[data.draw(st.integers(0, len(bad) - 1)) :]
    else:
        for _ in range(data.draw(st.integers(1, 4))):
            bad[data.draw(st.integers(0, len(bad) - 1))] = data.draw(st.integers(0, 255))
    path = saved.with_name("bad.mocapstudio")
    path.write_bytes(bad)
    try:
        loaded = session_file.load(path)
    except FileError as error:
        assert error.path == path
    else:
        assert loaded.declared("walk") == session_file.load(saved).declared("walk")


def test_a_failed_save_leaves_the_old_file_and_a_dirty_document(tmp_path: Path) -> None:
    document = _worked(tmp_path)
    path = tmp_path / "one.mocapstudio"
    session_file.save(document, path)
    before = path.read_bytes()
    document.undo()
    with pytest.raises(FileError, match="is an input"):
        session_file.save(document, tmp_path / "walk.bvh")
    with pytest.raises(FileError):
        session_file.save(document, tmp_path / "no folder" / "one.mocapstudio")
    assert path.read_bytes() == before
    assert document.state.path == path
    assert document.state.dirty
    assert sorted(p.name for p in tmp_path.iterdir()) == [
        "one.mocapstudio",
        "partner.bvh",
        "walk.bvh",
    ]


def test_a_session_that_is_open_elsewhere_says_so(tmp_path: Path) -> None:
    path = tmp_path / "one.mocapstudio"
    session_file.save(_worked(tmp_path), path)
    holder = Holder(1, "another-host", "ben")
    lock_path(path).write_text(json.dumps({"pid": 1, "host": "another-host", "user": "ben"}))
    problems = session_file.load(path).state.problems
    assert [p.what for p in problems] == [f"is open elsewhere: {holder}"]


def test_a_missing_context_is_told(tmp_path: Path) -> None:
    path = tmp_path / "one.mocapstudio"
    document = _worked(tmp_path)
    document.set_context([tmp_path / "gone"])
    session_file.save(document, path)
    assert [p.path for p in session_file.load(path).state.problems] == [tmp_path / "gone"]


def _text(path: Path) -> bytes:
    with zipfile.ZipFile(path) as file:
        return file.read("session.json")


def _rewrite(path: Path, samples: bytes | None = None, **changes) -> None:
    with zipfile.ZipFile(path) as file:
        record = json.loads(file.read("session.json"))
        kept = file.read("samples.npz")
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("session.json", json.dumps(record | changes))
        file.writestr("samples.npz", kept if samples is None else samples)
