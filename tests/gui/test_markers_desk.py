"""The Markers workspace, driven by mouse and keys over a real take with gaps."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hands import CTRL, Hands
from made_takes import walking
from mouse import click, drag
from PySide6.QtCore import QPointF, Qt
from PySide6.QtWidgets import QApplication, QTableView, QToolButton

from mocapstudio import formats
from mocapstudio.gui.dialogs.trouble import TroubleDialog
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.runs import runs
from mocapstudio.review.document import Document

SHIFT = Qt.KeyboardModifier.ShiftModifier


@pytest.fixture
def take(data):
    """Twenty-four markers, twenty-nine gaps."""
    return data / "gaps_c3d_btk_BSD" / "ADemo1_rewrite_c3d_pc_float.c3d"


@pytest.fixture
def user(window, qtbot) -> Hands:
    """A user at the shared desk, who finds it empty."""
    window.files._swap(Document("ana"))
    window.switching.show("review")
    window.activateWindow()
    hands = Hands(window, qtbot)
    hands.see(window.isActiveWindow)
    return hands


def opened(hands: Hands, path):
    """Open a file by the menu and return the workspace."""
    hands.menu("File", "Open")
    hands.answer_file_dialog(path)
    hands.see(lambda: hands.shows("markers-table"))
    return hands.window.switching.front


def listed(hands: Hands) -> list[list[str]]:
    model = hands.find("markers-table", QTableView).model()
    return [
        [model.index(row, column).data() for column in range(model.columnCount())]
        for row in range(model.rowCount())
    ]


def click_lane(workspace, marker: str, frame: int) -> None:
    plot = workspace.lanes.plot
    row = plot.rows.index[marker]
    y = plot.area.top() + plot.rows.tops[row] + plot.rows.row_height / 2
    click(plot.viewport(), QPointF(plot.x_of(frame), y))


def answer(hands: Hands, key: Qt.Key) -> None:
    """Answer the question that is asked."""
    hands.see(lambda: hands.shows("confirm-question"))
    question = hands.find("confirm-question")
    question.activateWindow()
    hands.see(question.isActiveWindow)
    hands.key(key)


def wait_for_edits(hands: Hands, count: int) -> None:
    bridge = hands.window.switching.front.bridge
    hands.see(lambda: not hands.window.jobs.running and len(bridge.shown.edits) == count)


def check_written(take, out, edited: np.ndarray, declared: set[Declared]) -> None:
    """Check that the file holds what was edited, and nothing else that is new."""
    (source,), _ = formats.read_any(take)
    (again,), _ = formats.read_any(out)
    allowed = np.zeros_like(source.missing)
    for one in declared:
        allowed[one.start : one.end, source.index[one.row]] = True
    rest = ~allowed
    assert np.array_equal(again.positions[rest], source.positions[rest], equal_nan=True)
    assert np.allclose(again.positions, edited, atol=1e-6, equal_nan=True)
    told = json.loads(out.with_name(f"{out.stem}.provenance.json").read_text())
    assert {(one["marker"], one["start"], one["end"]) for one in told["changes"]} == {
        (one.row, one.start, one.end) for one in declared
    }
    before, after = take.read_bytes(), out.read_bytes()
    assert len(before) == len(after)
    differing = sum(a != b for a, b in zip(before, after, strict=True))
    assert 0 < differing <= 16 * allowed.sum()


def test_gaps_are_filled_labels_exchanged_and_nothing_else_is_written(user, take, tmp_path):
    hands, workspace = user, opened(user, take)
    (source,), _ = formats.read_any(take)
    bridge, document = workspace.bridge, user.window.bridge.document
    assert len(listed(hands)) == len(source.labels)
    assert listed(hands)[0][:3] == ["L.Ankle", "2", "29"]
    assert hands.text("markers-count") == "29 gaps"

    # The first gap in time, by a key each.
    hands.press("N")
    first = (bridge.shown.marker, bridge.shown.span)
    assert source.missing[slice(*first[1]), source.index[first[0]]].all()
    hands.press("2")
    wait_for_edits(hands, 1)
    assert hands.text("markers-words").startswith("Filled")
    # Another way takes its place.
    hands.press("6")
    wait_for_edits(hands, 1)
    assert bridge.shown.edits[0].method == "straight line"

    # A gap by a click on its lane, and the rest of the short ones.
    marker = source.index["L.Ankle"]
    start, end = runs(source.missing[:, marker])[-1]
    click_lane(workspace, "L.Ankle", (start + end) // 2)
    assert (bridge.shown.marker, bridge.shown.span) == ("L.Ankle", (start, end))
    hands.click("button-markers-fill-rigid")
    wait_for_edits(hands, 2)

    # Labels exchanged over a span that is swept on the lanes.
    plot = workspace.lanes.plot
    y = plot.area.top() + plot.rows.tops[plot.rows.index["R.Heel"]] + 1
    drag(plot.viewport(), QPointF(plot.x_of(100), y), QPointF(plot.x_of(140), y), modifiers=SHIFT)
    assert bridge.shown.marker == "R.Heel"
    swept = bridge.shown.span
    assert abs(swept[0] - 100) <= 2 and abs(swept[1] - 140) <= 2
    hands.press("X")
    hands.see(lambda: hands.shows("exchange-dialog"))
    other = hands.find("exchange-other").currentData()
    hands.click("exchange-ok")
    hands.come_back()
    wait_for_edits(hands, 3)
    at = [source.index["R.Heel"], source.index[other]]
    moved = document.marker_result(bridge.shown.performer).positions[slice(*swept)][:, at]
    assert np.array_equal(moved, source.positions[slice(*swept)][:, at[::-1]], equal_nan=True)

    # All of it back, and done again.
    edited = bridge.shown.result
    for _ in range(4):
        hands.press("Z", CTRL)
    assert document.state.can_undo is None
    assert bridge.shown.result is bridge.shown.source
    assert hands.text("markers-count") == "29 gaps"
    for _ in range(4):
        hands.press("Y", CTRL)
    assert np.array_equal(bridge.shown.result.positions, edited.positions, equal_nan=True)

    hands.press("E", CTRL)
    out = tmp_path / "mended.c3d"
    hands.answer_file_dialog(out)
    hands.see(lambda: (tmp_path / "mended.provenance.json").exists())
    declared = {
        Declared(first[0], *first[1]),
        Declared("L.Ankle", start, end),
        Declared("R.Heel", *swept),
        Declared(other, *swept),
    }
    assert set(document.marker_declared(bridge.shown.performer)) == declared
    check_written(take, out, edited.positions, declared)
    (again,), _ = formats.read_any(out)
    assert not again.missing[start:end, marker].any()


def test_all_short_gaps_are_filled_at_once_and_taken_back_together(user, take):
    hands, workspace = user, opened(user, take)
    bridge = workspace.bridge
    hands.type("markers-longest", "6")
    short = bridge.shown.gaps.up_to(6)
    assert 2 < len(short) < 29
    hands.press("A", SHIFT)
    wait_for_edits(hands, len(short))
    assert not bridge.shown.gaps.up_to(6)
    assert bridge.shown.gaps.in_time
    assert len({edit.group for edit in bridge.shown.edits}) == 1
    hands.find("markers-tabs").setCurrentIndex(1)
    hands.click("marker-edit-mute")
    assert bridge.shown.gaps.up_to(6) == short
    hands.click("marker-edit-mute")
    hands.click("marker-edit-delete")
    assert not bridge.shown.edits
    assert bridge.shown.result is bridge.shown.source


def test_a_bad_stretch_is_taken_away_and_taken_back(user, take):
    hands, workspace = user, opened(user, take)
    bridge = workspace.bridge
    table = hands.find("markers-table")
    row = len(listed(hands)) - 1
    hands.click_cell(table, table.visualRect(table.model().index(row, 0)))
    marker = bridge.shown.marker
    assert marker == listed(hands)[-1][0]
    before = bridge.shown.gaps.by_label[marker].gaps
    start = next(f for f in range(50, 400) if not any(a < f + 50 and f < b for a, b in before))
    curves = workspace.curves.plot
    y = curves.area.center().y()
    places = (QPointF(curves.x_of(start + by), y) for by in (10, 40))
    drag(curves.viewport(), *places)
    span = bridge.shown.span
    assert abs(span[0] - start - 10) <= 2
    hands.key(Qt.Key.Key_Delete)
    assert set(bridge.shown.gaps.by_label[marker].gaps) == {*before, span}
    hands.press("U")
    assert bridge.shown.result is bridge.shown.source


def test_a_marker_is_chosen_in_the_viewport_and_played(user, take):
    hands, workspace = user, opened(user, take)
    bridge, stage = workspace.bridge, workspace.stage
    if stage.view.canvas is None:
        pytest.skip("no OpenGL here")
    hands.qtbot.wait(300)
    bridge.go(0)
    seen = [name for name in bridge.shown.result.labels if stage.pixel_of(name) is not None]
    name = next(one for one in seen if one != bridge.shown.marker)
    at = stage.pixel_of(name)
    click(stage.view.canvas, at)
    hands.see(lambda: bridge.shown.marker is not None)
    chosen = stage.pixel_of(bridge.shown.marker)
    assert abs(chosen.x() - at.x()) <= 12
    hands.key(Qt.Key.Key_Space)
    hands.see(lambda: bridge.shown.frame > 5)
    hands.key(Qt.Key.Key_Space)
    assert not bridge.shown.playing
    hands.key(Qt.Key.Key_Home)
    assert bridge.shown.frame == 0


def test_a_session_of_markers_alone_is_saved_and_opened_again(user, take, tmp_path):
    hands, workspace = user, opened(user, take)
    hands.press("N")
    hands.press("1")
    wait_for_edits(hands, 1)
    filled = workspace.bridge.shown.result
    hands.press("S", CTRL)
    session = tmp_path / "marks.mocapstudio"
    hands.answer_file_dialog(session)
    hands.see(session.exists)
    hands.window.files.begin_anew()
    hands.see(lambda: hands.shows("markers-empty"))
    hands.window.files.open_paths([session])
    hands.see(lambda: hands.shows("markers-table"))
    again = workspace.bridge.shown.result
    assert np.array_equal(again.positions, filled.positions, equal_nan=True)
    assert np.array_equal(again.filled, filled.filled)


def test_markers_closed_ask_first_where_they_were_edited(user, take):
    hands, workspace = user, opened(user, take)
    workspace.working.clear()
    hands.press("W", CTRL)
    answer(hands, Qt.Key.Key_Return)
    hands.see(lambda: hands.shows("markers-empty"))
    hands.come_back()
    assert not hands.window.bridge.state.markers
    assert not hands.window.bridge.state.sitting.marker_edits


def test_a_single_short_gap_is_filled_over_earlier_edits(user, take):
    hands, workspace = user, opened(user, take)
    bridge = workspace.bridge
    workspace.working.clear()
    shortest = bridge.shown.gaps.shortest
    count = len(bridge.shown.gaps.up_to(shortest))
    hands.type("markers-longest", str(shortest))
    hands.press("A", SHIFT)
    wait_for_edits(hands, 1 + count)


def test_markers_read_otherwise_lose_their_edits_after_a_question(user, take, tmp_path):
    source = tmp_path / "marks.trc"
    (markers,), _ = formats.read_any(take)
    formats.write(markers, source)
    hands, workspace = user, opened(user, source)
    workspace.working.clear()
    before = workspace.bridge.shown.source
    hands.press("I", CTRL)
    hands.see(lambda: hands.shows("import-report"))
    report = hands.find("import-report")
    report.activateWindow()
    hands.see(report.isActiveWindow)
    assert hands.text("import-name") == "marks.trc"
    hands.type("reading-unit-text", str(2 * before.source.unit), enter=False)
    hands.click("import-again")
    answer(hands, Qt.Key.Key_Escape)
    hands.see(lambda: not hands.shows("confirm-question"))
    assert workspace.bridge.shown.source is before
    hands.come_back()
    hands.click("import-again")
    answer(hands, Qt.Key.Key_Return)
    hands.see(lambda: workspace.bridge.shown.source is not before)
    after = workspace.bridge.shown
    assert np.allclose(after.source.positions, 2 * before.positions, equal_nan=True)
    assert not after.edits
    assert len(hands.window.bridge.state.markers) == 1
    hands.click("import-close")


def test_the_theme_changes_with_edits_in_the_list(user, take):
    hands, workspace = user, opened(user, take)
    hands.press("A", SHIFT)
    hands.see(lambda: not hands.window.jobs.running and len(workspace.bridge.shown.edits) > 1)
    workspace.working.clear()
    hands.find("markers-tabs").setCurrentIndex(1)
    for _ in range(4):
        hands.menu("View", "Light Theme")
        hands.qtbot.wait(50)
        assert hands.shows("marker-edit-mute")
    assert workspace.bridge.shown.edits


def test_commands_wait_for_markers(user, take):
    hands, actions = user, user.window.actions_
    hands.window.switching.show("markers")
    names = ("markers-fill-best", "markers-next", "markers-exchange", "markers-solve", "export")
    assert not any(actions[name].isEnabled() for name in names)
    buttons = [hands.window.findChild(QToolButton, f"button-{name}") for name in names]
    assert not any(button.isEnabled() for button in buttons)
    workspace = opened(hands, take)
    assert all(actions[name].isEnabled() for name in names)
    workspace.bridge.choose(None)
    assert not actions["markers-exchange"].isEnabled()


def test_a_take_of_joints_is_shown_for_review_and_the_markers_stay(user, take, tmp_path):
    hands = user
    opened(hands, take)
    hands.window.bridge.set_ui(learning=False)
    formats.write(walking(seconds=0.5, rate=30, name="walk"), tmp_path / "walk.bvh")
    hands.window.files.open_paths([tmp_path / "walk.bvh"])
    hands.see(lambda: hands.window.bridge.state.active == "walk")
    assert hands.window.switching.name == "review"
    hands.key(Qt.Key.Key_4, CTRL)
    assert hands.shows("markers-table")
    assert len(hands.window.bridge.state.markers) == 1


def test_what_is_protected_stays_as_it_is(user, take):
    hands, workspace = user, opened(user, take)
    bridge, document = workspace.bridge, user.window.bridge.document
    told = []
    hands.window.messages.told.connect(lambda text, _about: told.append(text))
    hands.press("N")
    shown = bridge.shown
    hands.press("P", SHIFT)
    assert bridge.shown.protected == (Declared(shown.marker, *shown.span),)
    assert hands.text("markers-words").endswith("protected")
    hands.press("1")
    assert told[-1] == f"{shown.marker} is protected there: Shift+U lifts the protection."
    hands.key(Qt.Key.Key_Delete)
    hands.see(lambda: isinstance(QApplication.activeModalWidget(), TroubleDialog))
    QApplication.activeModalWidget().close()
    hands.come_back()
    assert not bridge.shown.edits
    # The other short gaps are filled.
    short = bridge.shown.gaps.up_to(bridge.shown.longest)
    spared = [one for one in short if one.marker == shown.marker
              and (one.start, one.end) == shown.span]  # fmt: skip
    hands.press("A", SHIFT)
    wait_for_edits(hands, len(short) - len(spared))
    assert (
        document.marker_result(shown.performer)
        .missing[slice(*shown.span), shown.source.index[shown.marker]]
        .all()
    )
    bridge.choose(shown.marker, shown.span[0])
    hands.press("U", SHIFT)
    assert not bridge.shown.protected
    hands.press("1")
    wait_for_edits(hands, len(short) - len(spared) + 1)
