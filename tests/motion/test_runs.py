"""Runs of frames."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from mocapstudio.motion.runs import runs


@given(st.lists(st.booleans(), max_size=30))
def test_runs_are_what_is_true_and_do_not_touch(mask: list[bool]) -> None:
    found = runs(np.array(mask, dtype=bool))
    inside = [frame for start, end in found for frame in range(start, end)]
    assert inside == [frame for frame, true in enumerate(mask) if true]
    assert all(start < end for start, end in found)
    assert all(end < start for (_, end), (start, _) in pairwise(found))
