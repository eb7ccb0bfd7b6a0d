"""The form of a comparison's parameters in a real window, by mouse and keys."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hands import CTRL
from made_takes import paced, walking
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from mocapstudio.comparison.parameters import ComparisonParameters


@pytest.fixture
def hands(compare_hands):
    """A user in the Compare workspace."""
    return compare_hands


@pytest.fixture
def compare(hands):
    """The workspace with a teacher and a pupil, compared."""
    teacher = walking(seconds=4.0, rate=60, name="teacher")
    pace = 1.0 + 0.35 * np.sin(np.arange(2 * teacher.frames) / 25.0)
    workspace = hands.window.switching.front
    workspace.working.take_in([teacher, replace(paced(teacher, pace), name="pupil")])
    hands.see(lambda: workspace.bridge.state.linked is not None, 60)
    return workspace


def test_parameters_are_changed_undone_and_reset_in_the_form(hands, compare):
    state = lambda: compare.bridge.state  # noqa: E731
    hands.press("K")
    before = state().comparison
    hands.type("parameter-tolerance", "0.01")
    assert state().parameters.tolerance == 0.01
    assert state().comparison is not None, "only timed anew"
    assert (state().comparison.timing != 0).sum() > (before.timing != 0).sum()
    assert np.array_equal(state().comparison.path, before.path)
    hands.choose("parameter-extent", "source within")
    hands.see(lambda: state().linked is not None, 60)
    assert (state().parameters.begin, state().parameters.end) == ("reference", "reference")
    hands.click("parameter-masked")
    hands.see(lambda: state().linked is not None and not hands.window.jobs.running, 60)
    assert state().parameters.masked
    hands.press("ZZ", CTRL)
    assert not state().parameters.masked
    assert not state().parameters.open
    assert state().parameters.tolerance == 0.01
    hands.click("button-compare-defaults")
    assert state().parameters == ComparisonParameters()
    hands.see(lambda: state().linked is not None and not hands.window.jobs.running, 60)


def test_cancelling_leaves_a_word_and_a_way_back(hands, compare):
    state = lambda: compare.bridge.state  # noqa: E731
    compare.bridge.sitting.set_parameters(replace(state().parameters, rate=120.0))
    hands.window.jobs.cancel()
    hands.see(lambda: state().source.failure == "cancelled")
    hands.press("K")
    hands.click("button-compare-again")
    hands.see(lambda: state().linked is not None, 60)


def test_a_comparison_is_saved_with_the_session_and_opened_again(hands, compare, tmp_path):
    state = lambda: compare.bridge.state  # noqa: E731
    compare.bridge.sitting.add_segment(20, 70, "step")
    compare.bridge.sitting.set_parameters(replace(state().parameters, true_speed=True))
    hands.see(lambda: state().linked is not None, 60)
    hands.press("S", CTRL)
    path = tmp_path / "one.mocapstudio"
    hands.answer_file_dialog(path)
    hands.see(path.is_file)
    assert not hands.window.bridge.state.dirty
    compare.bridge.sitting.go(33)
    compare.bridge.sitting.rename_segment(0, "stride")
    assert hands.window.bridge.state.dirty
    hands.press("S", CTRL)
    hands.see(lambda: not hands.window.bridge.state.dirty)
    hands.window.files.begin_anew()
    hands.see(lambda: state().reference is None)
    hands.window.files.open_paths([path])
    hands.see(lambda: state().linked is not None, 60)
    assert [one.name for one in state().segments] == ["stride"]
    assert state().parameters.true_speed
    assert state().frame == 33
    assert not hands.window.bridge.state.dirty


def test_the_matrix_shows_costs_and_the_online_path(hands, compare):
    hands.press("X")
    plot = hands.find("compare-matrix-view")
    before = plot.grab().toImage()
    hands.choose("matrix-picture", "accumulated")
    hands.see(lambda: plot.grab().toImage() != before)
    hands.choose("matrix-kind", "online")
    hands.see(lambda: compare.desk.matrix.plot.scales[0].stretch.length > 100)
    hands.see(lambda: not hands.window.jobs.running and not hands.shows("matrix-hint"), 60)
    at = plot.place_of(120, 100)
    QTest.mouseClick(plot, Qt.MouseButton.LeftButton, pos=at.toPoint())
    state = compare.bridge.state
    assert state.frame > 0
    nearest = state.linked.nearest(state.frame, state.source_frame)
    assert abs(nearest[0] - state.frame) < 15, "both alignments are of one movement"
    hands.choose("matrix-kind", "after the fact")
    assert hands.find("matrix-kind").currentText() == "after the fact"


def test_a_session_that_only_compares_opens_in_its_workspace(hands, compare, tmp_path):
    path = tmp_path / "two.mocapstudio"
    hands.press("S", CTRL)
    hands.answer_file_dialog(path)
    hands.see(path.is_file)
    hands.window.files.begin_anew()
    hands.press("1", CTRL)
    hands.see(lambda: hands.window.switching.name == "review")
    hands.window.files.open_paths([path])
    hands.see(lambda: hands.window.switching.name == "compare")
    hands.see(lambda: compare.bridge.state.linked is not None, 60)
