"""Repairs of a sitting that keep hands, feet and contacts."""

from __future__ import annotations

import numpy as np
import pytest
from made_takes import turned, walking

from mocapstudio import formats
from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.contacts.detection import detecting
from mocapstudio.cleaning.contacts.model import Contact, Fixed, Following
from mocapstudio.cleaning.contacts.points import contact_points
from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.ik.foot_skate import clean
from mocapstudio.cleaning.ik.slide import places
from mocapstudio.cleaning.ik.targets import holds
from mocapstudio.cleaning.proposals import apply, propose
from mocapstudio.formats.changes import covered
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take
from mocapstudio.review.around import around_repairs
from mocapstudio.review.document import Document


def bent(seed: int) -> Take:
    """A walk with bent arms, which can give way."""
    take = walking(10.0, 30, seed=seed)
    for side, way in (("Left", -1), ("Right", 1)):
        take = turned(take, f"{side}ForeArm", 0, take.frames, 70.0 * way)
    return take


@pytest.fixture(scope="module")
def analysis() -> Analysis:
    return run(detect(turned(bent(0), "Chest", 100, 125, 45.0), [bent(1), bent(2)]))


@pytest.fixture
def document(analysis: Analysis) -> Document:
    document = Document(author="Ada")
    performer = document.open_take(analysis.take)
    document.finish_analysis(performer, document.begin_analysis(performer), analysis)
    return document


def chest(document: Document) -> str:
    return next(
        one.flag.id
        for one in document.state.queue
        if one.flag.joint == "Chest" and one.flag.overlaps(100, 125)
    )


def test_hands_are_kept_and_the_edit_declares_what_moved(document: Document) -> None:
    flag, performer = chest(document), document.state.active
    take = document.state.take
    document.set_keep_ends(True)
    assert document.state.keep_ends
    document.accept(flag)
    (edit,) = document.state.sitting.edits
    assert "ends kept" in edit.method
    result = document.result(performer)
    hands = [take.skeleton.index[name] for name in ("LeftHand", "RightHand")]
    moved = np.linalg.norm(take_pose(result)[0][:, hands] - take_pose(take)[0][:, hands], axis=2)
    assert np.median(moved[100:125]) < 1e-3
    allowed = covered(take, document.declared(performer))
    rotations = (result.rotations != take.rotations).any(axis=2)
    assert rotations.any(axis=0).sum() > 2
    assert not (rotations & ~allowed.rotations).any()


def test_proposals_are_made_anew_when_what_they_keep_changes(
    document: Document, analysis: Analysis
) -> None:
    flag = chest(document)
    item = document.state.item(flag)

    def offered() -> bool:
        return flag in document.state.proposals

    def offer() -> None:
        document.set_proposal(flag, None, propose(analysis, item.flag))
        assert offered()

    offer()
    document.set_keep_ends(False)
    assert offered()
    document.set_keep_ends(True)
    assert not offered()
    offer()
    contact = Contact("", "LeftHand", "palm", 90, 130, Fixed((0.3, 1.0, 0.2)))
    document.add_contact(contact)
    assert not offered()
    offer()
    document.undo()
    assert not offered()
    offer()
    document.protect(["Head"], 0, 10)
    assert offered()


def test_without_a_wish_nothing_but_the_flag_is_declared(document: Document) -> None:
    flag = chest(document)
    plain = propose(document.state.analysis, document.state.item(flag).flag)
    document.accept(flag)
    (edit,) = document.state.sitting.edits
    assert edit.joints == plain.joints
    assert edit.method == plain.method


def test_contacts_are_cut_to_the_frames_around_repairs(document: Document) -> None:
    take, flag = document.state.take, chest(document)
    hand = Contact("hand", "LeftHand", "palm", 0, 290, Fixed((0.0, 1.0, 0.0)))
    foot = Contact("foot", "LeftFoot", "heel", 0, 290, Fixed((0.0, 0.0, 0.0)))
    early = Contact("early", "RightHand", "palm", 0, 40, Fixed((0.0, 1.0, 0.0)))
    every = (hand, foot, early)
    assert around_repairs(take, every, document.state.sitting.edits) == ()
    document.accept(flag)
    (edit,) = document.state.sitting.edits
    # The chest carries hands, not feet; 0.3 s are 9 frames.
    (piece,) = around_repairs(take, every, document.state.sitting.edits)
    assert (piece.id, piece.start, piece.end) == ("hand", edit.start - 9, edit.end + 9)
    document.mute_edit(edit.id)
    assert around_repairs(take, every, document.state.sitting.edits) == ()


def test_joined_hands_of_dancers_stay_together_through_a_repair_of_an_arm(data) -> None:
    """A real flag of an arm that holds the partner's hand."""
    folder = data / "cmu_salsa_pairs_bvh"

    def read(name: str):
        return formats.read(folder / f"{name}_scaled.bvh")[0][0]

    take, partner = read("60_10"), read("61_10")
    analysis = run(detect(take, [read(f"60_0{n}") for n in (4, 6, 7, 9)]))
    points = contact_points(take)
    others = {partner.name: partner}
    found = run(detecting(take, others, points))
    held = [one for one in found if isinstance(one.target, Following)]
    pairs = [
        (flag, one)
        for flag in analysis.flags
        for one in held
        if flag.joint[0] == one.joint[0]
        and any(part in flag.joint for part in ("Shldr", "ForeArm", "Hand"))
        and one.start <= flag.start and flag.end <= one.end
    ]  # fmt: skip
    assert pairs, "no arm is flagged while it holds a hand"
    flag, contact = pairs[0]

    def gap(version) -> np.ndarray:
        (hold,) = holds(version, [contact], points, others)
        inside = slice(flag.start - contact.start, flag.end - contact.start)
        return hold.gap(places(version, [hold])[0])[inside]

    document = Document(author="Ada")
    performer = document.open_take(take)
    document.open_take(partner, partner=True)
    document.finish_analysis(performer, document.begin_analysis(performer), analysis)
    document.set_detected(performer, found)
    plain = apply(take, propose(analysis, flag))
    document.accept(flag.id)
    (edit,) = document.state.sitting.edits
    assert edit.method.endswith("on contacts")
    assert edit.donor is not None
    accepted = document.result(performer)
    assert gap(accepted).mean() < 0.25 * gap(plain).mean()

    # What remains out of the arm's reach, the solve around the repair closes.
    pieces = around_repairs(take, [contact], document.state.sitting.edits)
    solved = run(clean(accepted, pieces, points, others=others))
    assert gap(solved.take).max() < 1e-3
