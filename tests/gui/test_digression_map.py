"""The digression map in a real window, worked with the mouse."""

from __future__ import annotations

import mouse
import numpy as np
import plot_scene
import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QColor, QHelpEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from mocapstudio import formats
from mocapstudio.cleaning.detection import detect
from mocapstudio.gui import theme as themes
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.plots import row_labels
from mocapstudio.gui.plots.colours import lookup_table
from mocapstudio.gui.views.digression_map import DigressionMapView
from mocapstudio.motion.progress import run
from mocapstudio.review.document import Document
from mocapstudio.review.model import Verdict

SHIFT = Qt.KeyboardModifier.ShiftModifier
CONTROL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture
def document():
    return plot_scene.sitting()


@pytest.fixture
def view(qtbot, document):
    themes.apply(QApplication.instance(), themes.DARK)
    return shown(qtbot, document)


def shown(qtbot, document, height=420):
    view = DigressionMapView(DocumentBridge(document))
    qtbot.addWidget(view)
    view.resize(1440, height)
    view.show()
    qtbot.waitExposed(view)
    QApplication.processEvents()
    return view


def surface(view):
    return view.plot.viewport()


def place(view, row, frame):
    """Middle of a cell, in pixels of the plot."""
    layout = view._rows
    top = view.plot.area.top() + layout.tops[layout.index[row]]
    return QPointF(view.plot.x_of(frame), top + 0.5 * layout.row_height)


def quiet(view, frame, row="LeftToeBase"):
    at = place(view, row, frame)
    assert view.flag_at(at) is None
    return at


def flag_of(document, row):
    return next(item.flag for item in document.state.queue if item.flag.joint == row)


def colour_at(view, at):
    picture = view.plot.grab().toImage()
    return QColor(picture.pixel(at.toPoint()))


def close(a, b, within=3):
    return all(abs(x - y) <= within for x, y in zip(a.getRgb(), b.getRgb(), strict=True))


def test_without_an_analysis_it_says_what_to_do(qtbot):
    view = shown(qtbot, plot_scene.sitting(analysed=False))
    assert view.empty.isVisible()
    assert "Analyse" in view.empty.text()
    assert not view.plot.isVisible()


def test_the_map_appears_with_the_analysis_and_goes_with_the_take(qtbot):
    document = plot_scene.sitting(analysed=False)
    view = shown(qtbot, document)
    plot_scene.analyse(document, document.state.active)
    assert view.plot.isVisible()
    document.close_performer(document.state.active)
    assert view.empty.isVisible()


def test_each_cell_has_the_colour_of_its_value(view, document):
    mapped = document.state.analysis.map
    table = lookup_table(themes.DARK, document.state.threshold)
    view.time_range.show(200, 300)
    QApplication.processEvents()
    for row in ("Chest", "LeftFoot", "root heading"):
        for frame in (210, 250, 290):
            value = mapped.values[frame, mapped.rows.index(row)]
            expected = QColor.fromRgb(int(table[int(value * 255 + 0.5)]))
            assert close(colour_at(view, quiet(view, frame, row)), expected), (row, frame)


def test_one_bad_frame_is_seen_when_the_whole_of_a_long_take_is_shown(qtbot):
    take = plot_scene.walking(6000)
    analysis = plot_scene.analysis_of(take)
    column = analysis.map.rows.index("LeftFoot")
    analysis.map.values[:, column] = 0.0
    analysis.map.values[3333, column] = 1.0
    document = plot_scene.sitting(take, analysed=False)
    performer = document.state.active
    document.finish_analysis(performer, document.begin_analysis(performer), analysis)
    view = shown(qtbot, document, height=230)
    picture = view.plot.grab().toImage()
    y = place(view, "LeftFoot", 0).toPoint().y()
    at = round(view.plot.x_of(3333))
    around = [QColor(picture.pixel(x, y)).lightness() for x in range(at - 8, at + 9)]
    assert max(around) > 120
    assert sum(light > 120 for light in around) <= 3


def test_a_click_moves_the_play_head(view, document):
    mouse.click(surface(view), quiet(view, 777))
    assert document.state.frame == 777
    assert view.plot.play_head.x() == pytest.approx(view.plot.x_of(777), abs=0.5)


