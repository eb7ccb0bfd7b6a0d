"""What a reader found in a file, and what it did about it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Problem:
    """One oddity of a file.

    Parameters
    ----------
    line
        1-based line, or None where no line is to blame.
    what
        What was found.
    done
        What was done about it; a guess says so.
    override
        Name of the field of `ReadOptions` by which the user may decide otherwise, or None.
    guess
        True where the file leaves something open and a value was guessed.
    """

    line: int | None
    what: str
    done: str
    override: str | None = None
    guess: bool = False


@dataclass(frozen=True)
class ImportReport:
    """What was read from one file.

    Parameters
    ----------
    path
        The file.
    format
        Short name of the format, such as ``"bvh"``.
    problems
        Oddities in the order of the file, guesses last.
    """

    path: Path
    format: str
    problems: tuple[Problem, ...] = ()
