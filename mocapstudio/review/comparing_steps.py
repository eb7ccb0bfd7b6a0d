"""Undoable steps of a comparison sitting: over its segments and its parameters."""

from __future__ import annotations

from dataclasses import dataclass, field

from mocapstudio.comparison.parameters import ComparisonParameters
from mocapstudio.review.comparing_segments import Segments


@dataclass(frozen=True)
class Undoable:
    """What steps change.

    Parameters
    ----------
    segments
        Named parts of the reference.
    parameters
        How performances are compared.
    """

    segments: Segments = ()
    parameters: ComparisonParameters = field(default_factory=ComparisonParameters)


@dataclass(frozen=True)
class Steps:
    """The present, and what was before and after each step that was done or undone."""

    present: Undoable = field(default_factory=Undoable)
    past: tuple[tuple[str, Undoable], ...] = ()
    future: tuple[tuple[str, Undoable], ...] = ()

    def push(self, label: str, after: Undoable, *, joining: bool = False) -> Steps:
        """Go on; what changes nothing is no step.

        Parameters
        ----------
        joining
            Whether it goes on with the step before, where that has the same label.
        """
        if after == self.present:
            return self
        if joining and self.past and not self.future and self.past[-1][0] == label:
            return Steps(after, self.past)
        return Steps(after, (*self.past, (label, self.present)))

    def undo(self) -> Steps:
        """Go a step back; the same where there is none."""
        if not self.past:
            return self
        label, before = self.past[-1]
        return Steps(before, self.past[:-1], (*self.future, (label, self.present)))

    def redo(self) -> Steps:
        """Do an undone step again; the same where there is none."""
        if not self.future:
            return self
        label, after = self.future[-1]
        return Steps(after, (*self.past, (label, self.present)), self.future[:-1])
