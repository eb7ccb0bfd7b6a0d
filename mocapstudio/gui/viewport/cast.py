"""Who is on stage: which motions the 3-D view shows, and when each of them is seen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from mocapstudio.cleaning.model import Proposal
from mocapstudio.cleaning.proposals import apply
from mocapstudio.gui.viewport.figure import Figure
from mocapstudio.gui.viewport.shaping import build_figure
from mocapstudio.gui.viewport.solids import COARSE, FINE, Detail
from mocapstudio.gui.viewport.world import WorldMotion, WorldMotions
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take
from mocapstudio.review.model import Performer, Verdict
from mocapstudio.review.state import DocumentState


class Part(Enum):
    """What a figure on stage stands for."""

    RESULT = "result"
    ORIGINAL = "original"
    PROPOSAL = "proposal"
    NEIGHBOUR = "neighbour"
    PARTNER = "partner"
    BEFORE = "before"
    AFTER = "after"


ONION = (Part.BEFORE, Part.AFTER)
_SKINS, _APART = 3, 0.1
"""Onion skins on each side of the frame, and the seconds between two of them."""


@dataclass(frozen=True, eq=False)
class Role:
    """One figure on stage.

    Parameters
    ----------
    part
        What it stands for.
    name
        What the legend calls it.
    motion, figure
        How it moves, and its shape.
    spans
        Half-open spans of its own frames in which it may be seen.
    rate
        Its own frames for each frame of the active take.
    shift
        Its own frame at frame 0 of the active take; may be a fraction.
    turned
        Names of the joints whose rotations differ from the result's; empty where all may.
    fade
        0..1: how far its colour is lost in the background.
    """

    part: Part
    name: str
    motion: WorldMotion
    figure: Figure
    spans: tuple[tuple[int, int], ...]
    rate: float = 1.0
    shift: float = 0.0
    turned: frozenset[str] = frozenset()
    fade: float = 0.0

    def frame(self, frame: int) -> int | None:
        """Its own frame at a frame of the active take, or None while it is off stage."""
        own = int(np.floor(self.shift + frame * self.rate + 0.5))
        return own if any(start <= own < end for start, end in self.spans) else None


class Stage:
    """Casts the roles for a state, and remembers what is costly to work out."""

    def __init__(self) -> None:
        self.motions = WorldMotions()
        self._figures: dict[tuple[Skeleton, Detail], Figure] = {}
        self._applied: dict[tuple[Take, Proposal], Take] = {}

    def cast(
        self,
        state: DocumentState,
        result: Take,
        *,
        ghosts: bool,
        neighbours: Sequence[Proposal] = (),
        onion: bool = False,
    ) -> tuple[Role, ...]:
        """Return the roles of a state with an active performer, the result first.

        Parameters
        ----------
        state
            Of the document.
        result
            The active performer's take with its edits.
        ghosts
            Whether the proposal and the original are shown.
        neighbours
            Proposals made of each neighbour of the selected flag, if they are to be shown.
        onion
            Whether the result is also shown some frames before and after.
        """
        active = state.scene.performer(state.active)
        whole = ((0, result.frames),)
        roles = [Role(Part.RESULT, result.name, *self._seen(result, FINE), whole)]
        if ghosts:
            roles += self._original(state, active)
            item = state.selected
            shown = None if item is None else state.proposals.get(item.flag.id)
            # Once accepted it is the result.
            if shown is not None and item is not None and item.verdict is not Verdict.ACCEPTED:
                roles.append(self._ghost(Part.PROPOSAL, "proposal", result, shown))
        roles += [self._ghost(Part.NEIGHBOUR, "neighbours", result, one) for one in neighbours]
        roles += [self._partner(active, other) for other in _partners(state, active)]
        if onion:
            roles += self._skins(result)
        self._forget(roles, state)
        return tuple(roles)

    def _skins(self, result: Take) -> list[Role]:
        seen, whole = self._seen(result, COARSE), ((0, result.frames),)
        step = max(1, round(_APART * float(result.rate)))
        return [
            Role(part, str(part.value), *seen, whole, shift=float(way * far * step),
                 fade=far / (_SKINS + 1))
            for part, way in ((Part.BEFORE, -1), (Part.AFTER, 1))
            for far in range(1, _SKINS + 1)
        ]  # fmt: skip

    def _original(self, state: DocumentState, active: Performer) -> list[Role]:
        spans = tuple(
            (edit.start, edit.end)
            for edit in state.sitting.edits
            if edit.performer == active.id and not edit.muted
        )
        if not spans:
            return []
        return [Role(Part.ORIGINAL, "original", *self._seen(active.take, COARSE), spans)]

    def _ghost(self, part: Part, name: str, result: Take, proposal: Proposal) -> Role:
        key = (result, proposal)
        if key not in self._applied:
            self._applied[key] = apply(result, proposal)
        seen = self._seen(self._applied[key], COARSE)
        span = ((proposal.start, proposal.end),)
        return Role(part, name, *seen, span, turned=frozenset(proposal.joints))

    def _partner(self, active: Performer, other: Performer) -> Role:
        rate = float(other.take.rate / active.take.rate)
        shift = (active.offset - other.offset) * float(other.take.rate)
        whole = ((0, other.take.frames),)
        seen = self._seen(other.take, FINE)
        return Role(Part.PARTNER, other.take.name, *seen, whole, rate, shift)

    def _seen(self, take: Take, detail: Detail) -> tuple[WorldMotion, Figure]:
        motion = self.motions.of(take)
        key = (take.skeleton, detail)
        if key not in self._figures:
            self._figures[key] = build_figure(take.skeleton, motion.points(0), detail)
        return motion, self._figures[key]

    def _forget(self, roles: Sequence[Role], state: DocumentState) -> None:
        takes = [role.motion.take for role in roles]
        self.motions.keep([*takes, *(p.take for p in state.scene.performers)])
        kept = set(takes)
        self._applied = {key: take for key, take in self._applied.items() if take in kept}
        skeletons = {take.skeleton for take in takes}
        self._figures = {key: f for key, f in self._figures.items() if key[0] in skeletons}


def _partners(state: DocumentState, active: Performer) -> list[Performer]:
    """Everybody else in the space: partners of the take under review, or whom a partner joins."""
    others = [one for one in state.scene.performers if one.id != active.id]
    return others if active.partner else [one for one in others if one.partner]
