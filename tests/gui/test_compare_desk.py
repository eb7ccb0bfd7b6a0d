"""The Compare workspace in a real window, by mouse and keys."""

from __future__ import annotations

import csv
import json
from dataclasses import replace

import numpy as np
import pytest
from hands import CTRL, SHIFT, Hands
from made_comparison import shortened
from made_takes import paced, walking
from mouse import click, drag, wheel
from PySide6.QtCore import QPointF, Qt
from PySide6.QtWidgets import QApplication, QLineEdit, QTableView
from test_desk_layout import cut_texts

from mocapstudio import formats
from mocapstudio.gui.dialogs.trouble import TroubleDialog
from mocapstudio.gui.viewport.canvas import Canvas
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.review.comparing import MOST_SOURCES

SECONDS, RATE = 4.0, 60


@pytest.fixture(scope="module")
def performances(tmp_path_factory):
    """A teacher and eight pupils at paces of their own, as BVH."""
    folder = tmp_path_factory.mktemp("kata")
    teacher = walking(seconds=SECONDS, rate=RATE, name="teacher")
    at = np.arange(2 * teacher.frames)
    files = [folder / "teacher.bvh"]
    formats.write(teacher, files[0])
    for number in range(MOST_SOURCES):
        pace = 1.0 + 0.35 * np.sin(at / 25.0 + number)
        files.append(folder / f"pupil_{number + 1}.bvh")
        formats.write(paced(teacher, pace), files[-1])
    return files


@pytest.fixture(scope="module")
def takes(performances):
    """The same, read."""
    return [formats.read(path)[0][0] for path in performances]


@pytest.fixture
def hands(compare_hands):
    """A user at a desk of this file's own, who finds it empty and in the Compare workspace."""
    return compare_hands


@pytest.fixture
def compare(hands, takes):
    """The workspace with the teacher and the first pupil, compared."""
    workspace = hands.window.switching.front
    workspace.working.take_in(takes[:2])
    hands.see(lambda: workspace.bridge.state.linked is not None, 60)
    return workspace


def add_all(hands: Hands, workspace, takes) -> None:
    workspace.working.take_in(takes[2:])
    state = lambda: workspace.bridge.state  # noqa: E731
    hands.see(lambda: len(state().sources) == MOST_SOURCES, 60)
    hands.see(lambda: all(one.linked is not None for one in state().sources), 120)


