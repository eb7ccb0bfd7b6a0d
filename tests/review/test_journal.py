from __future__ import annotations

import os
import random
import signal
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from review_pieces import NAMES, analyse, document_with, flag, read_bvh, small_take, write_bvh

from mocapstudio.motion.errors import FileError, MocapError
from mocapstudio.review import journal_records, session_file
from mocapstudio.review.document import Document
from mocapstudio.review.journal import Journal, recover, unfinished
from mocapstudio.review.lock import LockedError, lock_path
from mocapstudio.review.model import Sitting
from mocapstudio.review.opening import journal_path

FLAGS = tuple(
    flag(row, start, start + 6, 0.9 - 0.001 * start) for row in NAMES for start in range(0, 110, 10)
)
KILLS = int(os.environ.get("MOCAPSTUDIO_KILLS", "8"))


def _session(folder: Path) -> Path:
    """Save a session with a take on disk and many flags, not decided."""
    take = read_bvh(write_bvh(folder / "walk.bvh", small_take()))
    document = Document("ana")
    document.open_take(take)
    analyse(document, FLAGS)
    session_file.save(document, folder / "one.mocapstudio")
    return folder / "one.mocapstudio"


def _opened(path: Path) -> Document:
    """Load a session and offer the same proposals as ever."""
    document = session_file.load(path, author="ana")
    analyse(document, FLAGS)
    return document


def _work(document: Document, seed: int) -> Iterator[None]:
    """Decide at random, for ever; the same for the same seed."""
    chance = random.Random(seed)
    while True:
        ids = [one.id for one in chance.sample(FLAGS, chance.randint(1, 3))]
        match chance.choice(["accept"] * 4 + ["reject", "defer", "undo", "redo", "trim", "mute"]):
            case "accept":
                document.accept(ids)
            case "reject":
                document.reject(ids)
            case "defer":
                document.defer(ids)
            case "undo":
                document.undo()
            case "redo":
                document.redo()
            case "trim":
                document.trim(chance.randint(0, 50), chance.randint(60, 120))
            case "mute" if edits := document.state.sitting.edits:
                document.mute_edit(chance.choice(edits).id, chance.random() < 0.5)
        yield


def _told(sitting: Sitting) -> object:
    """What a sitting says, apart from ids and times."""
    return (
        sorted((d.flag.id, d.verdict) for d in sitting.decisions),
        [(e.rows, e.start, e.end, e.muted, e.rotations.tobytes()) for e in sitting.edits],
        [(p.joints, p.start, p.end) for p in sitting.protected],
        sitting.trims,
    )


def _crash(journal: Journal) -> None:
    """Leave behind what a crash does."""
    journal._file.close()
    lock_path(journal._lock.path).write_text('{"pid": 0, "host": "gone"}')
    lock_path(journal._lock.path).unlink()


def test_steps_since_the_last_save_come_back_and_can_be_undone(tmp_path: Path) -> None:
    path = _session(tmp_path)
    document = _opened(path)
    journal = Journal(document)
    document.accept([FLAGS[0].id, FLAGS[9].id])
    document.reject(FLAGS[1].id)
    document.set_threshold(0.3)
    document.undo()
    _crash(journal)
    back = session_file.load(path)
    assert _told(back.state.sitting) == _told(document.state.sitting)
    assert np.array_equal(back.result("walk").rotations, document.result("walk").rotations)
    assert (back.state.can_undo, back.state.can_redo) == ("Accept 2 flags", "Reject Hips")
    assert back.state.threshold == 0.3
    assert back.state.dirty
    assert [p.what for p in back.state.problems] == ["2 steps recovered that had not been saved"]
    back.undo()
    assert back.state.sitting.edits == ()


def test_a_group_comes_back_as_one_step_and_a_failed_one_not_at_all(tmp_path: Path) -> None:
    path = _session(tmp_path)
    document = _opened(path)
    journal = Journal(document)
    with document.group("Tidy up"):
        document.accept(FLAGS[0].id)
        document.reject(FLAGS[1].id)
    with pytest.raises(MocapError), document.group("Fail"):
        document.accept(FLAGS[2].id)
        document.accept("nothing")
    _crash(journal)
    back = session_file.load(path)
    assert _told(back.state.sitting) == _told(document.state.sitting)
    assert back.state.can_undo == "Tidy up"
    back.undo()
    assert back.state.can_undo is None
    assert back.state.sitting.decisions == ()


def test_a_second_crash_after_recovery_loses_nothing_either(tmp_path: Path) -> None:
    path = _session(tmp_path)
    document = _opened(path)
    journal = Journal(document)
    document.accept(FLAGS[0].id)
    _crash(journal)
    again = _opened(path)
    second = Journal(again)
    again.accept(FLAGS[20].id)
    again.undo()
    again.undo()
    again.redo()
    again.accept(FLAGS[30].id)
    _crash(second)
    back = session_file.load(path)
    assert _told(back.state.sitting) == _told(again.state.sitting)
    assert len(back.state.sitting.edits) == 2


