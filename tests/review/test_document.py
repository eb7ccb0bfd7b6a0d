from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from review_pieces import (
    ROWS,
    FixedAnalysis,
    analyse,
    document_with,
    flag,
    proposal,
    small_take,
)

from mocapstudio.cleaning.model import Kind
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError, ParameterError
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION
from mocapstudio.review.document import Document
from mocapstudio.review.model import Selection, Verdict
from mocapstudio.review.protection import ProtectedError

A, B, C = flag("Spine", 10, 20, 0.9), flag("LeftLeg", 40, 50, 0.7), flag("Hips", 80, 95, 0.5)


def _verdicts(document: Document) -> dict[str, str]:
    return {item.flag.id: item.verdict.value for item in document.state.queue}


def test_accepting_is_one_step_of_decision_and_edit() -> None:
    document = document_with(A, B, C)
    source = document.source("walk")
    document.accept([A.id, B.id])
    assert document.state.can_undo == "Accept 2 flags"
    assert {e.flag for e in document.state.sitting.edits} == {A.id, B.id}
    assert len({e.group for e in document.state.sitting.edits}) == 1
    assert document.declared("walk") == (Declared("LeftLeg", 40, 50), Declared("Spine", 10, 20))
    document.undo()
    assert set(_verdicts(document).values()) == {"open"}
    assert document.result("walk") is source
    document.redo()
    assert _verdicts(document)[A.id] == "accepted"


def test_steps_of_one_kind_do_not_merge() -> None:
    document = document_with(A, B, C)
    for one in (A, B, C):
        document.reject(one.id)
    for left in (2, 1, 0):
        document.undo()
        assert list(_verdicts(document).values()).count("rejected") == left


def test_a_group_is_one_step_and_leaves_nothing_where_it_fails() -> None:
    document = document_with(A, B)
    heard: list[tuple[object, object]] = []
    with document.group("Tidy up"):
        document.accept(A.id)
        document.reject(B.id)
    assert document.state.can_undo == "Tidy up"
    before = document.state.sitting
    with pytest.raises(MocapError), document.group("Fail"):
        document.reopen(A.id)
        document.accept("nothing")
    assert document.state.sitting is before
    assert document.state.can_undo == "Tidy up"
    document.subscribe(lambda old, new: heard.append((old, new)))
    document.undo()
    assert document.state.sitting.edits == document.state.sitting.decisions == ()
    assert document.state.can_undo is None
    assert len(heard) == 1


def test_accepting_again_with_another_choice_replaces_the_edit_in_one_step() -> None:
    document = document_with(A, B)
    document.accept(A.id)
    document.accept(B.id)
    first = next(e for e in document.state.sitting.edits if e.flag == A.id)
    document.accept(A.id)
    assert document.state.can_undo == f"Accept {B.joint}", "the same samples are no step"
    document.set_proposal(A.id, 2, proposal(document.source("walk"), A, seed=9))
    document.accept(A.id)
    edits = document.state.sitting.edits
    assert [e.flag for e in edits] == [B.id, A.id]
    assert not np.array_equal(edits[1].rotations, first.rotations)
    document.undo()
    assert document.state.sitting.edits[0] is first


def test_rejecting_or_deferring_an_accepted_flag_removes_its_edit() -> None:
    for decide in (Document.reject, Document.defer, Document.reopen):
        document = document_with(A, B)
        document.accept([A.id, B.id])
        decide(document, A.id)
        assert [e.flag for e in document.state.sitting.edits] == [B.id]
        document.undo()
        assert len(document.state.sitting.edits) == 2


def test_rejected_spans_are_normal_for_the_next_analysis() -> None:
    document = document_with(A, B, C)
    document.reject([A.id, C.id])
    document.accept(B.id)
    assert document.normal("walk") == (Declared("Hips", 80, 95), Declared("Spine", 10, 20))


