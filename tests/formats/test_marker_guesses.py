"""Guesses about markers, on bodies whose unit and axes are known."""

from __future__ import annotations

import numpy as np
import pytest
from marker_text import LABELS, places

from mocapstudio.formats.guesses import turn_to_inside
from mocapstudio.formats.marker_guesses import guess_marker_unit, guess_marker_up
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import ParameterError

BODY = places() / 1000


@pytest.mark.parametrize("unit", [1.0, 0.01, 0.001])
def test_the_unit_comes_from_the_size_of_the_body(unit: float) -> None:
    seen = BODY / unit
    seen[:3] = np.nan
    assert guess_marker_unit(seen)[0] == unit


@pytest.mark.parametrize("turned", [0, 1, 2])
def test_up_is_where_the_head_is(turned: int) -> None:
    up, why = guess_marker_up(np.roll(BODY, turned, axis=2), LABELS)
    assert up == "yzx"[turned]
    assert "head is above" in why
    assert guess_marker_up(np.roll(BODY, turned, axis=2), ("a", "b", "c", "d"), "z")[0] == "z"


def test_lying_tells_nothing() -> None:
    lying = BODY.copy()
    lying[..., 1] = 0.1
    lying[..., 0] = -np.linspace(0, 1.6, 4)
    assert "head is above" not in guess_marker_up(-lying, LABELS)[1]


@pytest.mark.parametrize("up", ["x", "y", "z"])
@pytest.mark.parametrize("forward", ["x", "-x", "y", "-y", "z", "-z"])
def test_up_and_forward_become_y_and_z(up, forward) -> None:
    axis = dict(zip("xyz", np.eye(3), strict=True))
    if forward[-1] == up:
        with pytest.raises(ParameterError, match="along the up axis"):
            turn_to_inside(up, forward)
        return
    turn = turn_to_inside(up, forward)
    ahead = axis[forward[-1]] * (-1 if "-" in forward else 1)
    np.testing.assert_allclose(rot.rotate(turn, axis[up]), [0, 1, 0], atol=1e-12)
    np.testing.assert_allclose(rot.rotate(turn, ahead), [0, 0, 1], atol=1e-12)
