"""Repairs of a sitting that leave hands, feet and contacts where they are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from mocapstudio.cleaning.contacts.model import ContactPoint, Following, Target
from mocapstudio.cleaning.model import Flag, Proposal
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.take import Take
from mocapstudio.review.beside import on_clock
from mocapstudio.review.core import Core

if TYPE_CHECKING:
    from mocapstudio.cleaning.contacts.keeping import Kept


class Keeping(Core):
    """What repairs keep, and proposals that keep it."""

    def set_keep_ends(self, on: bool) -> None:
        """Let proposals leave hands and feet where they were, or not; those made are made anew."""
        if on != self._state.keep_ends:
            self._analyses.withdraw()
            self._put(keep_ends=on)

    def kept(self, performer: str) -> Kept:
        """Return what repairs of a performer leave where it is: hands and feet, and contacts."""
        from mocapstudio.cleaning.contacts.keeping import Kept

        sitting, state = self._history.present, self._state
        own = [one.contact for one in sitting.contacts if one.performer == performer]
        if not own:
            return Kept(state.keep_ends)
        active, take = state.scene.performer(performer), self._take(performer)
        others = {
            one.id: on_clock(take, active.offset, self.result(one.id), one.offset)
            for one in state.scene.performers
            if one.id != performer
        }
        points = self._points(performer, take)
        fit = [one for one in own if _fits(one.target, others)]
        contacts = tuple(sorted(fit, key=lambda one: (one.start, one.joint, one.point or "")))
        return Kept(state.keep_ends, contacts, points, others)

    def _points(self, performer: str, take: Take) -> tuple[ContactPoint, ...]:
        from mocapstudio.cleaning.contacts.points import contact_points

        for one in self._history.present.points:
            if one.performer == performer:
                return one.points
        known = self._points_of.get(performer)
        if known is None or known[0] is not take:
            known = take, contact_points(take)
            self._points_of[performer] = known
        return known[1]

    def _propose(self, performer: str, flag: Flag, onto: Take | None = None) -> Proposal:
        # The engine's kernels take a while to import; a desk that only looks needs none.
        from mocapstudio.cleaning.contacts.keeping import propose_keeping

        analysis = self._analyses.latest.get(performer)
        if analysis is None:
            raise MocapError(f"no proposal for {flag.joint} yet: analyse the take first")
        choice = self._state.choices.get(flag.id)
        return propose_keeping(analysis, flag, choice, onto, kept=self.kept(performer))


def _fits(target: Target, others: Mapping[str, Take]) -> bool:
    """Tell whether whom a contact follows is there."""
    if not isinstance(target, Following):
        return True
    other = others.get(target.performer)
    return other is not None and target.joint in other.skeleton.index