def test_saving_folds_the_journal_in(tmp_path: Path) -> None:
    path = _session(tmp_path)
    document = _opened(path)
    journal = Journal(document)
    document.accept(FLAGS[0].id)
    session_file.save(document, path)
    assert [type(e).__name__ for e in journal_records.read(journal_path(path)).events] == []
    document.undo()
    _crash(journal)
    back = session_file.load(path)
    assert back.state.sitting.edits == ()
    assert back.state.can_redo == f"Accept {FLAGS[0].joint}"
    back.redo()
    assert len(back.state.sitting.edits) == 1


def test_a_journal_that_was_folded_in_already_is_not_replayed(tmp_path: Path) -> None:
    path = _session(tmp_path)
    document = _opened(path)
    journal = Journal(document)
    document.accept(FLAGS[0].id)
    left = journal_path(path).read_bytes()
    session_file.save(document, path)
    _crash(journal)
    journal_path(path).write_bytes(left)
    back = session_file.load(path)
    assert back.state.problems == ()
    assert len(back.state.sitting.decisions) == 1
    Journal(back).close()
    assert not journal_path(path).exists()


def test_a_torn_end_costs_only_the_last_record(tmp_path: Path) -> None:
    path = _session(tmp_path)
    document = _opened(path)
    journal = Journal(document)
    place, told, ends = journal_path(path), [_told(document.state.sitting)], []
    ends.append(place.stat().st_size)
    for one in (FLAGS[0], FLAGS[13], FLAGS[25]):
        document.accept(one.id)
        told.append(_told(document.state.sitting))
        ends.append(place.stat().st_size)
    _crash(journal)
    whole = place.read_bytes()
    for length in sorted({*range(0, len(whole), 37), *ends, *(end - 1 for end in ends)}):
        place.write_bytes(whole[:length])
        done = sum(length >= end for end in ends[1:])
        back = session_file.load(path)
        assert _told(back.state.sitting) == told[done]
        torn = any("torn" in p.what for p in back.state.problems)
        assert torn == (length not in (0, *ends) and length > ends[0])


def test_a_damaged_record_ends_what_can_be_trusted(tmp_path: Path) -> None:
    path = _session(tmp_path)
    document = _opened(path)
    journal = Journal(document)
    document.accept(FLAGS[0].id)
    told, end = _told(document.state.sitting), journal_path(path).stat().st_size
    document.accept(FLAGS[13].id)
    document.accept(FLAGS[25].id)
    _crash(journal)
    data = bytearray(journal_path(path).read_bytes())
    data[end + 40] ^= 1
    journal_path(path).write_bytes(data)
    back = session_file.load(path)
    assert _told(back.state.sitting) == told
    assert "torn" in back.state.problems[-1].what
    second = Journal(back)
    assert journal_path(path).stat().st_size == end
    second.close()


def test_a_journal_that_is_none_is_set_aside(tmp_path: Path) -> None:
    path = _session(tmp_path)
    journal_path(path).write_text("my diary")
    document = session_file.load(path)
    assert "no journal" in document.state.problems[0].what
    Journal(document).close()
    assert [p.read_text() for p in tmp_path.glob("*.journal.*")] == ["my diary"]


def test_an_unsaved_sitting_is_recovered_with_its_takes(tmp_path: Path) -> None:
    folder = tmp_path / "state"
    document = Document("ana")
    journal = Journal(document, folder)
    document.open_take(read_bvh(write_bvh(tmp_path / "walk.bvh", small_take())))
    document.open_take(small_take("made", seed=3), partner=True, offset=1.5)
    gone = document.open_take(small_take("gone", seed=4))
    analyse(document, FLAGS)
    document.accept([one.id for one in FLAGS[:5]])
    document.set_context([tmp_path])
    document.close_performer(gone)
    assert unfinished(folder) == [], "it is still open"
    _crash(journal)
    assert unfinished(folder) == [journal.path]
    back = recover(journal.path)
    assert [(p.id, p.offset, p.partner) for p in back.state.scene.performers] == [
        ("walk", 0.0, False),
        ("made", 1.5, True),
    ]
    assert _told(back.state.sitting) == _told(document.state.sitting)
    assert np.array_equal(back.source("made").rotations, document.source("made").rotations)
    assert back.state.context == (tmp_path,)
    assert back.state.dirty
    assert back.state.path is None
    again = Journal(back, folder)
    session_file.save(back, tmp_path / "one.mocapstudio")
    assert list(folder.iterdir()) == []
    assert again.path == journal_path(tmp_path / "one.mocapstudio")
    again.close()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["one.mocapstudio", "state", "walk.bvh"]


def test_journals_in_which_nothing_was_decided_are_cleared_away(tmp_path: Path) -> None:
    document = Document("ana")
    journal = Journal(document, tmp_path)
    document.open_take(small_take())
    _crash(journal)
    assert unfinished(tmp_path) == []
    assert list(tmp_path.iterdir()) == []


