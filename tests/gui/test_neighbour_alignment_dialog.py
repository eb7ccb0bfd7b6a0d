"""The alignment with a neighbour in a real window: how one gets there, what a click does."""

from __future__ import annotations

from dataclasses import replace

import mouse
import pytest
from hands import Hands
from made_takes import turned, walking
from PySide6.QtCore import QSize
from PySide6.QtGui import QContextMenuEvent
from PySide6.QtWidgets import QApplication, QComboBox

from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.distance_profile import distance_profile
from mocapstudio.cleaning.model import Flag, Kind
from mocapstudio.cleaning.reasons import neighbours
from mocapstudio.gui import theme as themes
from mocapstudio.gui.dialogs.neighbour_alignment import NeighbourAlignmentDialog
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.inspector.neighbours import NeighbourList
from mocapstudio.gui.reasons import Reason, Reasons
from mocapstudio.motion.progress import run
from mocapstudio.review.document import Document

FLAG = Flag("one", "LeftArm", ("LeftArm",), 100, 120, 0.9, 110, 0.9, Kind.OFFSET)


@pytest.fixture(scope="module")
def analysis():
    """Eight seconds with an error, against another recording of the same walk."""
    take = turned(walking(8.0, 30, seed=0), "LeftArm", 100, 120, 60)
    return replace(run(detect(take, [walking(6.0, 30, seed=1)])), flags=(FLAG,))


@pytest.fixture
def dialog(qtbot, qapp, analysis):
    themes.apply(qapp, themes.DARK)
    document = Document(author="tester")
    performer = document.open_take(analysis.take)
    assert document.finish_analysis(performer, document.begin_analysis(performer), analysis)
    bridge = DocumentBridge(document)
    profile = distance_profile(analysis, FLAG)
    assert profile is not None
    made = NeighbourAlignmentDialog(
        bridge, analysis, FLAG, profile, neighbours(analysis, FLAG), None
    )
    made.bridge = bridge
    made.show_neighbour(0)
    made.show()
    qtbot.waitExposed(made)
    yield made
    made.close()
    QApplication.processEvents()


def test_a_right_click_on_a_neighbour_offers_its_alignment(qtbot, qapp, analysis):
    themes.apply(qapp, themes.DARK)
    view = NeighbourList()
    qtbot.addWidget(view)
    near = neighbours(analysis, FLAG)
    view.show_neighbours(near, ["1 s"] * len(near), "", choosable=False)
    view.resize(QSize(300, 200))
    view.show()
    qtbot.waitExposed(view)
    heard = []
    view.alignment_wanted.connect(heard.append)
    button = view.findChild(object, "neighbour-2")
    at = button.geometry().center()
    reason = QContextMenuEvent.Reason.Mouse
    QApplication.sendEvent(view, QContextMenuEvent(reason, at, view.mapToGlobal(at)))
    menu = QApplication.activePopupWidget()
    assert [one.text() for one in menu.actions()] == ["Show the Alignment…"]
    menu.actions()[0].trigger()
    menu.close()
    assert heard == [1]


def test_the_path_is_drawn_and_a_click_goes_there(qtbot, dialog):
    bridge, plot = dialog.bridge, dialog.plot
    qtbot.waitUntil(lambda: plot.width() > 300)
    mouse.click(plot, plot.place_of(20, 20))
    assert abs(bridge.state.frame - 115) < 12, "twenty frames into the span with its margin"
    before = plot.grab().toImage()
    bridge.document.set_frame(bridge.state.frame - 8)
    qtbot.waitUntil(lambda: plot.grab().toImage() != before)
    box = dialog.findChild(QComboBox, "alignment-neighbour")
    assert box.count() == len(neighbours(dialog._analysis, FLAG))
    words = dialog._words.text()
    dialog.show_neighbour(1)
    assert dialog._words.text() != words


def test_the_wheel_zooms_and_never_leaves_the_neighbour(dialog):
    plot = dialog.plot
    whole = plot.scales[0].stretch
    mouse.wheel(plot, plot.area.center(), 4)
    near = plot.scales[0].stretch
    assert near.length < whole.length
    mouse.wheel(plot, plot.area.center(), -40)
    assert plot.scales[0].stretch == whole


def test_a_key_shows_the_neighbour_that_is_previewed(window, qtbot, analysis, monkeypatch):
    document = Document(author="tester")
    performer = document.open_take(analysis.take)
    assert document.finish_analysis(performer, document.begin_analysis(performer), analysis)
    window.bridge.replace(document)
    window.switching.show("review")
    window.activateWindow()
    user = Hands(window, qtbot)
    user.see(window.isActiveWindow)
    told = []
    window.messages.told.connect(lambda text, _about: told.append(text))
    document.clear_selection()
    assert not window.actions_["neighbour-alignment"].isEnabled()
    document.select_flag(FLAG.id)
    user.press("X")
    assert told == ["No neighbour of this flag is known."]
    # As once the search has ended.
    found = Reason(neighbours(analysis, FLAG), distance_profile(analysis, FLAG))
    monkeypatch.setattr(Reasons, "current", property(lambda _self: found))
    user.press("2")
    user.press("X")
    user.see(lambda: user.shows("neighbour-alignment"))
    shown = user.find("neighbour-alignment")
    assert shown.findChild(QComboBox, "alignment-neighbour").currentIndex() == 1
    shown.close()
