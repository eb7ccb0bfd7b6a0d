"""What clean and export tell of changes: every changed joint and span, once."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from mocapstudio.cleaning.model import Neighbour
from mocapstudio.cli.changes import as_json
from mocapstudio.review.model import Edit

DONOR = Neighbour("other", 3, 9, 1.0, 1)


def edit(
    rows: tuple[str, ...], start: int, length: int, method: str, donor: bool, muted: bool
) -> Edit:
    samples = np.zeros((length, len(rows), 4))
    return Edit(
        "e", "p", rows, rows, start, start + length, samples, None, method,
        DONOR if donor else None, None, "g", "somebody", "2026-01-01T00:00:00+00:00", muted,
    )  # fmt: skip


EDITS = st.lists(
    st.builds(
        edit,
        st.lists(st.sampled_from(["Hips", "Head"]), min_size=1, unique=True).map(tuple),
        st.integers(0, 12),
        st.integers(1, 8),
        st.sampled_from(["prediction", "swap"]),
        st.booleans(),
        st.booleans(),
    ),
    max_size=6,
)


def cells(changes: list[dict]) -> set[tuple]:
    return {
        (one["joint"], one["method"], one["donor"] is None, frame)
        for one in changes
        for frame in range(one["start"], one["end"])
    }


@settings(max_examples=60, deadline=None)
@given(EDITS)
def test_everything_is_told_and_nothing_twice(edits: list[Edit]) -> None:
    told = as_json(Path("a"), Path("b"), edits)["changes"]
    wanted = {
        (row, one.method, one.donor is None, frame)
        for one in edits
        if not one.muted
        for row in one.rows
        for frame in range(one.start, one.end)
    }
    assert cells(told) == wanted
    for one in told:
        wider = [
            other
            for other in told
            if other is not one and other["start"] <= one["start"] and other["end"] >= one["end"]
        ]
        assert not cells([one]) <= cells(wider)