def test_a_drag_takes_the_play_head_along_and_stays_within_what_is_seen(view, document):
    view.time_range.show(300, 700)
    mouse.drag(surface(view), quiet(view, 400), QPointF(view.plot.area.right() + 60, 200))
    assert document.state.frame == 700
    assert (view.time_range.start, view.time_range.end) == (300, 700)


def test_a_click_on_a_flag_selects_it(view, document):
    flag = flag_of(document, "RightLeg")
    document.set_frame(5)
    mouse.click(surface(view), place(view, "RightLeg", flag.start + 2))
    selection = document.state.selection
    assert selection.flag == flag.id
    assert selection.span == (flag.start, flag.end)
    assert document.state.frame == flag.peak_frame


def test_a_flag_of_one_frame_can_be_hit_in_a_long_take(qtbot):
    document = plot_scene.sitting(plot_scene.walking(6000))
    view = shown(qtbot, document, height=230)
    flag = flag_of(document, "Spine1")
    mouse.click(surface(view), place(view, "Spine1", flag.start) + QPointF(1.5, 0))
    assert document.state.selection.flag == flag.id


def test_a_drag_that_begins_on_a_flag_scrubs(view, document):
    flag = flag_of(document, "RightHand")
    begin = place(view, "RightHand", flag.start + 10)
    mouse.drag(surface(view), begin, place(view, "RightHand", 100))
    assert document.state.frame == 100
    assert document.state.selection.flag is None


def test_shift_and_drag_select_rows_and_frames(view, document):
    document.select_flag(flag_of(document, "Head").id)
    mouse.drag(
        surface(view), place(view, "LeftArm", 300), place(view, "LeftHand", 399), modifiers=SHIFT
    )
    selection = document.state.selection
    assert selection.joints == {"LeftArm", "LeftForeArm", "LeftHand"}
    assert selection.span == (300, 400)
    assert selection.flag is None


def test_a_click_on_a_name_selects_the_row_and_on_a_limb_all_of_it(view, document):
    y = place(view, "LeftLeg", 0).y()
    mouse.click(view.labels, QPointF(150, y))
    assert document.state.selection.joints == {"LeftLeg"}
    mouse.click(view.labels, QPointF(150, place(view, "Head", 0).y()), modifiers=CONTROL)
    assert document.state.selection.joints == {"LeftLeg", "Head"}
    mouse.click(view.labels, QPointF(30, y))
    assert document.state.selection.joints == {
        "LeftUpLeg",
        "LeftLeg",
        "LeftFoot",
        "LeftToeBase",
    }


def test_the_wheel_zooms_about_the_cursor(view):
    at = quiet(view, 400)
    before = view.plot.frame_at(at.x())
    mouse.wheel(surface(view), at, 4)
    assert view.time_range.length < 700
    assert view.plot.frame_at(at.x()) == pytest.approx(before, abs=1e-6)


def test_the_middle_button_pans_and_home_shows_the_whole(view, document):
    view.time_range.show(400, 600)
    area = view.plot.area
    begin = QPointF(area.center())
    mouse.drag(
        surface(view), begin, begin + QPointF(area.width() / 4, 0), Qt.MouseButton.MiddleButton
    )
    assert view.time_range.start == pytest.approx(350, abs=1)
    assert view.time_range.length == 200
    assert document.state.frame == 0
    QTest.keyClick(view.plot, Qt.Key.Key_Home)
    assert view.time_range.is_whole
    assert not view.whole.isVisible()
    view.time_range.show(400, 600)
    mouse.click(view.whole, QPointF(10, 8))
    assert view.time_range.is_whole


def test_z_and_a_double_click_zoom_to_the_selected_flag(view, document):
    flag = flag_of(document, "Head")
    document.select_flag(flag.id)
    QTest.keyClick(view.plot, Qt.Key.Key_Z)
    assert view.time_range.length < 300
    assert view.time_range.start < flag.start < flag.end < view.time_range.end
    view.whole_take()
    other = flag_of(document, "RightHand")
    mouse.double_click(surface(view), place(view, "RightHand", other.start + 5))
    assert view.time_range.start < other.start < other.end < view.time_range.end
    assert not view.time_range.is_whole


