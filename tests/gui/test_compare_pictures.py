"""The pictures of a comparison in a real window: linked heads, zoom, segments, colours."""

from __future__ import annotations

import numpy as np
import pytest
from made_comparison import LIMBS, ROWS, comparison, shortened
from made_takes import walking
from mouse import click, drag, wheel
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor

from mocapstudio.gui import theme
from mocapstudio.gui.compare import colours as kinds
from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.compare.layout import frames_wide, reference_stretch, timing_lines
from mocapstudio.gui.compare.naming import short_names
from mocapstudio.gui.compare.pictures import PicturesView
from mocapstudio.gui.compare.pooling import PooledPoses, columns, contrast

REFERENCE, SOURCE = 300, 240


def slow_then_quick(n: np.ndarray) -> np.ndarray:
    """The pupil is slow for the first half and makes up for it in the second."""
    half = SOURCE / 2
    slow = 0.6 * n
    return np.where(n < half, slow, 0.6 * half + (n - half) * (299 - 0.6 * half) / (SOURCE - half))


@pytest.fixture(scope="module")
def walk():
    return walking(seconds=3.2, rate=100)


@pytest.fixture
def view(qtbot, walk):
    """Pictures of a pupil who is late, then hurries."""
    bridge = CompareBridge()
    bridge.sitting.set_reference(shortened(walk, REFERENCE, "teacher"))
    bridge.sitting.add_sources([shortened(walk, SOURCE, "pupil")])
    made = PicturesView(bridge)
    qtbot.addWidget(made)
    made.resize(1200, 420)
    with qtbot.waitExposed(made):
        made.show()
    both = comparison((REFERENCE, SOURCE), warp=slow_then_quick)
    bridge.sitting.finish(bridge.sitting.pending()[0], both)
    made.bridge = bridge
    qtbot.waitUntil(lambda: made.heat.rows.names == ROWS)
    return made


def at(plot, frame: float, y: float | None = None) -> QPointF:
    return QPointF(plot.x_of(frame), plot.area.center().y() if y is None else y)


def test_a_click_in_any_picture_moves_both_heads(view):
    for plot, frame in ((view.difference, 60), (view.misalignment, 180)):
        click(plot.viewport(), at(plot, frame))
        state = view.bridge.state
        assert state.source_frame == frame
        assert state.frame == pytest.approx(slow_then_quick(np.array(frame)), abs=1)
    heat = view.heat
    click(heat.viewport(), at(heat, 100, heat.bands.source.center().y()))
    assert view.bridge.state.source_frame == 100
    x = heat.reference_scale.x(250)
    click(heat.viewport(), QPointF(x, heat.bands.reference.center().y()))
    assert view.bridge.state.frame == 250
    assert slow_then_quick(np.array(view.bridge.state.source_frame)) == pytest.approx(250, abs=2)


def test_the_wheel_zooms_all_pictures_and_the_sitting_knows(view):
    place = at(view.difference, 90)
    wheel(view.difference.viewport(), place, 8)
    start, end = view.bridge.state.shown
    assert end - start < 0.4 * SOURCE
    assert view.difference.x_of(90) == pytest.approx(place.x(), abs=1.0)
    assert view.heat.time_range is view.misalignment.time_range
    view.bridge.sitting.show(-0.5, SOURCE - 0.5)
    assert view.time_range.is_whole


def test_seen_from_near_matched_frames_lie_below_each_other(view):
    both = view.bridge.state.comparison
    whole = reference_stretch(both, -0.5, SOURCE - 0.5, False)
    assert (whole.start, whole.end) == pytest.approx((-0.5, REFERENCE - 0.5))
    for middle in (40, 120, 200):
        near = reference_stretch(both, middle - 3, middle + 3, False)
        centre = 0.5 * (near.start + near.end)
        assert centre == pytest.approx(both.warp[middle], abs=2.5)


def test_at_true_speed_a_second_is_as_wide_in_both():
    both = comparison((300, 240), rates=(100, 50))
    stretch = reference_stretch(both, -0.5, 239.5, True)
    assert stretch.length / 100 == pytest.approx(240 / 50)
    assert frames_wide(both, True) == 240
    assert frames_wide(comparison((300, 240)), True) == 300
    assert frames_wide(comparison((300, 240)), False) == 240


def test_lines_grow_denser_to_every_step_of_the_path(view):
    both = view.bridge.state.comparison
    far = timing_lines(both, -0.5, SOURCE - 0.5, 300.0)
    near = timing_lines(both, 100.0, 120.0, 300.0)
    assert np.diff(far[:, 0]).min() * 300 / SOURCE >= 9.0
    inside = (both.path[:, 1] >= 100) & (both.path[:, 1] <= 120)
    drawn = {tuple(pair) for pair in near}
    assert {(s, r) for r, s in both.path[inside]} <= drawn


def test_late_and_early_are_coloured_so(view, qtbot):
    qtbot.wait(50)
    picture = view.difference.grab().toImage()
    area = view.difference.area

    def has(frame_from: int, frame_to: int, kind: int) -> bool:
        wanted = kinds.timing(theme.current(), kind)
        for x in range(int(view.difference.x_of(frame_from)), int(view.difference.x_of(frame_to))):
            for y in range(int(area.top()), int(area.bottom())):
                if QColor(picture.pixel(x, y)) == wanted:
                    return True
        return False

    assert has(10, 100, -1)
    assert not has(10, 100, 1)
    assert has(140, 230, 1)
    assert not has(140, 230, -1)


