"""Which markers are missing where."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from mocapstudio.motion.markers import MarkerTake
from mocapstudio.review.marker_gaps import take_gaps

_cells = arrays.arrays(np.uint8, (12, 3), elements=st.integers(0, 2))


def take_of(cells: np.ndarray) -> MarkerTake:
    """A take of cells: 0 measured, 1 filled, 2 missing."""
    places = np.ones((*cells.shape, 3))
    places[cells == 2] = np.nan
    return MarkerTake("m", ("a", "b", "c"), places, Fraction(30), filled=cells == 1)


@given(_cells)
def test_every_frame_is_told_once(cells: np.ndarray) -> None:
    gaps = take_gaps(take_of(cells))
    for at, label in enumerate("abc"):
        one = gaps.by_label[label]
        for kind, spans in ((2, one.gaps), (1, one.filled)):
            told = [frame for start, end in spans for frame in range(start, end)]
            assert told == list(np.flatnonzero(cells[:, at] == kind))
        assert one.missing == (cells[:, at] == 2).sum()
        assert one.never_seen == (cells[:, at] == 2).all()
        for frame, cell in enumerate(cells[:, at]):
            span = gaps.span_at(label, frame)
            assert (span is not None) == (cell > 0)
            assert span is None or span[0] <= frame < span[1]


@given(_cells, st.integers(1, 12))
def test_worst_come_first_and_what_is_never_seen_last(cells: np.ndarray, longest: int) -> None:
    gaps = take_gaps(take_of(cells))
    missing = [one.missing for one in gaps.markers if not one.never_seen]
    assert missing == sorted(missing, reverse=True)
    never = [one.never_seen for one in gaps.markers]
    assert never == sorted(never)
    assert list(gaps.in_time) == sorted(gaps.in_time)
    short = gaps.up_to(longest)
    assert set(short) == {one for one in gaps.in_time if one.end - one.start <= longest}
    assert (0 < gaps.shortest <= longest) == bool(short)


def test_the_first_gap_within_a_span() -> None:
    cells = np.zeros((12, 3), np.uint8)
    cells[2:4, 0] = 2
    cells[6:9, 0] = 1
    gaps = take_gaps(take_of(cells))
    assert gaps.first_within("a", 0, 12) == (2, 4)
    assert gaps.first_within("a", 4, 7) == (6, 9)
    assert gaps.first_within("a", 4, 6) is None
    assert gaps.first_within("b", 0, 12) is None
