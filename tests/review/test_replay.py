from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from review_pieces import NAMES, flag, proposal, small_take

from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION
from mocapstudio.review.decisions import Stamp, edit_of
from mocapstudio.review.replay import Results, declared, replay

STAMP = Stamp("ana", "2026-01-01T00:00:00Z", "g")


def _edit(take, one, seed=0, name="e"):
    return edit_of(take, "walk", proposal(take, one, seed), STAMP, f"{name}{seed}", one)


def test_only_the_declared_samples_change_and_they_become_the_proposed_rotation() -> None:
    take = small_take()
    edit = _edit(take, flag("LeftLeg", 30, 50))
    result = replay(take, [edit])
    changed = (result.rotations != take.rotations).any(axis=2)
    assert changed[30:50, 3].all()
    assert changed.sum() == 20
    assert result.translations is take.translations
    proposed = proposal(take, flag("LeftLeg", 30, 50)).rotations[:, 0]
    alike = np.abs((result.rotations[30:50, 3] * proposed).sum(axis=1))
    np.testing.assert_allclose(alike, 1.0, atol=1e-12)


def test_the_stored_quaternions_continue_the_sign_of_the_frame_before() -> None:
    take = small_take()
    proposed = proposal(take, flag("Spine", 30, 50))
    steady = np.repeat(take.rotations[29:30, 1:2], 20, axis=0)
    for sign in (1.0, -1.0):
        edit = edit_of(take, "walk", replace(proposed, rotations=steady * sign), STAMP, "e", None)
        assert np.array_equal(edit.rotations, steady)


def test_root_rows_change_the_place_of_the_body() -> None:
    take = small_take()
    place, turn = _edit(take, flag(ROOT_POSITION, 5, 9)), _edit(take, flag(ROOT_HEADING, 5, 9))
    assert place.rows == (ROOT_POSITION,)
    assert turn.rows == (ROOT_HEADING,)
    result = replay(take, [place, turn])
    assert (result.translations[5:9] != take.translations[5:9]).any(axis=2).all()
    assert (result.rotations[5:9, 0] != take.rotations[5:9, 0]).any(axis=1).all()
    assert np.array_equal(np.delete(result.rotations, 0, 1), np.delete(take.rotations, 0, 1))


def test_later_edits_win_and_muted_ones_are_as_if_absent() -> None:
    take = small_take()
    first, second = _edit(take, flag("Spine", 10, 30), 1), _edit(take, flag("Spine", 20, 40), 2)
    both = replay(take, [first, second])
    assert np.array_equal(both.rotations[20:40, 1], second.rotations[:, 0])
    assert np.array_equal(both.rotations[10:20, 1], first.rotations[:10, 0])
    muted = replay(take, [first, replace(second, muted=True)])
    assert np.array_equal(muted.rotations, replay(take, [first]).rotations)
    assert replay(take, [replace(first, muted=True)]) is take


def test_results_are_recognised_by_identity() -> None:
    take, results = small_take(), Results()
    edit = _edit(take, flag("Spine", 10, 30))
    first = results.of("walk", take, [edit], None)
    assert results.of("walk", take, [edit], None) is first
    assert results.of("walk", take, [replace(edit)], None) is not first
    trimmed = results.of("walk", take, [], (3, 9))
    assert trimmed.span == (3, 9)
    assert trimmed.rotations is take.rotations


def test_results_cannot_be_written_to_by_accident() -> None:
    take = small_take()
    edit = _edit(take, flag("Spine", 10, 30))
    with pytest.raises(ValueError, match="read-only"):
        replay(take, [edit]).rotations[0, 0, 0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        edit.rotations[0, 0, 0] = 1.0


def test_declared_joins_touching_spans_of_a_row() -> None:
    take = small_take()
    edits = [
        _edit(take, flag("Spine", 10, 20), 1),
        _edit(take, flag("Spine", 20, 30), 2),
        _edit(take, flag("Spine", 40, 50), 3),
        replace(_edit(take, flag("Hips", 0, 9), 4), muted=True),
    ]
    assert declared(edits) == (Declared("Spine", 10, 30), Declared("Spine", 40, 50))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"joints": ("Tail",)}, "no joint named Tail"),
        ({"start": -1}, "120 frames"),
        ({"end": 121}, "120 frames"),
        ({"rotations": np.zeros((3, 1, 4))}, "odd shape"),
        ({"rotations": np.full((20, 1, 4), np.nan)}, "missing samples"),
        ({"translations": np.zeros((3, 3))}, "odd shape"),
        ({"joints": (), "rotations": np.zeros((20, 0, 4))}, "changes nothing"),
    ],
)
def test_a_proposal_that_does_not_fit_the_take_is_refused(change, message) -> None:
    take = small_take()
    proposed = replace(proposal(take, flag(NAMES[1], 10, 30)), **change)
    with pytest.raises(MocapError, match=message):
        edit_of(take, "walk", proposed, STAMP, "e", None)
