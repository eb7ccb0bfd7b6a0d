"""Who is on stage in which viewport, where they stand, and how they are coloured. No Qt."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum, auto

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison.model import Comparison
from mocapstudio.gui.compare import placing
from mocapstudio.gui.compare.bridge import Alignment, CompareUi
from mocapstudio.gui.compare.guest import Guest
from mocapstudio.gui.compare.placing import Placing
from mocapstudio.gui.stage.actors import Actor, actor_of
from mocapstudio.gui.viewport.figure import Figure
from mocapstudio.gui.viewport.palette import Colour
from mocapstudio.gui.viewport.solids import COARSE, FINE, Detail
from mocapstudio.review.comparing import Compared, ComparingState, Recording

Indices = NDArray[np.int64]

_LEAST_SCALE = 0.04


class Part(Enum):
    """What a figure on stage stands for."""

    REFERENCE = auto()
    SOURCE = auto()
    OTHER = auto()


@dataclass(frozen=True, eq=False)
class Member:
    """One figure on stage.

    Parameters
    ----------
    part
        What it stands for.
    actor, figure
        How it moves, and its shape.
    source
        The source it shows, or None for the reference and for a guest.
    number
        Position among the sources, for its colour.
    """

    part: Part
    actor: Actor | Guest
    figure: Figure
    source: Compared | None = None
    number: int = -1

    def frame(self, state: ComparingState) -> int:
        """Its own current frame."""
        wanted = state.frame if self.source is None else state.frame_of(self.source)
        return min(wanted, self.actor.frames - 1)


class Troupe:
    """Casts the figures for a state, and remembers what is costly to work out."""

    def __init__(self) -> None:
        self._actors: dict[Recording, Actor] = {}
        self._figures: dict[tuple[Recording, Detail], Figure] = {}
        self._common: dict[Comparison, tuple[Indices, Indices]] = {}
        self._here: dict[tuple[Comparison, int], Placing] = {}
        self._scales: dict[Comparison, tuple[float, Indices]] = {}

    @staticmethod
    def invited(guest: Guest) -> Member:
        """Return somebody who is no source, in the place of one."""
        return Member(Part.SOURCE, guest, guest.figure(FINE), number=0)

    def actor(self, take: Recording) -> Actor:
        """Return the actor of a performance, the same one for the same take."""
        if take not in self._actors:
            self._actors[take] = actor_of(take)
        return self._actors[take]

    def reference(self, state: ComparingState) -> tuple[Member, ...]:
        """Return the reference alone, or nobody."""
        if state.reference is None:
            return ()
        take = state.reference
        return (Member(Part.REFERENCE, self.actor(take), self._figure(take, FINE)),)

    def sources(self, state: ComparingState, others: bool) -> tuple[Member, ...]:
        """Return the chosen source, and the others too if asked for."""
        members = []
        for number, one in enumerate(state.sources):
            chosen = one.id == state.chosen
            if chosen or (others and one.linked is not None):
                detail = FINE if chosen else COARSE
                part = Part.SOURCE if chosen else Part.OTHER
                figure = self._figure(one.take, detail)
                members.append(Member(part, self.actor(one.take), figure, one, number))
        return tuple(sorted(members, key=lambda one: one.part is Part.OTHER))

    def keep(self, state: ComparingState) -> None:
        """Forget performances that are no longer compared."""
        takes = {one.take for one in state.sources} | ({state.reference} - {None})
        if set(self._actors) - takes:
            self._actors = {take: one for take, one in self._actors.items() if take in takes}
            self._figures = {key: one for key, one in self._figures.items() if key[0] in takes}
        kept = {one.comparison for one in state.sources}
        self._common = {one: both for one, both in self._common.items() if one in kept}
        self._scales = {one: scale for one, scale in self._scales.items() if one in kept}
        self._here = {key: one for key, one in self._here.items() if key[0] in kept}

    def place(self, member: Member, state: ComparingState, ui: CompareUi) -> Placing:
        """Return where a member stands beside the reference."""
        source, reference = member.source, state.reference
        if source is None or reference is None:
            return placing.IN_PLACE
        if ui.alignment is Alignment.RECORDED or source.linked is None:
            return placing.IN_PLACE
        if ui.alignment is Alignment.THROUGHOUT:
            return self._fit(member, reference, state.frame, member.frame(state))
        key = (source.linked.comparison, ui.anchor)
        if key not in self._here:
            at = source.linked.source_of(ui.anchor)
            self._here[key] = self._fit(member, reference, ui.anchor, at)
        return self._here[key]

    def colours(
        self, member: Member, state: ComparingState, own: Colour, hot: Colour | None
    ) -> NDArray[np.uint8]:
        """(P, 3) colour of each point: its own, or towards `hot` where it differs.

        Parameters
        ----------
        own
            The member's colour.
        hot
            Colour of what differs most; None leaves differences out.
        """
        count = len(member.actor.owners)
        plain = np.broadcast_to(np.array(own, np.uint8), (count, 3))
        comparison = None if member.source is None else member.source.comparison
        if hot is None or comparison is None:
            return plain
        scale, rows = self._scale(member, comparison)
        at = min(member.frame(state), len(comparison.joint_difference) - 1)
        values = np.nan_to_num(comparison.joint_difference[at]) / scale
        share = np.zeros(len(member.actor.names))
        known = rows >= 0
        share[rows[known]] = np.clip(values[known], 0.0, 1.0)
        mixed = np.array(own) + share[member.actor.owners][:, None] ** 1.4 * (
            np.array(hot, dtype=float) - np.array(own)
        )
        rounded: NDArray[np.uint8] = np.round(mixed).astype(np.uint8)
        return rounded

    def row_of(self, member: Member, point: int, state: ComparingState) -> str | None:
        """Name of the compared row that a point stands for, or None."""
        comparison = state.comparison if member.source is None else member.source.comparison
        if point >= len(member.actor.names) or comparison is None:
            return None
        name = member.actor.names[point]
        names = comparison.rows if member.source is None else _own_rows(comparison)
        return comparison.rows[names.index(name)] if name in names else None

    def point_of(self, member: Member, row: str | None) -> int | None:
        """Return the point that stands for a compared row, or None."""
        comparison = None if member.source is None else member.source.comparison
        if comparison is not None and row in comparison.rows:
            row = _own_rows(comparison)[comparison.rows.index(row)]
        return member.actor.names.index(row) if row in member.actor.names else None

    def _scale(self, member: Member, comparison: Comparison) -> tuple[float, Indices]:
        """Difference that is coloured most, and the point of each row."""
        if comparison not in self._scales:
            known = comparison.joint_difference[np.isfinite(comparison.joint_difference)]
            high = float(np.percentile(known, 98)) if known.size else 0.0
            index = {name: i for i, name in enumerate(member.actor.names)}
            rows = np.array([index.get(row, -1) for row in _own_rows(comparison)], dtype=np.int64)
            self._scales[comparison] = max(high, _LEAST_SCALE), rows
        return self._scales[comparison]

    def _fit(self, member: Member, reference: Recording, frame: int, own: int) -> Placing:
        actor, other = member.actor, self.actor(reference)
        mine, theirs = self._shared(member, other)
        rise = other.level - actor.level
        own, frame = min(own, actor.frames - 1), min(frame, other.frames - 1)
        if len(mine) < 2:
            return placing.fit(actor.followed[own][None], other.followed[frame][None], rise)
        return placing.fit(actor.points(own)[mine], other.points(frame)[theirs], rise)

    def _shared(self, member: Member, other: Actor) -> tuple[Indices, Indices]:
        """Points of a member and of the reference that stand for the same part of the body."""
        assert member.source is not None
        comparison = member.source.comparison
        assert comparison is not None
        if comparison not in self._common:
            own = {name: i for i, name in enumerate(member.actor.names)}
            index = {name: i for i, name in enumerate(other.names)}
            named = zip(_own_rows(comparison), comparison.rows, strict=True)
            pairs = [(own[a], index[b]) for a, b in named if a in own and b in index]
            both = np.array(pairs, dtype=np.int64).reshape(-1, 2)
            self._common[comparison] = both[:, 0], both[:, 1]
        return self._common[comparison]

    def _figure(self, take: Recording, detail: Detail) -> Figure:
        key = (take, detail)
        if key not in self._figures:
            self._figures[key] = self.actor(take).figure(detail)
        return self._figures[key]


def _own_rows(comparison: Comparison) -> tuple[str, ...]:
    """Names of the rows in the source."""
    return comparison.source_rows or comparison.rows


def figures(members: Sequence[Member]) -> list[Figure]:
    """Return the shapes of members, in their order."""
    return [one.figure for one in members]
