"""Progress of long work, as generators yield it."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import TypeVar

Result = TypeVar("Result")


@dataclass(frozen=True)
class Progress:
    """How far long work has come.

    Parameters
    ----------
    done
        Share of the work, 0..1.
    what
        What is being done, for the user.
    """

    done: float
    what: str


def run(
    work: Generator[Progress, None, Result],
    on_progress: Callable[[Progress], None] | None = None,
) -> Result:
    """Drive a generator of progress to its end and return its result.

    An exception from `on_progress`, such as `CancelledError`, closes the generator and propagates.
    """
    try:
        while True:
            try:
                progress = next(work)
            except StopIteration as stop:
                result: Result = stop.value
                return result
            if on_progress is not None:
                on_progress(progress)
    finally:
        work.close()


def scaled(
    work: Generator[Progress, None, Result], low: float, high: float
) -> Generator[Progress, None, Result]:
    """Pass progress on as a part, `low` to `high`, of a larger piece of work."""
    try:
        while True:
            progress = next(work)
            yield Progress(low + (high - low) * progress.done, progress.what)
    except StopIteration as stop:
        result: Result = stop.value
        return result
    finally:
        work.close()