def test_the_threshold_is_dragged_live_and_lands_where_it_is_let_go(view, document, qtbot):
    bar = view.bar
    begin = QPointF(20, bar.y_of(document.state.threshold))
    end = QPointF(20, bar.y_of(0.8))
    mouse.drag(bar, begin, end)
    assert document.state.threshold == pytest.approx(0.8, abs=0.004)
    assert {item.flag.peak >= 0.8 for item in document.state.queue} == {True}
    assert bar.threshold == document.state.threshold


def test_a_threshold_set_elsewhere_moves_the_mark_and_recolours_the_map(view, document):
    row, frame = "Head", flag_of(document, "Head").peak_frame
    view.time_range.show(frame - 20, frame + 20)
    before = colour_at(view, place(view, row, frame + 3))
    document.set_threshold(0.9)
    QApplication.processEvents()
    after = colour_at(view, place(view, row, frame + 3))
    assert view.bar.threshold == 0.9
    assert after.lightness() < before.lightness() - 20


@pytest.mark.parametrize("verdict", [Verdict.OPEN, Verdict.REJECTED, Verdict.DEFERRED])
def test_flags_are_outlined_in_the_colour_of_their_verdict(view, document, verdict):
    flag = flag_of(document, "RightHand")
    if verdict is Verdict.REJECTED:
        document.reject([flag.id])
    if verdict is Verdict.DEFERRED:
        document.defer([flag.id])
    document.clear_selection()
    QApplication.processEvents()
    picture = view.plot.grab().toImage()
    cell = place(view, "RightHand", (flag.start + flag.end) / 2).toPoint()
    half = view._rows.row_height // 2 + 2
    wanted = QColor(themes.DARK.verdict(verdict))
    seen = [
        QColor(picture.pixel(x, y))
        for x in range(cell.x() - 8, cell.x() + 8)
        for y in (*range(cell.y() - half, cell.y() - half + 4),)
    ]
    assert any(close(one, wanted, 12) for one in seen)


def test_the_read_out_names_row_time_frame_value_residual_flag_and_edit(view, document):
    flag = flag_of(document, "RightLeg")
    plot_scene.offer(document, flag.id)
    document.accept([flag.id])
    at = place(view, "RightLeg", flag.peak_frame)
    frame = view.plot.whole_frame_at(at.x())
    mapped = document.state.analysis.map
    column = mapped.rows.index("RightLeg")
    text = view.read_out(at)
    assert "RightLeg" in text
    assert f"frame {frame + document.state.take.first_frame}" in text
    assert f"digression {mapped.values[frame, column]:.2f}" in text
    assert f"{mapped.residuals[frame, column]:.1f}°" in text
    assert "freeze" in text
    assert "accepted" in text
    assert "edited: interpolation" in text
    root = view.read_out(place(view, "root position", 500))
    assert " cm from" in root


def test_edits_show_in_the_provenance_band_and_protected_spans_are_hatched(view, document):
    flag = flag_of(document, "RightLeg")
    offered = plot_scene.offer(document, flag.id)
    band = QPointF(view.plot.x_of(offered.start + 3), view.plot.area.bottom() - 3)
    empty = colour_at(view, band)
    document.accept([flag.id])
    QApplication.processEvents()
    assert colour_at(view, band) != empty
    document.mute_edit(document.state.sitting.edits[0].id, True)
    QApplication.processEvents()
    assert colour_at(view, band) == empty
    document.protect(["LeftShoulder"], 500, 600)
    QApplication.processEvents()
    picture = view.plot.grab().toImage()
    at = place(view, "LeftShoulder", 550).toPoint()
    line = [QColor(picture.pixel(at.x() + dx, at.y())) for dx in range(20)]
    assert any(close(one, QColor(themes.DARK.protected), 40) for one in line)
    assert "protected" in view.read_out(place(view, "LeftShoulder", 550))


def test_what_the_trim_leaves_out_is_dimmed(view, document):
    flag = flag_of(document, "RightLeg")
    at = place(view, "RightLeg", flag.peak_frame)
    before = colour_at(view, at)
    document.trim(600, 1100)
    QApplication.processEvents()
    assert colour_at(view, at).lightness() < before.lightness()


