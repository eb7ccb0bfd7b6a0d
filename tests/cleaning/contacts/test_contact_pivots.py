"""Feet that turn on the floor keep one point in contact."""

from __future__ import annotations

import numpy as np
import pytest

from mocapstudio.cleaning.contacts.model import Contact, Floor, Point
from mocapstudio.cleaning.contacts.pivots import Standing, held_at_pivots
from mocapstudio.motion import rotations as rot

FRAMES, FIRST, LAST = 150, 60, 90
ALONG: dict[Point, float] = {"heel": -0.15, "ball": 0.0, "toe": 0.06}


def swivel(degrees: float, rate: float = 120.0) -> list[Contact]:
    """Turn a foot about its ball between the frames FIRST and LAST, all of it on the floor."""
    share = np.clip((np.arange(FRAMES) - FIRST) / (LAST - FIRST), 0, 1)
    world = rot.about_axis(1, np.deg2rad(degrees) * share)[:, None]
    standing = [
        Standing(
            Contact(f"Foot-{name}-0", "Foot", name, 0, FRAMES, Floor(0.0)),
            rot.rotate(world[:, 0], np.array([0.0, 0.0, along])),
            0,
        )
        for name, along in ALONG.items()
    ]
    return held_at_pivots(standing, world, rate)


def of(contacts: list[Contact], name: str) -> list[tuple[int, int]]:
    return [(c.start, c.end) for c in contacts if c.point == name]


@pytest.mark.parametrize("degrees", [70.0, -110.0])
def test_only_the_pivot_stays_while_a_foot_turns(degrees: float) -> None:
    found = swivel(degrees)
    assert of(found, "ball") == [(0, FRAMES)]
    for name in ("heel", "toe"):
        (_, before), (after, _) = of(found, name)
        assert abs(before - FIRST) <= 8
        assert abs(after - LAST) <= 8
    assert len({c.id for c in found}) == len(found) == 5


@pytest.mark.parametrize("degrees", [0.0, 30.0])
def test_a_foot_that_hardly_turns_keeps_all(degrees: float) -> None:
    assert all(of(swivel(degrees), name) == [(0, FRAMES)] for name in ALONG)


def test_the_same_at_a_low_rate() -> None:
    found = swivel(90.0, rate=30.0)
    assert of(found, "ball") == [(0, FRAMES)]
    assert len(of(found, "heel")) == len(of(found, "toe")) == 2
