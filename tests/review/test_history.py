from __future__ import annotations

from dataclasses import replace

from mocapstudio.review.history import DEPTH, History, same
from mocapstudio.review.model import Protected, Sitting


def _protected(performer: str, start: int) -> Protected:
    return Protected(performer, frozenset(), start, start + 1, "ana", "")


def _grown(history: History, label: str, one: Protected) -> History:
    sitting = replace(history.present, protected=(*history.present.protected, one))
    return history.push(label, sitting)


def test_undo_and_redo_return_the_very_sittings() -> None:
    start = History()
    one = _grown(start, "one", _protected("a", 0))
    two = _grown(one, "two", _protected("a", 1))
    assert two.can_undo == "two"
    assert two.undo().present is one.present
    assert two.undo().can_redo == "two"
    assert two.undo().undo().present is start.present
    assert two.undo().undo().redo().redo().present is two.present
    assert two.undo().undo().undo().present is start.present


def test_a_new_step_ends_what_could_be_redone() -> None:
    history = _grown(_grown(History(), "one", _protected("a", 0)), "two", _protected("a", 1))
    other = _grown(history.undo(), "three", _protected("a", 2))
    assert other.can_redo is None
    assert [step.label for step in other.past] == ["one", "three"]


def test_a_step_that_changes_nothing_is_none() -> None:
    history = _grown(History(), "one", _protected("a", 0)).undo()
    assert history.push("nothing", Sitting()) is history


def test_the_oldest_steps_are_let_go() -> None:
    history = History()
    for n in range(DEPTH + 5):
        history = _grown(history, str(n), _protected("a", n))
    assert len(history.past) == DEPTH
    assert history.past[0].label == "5"


def test_forgetting_a_performer_leaves_the_steps_of_others() -> None:
    history = History()
    for n, performer in enumerate("abab"):
        history = _grown(history, f"{performer}{n}", _protected(performer, n))
    history = history.undo().forget("a")
    assert [step.label for step in history.past] == ["b1"]
    assert history.can_redo == "b3"
    assert {p.performer for p in history.redo().present.protected} == {"b"}
    assert history.undo().present.protected == ()
    assert same(history.redo().undo().present, history.present)
