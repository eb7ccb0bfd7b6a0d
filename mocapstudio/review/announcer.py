"""Tells listeners of state changes, one after the other, never nested."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Generic, TypeVar

State = TypeVar("State")


class Announcer(Generic[State]):
    """Listeners and the queue of announcements.

    A change made by a listener is announced after every listener has heard of the present one,
    so that all hear of all changes in the same order.
    """

    def __init__(self) -> None:
        self._listeners: list[Callable[[State, State], None]] = []
        self._waiting: deque[tuple[State, State]] = deque()
        self._busy = False

    def subscribe(self, listener: Callable[[State, State], None]) -> Callable[[], None]:
        """Call `listener(old, new)` at every change; returns what ends that."""
        self._listeners.append(listener)

        def end() -> None:
            # By identity: bound methods of equal objects compare equal.
            self._listeners[:] = [one for one in self._listeners if one is not listener]

        return end

    def announce(self, old: State, new: State) -> None:
        """Tell every listener; queued where an announcement is under way.

        Raises
        ------
        Exception
            The first one a listener raised, after all others were told.
        """
        self._waiting.append((old, new))
        if self._busy:
            return
        self._busy = True
        failure: Exception | None = None
        try:
            while self._waiting:
                pair = self._waiting.popleft()
                for listener in tuple(self._listeners):
                    try:
                        listener(*pair)
                    except Exception as error:  # told to the caller once all have heard
                        failure = failure or error
        finally:
            self._busy = False
        if failure is not None:
            raise failure
