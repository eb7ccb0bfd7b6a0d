"""The queue's table: what it says, filters and how it follows the selection."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from plot_scene import sitting, walking
from PySide6.QtCore import Qt

from mocapstudio.cleaning.model import Kind
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.queue.model import Column, Filter, QueueFilter, QueueModel
from mocapstudio.gui.views.queue import QueueView
from mocapstudio.review.model import Verdict


@pytest.fixture
def bridge(qapp):
    return DocumentBridge(sitting(walking(1200, 120, first_frame=1)))


@pytest.fixture
def view(bridge, qtbot):
    view = QueueView(bridge)
    qtbot.addWidget(view)
    view.resize(480, 500)
    view.show()
    return view


def table(view: QueueView):
    return view.findChild(object, "queue-table")


def column(view: QueueView, which: Column) -> list[str]:
    model = table(view).model()
    return [model.index(row, which).data() for row in range(model.rowCount())]


def test_times_are_seconds_and_frames_the_files_own(view, bridge):
    starts = [item.flag.start for item in bridge.state.queue]
    assert column(view, Column.TIME) == [f"{start / 120:.2f} s" for start in starts]
    assert column(view, Column.FRAME) == [str(start + 1) for start in starts]
    assert column(view, Column.RANK) == [str(n + 1) for n in range(len(starts))]


def test_a_decided_flag_that_is_no_longer_raised_is_italic(view, bridge):
    weakest = bridge.state.queue[-1].flag
    bridge.document.reject([weakest.id])
    bridge.document.set_threshold(0.9)
    gone = [item for item in bridge.state.queue if not item.current]
    assert [item.flag.joint for item in gone] == [weakest.joint]
    model = table(view).model()
    fonts = [
        model.index(row, 1).data(Qt.ItemDataRole.FontRole).italic()
        for row in range(model.rowCount())
    ]
    assert fonts == [not item.current for item in bridge.state.queue]
    assert "No longer flagged" in model.index(model.rowCount() - 1, 1).data(
        Qt.ItemDataRole.ToolTipRole
    )


def test_selection_goes_both_ways(view, bridge):
    third = bridge.state.queue[2].flag
    bridge.document.select_flag(third.id)
    assert view.selected == (third.id,)
    table(view).selectRow(0)
    assert bridge.state.selection.flag == bridge.state.queue[0].flag.id
    bridge.document.clear_selection()
    assert view.selected == ()


def test_the_selection_survives_a_verdict_and_a_sort(view, bridge):
    flag = bridge.state.queue[1].flag
    bridge.document.select_flag(flag.id)
    bridge.document.reject([flag.id])
    assert view.selected == (flag.id,)
    table(view).sortByColumn(Column.TIME, Qt.SortOrder.DescendingOrder)
    assert view.selected == (flag.id,)
    assert bridge.state.selection.flag == flag.id


def test_next_follows_what_is_shown_not_the_rank(view, bridge):
    table(view).sortByColumn(Column.TIME, Qt.SortOrder.AscendingOrder)
    by_time = sorted(bridge.state.queue, key=lambda item: item.flag.start)
    bridge.document.select_flag(by_time[0].flag.id)
    assert view.beside(1) == by_time[1].flag.id
    assert view.beside(-1) == by_time[-1].flag.id
    bridge.document.reject([by_time[1].flag.id])
    assert view.following([by_time[0].flag.id]) == by_time[2].flag.id
    everything = [item.flag.id for item in by_time]
    assert view.following(everything) is None


@pytest.mark.parametrize("width", [300, 380, 420, 480, 700])
def test_no_cell_is_cut_at_any_width(view, width):
    view.resize(width, 500)
    shown = table(view)
    metrics = shown.fontMetrics()
    for which in Column:
        if shown.isColumnHidden(which) or which is Column.JOINT:
            continue
        room = shown.columnWidth(which)
        icon = 20 if which is Column.VERDICT else 0
        for text in column(view, which):
            assert metrics.horizontalAdvance(text) + icon <= room, (which.name, text, room)
    assert shown.columnWidth(Column.JOINT) >= 60


@pytest.mark.parametrize("kind", list(Kind))
def test_every_kind_has_room(view, kind):
    view.resize(480, 500)
    shown = table(view)
    assert not shown.isColumnHidden(Column.KIND)
    assert shown.fontMetrics().horizontalAdvance(kind) + 8 <= shown.columnWidth(Column.KIND)


@given(
    verdict=st.one_of(st.none(), st.sampled_from(list(Verdict))),
    text=st.sampled_from(["", "left", "LEFT arm", "spike", "root", "open", "no such joint"]),
    limb=st.one_of(st.none(), st.sampled_from(["left arm", "root", "no such limb"])),
    rejected=st.sets(st.integers(0, 6)),
)
def test_the_filter_shows_exactly_what_passes(qapp, verdict, text, limb, rejected):
    document = sitting(walking(1200, 120))
    queue = document.state.queue
    document.reject([queue[n].flag.id for n in sorted(rejected) if n < len(queue)])
    limbs = {"LeftForeArm": "left arm", "LeftHand": "left arm", "root position": "root"}
    model, shown = QueueModel(), QueueFilter()
    shown.setSourceModel(model)
    model.show(document.state.queue, document.state.take)
    shown.set_filter(Filter(verdict, None, limb, text), limbs)

    def passes(item) -> bool:
        words = f"{item.flag.joint} {item.flag.kind} {item.verdict}".lower()
        return (
            (verdict is None or item.verdict is verdict)
            and (limb is None or limbs.get(item.flag.joint) == limb)
            and all(word in words for word in text.lower().split())
        )

    ids = [
        model.items[shown.mapToSource(shown.index(row, 0)).row()].flag.id
        for row in range(shown.rowCount())
    ]
    assert ids == [item.flag.id for item in document.state.queue if passes(item)]