def test_names_that_do_not_fit_are_left_to_the_worst_flags_and_the_selection(qtbot, document):
    view = shown(qtbot, document, height=150)
    names = view.labels.shown_names()
    assert "Spine1" in names
    assert len(names) < len(view._rows.names)
    document.select(joints=["LeftToeBase"])
    assert "LeftToeBase" in view.labels.shown_names()
    view.resize(1440, 600)
    QApplication.processEvents()
    assert view.labels.shown_names() == view._rows.names


def test_joints_that_were_not_analysed_are_told(view, monkeypatch):
    told = []
    monkeypatch.setattr(row_labels.QToolTip, "showText", lambda _at, text, _of: told.append(text))
    foot = QPoint(120, view.labels.height() - 5)
    for names in ((), ("LeftThumb", "RightThumb")):
        view.labels.set_left_out(names)
        asked = QHelpEvent(QEvent.Type.ToolTip, foot, view.labels.mapToGlobal(foot))
        QApplication.sendEvent(view.labels, asked)
    assert told[0] == ""
    assert told[1] == "Not analysed: LeftThumb, RightThumb"
    before = view.labels.grab().toImage()
    view.labels.set_left_out(())
    assert view.labels.grab().toImage() != before


def test_moving_the_play_head_draws_no_cell_again(view, document, monkeypatch):
    drawn = []
    monkeypatch.setattr("mocapstudio.gui.plots.map_drawing.draw_cells", lambda *_: drawn.append(1))
    QApplication.processEvents()
    for frame in range(20, 200, 10):
        document.set_frame(frame)
        QApplication.processEvents()
    assert not drawn
    document.set_threshold(0.7)
    view.plot.grab()
    assert drawn


def test_an_equal_state_changes_nothing(view, document):
    pooled, rows = view._pooled, view._rows
    view.show_state(document.state, document.state)
    document.select(joints=["Head"])
    document.set_threshold(0.6)
    assert view._pooled is pooled
    assert view._rows is rows


def test_a_page_is_turned_when_the_play_head_leaves_it(view, document):
    view.time_range.show(0, 200)
    document.set_frame(201)
    assert view.time_range.start <= 201 <= view.time_range.end
    assert view.time_range.length == 200


def test_another_theme_repaints_it(view):
    at = quiet(view, 3)
    dark = colour_at(view, at)
    themes.apply(QApplication.instance(), themes.LIGHT)
    QApplication.processEvents()
    light = colour_at(view, at)
    themes.apply(QApplication.instance(), themes.DARK)
    assert light.lightness() > dark.lightness() + 100


def test_it_is_a_native_window_and_its_parents_are_not(qtbot, document):
    from PySide6.QtWidgets import QVBoxLayout, QWidget

    outer = QWidget()
    middle = QWidget()
    view = DigressionMapView(DocumentBridge(document))
    QVBoxLayout(outer).addWidget(middle)
    QVBoxLayout(middle).addWidget(view)
    qtbot.addWidget(outer)
    outer.show()
    qtbot.waitExposed(outer)
    assert view.internalWinId() != 0
    assert middle.internalWinId() == 0


def test_a_real_take_shows_its_real_flags(qtbot, data):
    take = formats.read(data / "cmu_salsa_pairs_bvh" / "60_10_scaled.bvh")[0][0]
    document = Document(author="tester")
    performer = document.open_take(take)
    analysis = run(detect(take))
    document.finish_analysis(performer, document.begin_analysis(performer), analysis)
    view = shown(qtbot, document, height=230)
    assert set(view._rows.names) == set(analysis.map.rows)
    hit = 0
    for item in document.state.queue:
        at = place(view, item.flag.joint, 0.5 * (item.flag.start + item.flag.end - 1))
        found = view.flag_at(at)
        assert found is not None
        assert found.flag.joint == item.flag.joint
        hit += found.flag.id == item.flag.id
    assert hit >= 0.9 * len(document.state.queue) > 0
    picture = view.plot.grab().toImage()
    area = view.plot.area.toRect()
    colours = {
        picture.pixel(x, y)
        for x in range(area.left(), area.right(), 3)
        for y in range(area.top(), area.bottom(), 2)
    }
    assert len(colours) > 40
    assert np.isfinite(analysis.map.values).all()
