"""What is open in the desk comes into the comparison as it was edited, joints or markers."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hands import CTRL, SHIFT
from made_takes import walking
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication

from mocapstudio.motion.kinematics import global_pose
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Source
from mocapstudio.review.performances import marker_performance


def dotted(seconds: float, name: str) -> MarkerTake:
    """The joints of somebody who walks as markers, one of which is missing for a while."""
    take = walking(seconds=seconds, rate=30)
    places, _ = global_pose(take.skeleton, take.rotations, take.translations, take.translated)
    places = np.array(places)
    places[10:14, 3] = np.nan
    return MarkerTake(name, take.skeleton.names, places, Fraction(30))


@pytest.fixture
def hands(compare_hands):
    return compare_hands


@pytest.fixture
def document(hands):
    found = hands.window.bridge.document
    found.open_markers(dotted(2.0, "teacher dots"))
    found.open_markers(dotted(2.4, "pupil dots"))
    return found


def test_marker_takes_come_with_their_edits(hands, document):
    pupil = document.state.markers[1]
    document.clear_markers(pupil.id, [pupil.take.labels[5]], 20, 30)
    workspace = hands.window.switching.front
    hands.press("R", CTRL | SHIFT)
    hands.see(lambda: workspace.bridge.state.linked is not None, 60)
    state = workspace.bridge.state
    assert state.reference is document.state.markers[0].take
    compared = state.sources[0].take
    assert compared.missing[20:30, 5].all()
    assert not compared.missing[:20, 5].any()


def test_a_file_is_not_named_for_what_was_edited(hands, document):
    pupil = document.state.markers[1]
    source = Source("pupil.c3d", "c3d", "0" * 64, 1.0, np.array([0.0, 0, 0, 1]), 0, None)
    document.replace_markers(pupil.id, replace(pupil.take, source=source))
    assert marker_performance(document, pupil.id).source is source
    edit = document.clear_markers(pupil.id, [pupil.take.labels[5]], 20, 30)
    assert marker_performance(document, pupil.id).source is None
    document.mute_marker_edit(edit)
    assert marker_performance(document, pupil.id).source is source


def test_where_both_are_open_the_user_chooses_once(hands, document):
    first = document.open_take(walking(seconds=2.0, rate=30, name="teacher"))
    document.open_take(walking(seconds=2.2, rate=30, name="pupil"))
    assert document.state.active == first
    workspace = hands.window.switching.front
    hands.press("R", CTRL | SHIFT)
    hands.see(lambda: QApplication.activePopupWidget() is not None)
    menu = QApplication.activePopupWidget()
    words = [one.text() for one in menu.actions()]
    assert words == ["&Joints: teacher, pupil", "&Markers: teacher dots, pupil dots"]
    hands.qtbot.keyClick(menu, Qt.Key.Key_M)
    hands.see(lambda: workspace.bridge.state.linked is not None, 60)
    assert workspace.bridge.state.reference.name == "teacher dots"
    # From now on there is nothing to ask: what is compared are markers.
    hands.press("R", CTRL | SHIFT)
    hands.see(lambda: len(workspace.bridge.state.sources) == 3)
    assert all(isinstance(one.take, MarkerTake) for one in workspace.bridge.state.sources)


def test_what_does_not_go_with_the_reference_is_told(hands, document):
    workspace = hands.window.switching.front
    workspace.working.take_in([walking(seconds=2.0, rate=30, name="teacher")])
    told = []
    hands.window.messages.told.connect(lambda text, _about: told.append(text))
    hands.press("R", CTRL | SHIFT)
    hands.see(lambda: told == ["No take of joints, as the reference is, is open."])
    assert not workspace.bridge.state.sources