def test_a_proposal_that_touches_a_protected_sample_is_refused() -> None:
    document = document_with(A, B)
    document.protect(["Spine"], 15, 60)
    before = document.state
    with pytest.raises(ProtectedError, match="Spine is protected in frames 15 to 20"):
        document.accept([B.id, A.id])
    assert document.state is before
    document.accept(B.id)
    with pytest.raises(MocapError, match="LeftLeg"):
        document.protect([], 0, 120)
        document.delete_edit(document.state.sitting.edits[0].id)
    document.undo()
    document.undo()
    assert document.state.sitting.edits == ()


@pytest.mark.parametrize(
    ("closed", "flagged", "refused"),
    [
        ("Hips", ROOT_HEADING, True),
        (ROOT_HEADING, "Hips", True),
        (ROOT_POSITION, "Hips", False),
        ("Hips", ROOT_POSITION, False),
        (ROOT_POSITION, ROOT_POSITION, True),
    ],
)
def test_protection_knows_which_samples_the_root_rows_share(closed, flagged, refused) -> None:
    one = flag(flagged, 10, 20)
    document = document_with(one)
    document.protect([closed], 0, 30)
    if refused:
        with pytest.raises(ProtectedError):
            document.accept(one.id)
    else:
        document.accept(one.id)


def test_unprotecting_leaves_the_rest_protected() -> None:
    document = document_with(A)
    document.protect([], 0, 100)
    document.unprotect(["Spine"], 20, 30)
    spine = [(d.start, d.end) for d in document.protected("walk") if d.row == "Spine"]
    assert spine == [(0, 20), (30, 100)]
    others = {(d.row, d.start, d.end) for d in document.protected("walk") if d.row != "Spine"}
    assert others == {(row, 0, 100) for row in ROWS if row != "Spine"}
    document.unprotect([], 0, 120)
    assert document.protected("walk") == ()


def test_muting_and_deleting_an_edit_leaves_those_after_it() -> None:
    document = document_with(A, flag("Spine", 15, 30, 0.6), B)
    document.accept([item.flag.id for item in document.state.queue])
    edits = document.state.sitting.edits
    full = document.result("walk")
    document.mute_edit(edits[0].id, True)
    assert [e.id for e in document.state.sitting.edits] == [e.id for e in edits]
    assert np.array_equal(full.rotations[40:50], document.result("walk").rotations[40:50])
    document.mute_edit(edits[0].id, False)
    assert np.array_equal(full.rotations, document.result("walk").rotations)
    document.delete_edit(edits[0].id)
    assert len(document.state.sitting.edits) == 2
    opened = [v for v in _verdicts(document).values() if v == "open"]
    assert len(opened) == 1


def test_reject_like_takes_open_flags_of_the_same_row_and_kind_within_the_band() -> None:
    like = flag("Spine", 50, 60, 0.85)
    other_kind = flag("Spine", 70, 80, 0.9, Kind.DRIFT)
    far = flag("Spine", 100, 110, 0.3)
    decided = flag("Spine", 30, 40, 0.9)
    document = document_with(A, like, other_kind, far, decided, B)
    document.defer(decided.id)
    assert document.reject_like(A.id) == 2
    rejected = {k for k, v in _verdicts(document).items() if v == "rejected"}
    assert rejected == {A.id, like.id}
    document.undo()
    assert list(_verdicts(document).values()).count("rejected") == 0


def test_the_threshold_never_drops_a_decided_flag() -> None:
    document = document_with(A, B)
    document.reject(A.id)
    generation = document.begin_analysis("walk")
    assert document.finish_analysis("walk", generation, FixedAnalysis(document.source("walk"), ()))
    assert [(i.flag, i.current) for i in document.state.queue] == [(A, False)]
    document.reopen(A.id)
    assert document.state.queue == ()


def test_stale_analyses_are_dropped_performer_by_performer() -> None:
    document = document_with(A)
    other = document.open_take(small_take("other"))
    old, fresh = document.begin_analysis("walk"), document.begin_analysis("walk")
    others = document.begin_analysis(other)
    take = document.source("walk")
    before = document.state
    assert not document.finish_analysis("walk", old, FixedAnalysis(take, (B,)))
    assert document.state is before
    assert document.finish_analysis("walk", fresh, FixedAnalysis(take, (B,)))
    document.close_performer(other)
    assert not document.finish_analysis(other, others, FixedAnalysis(take, (C,)))


