"""Pieces of the Markers workspace that need no window."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from mocapstudio.gui.markers.lane_drawing import Cell, cells, pooled, side_groups
from mocapstudio.gui.markers.nearness import nearest_markers
from mocapstudio.motion.markers import MarkerTake


def test_cells_tell_what_is_measured_filled_and_missing() -> None:
    places = np.zeros((3, 2, 3))
    places[1, 0] = np.nan
    filled = np.array([[False, True], [True, False], [False, False]])
    take = MarkerTake("m", ("a", "b"), places, Fraction(30), filled=filled)
    assert cells(take).tolist() == [
        [Cell.MEASURED, Cell.FILLED],
        [Cell.MISSING, Cell.MEASURED],
        [Cell.MEASURED, Cell.MEASURED],
    ]


@given(st.integers(1, 400), st.integers(1, 90), st.integers(0, 9), st.data())
def test_a_pixel_shows_the_worst_of_its_frames(frames, pixels, seed, data) -> None:
    found = np.random.default_rng(seed).integers(0, 3, (frames, 2)).astype(np.uint8)
    start = data.draw(st.floats(-0.5, frames - 1.5 if frames > 1 else -0.5))
    length = data.draw(st.floats(0.9, frames))
    length = min(length, frames - 0.5 - start)
    if length <= 0:
        return
    shown = pooled(found, start, length, pixels)
    assert shown.shape == (pixels, 2)
    for pixel in range(pixels):
        edges = start + 0.5 + np.array([pixel, pixel + 1]) * length / pixels
        first = min(int(np.floor(edges[0])), frames - 1)
        # Frames that begin right at the edge may fall to either side of it.
        least = found[first : max(int(np.floor(edges[1] - 1e-9)), first + 1)].max(axis=0)
        most = found[max(first - 1, 0) : int(np.floor(edges[1])) + 2].max(axis=0)
        assert (shown[pixel] >= np.minimum(least, most)).all()
        assert (shown[pixel] <= most).all()


def test_markers_are_sorted_by_the_side_that_their_labels_name() -> None:
    groups = side_groups(("LFHD", "C7", "RFHD", "LTOE"))
    assert [(one.name, one.rows) for one in groups] == [
        ("left", ("LFHD", "LTOE")),
        ("right", ("RFHD",)),
        ("middle", ("C7",)),
    ]
    plain = ("Foot_Marker1", "Knee_Marker2")
    assert [one.rows for one in side_groups(plain)] == [plain]


def test_the_nearest_markers_come_first_also_from_where_one_was_seen_last() -> None:
    places = np.zeros((4, 3, 3))
    places[:, 1, 0], places[:, 2, 0] = 0.5, 0.2
    places[3, 0] = places[3, 1] = np.nan
    take = MarkerTake("m", ("a", "b", "c"), places, Fraction(30))
    assert nearest_markers(take, "a", 0) == [("c", "20.0 cm"), ("b", "50.0 cm")]
    assert nearest_markers(take, "a", 3) == [("c", "20.0 cm"), ("b", "missing here")]