def test_a_drag_in_the_lane_names_a_part_and_its_edge_can_be_moved(view):
    heat = view.heat
    lane = heat.bands.lane.center().y()
    here = lambda frame: QPointF(heat.reference_scale.x(frame), lane)  # noqa: E731
    drag(heat.viewport(), here(50), here(120))
    (segment,) = view.bridge.state.segments
    assert (segment.start, segment.end) == (50, 121)
    assert view.bridge.state.segment == 0
    drag(heat.viewport(), here(120.5), here(160))
    (segment,) = view.bridge.state.segments
    assert segment.start == 50
    assert segment.end == pytest.approx(160, abs=1)
    view.bridge.sitting.undo()
    assert view.bridge.state.segments[0].end == 121
    click(heat.viewport(), here(200))
    assert view.bridge.state.segment is None
    click(heat.viewport(), here(80))
    assert view.bridge.state.segment == 0
    assert view.bridge.state.frame == 50


def test_a_click_on_a_name_selects_its_row_in_both_bands(view, qtbot):
    labels = view._margin._source
    middle = 0.5 * (labels._rows.tops[4] + labels._rows.tops[4] + labels._rows.row_height)
    click(labels, QPointF(labels.width() - 20, middle))
    assert view.bridge.state.row == "LeftHand"
    click(labels, QPointF(labels.width() - 20, middle))
    assert view.bridge.state.row is None


def test_double_click_zooms_to_the_segment(view):
    view.bridge.sitting.add_segment(100, 160, "turn")
    view.zoom_to_segment()
    start, end = view.bridge.state.shown
    answer = view.bridge.state.linked.carried(view.bridge.state.segments)[0].source
    assert start < answer.start < answer.end < end + 1
    assert end - start < 2 * (answer.end - answer.start)


def test_what_lies_under_the_mouse_is_said_with_units(view):
    heat = view.heat
    text = view.read_out(heat, at(heat, 100, heat.bands.source.top() + 1))
    assert text.startswith("Hips")
    assert "source 1.00 s" in text
    assert "delayed" in text


def test_another_theme_recolours_the_pictures(view, qapp, qtbot):
    def ground():
        qtbot.wait(30)
        bands = view.heat.bands
        x, y = int(bands.lane.right()) - 8, int(bands.lane.center().y())
        return QColor(view.heat.grab().toImage().pixel(x, y)).lightness()

    dark = ground()
    theme.apply(qapp, theme.LIGHT)
    view.restyle()
    light = ground()
    theme.apply(qapp, theme.DARK)
    view.restyle()
    assert light > 200 > dark


def test_colours_of_poses_are_means_of_blocks_and_gaps_stay_empty():
    poses = np.random.default_rng(0).random((50, len(ROWS), 3)).astype(np.float32)
    poses[10:20, 2] = np.nan
    low, high = np.zeros(3, np.float32), np.ones(3, np.float32)
    pooled = PooledPoses(poses, low, high)
    blocks = pooled.blocks(10)
    assert blocks.shape == (len(ROWS), 5)
    red = blocks[1, 3] >> 16 & 255
    assert red == pytest.approx(255 * poses[30:40, 1, 0].mean(), abs=1)
    assert blocks[2, 1] == 0
    assert blocks[2, 0] >> 24 == 255
    np.testing.assert_array_equal(pooled.blocks(1).shape, (len(ROWS), 50))


def test_both_performances_share_one_scale_of_colours():
    both = comparison((REFERENCE, SOURCE), offset=0.2)
    low, high = contrast(both.reference_poses, both.source_poses)
    merged = np.concatenate([both.reference_poses.reshape(-1, 3), both.source_poses.reshape(-1, 3)])
    np.testing.assert_allclose(low, np.percentile(merged, 1, axis=0), atol=0.02)
    np.testing.assert_allclose(high, np.percentile(merged, 99, axis=0), atol=0.02)


def test_columns_keep_extremes_and_the_commonest_timing():
    values = np.arange(100, dtype=float)
    timing = np.zeros(100, np.int8)
    timing[20:30] = 1
    timing[40:43] = -1
    pooled = columns(values, timing, -0.5, 99.5, 10)
    np.testing.assert_array_equal(pooled.first, np.arange(0, 100, 10))
    np.testing.assert_array_equal(pooled.low, np.arange(0, 100, 10))
    np.testing.assert_array_equal(pooled.high, np.arange(9, 100, 10))
    np.testing.assert_array_equal(pooled.timing, [0, 0, 1, 0, 0, 0, 0, 0, 0, 0])


def test_rows_stand_by_limb_in_the_order_of_the_body(view):
    assert [group.name for group in view.heat.rows.groups] == list(dict.fromkeys(LIMBS))
    assert view.heat.rows.names == ROWS


@pytest.mark.parametrize(
    ("names", "short"),
    [
        (["dataset-1_bow_angry_001", "dataset-1_bow_old_001"], ["angry", "old"]),
        (["pupil 1", "pupil 2"], ["pupil 1", "pupil 2"]),
        (["alone"], ["alone"]),
        (["kata", "kata 2"], ["kata", "kata 2"]),
        (["a_b", "a_b_c"], None),
    ],
)
def test_names_leave_out_what_all_share(names, short):
    found = short_names(names)
    assert list(found) == names
    assert len(set(found.values())) == len(names)
    if short is not None:
        assert list(found.values()) == short


def test_the_hint_says_what_is_waited_for(qtbot, walk):
    bridge = CompareBridge()
    bridge.sitting.set_reference(shortened(walk, REFERENCE, "teacher"))
    bridge.sitting.add_sources([shortened(walk, SOURCE, "pupil")])
    view = PicturesView(bridge)
    qtbot.addWidget(view)
    view.show()
    assert view._hint.text() == "Comparing pupil…"
    bridge.sitting.fail(bridge.sitting.pending()[0], "another skeleton")
    assert "another skeleton" in view._hint.text()
    assert Qt.AlignmentFlag.AlignCenter & view._hint.alignment()
