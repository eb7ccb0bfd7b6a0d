"""A whole take aligned online: what the matrix of it shows."""

from __future__ import annotations

import numpy as np
import pytest
from made_takes import paced
from test_kata import as_markers, dance

from mocapstudio.comparison.online_path import following
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.progress import run


def test_path_and_answers_follow_a_known_warp() -> None:
    take = dance(6.0, 60)
    pace = 1.0 + 0.4 * np.sin(np.arange(2 * take.frames) / 30.0)
    source = paced(take, pace)
    found = run(following(take, source))
    assert found.frames == (take.frames, source.frames)
    assert found.distances.shape == found.accumulated.shape
    truth = np.cumsum(np.append(0.0, pace))
    for pairs, most in ((found.path, 4.0), (found.answers[20:], 8.0)):
        error = np.abs(pairs[:, 0] - truth[pairs[:, 1]])
        assert np.median(error) < most
    # The cheapest path ends where the last row of the costs is smallest.
    last = found.accumulated[:, -1]
    row = round((found.path[-1, 0] - found.reference_at[0]) / found.reference_at[1])
    assert row == int(np.argmin(last))
    assert (np.diff(found.path, axis=0) >= 0).all()


def test_what_cannot_be_followed_says_why() -> None:
    take = dance(2.0)
    with pytest.raises(MocapError, match="markers"):
        run(following(take, as_markers(take)))