def test_a_threshold_out_of_bounds_changes_nothing() -> None:
    document = document_with(A)
    before = document.state
    for bad in (-0.1, 0.0, 1.2, float("nan")):
        with pytest.raises(ParameterError):
            document.set_threshold(bad)
    assert document.state is before


def test_proposals_live_as_long_as_their_very_flag() -> None:
    document = document_with(A, B)
    document.set_proposal(A.id, 3, proposal(document.source("walk"), A))
    longer = replace(B, end=B.end + 3)
    analyse_only(document, (A, longer))
    assert document.state.choices == {A.id: 3}
    assert set(document.state.proposals) == {A.id}
    assert not document.set_proposal("gone", 1, proposal(document.source("walk"), A))


def analyse_only(document: Document, flags) -> None:
    generation = document.begin_analysis("walk")
    document.finish_analysis("walk", generation, FixedAnalysis(document.source("walk"), flags))


def test_without_an_analysis_an_unknown_proposal_is_a_clear_error() -> None:
    document = document_with(A)
    document.reject(A.id)
    analyse_only(document, ())
    document._analyses.latest = {}
    with pytest.raises(MocapError, match="analyse the take first"):
        document.accept(A.id)


def test_deferred_flags_go_to_the_end_and_come_back_with_undo() -> None:
    document = document_with(A, B, C)
    document.select_flag(B.id)
    document.defer(B.id)
    assert [i.flag.id for i in document.state.queue] == [A.id, C.id, B.id]
    assert document.state.selection.flag == B.id
    document.undo()
    assert [i.flag.id for i in document.state.queue] == [A.id, B.id, C.id]


def test_select_leaves_what_is_not_named_and_clears_what_is_empty() -> None:
    document = document_with(A)
    document.select(joints=["Spine", "Hips"], span=(3, 9))
    document.select(joints="LeftLeg")
    assert document.state.selection == Selection("walk", frozenset(["LeftLeg"]), (3, 9), None)
    document.select(span=(), flag=A.id)
    assert document.state.selection == Selection("walk", frozenset(["LeftLeg"]), None, A.id)
    document.select(flag="")
    assert document.state.selection.flag is None
    for wrong in ({"joints": ["Tail"]}, {"span": (9, 3)}, {"span": (0, 121)}, {"flag": "no"}):
        with pytest.raises(MocapError):
            document.select(**wrong)


def test_equal_values_announce_nothing() -> None:
    document = document_with(A)
    document.select_flag(A.id)
    heard: list[object] = []
    document.subscribe(lambda _, new: heard.append(new))
    state = document.state
    document.set_frame(state.frame)
    document.select_flag(A.id)
    document.set_threshold(state.threshold)
    document.set_mode(state.mode)
    document.set_context([])
    document.set_active("walk")
    document.trim(0, 120)
    document.reopen(A.id)
    document.undo()
    assert heard == []
    assert document.state is state


def test_intents_of_listeners_are_announced_after_all_heard_of_the_first() -> None:
    document = document_with(A)
    heard: list[tuple[str, int, int]] = []

    def first(old, new) -> None:
        heard.append(("first", old.frame, new.frame))
        if new.frame == 5:
            document.set_frame(6)

    document.subscribe(first)
    end = document.subscribe(lambda old, new: heard.append(("second", old.frame, new.frame)))
    document.set_frame(5)
    assert heard == [("first", 0, 5), ("second", 0, 5), ("first", 5, 6), ("second", 5, 6)]
    end()
    document.set_frame(7)
    assert heard[4:] == [("first", 6, 7)]


def test_a_listener_that_fails_does_not_keep_others_from_hearing() -> None:
    document = document_with(A)
    heard: list[int] = []

    def fails(old, new) -> None:
        raise ValueError("a bug in a view")

    document.subscribe(fails)
    document.subscribe(lambda _, new: heard.append(new.frame))
    with pytest.raises(ValueError, match="a bug"):
        document.set_frame(5)
    assert heard == [5]
    assert document.state.frame == 5


