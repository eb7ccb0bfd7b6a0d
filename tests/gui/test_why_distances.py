"""Distance over time in a real window: what it shows, what a click does, rest while hidden."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import mouse
import pytest
from made_takes import turned, walking
from PySide6.QtCore import QPointF
from PySide6.QtWidgets import QApplication

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.model import Flag, Kind
from mocapstudio.cleaning.reasons import neighbours
from mocapstudio.gui import theme as themes
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.plots.profile_drawing import badge_centres
from mocapstudio.gui.reasons import Reasons
from mocapstudio.gui.views.distances import DistancesView
from mocapstudio.motion.progress import run
from mocapstudio.review.document import Document


@pytest.fixture(scope="module")
def analysis() -> Analysis:
    """Eight seconds with an error, against another recording of the same walk."""
    take = turned(walking(8.0, 30, seed=0), "LeftArm", 100, 120, 60)
    found = run(detect(take, [walking(6.0, 30, seed=1)]))
    flag = Flag("one", "LeftArm", ("LeftArm",), 100, 120, 0.9, 110, 0.9, Kind.OFFSET)
    return replace(found, flags=(flag,))


@pytest.fixture
def document(analysis: Analysis) -> Document:
    document = Document(author="tester")
    performer = document.open_take(analysis.take)
    assert document.finish_analysis(performer, document.begin_analysis(performer), analysis)
    return document


@pytest.fixture
def bridge(qapp, document: Document) -> DocumentBridge:
    themes.apply(qapp, themes.DARK)
    return DocumentBridge(document)


@pytest.fixture
def view(qtbot, bridge: DocumentBridge) -> DistancesView:
    jobs = Jobs(bridge)
    reasons = Reasons(bridge, jobs, bridge)
    view = DistancesView(bridge, reasons)
    qtbot.addWidget(view)
    view.resize(1280, 260)
    view.show()
    qtbot.waitExposed(view)
    bridge.document.select_flag("one")
    qtbot.waitUntil(lambda: reasons.current.neighbours is not None, timeout=60_000)
    QApplication.processEvents()
    yield view
    jobs.cancel()
    assert jobs.wait(20)
    QApplication.processEvents()


def every_mark(view: DistancesView) -> dict[int, tuple[object, QPointF]]:
    """Number of a neighbour to the widget that marks it, and where."""
    found = {number: (view.plot.viewport(), at) for number, at in view._places()}
    return found | {number: (view.strip, at) for number, at in view.strip._places()}


def test_without_a_flag_it_says_what_to_do(qtbot, bridge: DocumentBridge) -> None:
    view = DistancesView(bridge, Reasons(bridge, Jobs(bridge), bridge))
    qtbot.addWidget(view)
    view.show()
    qtbot.waitExposed(view)
    assert view.empty.isVisible() and "Select a flag" in view.empty.text()


def test_every_neighbour_has_its_mark_at_its_distance(view, analysis) -> None:
    near = neighbours(analysis, analysis.flags[0])
    marks = every_mark(view)
    assert sorted(marks) == list(range(len(near)))
    assert len(near) == 5
    for number, one in enumerate(near):
        widget, at = marks[number]
        assert (widget is view.strip) == (one.index == 1)
        words = (view.strip if one.index else view).read_out(at)
        assert one.take in words
        assert f"{one.distance:.1f}°" in words
        assert f"neighbour {number + 1}: click" in words


def test_a_click_on_a_minimum_previews_that_neighbour(view, bridge) -> None:
    frame = bridge.state.frame
    for number, (widget, _) in every_mark(view).items():
        bridge.set_ui(preview=None)
        area = view.strip.area if widget is view.strip else view.plot.area
        places = view.strip._places() if widget is view.strip else view._places()
        mouse.click(widget, badge_centres(places, area)[number])
        assert bridge.ui.preview == number
    assert bridge.state.frame == frame


def test_a_click_elsewhere_goes_to_that_frame(view, bridge) -> None:
    at = QPointF(view.plot.x_of(30), view.plot.area.top() + 3)
    assert view.mark_at(at) is None
    mouse.click(view.plot.viewport(), at)
    assert bridge.state.frame == 30
    ((_, here),) = view.values.lines
    assert here in view.read_out(at)


def test_the_flagged_span_itself_is_no_neighbour_and_says_so(view) -> None:
    words = view.read_out(QPointF(view.plot.x_of(100), view.plot.area.bottom() - 4))
    assert "no neighbour" in words
    assert "frame 100" in words


def test_hidden_it_does_nothing_and_catches_up(view, bridge, monkeypatch) -> None:
    view.hide()
    moved = []
    monkeypatch.setattr(view.plot, "set_frame", moved.append)
    bridge.document.set_frame(55)
    bridge.document.clear_selection()
    assert moved == [] and view._own is not None
    view.show()
    assert moved == [55] and view._own is None


def test_crowded_numbers_stand_side_by_side() -> None:
    from PySide6.QtCore import QRectF

    area = QRectF(100, 0, 300, 50)
    marks = [(k, QPointF(x, 30.0)) for k, x in enumerate((399.0, 398.0, 110.0, 101.0, 250.0))]
    centres = badge_centres(marks, area)
    across = sorted(one.x() for one in centres.values())
    assert all(b - a >= 15 for a, b in pairwise(across))
    assert across[0] >= area.left() + 7 and across[-1] <= area.right() - 7
    assert centres[4].x() == 250.0
