"""Results of replay that are worked out once."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Generic, Protocol, TypeVar


class _Mutable(Protocol):
    @property
    def muted(self) -> bool: ...


TakeT = TypeVar("TakeT")
EditT = TypeVar("EditT", bound=_Mutable)


class Remembered(Generic[TakeT, EditT]):
    """Results of replay, one remembered for each performer and recognised by identity.

    Parameters
    ----------
    replay
        Does edits over a take.
    """

    def __init__(self, replay: Callable[[TakeT, Iterable[EditT]], TakeT]) -> None:
        self._replay = replay
        self._known: dict[str, tuple[TakeT, tuple[EditT, ...], TakeT]] = {}

    def of(self, performer: str, take: TakeT, edits: Iterable[EditT]) -> TakeT:
        """Return the replayed take; the same object while nothing changes."""
        in_force = tuple(edit for edit in edits if not edit.muted)
        source, known, result = self._known.get(performer, (None, (), take))
        alike = len(known) == len(in_force) and all(
            a is b for a, b in zip(known, in_force, strict=True)
        )
        if source is not take or not alike:
            result = self._replay(take, in_force)
            self._known[performer] = (take, in_force, result)
        return result

    def forget(self, performer: str) -> None:
        """Let go of one performer's result."""
        self._known.pop(performer, None)
