"""What a check found."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class State(StrEnum):
    """How good or bad a finding is."""

    OK = "ok"
    NOTE = "note"
    FAILED = "failed"


@dataclass(frozen=True)
class Finding:
    """One line of the doctor's table.

    Parameters
    ----------
    what
        What was looked at.
    state
        `NOTE` where only a part of the program is not to be had.
    found
        What was found, on one line.
    remedy
        What to do about it, or "".
    """

    what: str
    state: State
    found: str
    remedy: str = ""
