"""The course of a live action, kept in bounded memory."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from mocapstudio.comparison.live_history import LiveHistory
from mocapstudio.comparison.online import AlignmentStep

REFERENCE = 37


def step(frame: int, at: int) -> AlignmentStep:
    return AlignmentStep(frame, at, at, 0.1 + 0.01 * frame, 0.2, 0.5 - 0.01 * frame, None, True)


def pooled(distances: np.ndarray, block: int) -> np.ndarray:
    return np.array([distances[i : i + block].mean() for i in range(0, len(distances), block)])


@settings(max_examples=25, deadline=None)
@given(
    skips=st.lists(st.integers(0, 3), min_size=1, max_size=70),
    columns=st.sampled_from([4, 16, 128]),
    rows=st.sampled_from([5, 64]),
)
def test_columns_are_means_of_their_frames_however_long_it_gets(skips, columns, rows):
    rng = np.random.default_rng(len(skips))
    history = LiveHistory(REFERENCE, columns, rows)
    raw, frame = [], -1
    for skipped in skips:
        frame += 1 + skipped
        distances = rng.random(REFERENCE).astype(np.float32)
        history.add(step(frame, frame % REFERENCE), distances)
        # Frames that were passed over take the column of the one after them.
        raw += [(frame, pooled(distances, history.block))] * (1 + skipped)
    assert history.frames == frame + 1 == len(raw)
    assert history.columns <= columns
    assert history.columns == -(-len(raw) // history.stride)
    assert history.distances.shape[1] <= max(rows, 1)
    for column in range(history.columns):
        within = raw[column * history.stride : (column + 1) * history.stride]
        wanted = np.mean([one for _, one in within], axis=0)
        np.testing.assert_allclose(history.distances[column], wanted, atol=1e-5)
        last = within[-1][0]
        assert history.course.at[column] == last % REFERENCE
        assert history.course.cost[column] == 0.1 + 0.01 * last


def test_a_frame_that_is_repeated_changes_nothing_and_a_new_action_begins_empty():
    history = LiveHistory(REFERENCE)
    near, far = np.zeros(REFERENCE, np.float32), np.ones(REFERENCE, np.float32)
    history.add(step(0, 0), near)
    history.add(step(0, 5), far)
    assert history.frames == 1
    assert not history.distances.any()
    history.clear()
    assert history.columns == 0
    history.add(step(0, 3), far)
    assert history.course.at.tolist() == [3]
    np.testing.assert_allclose(history.distances, 1.0)
