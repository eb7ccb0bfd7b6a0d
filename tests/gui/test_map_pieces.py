"""Pooling, rows, ticks and the shared time range."""

from __future__ import annotations

import numpy as np
import plot_scene
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocapstudio.gui import theme as themes
from mocapstudio.gui.plots.colours import lookup_table
from mocapstudio.gui.plots.pooling import PooledMap, block_length
from mocapstudio.gui.plots.rows import RowLayout, limb_groups
from mocapstudio.gui.plots.ticks import clock, time_ticks, value_ticks
from mocapstudio.gui.plots.time_range import SHORTEST, TimeRange
from mocapstudio.motion.facing import ROOT_ROWS


@given(st.integers(1, 400), st.integers(1, 60), st.data())
def test_an_error_of_one_frame_survives_every_zoom(frames, step, data):
    at = data.draw(st.integers(0, frames - 1))
    values = np.zeros((frames, 3), dtype=np.float32)
    values[at, 1] = 1.0
    blocks = PooledMap(values, np.array([2, 1, 0])).blocks(step)
    assert blocks.shape == (3, -(-frames // step))
    assert blocks[1, at // step] == 255
    assert blocks.astype(int).sum() == 255


def test_rows_are_drawn_in_the_order_asked_for_and_gaps_in_the_values_count_as_quiet():
    values = np.array([[0.0, 0.5, np.nan], [1.0, 2.0, -1.0]], dtype=np.float32)
    blocks = PooledMap(values, np.array([2, 0, 1])).blocks(1)
    assert blocks.tolist() == [[0, 0], [0, 255], [128, 255]]


@given(st.floats(0.001, 500))
def test_a_block_is_at_least_one_pixel_wide_and_less_than_a_frame_wider(frames_per_pixel):
    length = block_length(frames_per_pixel)
    assert length >= frames_per_pixel - 1e-6
    assert length == 1 or length - 1 < frames_per_pixel


def test_limbs_come_in_the_order_of_the_body_and_the_root_last():
    bones = plot_scene.skeleton()
    groups = limb_groups(bones, (*reversed(bones.names), *ROOT_ROWS))
    assert [group.name for group in groups] == [
        "spine",
        "head",
        "left arm",
        "right arm",
        "left leg",
        "right leg",
        "root",
    ]
    assert groups[2].rows == ("LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand")
    assert sorted(name for group in groups for name in group.rows) == sorted(
        (*bones.names, *ROOT_ROWS)
    )


def test_a_row_that_is_no_joint_is_still_drawn():
    groups = limb_groups(plot_scene.skeleton(), ("Head", "stick"))
    assert [(group.name, group.rows) for group in groups] == [
        ("head", ("Head",)),
        ("other", ("stick",)),
    ]


@pytest.mark.parametrize("height", [30, 90, 180, 400, 2000])
def test_rows_never_overlap_and_each_is_found_in_its_middle(height):
    bones = plot_scene.skeleton()
    layout = RowLayout(limb_groups(bones, (*bones.names, *ROOT_ROWS)), height)
    assert (np.diff(layout.tops) >= layout.row_height).all()
    for name, top in zip(layout.names, layout.tops, strict=True):
        assert layout.row_at(top + 0.5 * layout.row_height) == name
    assert layout.row_at(-1) is None
    assert layout.row_at(layout.bottom) is None
    if height >= 90:
        assert layout.bottom <= height


def test_rows_between_two_heights_and_their_blocks():
    layout = RowLayout(limb_groups(plot_scene.skeleton(), plot_scene.skeleton().names), 400)
    arm = layout.groups[2]
    top, bottom = layout.extent(arm)
    assert layout.rows_between(bottom - 1, top + 1) == arm.rows
    assert layout.runs(frozenset(arm.rows)) == [(top, bottom)]
    assert len(layout.runs(frozenset(layout.names))) == len(layout.groups)


def test_ticks_stand_at_round_seconds_and_are_not_too_many():
    ticks = time_ticks(-0.5, 2399.5, 120.0, 9)
    labelled = [(tick.frame, tick.label) for tick in ticks if tick.label]
    assert labelled == [(0.0, "0 s"), (600.0, "5 s"), (1200.0, "10 s"), (1800.0, "15 s")]
    assert all(-0.5 <= tick.frame <= 2399.5 for tick in ticks)


@given(st.floats(0, 1e5), st.floats(1, 1e5), st.sampled_from([24.0, 30.0, 119.88, 120.0]))
def test_ticks_keep_to_the_room_there_is(start, length, rate):
    ticks = time_ticks(start, start + length, rate, 8)
    assert sum(bool(tick.label) for tick in ticks) <= 9


@pytest.mark.parametrize(
    ("seconds", "step", "text"),
    [(0, 1, "0 s"), (12.5, 0.5, "12.5 s"), (72, 1, "1:12"), (72.25, 0.05, "1:12.25")],
)
def test_the_clock(seconds, step, text):
    assert clock(seconds, step) == text


def test_values_are_round_and_within():
    assert value_ticks(-6.2, 6.1, 4) == [(-5.0, "−5"), (0.0, "0"), (5.0, "5")]
    assert [label for _, label in value_ticks(0.94, 1.01, 4)] == ["0.94", "0.96", "0.98", "1.00"]
    assert value_ticks(1.0, 1.0, 4) == []


@pytest.mark.parametrize("theme", [themes.DARK, themes.LIGHT], ids=lambda theme: theme.name)
@pytest.mark.parametrize("threshold", [0.02, 0.3, 0.5, 0.95])
def test_the_threshold_is_a_step_in_lightness_and_the_rest_goes_one_way(theme, threshold):
    table = lookup_table(theme, threshold)
    red, green, blue = (table >> 16) & 255, (table >> 8) & 255, table & 255
    light = 0.2126 * red + 0.7152 * green + 0.0722 * blue
    if theme is themes.LIGHT:
        light = -light
    steps = np.diff(light)
    assert steps.min() > -3.0
    at = int(np.ceil(threshold * 255)) - 1
    assert steps[at - 1 : at + 2].max() > 20
    assert steps[at - 1 : at + 2].max() == steps.max()


def test_the_range_keeps_to_the_take_and_tells_only_of_changes(qtbot):
    shown = TimeRange()
    told = []
    shown.changed.connect(lambda: told.append((shown.start, shown.end)))
    shown.set_frames(1000)
    shown.set_frames(1000)
    assert told == [(-0.5, 999.5)]
    shown.zoom(0.5, 250.0)
    assert shown.length == 500
    assert (250.0 - shown.start) / shown.length == pytest.approx(250.5 / 1000)
    shown.pan(-10_000)
    assert (shown.start, shown.end) == (-0.5, 499.5)
    shown.zoom(1e-9, 100.0)
    assert shown.length == SHORTEST
    shown.whole()
    assert shown.is_whole
    before = len(told)
    shown.whole()
    shown.reveal(3)
    assert len(told) == before


def test_a_frame_out_of_sight_turns_the_page(qtbot):
    shown = TimeRange()
    shown.set_frames(1000)
    shown.show(0, 100)
    shown.reveal(50)
    assert (shown.start, shown.end) == (0, 100)
    shown.reveal(101)
    assert shown.start < 101 < shown.end
    assert shown.length == 100
    shown.focus(400, 401)
    assert shown.start < 399.5
    assert shown.end > 400.5
