"""Undo and redo over frozen sittings that share what did not change."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace

from mocapstudio.review.model import Sitting

# Each step holds its own tuples of references: a thousand steps cost some megabytes.
DEPTH = 1_000


def same(a: Sitting, b: Sitting) -> bool:
    """Tell whether two sittings hold the very same objects in the same order."""
    if a is b:
        return True
    for one in fields(Sitting):
        left, right = getattr(a, one.name), getattr(b, one.name)
        if len(left) != len(right) or any(x is not y for x, y in zip(left, right, strict=True)):
            return False
    return True


@dataclass(frozen=True, eq=False)
class Step:
    """One undoable step: its label and the sitting on its far side (before it, or after)."""

    label: str
    sitting: Sitting


@dataclass(frozen=True, eq=False)
class History:
    """The present sitting, the steps that led to it and those that were undone.

    Parameters
    ----------
    present
        The sitting that is shown.
    past
        Steps done, oldest first, each with the sitting before it.
    future
        Steps undone, the next to redo last, each with the sitting after it.
    """

    present: Sitting = field(default_factory=Sitting)
    past: tuple[Step, ...] = ()
    future: tuple[Step, ...] = ()

    @property
    def can_undo(self) -> str | None:
        """Label of the step that `undo` takes back, or None."""
        return self.past[-1].label if self.past else None

    @property
    def can_redo(self) -> str | None:
        """Label of the step that `redo` does again, or None."""
        return self.future[-1].label if self.future else None

    def push(self, label: str, sitting: Sitting) -> History:
        """Go on to `sitting`; a sitting that changes nothing is no step."""
        if same(self.present, sitting):
            return self
        past = (*self.past, Step(label, self.present))[-DEPTH:]
        return History(sitting, past)

    def undo(self) -> History:
        """Go one step back; the same history where there is none."""
        if not self.past:
            return self
        step = self.past[-1]
        undone = Step(step.label, self.present)
        return History(step.sitting, self.past[:-1], (*self.future, undone))

    def redo(self) -> History:
        """Go one undone step forward; the same history where there is none."""
        if not self.future:
            return self
        step = self.future[-1]
        done = Step(step.label, self.present)
        return History(step.sitting, (*self.past, done), self.future[:-1])

    def forget(self, performer: str) -> History:
        """Drop everything about one performer from all steps, and the steps that become empty."""

        def without(sitting: Sitting) -> Sitting:
            return Sitting(
                tuple(e for e in sitting.edits if e.performer != performer),
                tuple(d for d in sitting.decisions if d.performer != performer),
                tuple(p for p in sitting.protected if p.performer != performer),
                tuple(t for t in sitting.trims if t[0] != performer),
                tuple(c for c in sitting.contacts if c.performer != performer),
                tuple(p for p in sitting.points if p.performer != performer),
                tuple(e for e in sitting.marker_edits if e.performer != performer),
            )

        present = without(self.present)
        return History(
            present,
            _filtered(self.past, present, without),
            _filtered(self.future, present, without),
        )


def _filtered(
    steps: tuple[Step, ...], present: Sitting, change: Callable[[Sitting], Sitting]
) -> tuple[Step, ...]:
    kept: list[Step] = []
    near = present
    for step in reversed(steps):
        far = change(step.sitting)
        if not same(far, near):
            kept.append(replace(step, sitting=far))
        near = far
    return tuple(reversed(kept))
