"""Which samples a change may touch, as it was declared beforehand."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Declared:
    """One row (joint or root row) over a half-open span of frames at the take's own rate."""

    row: str
    start: int
    end: int
