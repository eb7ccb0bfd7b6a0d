"""The score of the demo take: what follows what."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mocapstudio.evaluation.demo.poses import (
    ACROSS,
    FLOOR_BOX,
    REACH_SECONDS,
    SHELF,
    TABLE,
    Reach,
)
from mocapstudio.evaluation.demo.route import Stand, Walk


@dataclass(frozen=True)
class Item:
    """A walk or a pause, and what the hands do in the pause."""

    what: Walk | Stand
    reaches: tuple[Reach, ...] = ()


_SETTLE = 0.7


def _reach(*which: Reach) -> Item:
    return Item(Stand(2 * _SETTLE + REACH_SECONDS * len(which)), which)


SCORE: Sequence[Item] = (
    Item(Stand(2.0)),
    Item(Walk(8.0, turns=((2.5, 2.0, 90.0), (5.0, 2.0, 90.0)))),
    _reach(SHELF, SHELF, TABLE),
    Item(Walk(6.5, turns=((2.5, 2.0, 180.0),))),
    _reach(FLOOR_BOX, FLOOR_BOX),
    Item(Walk(2.0, turns=((0.1, 1.8, -180.0),), pace=0.15)),
    Item(Walk(7.0, turns=((2.0, 2.0, -90.0), (4.0, 2.0, -90.0)))),
    _reach(TABLE, ACROSS, TABLE, ACROSS),
    Item(Walk(9.0, turns=((1.5, 2.0, 90.0), (5.5, 2.5, -150.0)))),
    _reach(SHELF, FLOOR_BOX, SHELF, FLOOR_BOX),
    Item(Walk(8.0, turns=((2.5, 2.0, 90.0), (5.0, 2.0, 90.0)))),
    _reach(ACROSS, TABLE),
    Item(Walk(6.5, turns=((2.5, 2.0, 180.0),))),
    Item(Stand(2.0)),
)


def reaches(pauses: Sequence[tuple[float, float]]) -> tuple[tuple[float, Reach], ...]:
    """When each reach begins, in seconds, given the pauses as they were laid out."""
    standing = [item for item in SCORE if isinstance(item.what, Stand)]
    return tuple(
        (begin + _SETTLE + i * REACH_SECONDS, reach)
        for item, (begin, _) in zip(standing, pauses, strict=True)
        for i, reach in enumerate(item.reaches)
    )
