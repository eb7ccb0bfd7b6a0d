"""Analyses of each performer, their generations, and the proposals that belong to their flags."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from mocapstudio.cleaning.model import Flag, Proposal

if TYPE_CHECKING:
    from mocapstudio.cleaning.analysis import Analysis

_NOTHING: Mapping[str, Any] = MappingProxyType({})


class Analyses:
    """What the engine last said of each performer.

    Mappings handed out are never changed afterwards, so that states may hold them.
    """

    def __init__(self) -> None:
        self.latest: Mapping[str, Analysis] = _NOTHING
        self._generations: dict[str, int] = {}
        self._flags: dict[str, tuple[Flag, ...]] = {}
        self._choices: dict[str, Mapping[str, int | None]] = {}
        self._proposals: dict[str, Mapping[str, Proposal]] = {}

    def begin(self, performer: str) -> int:
        """Return the number of a new analysis; all earlier ones of that performer are stale."""
        self._generations[performer] = self._generations.get(performer, 0) + 1
        return self._generations[performer]

    def finish(self, performer: str, generation: int, analysis: Analysis, threshold: float) -> bool:
        """Take an analysis over, re-flagged at the threshold; False where it is stale."""
        if self._generations.get(performer) != generation:
            return False
        if analysis.parameters.threshold != threshold:
            analysis = analysis.with_threshold(threshold)
        self._set(performer, analysis)
        return True

    def reflag(self, threshold: float) -> None:
        """Flag every performer's map again at another threshold."""
        again = {p: analysis.with_threshold(threshold) for p, analysis in self.latest.items()}
        for performer, analysis in again.items():
            self._set(performer, analysis)

    def forget(self, performer: str) -> None:
        """Let go of a performer; an analysis under way becomes stale."""
        self.begin(performer)
        self.latest = MappingProxyType({p: a for p, a in self.latest.items() if p != performer})
        for kept in (self._flags, self._choices, self._proposals):
            kept.pop(performer, None)

    def flags(self, performer: str) -> tuple[Flag, ...]:
        """Flags of the latest analysis, or those a session file had kept."""
        return self._flags.get(performer, ())

    def choices(self, performer: str) -> Mapping[str, int | None]:
        """Neighbour chosen for each flag, by flag id."""
        return self._choices.get(performer, _NOTHING)

    def proposals(self, performer: str) -> Mapping[str, Proposal]:
        """Replacement offered for each flag, by flag id."""
        return self._proposals.get(performer, _NOTHING)

    def offer(self, performer: str, flag_id: str, choice: int | None, proposal: Proposal) -> None:
        """Keep a proposal for a flag, and the choice it came from."""
        self._choices[performer] = MappingProxyType({**self.choices(performer), flag_id: choice})
        self._proposals[performer] = MappingProxyType(
            {**self.proposals(performer), flag_id: proposal}
        )

    def withdraw(self) -> None:
        """Let go of all proposals, since they would be made otherwise by now; choices stay."""
        self._proposals = {}

    def restore(
        self, performer: str, flags: Iterable[Flag], choices: Mapping[str, int | None]
    ) -> None:
        """Put back what a session file kept, until the next analysis."""
        self._flags[performer] = tuple(flags)
        self._choices[performer] = MappingProxyType(dict(choices))

    def _set(self, performer: str, analysis: Analysis) -> None:
        if self.latest.get(performer) is analysis:
            return
        before = set(self._flags.get(performer, ()))
        unchanged = {flag.id for flag in analysis.flags if flag in before}
        # An offer outlives a re-flagging only with the very flag it was made for.
        self._choices[performer] = _only(self.choices(performer), unchanged)
        self._proposals[performer] = _only(self.proposals(performer), unchanged)
        self._flags[performer] = tuple(analysis.flags)
        self.latest = MappingProxyType({**self.latest, performer: analysis})


def _only(offers: Mapping[str, Any], ids: set[str]) -> Mapping[str, Any]:
    return MappingProxyType({k: v for k, v in offers.items() if k in ids})
