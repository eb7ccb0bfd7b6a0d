"""Which samples of a take a named row stands for, and spans of rows."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal, NamedTuple

from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION, ROOT_ROWS, carrier
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology


class Samples(NamedTuple):
    """One channel of a take: local rotations of a joint, or translations of a translated one.

    `at` is the joint's index for ``"rotation"``, the position in `Take.translated` for
    ``"translation"``.
    """

    kind: Literal["rotation", "translation"]
    at: int


def rows_of(take: Take) -> tuple[str, ...]:
    """All rows of a take: its joints, then the two root rows."""
    return (*take.skeleton.names, *ROOT_ROWS)


def samples_of(take: Take, row: str) -> frozenset[Samples]:
    """Tell which samples a row stands for, as `formats` does when it writes declared changes.

    ``root position`` is the translation of the joint that carries the body, ``root heading`` the
    rotations of the hips and the joints above them; any other row is the rotation of that joint,
    and its own translation where it has one and does not carry the body.

    Raises
    ------
    MocapError
        If the take has no such row.
    """
    body = carrier(take)
    if row == ROOT_POSITION:
        return frozenset({Samples("translation", body)})
    if row == ROOT_HEADING:
        parts = topology(take.skeleton)
        return frozenset(Samples("rotation", j) for j in (parts.hips, *parts.above_hips))
    joint = take.skeleton.index.get(row)
    if joint is None:
        raise MocapError(f"{take.name} has no joint named {row}")
    own = {Samples("translation", t) for t, j in enumerate(take.translated) if j == joint}
    return frozenset({Samples("rotation", joint)} | own - {Samples("translation", body)})


def check_rows(take: Take, rows: Iterable[str]) -> None:
    """Raise MocapError for the first row that the take does not have."""
    for row in rows:
        samples_of(take, row)


def check_span(take: Take | MarkerTake, start: int, end: int) -> None:
    """Raise MocapError where [start, end) is empty or leaves the take."""
    if not 0 <= start < end <= take.frames:
        raise MocapError(
            f"frames {start} to {end} are no span of {take.name}, which has {take.frames} frames"
        )


def union(spans: Iterable[Declared]) -> tuple[Declared, ...]:
    """Join touching and overlapping spans of each row; ordered by row, then start."""
    joined: list[Declared] = []
    for one in sorted(spans, key=lambda d: (d.row, d.start, d.end)):
        last = joined[-1] if joined else None
        if last is not None and last.row == one.row and one.start <= last.end:
            joined[-1] = Declared(one.row, last.start, max(last.end, one.end))
        else:
            joined.append(one)
    return tuple(joined)