def test_performers_share_one_clock() -> None:
    document = document_with(A)
    document.set_frame(60)
    fast = document.open_take(small_take("fast", frames=400, rate=120), offset=0.5)
    assert document.state.active == "walk"
    document.set_active(fast)
    assert document.state.frame == 180
    assert document.state.selection == Selection(fast)
    assert document.state.queue == ()
    document.set_active("walk")
    assert document.state.frame == 60
    assert document.state.queue[0].flag == A


def test_queues_of_performers_with_flags_of_one_name_stay_apart() -> None:
    document = document_with(A)
    other = document.open_take(small_take("other", seed=5))
    generation = document.begin_analysis(other)
    document.finish_analysis(other, generation, FixedAnalysis(document.source(other), (A,)))
    document.reject(A.id)
    document.set_active(other)
    assert _verdicts(document) == {A.id: "open"}
    assert document.state.proposals == {}
    document.set_active("walk")
    assert _verdicts(document) == {A.id: "rejected"}


def test_takes_of_one_name_get_ids_of_their_own() -> None:
    document = Document("ana")
    ids = [document.open_take(small_take()) for _ in range(3)]
    assert ids == ["walk", "walk#2", "walk#3"]


def test_closing_forgets_a_performer_and_its_steps() -> None:
    document = document_with(A)
    other = document.open_take(small_take("other"))
    document.accept(A.id)
    document.set_active(other)
    document.trim(5, 100)
    document.close_performer("walk")
    assert document.state.can_undo == "Trim"
    document.undo()
    assert document.state.can_undo is None
    assert document.state.sitting.edits == ()
    document.close_performer(other)
    assert document.state.active == ""
    assert document.state.take is None
    with pytest.raises(MocapError, match="no take is open"):
        document.trim(1, 2)


def test_trim_is_undoable_and_seen_in_source_and_result() -> None:
    document = document_with(A)
    document.accept(A.id)
    document.trim(5, 100)
    assert document.source("walk").span == document.result("walk").span == (5, 100)
    document.trim(0, 120)
    assert document.source("walk").trim is None
    document.undo()
    assert document.source("walk").span == (5, 100)
    document.undo()
    assert document.source("walk").trim is None
    with pytest.raises(MocapError, match="no span"):
        document.trim(7, 7)


def test_dirty_says_whether_there_is_something_to_save() -> None:
    document = document_with(A)
    document.set_frame(9)
    document.select_flag(A.id)
    assert not document.state.dirty
    document.reject(A.id)
    assert document.state.dirty
    document.undo()
    assert not document.state.dirty
    document.mark_saved(Path("/nowhere/x.mocapstudio"), "one")
    document.set_threshold(0.6)
    assert document.state.dirty
    document.set_threshold(0.5)
    assert not document.state.dirty


def test_one_decision_of_two_heirs_can_be_decided_apart() -> None:
    whole = flag("Spine", 10, 40)
    document = document_with(whole)
    document.reject(whole.id)
    left, right = flag("Spine", 10, 20, 0.8), flag("Spine", 25, 40, 0.7)
    analyse(document, (left, right))
    assert set(_verdicts(document).values()) == {"rejected"}
    document.accept(left.id)
    assert _verdicts(document) == {left.id: "accepted", right.id: "rejected"}


def test_decisions_carry_author_and_utc_time() -> None:
    from datetime import UTC, datetime, timedelta, timezone

    moment = datetime(2026, 3, 1, 12, 0, tzinfo=timezone(timedelta(hours=2)))
    document = Document("ana", clock=lambda: moment)
    document.open_take(small_take())
    analyse(document, (A,))
    document.accept(A.id)
    decision, edit = document.state.sitting.decisions[0], document.state.sitting.edits[0]
    assert decision.author == edit.author == "ana"
    assert datetime.fromisoformat(decision.time) == moment
    assert datetime.fromisoformat(decision.time).tzinfo == UTC
    assert document.state.queue[0].verdict is Verdict.ACCEPTED