def colours_of(view) -> int:
    """How many colours the middle of a viewport shows; a background alone has few."""
    picture = view.grab().toImage()
    width, height = picture.width(), picture.height()
    return len(
        {
            picture.pixel(x, y)
            for x in range(width // 4, 3 * width // 4, 2)
            for y in range(height // 5, 4 * height // 5, 2)
        }
    )


def test_the_switch_brings_workspaces_to_the_front_and_back(hands):
    hands.press("1", CTRL)
    hands.see(lambda: hands.shows("welcome"))
    assert not hands.shows("compare")
    assert not hands.window.actions_["compare-overlay"].isEnabled()
    hands.click("button-workspace-compare")
    hands.see(lambda: hands.shows("compare-empty"))
    assert not hands.shows("welcome")
    shown = [m.title() for m in hands.window.menus.values() if m.menuAction().isVisible()]
    assert "&Compare" in shown
    assert "Fla&g" not in shown
    # Commands about flags have no place here, and their keys are free.
    assert not hands.window.actions_["accept"].isEnabled()
    hands.menu("Workspace", "Review")
    hands.see(lambda: hands.shows("welcome"))


def test_files_are_chosen_read_and_compared(hands, performances, tmp_path):
    assert "reference" in hands.text("compare-words")
    hands.click("button-compare-reference")
    hands.answer_file_dialog(performances[0])
    hands.see(lambda: hands.text("compare-hint") == "Compare with teacher")
    bad = tmp_path / "bad.bvh"
    bad.write_text("HIERARCHY\nnonsense\n")
    hands.press("A", CTRL | SHIFT)
    hands.answer_file_dialog(bad, performances[1])
    # The bad file is named, the other is compared.
    hands.see(lambda: isinstance(QApplication.activeModalWidget(), TroubleDialog))
    QApplication.activeModalWidget().close()
    hands.come_back()
    state = lambda: hands.window.switching.front.bridge.state  # noqa: E731
    hands.see(lambda: state().linked is not None, 60)
    assert [one.id for one in state().sources] == ["pupil_1"]


def test_a_pupil_is_set_beside_the_teacher(hands, compare):
    state = compare.bridge.state
    assert hands.text("reference-name") == "teacher"
    assert state.linked.comparison.source == "pupil_1"
    # What was done to the pace is found again.
    truth = np.cumsum(1.0 + 0.35 * np.sin(np.arange(len(state.comparison.warp)) / 25.0))
    off = np.abs(state.comparison.warp[20:-20] - truth[20:-20])
    assert np.median(off) < 4
    for view in compare.desk.stage.views:
        hands.see(lambda view=view: colours_of(view) > 100)
    assert hands.window.workspace.viewport.isVisible() is False


def test_clicks_keys_and_pictures_move_one_frame(hands, compare):
    pictures = compare.desk.pictures
    plot = pictures.difference
    click(plot.viewport(), QPointF(plot.x_of(100), plot.area.center().y()))
    assert compare.bridge.state.source_frame == 100
    assert hands.text("source-time") == f"{100 / RATE:.2f} s"
    hands.key(Qt.Key.Key_Right)
    hands.key(Qt.Key.Key_Right, SHIFT)
    assert compare.bridge.state.source_frame == 111
    hands.key(Qt.Key.Key_Home)
    assert (compare.bridge.state.frame, compare.bridge.state.source_frame) == (0, 0)
    hands.key(Qt.Key.Key_End)
    assert compare.bridge.state.source_frame == compare.bridge.state.source.take.frames - 1


def test_space_plays_along_the_path_and_at_true_speed(hands, compare):
    bridge = compare.bridge
    hands.key(Qt.Key.Key_Home)
    hands.key(Qt.Key.Key_Space)
    hands.see(lambda: bridge.state.frame > 25)
    hands.key(Qt.Key.Key_Space)
    linked = bridge.state.linked
    pair = (bridge.state.frame, bridge.state.source_frame)
    assert pair in set(map(tuple, linked.comparison.path.tolist()))
    hands.key(Qt.Key.Key_Home)
    hands.press("W")
    assert not bridge.ui.along_path
    hands.key(Qt.Key.Key_Space)
    hands.see(lambda: bridge.state.frame > 40)
    hands.key(Qt.Key.Key_Space)
    assert bridge.state.source_frame == pytest.approx(bridge.state.frame, abs=1)


def test_eight_sources_are_ranked_zoomed_and_played(hands, compare, takes):
    add_all(hands, compare, takes)
    bridge = compare.bridge
    table = hands.find("ranking", QTableView)
    assert table.model().rowCount() == MOST_SOURCES
    unlike = [float(table.model().index(r, 2).data().rstrip(" ?")) for r in range(MOST_SOURCES)]
    assert unlike == sorted(unlike)
    hands.click_cell(table, table.visualRect(table.model().index(5, 1)))
    assert bridge.state.chosen == bridge.state.ranking[5].id
    hands.press("M")
    hands.see(lambda: hands.shows("compare-multiples-view"))
    strips = compare.desk.multiples.plot
    one, place = strips.strips()[2]
    click(strips.viewport(), QPointF(strips.x_of(90), place.center().y()))
    assert bridge.state.chosen == one.id
    assert bridge.state.frame == 90
    wheel(strips.viewport(), QPointF(strips.x_of(90), place.center().y()), 6)
    start, end = bridge.state.shown
    assert end - start < 0.6 * one.take.frames
    hands.press("A")
    hands.press("V")
    assert [view.isVisible() for view in compare.desk.stage.views] == [True, False]
    members = compare.desk.stage._members[compare.desk.stage.left]
    assert len(members) == 1 + MOST_SOURCES
    before = bridge.state.frame
    hands.key(Qt.Key.Key_Space)
    hands.see(lambda: bridge.state.frame > before + 10)
    hands.key(Qt.Key.Key_Space)
    hands.press("N")
    assert bridge.state.chosen != one.id


def test_at_most_two_viewports_are_drawn(hands, compare):
    def drawn() -> int:
        return sum(one.isVisible() for one in hands.window.findChildren(Canvas))

    assert drawn() == 2
    hands.press("V")
    assert drawn() == 1
    hands.press("1", CTRL)
    assert drawn() <= 1


def test_parts_are_drawn_renamed_deleted_saved_and_carried(hands, compare, tmp_path):
    heat, bridge = compare.desk.pictures.heat, compare.bridge
    lane = heat.bands.lane.center().y()
    here = lambda frame: QPointF(heat.reference_scale.x(frame), lane)  # noqa: E731
    drag(heat.viewport(), here(30), here(80))
    drag(heat.viewport(), here(120), here(170))
    assert len(bridge.state.segments) == 2
    table = hands.find("segments-table", QTableView)
    hands.click_cell(table, table.visualRect(table.model().index(0, 0)))
    hands.key(Qt.Key.Key_F2)
    editor = table.findChild(QLineEdit)
    editor.selectAll()
    hands.qtbot.keyClicks(editor, "mae geri")
    hands.qtbot.keyClick(editor, Qt.Key.Key_Return)
    hands.see(lambda: bridge.state.segments[0].name == "mae geri")
    hands.window.setFocus()
    bridge.sitting.select_segment(1)
    hands.key(Qt.Key.Key_Delete)
    assert [one.name for one in bridge.state.segments] == ["mae geri"]
    hands.press("Z", CTRL)
    assert len(bridge.state.segments) == 2
    hands.press("L", CTRL | SHIFT)
    path = tmp_path / "parts.json"
    hands.answer_file_dialog(path)
    hands.see(path.exists)
    kept = json.loads(path.read_text())
    assert kept["take"] == "teacher"
    assert kept["fps"] == RATE
    first = bridge.state.segments[0]
    assert kept["segments"][0] == {"name": "mae geri", "start": first.start, "end": first.end}
    assert not bridge.state.unsaved
    bridge.sitting.set_segments((), "Nothing")
    hands.press("L", CTRL)
    hands.answer_file_dialog(path)
    hands.see(lambda: len(bridge.state.segments) == 2)
    answer = bridge.state.linked.carried(bridge.state.segments)[0]
    shown = [table.model().index(0, c).data() for c in range(5)]
    assert shown[2:4] == [f"{answer.reference_duration:.2f}", f"{answer.source_duration:.2f}"]


def test_suggestions_can_be_undone(hands, compare):
    hands.press("G", CTRL)
    hands.see(lambda: not hands.window.jobs.running)
    found = compare.bridge.state.segments
    if found:
        hands.press("Z", CTRL)
    assert compare.bridge.state.segments == ()


def test_the_matrix_shows_the_path_and_takes_clicks(hands, compare):
    hands.press("X")
    view = hands.find("compare-matrix-view")
    place = view.place_of(100, compare.bridge.state.linked.source_of(100))
    click(view, place)
    assert compare.bridge.state.frame == pytest.approx(100, abs=2)
    wheel(view, place, 5)
    start, end = compare.bridge.state.shown
    assert end - start < 0.6 * compare.bridge.state.linked.frames[1]
    assert compare.desk.pictures.time_range.start == pytest.approx(start)


def test_true_speed_compares_anew(hands, compare):
    before = compare.bridge.state.comparison
    hands.press("S")
    hands.see(lambda: compare.bridge.state.comparison not in (None, before), 60)
    assert compare.bridge.state.comparison.true_speed
    hands.press("S")
    hands.see(lambda: compare.bridge.state.linked is not None, 60)
    assert not compare.bridge.state.comparison.true_speed


def test_pictures_tables_and_the_warped_source_are_written(hands, compare, tmp_path):
    compare.bridge.sitting.add_segment(30, 90, "step")
    for name in ("pictures.png", "pictures.svg"):
        hands.press("P", CTRL)
        hands.answer_file_dialog(tmp_path / name)
        hands.see((tmp_path / name).exists)
    assert (tmp_path / "pictures.png").read_bytes().startswith(b"\x89PNG")
    drawing = (tmp_path / "pictures.svg").read_text()
    assert drawing.count("<path") + drawing.count("<polyline") > 20
    hands.press("T", CTRL)
    hands.answer_file_dialog(tmp_path / "kata.csv")
    hands.see((tmp_path / "kata.segments.csv").exists)
    with (tmp_path / "kata.csv").open() as file:
        rows = list(csv.DictReader(file))
    comparison = compare.bridge.state.comparison
    assert len(rows) == len(comparison.warp)
    assert float(rows[50]["reference frame"]) == pytest.approx(comparison.warp[50], abs=1e-3)
    assert rows[50]["timing"] in {"delayed", "on time", "hastened"}
    hands.press("U", CTRL)
    hands.answer_file_dialog(tmp_path / "warped.bvh")
    hands.see((tmp_path / "warped.bvh").exists)
    warped = formats.read(tmp_path / "warped.bvh")[0][0]
    assert warped.frames == compare.bridge.state.reference.frames


def test_markers_with_gaps_are_drawn_and_compared(hands, data):
    workspace = hands.window.switching.front
    path = data / "gaps_c3d_pycgm_MIT" / "Movement_trial.c3d"
    workspace.working.add_sources([path])
    hands.see(lambda: workspace.bridge.state.reference is not None, 60)
    take = workspace.bridge.state.reference
    assert isinstance(take, MarkerTake)
    at = np.clip(np.arange(take.frames) + 12 * np.sin(np.arange(take.frames) / 30), 0, 322)
    moved = take.positions[np.rint(at).astype(int)].copy()
    moved[100:180, 5] = np.nan
    again = replace(take, name="again", positions=moved, filled=None, source=None)
    workspace.working.take_in([again])
    hands.see(lambda: workspace.bridge.state.linked is not None, 60)
    workspace.bridge.sitting.go_source(140)
    for view in workspace.desk.stage.views:
        hands.see(lambda view=view: colours_of(view) > 40)
    actor = workspace.desk.stage._members[workspace.desk.stage.right][0].actor
    swell = actor.swell(140)
    assert swell[5] < 1.0
    assert swell[6] == 1.0
    assert np.isfinite(actor.points(140)).all()


def test_a_missing_frame_rate_is_asked_for(hands, data):
    workspace = hands.window.switching.front
    workspace.working.set_reference(data / "karate_rmocap_GPL3" / "mawashi.geri.left.1.csv")
    hands.see(lambda: hands.shows("rate-dialog"))
    hands.type("rate-text", "100", enter=False)
    hands.click("rate-ok")
    hands.see(lambda: workspace.bridge.state.reference is not None)
    assert workspace.bridge.state.reference.rate == 100


def test_performers_under_review_are_compared(hands, takes):
    document = hands.window.bridge.document
    document.open_take(takes[0])
    document.open_take(shortened(takes[0], 150, "short"))
    hands.press("R", CTRL | SHIFT)
    workspace = hands.window.switching.front
    hands.see(lambda: workspace.bridge.state.linked is not None, 60)
    both = {workspace.bridge.state.reference.frames, workspace.bridge.state.source.take.frames}
    assert both == {150, takes[0].frames}


def test_closing_asks_before_parts_are_lost(hands, compare):
    compare.bridge.sitting.add_segment(10, 60, "step")
    hands.window.close()
    hands.see(lambda: hands.shows("confirm-question"))
    assert hands.window.isVisible()
    QApplication.activeModalWidget().reject()
    hands.come_back()


@pytest.mark.parametrize("size", [(1280, 720), (1440, 900)])
def test_nothing_is_cut_off(hands, compare, size):
    hands.window.resize(*size)
    compare.desk.share_out()
    assert (hands.window.width(), hands.window.height()) == size
    hands.see(lambda: cut_texts(hands.window) == [])
    pictures = compare.desk.pictures
    hands.see(lambda: pictures.geometry() == pictures.parentWidget().rect())
