"""Contacts as part of a sitting: undone, saved, journalled, opened again."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest
from review_pieces import analyse, document_with, flag, proposal, read_bvh, small_take, write_bvh

from mocapstudio.cleaning.contacts.changes import METHOD
from mocapstudio.cleaning.contacts.model import (
    Contact,
    ContactPoint,
    Fixed,
    Floor,
    Following,
    Line,
    Target,
)
from mocapstudio.cleaning.model import Proposal
from mocapstudio.motion.errors import FileError, MocapError
from mocapstudio.review import session_file
from mocapstudio.review.document import Document
from mocapstudio.review.history import same
from mocapstudio.review.journal import Journal
from mocapstudio.review.model import Sitting
from mocapstudio.review.protection import ProtectedError

FOOT, OTHER = "LeftLeg", "RightLeg"
TARGETS: tuple[Target, ...] = (
    Fixed((0.1, 0.2, -0.3)),
    Floor(0.05, (0.0, 0.8, 0.6)),
    Line((0.0, 1.0, 2.0), (1.0, 0.0, 0.0)),
    Following("partner", "Hips", (0.01, 0.0, 0.02)),
)


def contact(start: int, end: int, joint: str = FOOT, target: Target = TARGETS[0]) -> Contact:
    return Contact(f"{joint}-{start}", joint, "heel", start, end, target, 0.7)


@pytest.fixture
def document() -> Document:
    return document_with()


def spans(document: Document) -> list[tuple[str, int, int]]:
    return [(c.joint, c.start, c.end) for c in document.contacts(document.state.active)]


def solved(document: Document, start: int, end: int, seed: int = 0) -> Proposal:
    take = document.state.take
    assert take is not None
    made = proposal(take, flag("Spine", start, end), seed)
    return replace(made, method=METHOD, donor=None)


def test_each_intent_is_one_step_that_can_be_undone(document: Document) -> None:
    first = document.add_contact(contact(10, 20))
    second = document.add_contact(contact(30, 40))
    document.change_contact(first, "Resize contact", end=25)
    assert document.state.can_undo == "Resize contact"
    assert spans(document) == [(FOOT, 10, 25), (FOOT, 30, 40)]
    left, right = document.split_contact(first, 15)
    assert spans(document) == [(FOOT, 10, 15), (FOOT, 15, 25), (FOOT, 30, 40)]
    merged = document.merge_contacts([left, second])
    assert spans(document) == [(FOOT, 10, 40)]
    assert {right} & {c.id for c in document.contacts("walk")} == set()
    document.delete_contacts([merged])
    steps = [
        [(FOOT, 10, 40)],
        [(FOOT, 10, 15), (FOOT, 15, 25), (FOOT, 30, 40)],
        [(FOOT, 10, 25), (FOOT, 30, 40)],
        [(FOOT, 10, 20), (FOOT, 30, 40)],
        [(FOOT, 10, 20)],
        [],
    ]
    for expected in steps:
        document.undo()
        assert spans(document) == expected
    assert document.state.can_undo is None
    assert same(document.state.sitting, Sitting())


def test_an_equal_change_is_no_step(document: Document) -> None:
    one = document.add_contact(contact(10, 20))
    document.change_contact(one, "Move target", target=TARGETS[0])
    assert document.state.can_undo == "Draw contact"


@pytest.mark.parametrize(
    "intent",
    [
        lambda d, c: d.add_contact(contact(10, 500)),
        lambda d, c: d.add_contact(contact(10, 20, "Nose")),
        lambda d, c: d.change_contact(c, start=20),
        lambda d, c: d.split_contact(c, 10),
        lambda d, c: d.merge_contacts([c]),
        lambda d, c: d.delete_contacts(["none"]),
    ],
)
def test_what_cannot_be_done_changes_nothing(document: Document, intent) -> None:
    one = document.add_contact(contact(10, 20))
    before = document.state.sitting
    with pytest.raises(MocapError):
        intent(document, one)
    assert document.state.sitting is before


def test_contacts_of_two_points_are_not_merged(document: Document) -> None:
    ids = [document.add_contact(contact(10, 20)), document.add_contact(contact(10, 20, OTHER))]
    with pytest.raises(MocapError, match="same point"):
        document.merge_contacts(ids)


def test_detecting_again_leaves_drawn_contacts(document: Document) -> None:
    document.set_detected("walk", [contact(0, 8), contact(50, 60)])
    drawn = document.add_contact(contact(20, 30))
    changed = document.contacts("walk")[-1].id
    document.change_contact(changed, end=70)
    kept = {c.id: c for c in document.contacts("walk") if c.drawn}
    assert set(kept) == {drawn, changed}
    # One lies over a drawn contact, one bears a drawn contact's id, one is new.
    found = [contact(25, 40), replace(contact(80, 90), id=changed), contact(25, 40, OTHER)]
    document.set_detected("walk", found)
    now = {c.id: c for c in document.contacts("walk")}
    assert {name: now[name] for name in kept} == kept
    assert spans(document) == [(FOOT, 20, 30), (OTHER, 25, 40), (FOOT, 50, 70), (FOOT, 80, 90)]


def test_a_solve_takes_the_place_of_the_one_before(document: Document) -> None:
    document.add_edit(proposal(small_take(), flag("Spine", 5, 15), 3))
    other = document.state.sitting.edits
    before = document.result("walk")
    document.set_corrections("walk", [solved(document, 10, 30), solved(document, 50, 60)])
    first = document.result("walk")
    assert not np.array_equal(first.rotations, before.rotations)
    base = document.uncorrected("walk")
    np.testing.assert_array_equal(base.rotations, before.rotations)
    document.set_corrections("walk", [solved(document, 20, 40, seed=1)])
    edits = document.state.sitting.edits
    assert edits[0] is other[0]
    assert [(e.start, e.end) for e in edits[1:]] == [(20, 40)]
    document.undo()
    np.testing.assert_array_equal(document.result("walk").rotations, first.rotations)
    document.undo()
    np.testing.assert_array_equal(document.result("walk").rotations, before.rotations)


def test_a_solve_does_not_reach_into_protected_spans(document: Document) -> None:
    document.protect(["Spine"], 20, 30)
    before = document.state.sitting
    with pytest.raises(ProtectedError):
        document.set_corrections("walk", [solved(document, 10, 25)])
    assert document.state.sitting is before


def worked(folder: Path) -> Document:
    """Two takes on disk; all kinds of targets, adjusted points, a solve."""
    document = Document("ana")
    for name in ("walk", "partner"):
        take = read_bvh(write_bvh(folder / f"{name}.bvh", small_take(name)))
        document.open_take(take, partner=name == "partner")
    points = (ContactPoint(FOOT, "heel", np.array([0.0, -0.1, 0.02])),)
    document.load_contacts(
        [contact(10 * i, 10 * i + 5, target=one) for i, one in enumerate(TARGETS)], points
    )
    document.add_contact(Contact("", OTHER, None, 3, 4, TARGETS[1]))
    document.set_corrections("walk", [solved(document, 10, 30)])
    return document


def alike(one: Document, other: Document) -> None:
    assert one.contacts("walk") == other.contacts("walk")
    mine, theirs = one.contact_points("walk"), other.contact_points("walk")
    assert mine is not None
    assert theirs is not None
    assert [p.key for p in mine] == [p.key for p in theirs]
    np.testing.assert_array_equal([p.offset for p in mine], [p.offset for p in theirs])
    np.testing.assert_array_equal(one.result("walk").rotations, other.result("walk").rotations)


def test_contacts_come_back_from_the_session_file(tmp_path: Path) -> None:
    document = worked(tmp_path)
    assert document.state.dirty
    session_file.save(document, tmp_path / "one.mocapstudio")
    assert not document.state.dirty
    loaded = session_file.load(tmp_path / "one.mocapstudio")
    assert not loaded.state.dirty
    alike(loaded, document)


def test_contacts_come_back_from_the_journal(tmp_path: Path) -> None:
    document = worked(tmp_path)
    session_file.save(document, tmp_path / "one.mocapstudio")
    journal = Journal(document)
    last = document.contacts("walk")[-1]
    document.change_contact(last.id, "Move target", target=Fixed((1.0, 2.0, 3.0)))
    document.delete_contacts([document.contacts("walk")[0].id])
    document.undo()
    document.split_contact(document.contacts("walk")[0].id, 2)
    # The program dies here.
    journal.close(keep=True)
    loaded = session_file.load(tmp_path / "one.mocapstudio")
    alike(loaded, document)
    assert loaded.state.can_undo == document.state.can_undo


def test_a_contact_that_cannot_be_is_refused(tmp_path: Path) -> None:
    document = worked(tmp_path)
    path = tmp_path / "one.mocapstudio"
    session_file.save(document, path)
    record, arrays = session_file.session_record.read(path)
    wrong = msgspec.structs.replace(record.sitting.contacts[0], joint="Nose")
    sitting = msgspec.structs.replace(record.sitting, contacts=(wrong,))
    damaged = msgspec.structs.replace(record, sitting=sitting)
    path.write_bytes(session_file.session_record.to_bytes(damaged, arrays))
    with pytest.raises(FileError, match="no joint Nose"):
        session_file.load(path)


def test_closing_a_take_forgets_its_contacts(document: Document) -> None:
    document.add_contact(contact(10, 20))
    analyse(document, ())
    document.close_performer("walk")
    assert document.state.sitting.contacts == ()
    assert document.state.can_undo is None
