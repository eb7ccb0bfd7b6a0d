"""What stands in which cell of a table's rows."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Columns:
    """What stands in which cell of a row.

    Attributes
    ----------
    labels
        One a marker.
    places
        (x, y, z) cells of each marker, counted from 0.
    width
        Cells of a whole row.
    frame, time, timecode
        Cells of those, or None.
    tick
        Seconds per unit of the times.
    """

    labels: tuple[str, ...]
    places: tuple[tuple[int, int, int], ...]
    width: int
    frame: int | None = None
    time: int | None = None
    timecode: int | None = None
    tick: float = 1.0

    @property
    def wanted(self) -> tuple[int, ...]:
        """Cells that are read as numbers: frame and time where they are, then the markers."""
        extra = [c for c in (self.frame, self.time) if c is not None]
        return (*extra, *(cell for place in self.places for cell in place))