def test_a_journal_attached_late_holds_what_came_before(tmp_path: Path) -> None:
    document = document_with(*FLAGS[:4])
    document.accept(FLAGS[0].id)
    document.reject(FLAGS[1].id)
    journal = Journal(document, tmp_path)
    document.reject(FLAGS[2].id)
    _crash(journal)
    assert _told(recover(journal.path).state.sitting) == _told(document.state.sitting)


def test_closing_leaves_nothing_behind(tmp_path: Path) -> None:
    path = _session(tmp_path)
    document = _opened(path)
    journal = Journal(document)
    document.accept(FLAGS[0].id)
    journal.close()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["one.mocapstudio", "walk.bvh"]


def test_opening_the_same_session_again_goes_back_to_the_last_save(tmp_path: Path) -> None:
    path = _session(tmp_path)
    document = _opened(path)
    journal = Journal(document)
    document.accept(FLAGS[0].id)
    again = session_file.load(path)
    assert again.state.sitting.edits == ()
    journal.close()
    Journal(again).close()


def test_a_recovered_document_whose_journal_is_gone_begins_a_new_one(tmp_path: Path) -> None:
    path = _session(tmp_path)
    document = _opened(path)
    journal = Journal(document)
    document.accept(FLAGS[0].id)
    _crash(journal)
    back = session_file.load(path)
    journal_path(path).unlink()
    second = Journal(back)
    _crash(second)
    assert len(session_file.load(path).state.sitting.edits) == 1


def test_a_session_open_elsewhere_gets_no_journal_unless_forced(tmp_path: Path) -> None:
    path = _session(tmp_path)
    lock_path(path).write_text('{"pid": 1, "host": "another-host"}')
    document = session_file.load(path)
    with pytest.raises(LockedError):
        Journal(document)
    assert not journal_path(path).exists()
    Journal(document, force=True).close()


def test_the_disk_is_reached_at_most_once_a_second(tmp_path: Path, monkeypatch) -> None:
    now, synced = [0.0], []
    monkeypatch.setattr(os, "fsync", lambda _: synced.append(now[0]))
    document = document_with(*FLAGS)
    journal = Journal(document, tmp_path, clock=lambda: now[0])
    synced.clear()
    for one in FLAGS[:32]:
        now[0] += 0.125
        document.reject(one.id)
    assert synced == [1.0, 2.0, 3.0, 4.0]
    now[0] += 0.125
    document.reject(FLAGS[41].id)
    journal.sync()
    assert len(synced) == 4
    now[0] += 1.0
    journal.sync()
    journal.sync()
    assert synced[4:] == [5.125]


def test_a_disk_without_room_stops_the_journal_and_is_told_once(tmp_path: Path) -> None:
    resource = pytest.importorskip("resource")
    path = _session(tmp_path)
    document = _opened(path)
    journal = Journal(document)
    document.reject(FLAGS[1].id)
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    room = journal_path(path).stat().st_size + 50
    resource.setrlimit(resource.RLIMIT_FSIZE, (room, limits[1]))
    try:
        document.accept(FLAGS[0].id)
        document.accept(FLAGS[13].id)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert len(document.state.sitting.edits) == 2, "the decisions stand"
    with pytest.raises(FileError, match="cannot be written"):
        journal.sync()
    journal.sync()
    kept = [type(e).__name__ for e in journal_records.read(journal_path(path)).events]
    assert kept == ["Stepped"]
    session_file.save(document, path)
    document.reject(FLAGS[2].id)
    journal.sync()
    _crash(journal)
    assert len(session_file.load(path).state.sitting.decisions) == 4


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_kill_at_any_moment_loses_no_decision_that_was_made(tmp_path: Path) -> None:
    """MOCAPSTUDIO_KILLS says how often."""
    path = _session(tmp_path)
    untouched = path.read_bytes()
    chance = random.Random(7)
    reached = []
    for seed in range(KILLS):
        path.write_bytes(untouched)
        journal_path(path).unlink(missing_ok=True)
        done = _killed(path, seed, chance.uniform(0.0, 0.15))
        reached.append(done)
        back = session_file.load(path)
        model = Document("ana")
        model.open_take(read_bvh(tmp_path / "walk.bvh"))
        analyse(model, FLAGS)
        work = _work(model, seed)
        for _ in range(done):
            next(work)
        told = [_told(model.state.sitting)]
        next(work)
        told.append(_told(model.state.sitting))
        assert _told(back.state.sitting) in told, f"after {done} intents"
    assert max(reached) > 5


def _killed(path: Path, seed: int, seconds: float) -> int:
    """Let a child work on a session, kill it, and return how many intents it had finished."""
    read_end, write_end = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            document = _opened(path)
            Journal(document)
            for n, _ in enumerate(_work(document, seed)):
                os.write(write_end, b".")
                if n % 9 == 8:
                    session_file.save(document, path)
        finally:
            os._exit(1)
    os.close(write_end)
    first = os.read(read_end, 1)
    time.sleep(seconds)
    os.kill(child, signal.SIGKILL)
    _, status = os.waitpid(child, 0)
    assert os.WIFSIGNALED(status), "the child failed by itself"
    done = len(first)
    while more := os.read(read_end, 65536):
        done += len(more)
    os.close(read_end)
    return done
