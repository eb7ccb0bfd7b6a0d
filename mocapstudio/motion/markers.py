"""The marker take: one recording of one performer as labelled markers."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.take import Source
from mocapstudio.motion.timed import Timed


@dataclass(frozen=True)
class Event:
    """Something the file marks in time, such as a foot strike.

    Parameters
    ----------
    name
        What happened, with its context where the file gives one, such as ``"Left Foot Strike"``.
    time
        Seconds after the take's first frame.
    """

    name: str
    time: float


@dataclass(frozen=True, eq=False)
class MarkerTake(Timed):
    """Labelled markers of one performer, in metres and seconds, Y up, right-handed.

    Parameters
    ----------
    name
        What the user calls it: by default the file's stem.
    labels
        One unique name a marker, as in the file (duplicates get ``#2``, ``#3``).
    positions
        (F, M, 3) metres in the world; NaN where a marker is missing.
    rate
        Frames a second.
    first_frame
        The number that the file gives its first frame.
    timecode
        SMPTE timecode of the first frame, or None.
    trim
        Half-open span of frames that analysis and report look at, or None for all.
    filled
        (F, M) True where a position was not measured but completed, or None where none was.
    bones
        Pairs of marker indices that are drawn as lines; empty where nobody said.
    events
        What the file marks in time.
    source
        The file behind it, or None for a take made in memory.

    Raises
    ------
    MocapError
        If shapes disagree, labels repeat, or there is no frame.
    """

    name: str
    labels: tuple[str, ...]
    positions: NDArray[np.float64]
    rate: Fraction
    first_frame: int = 0
    timecode: str | None = None
    trim: tuple[int, int] | None = None
    filled: NDArray[np.bool_] | None = None
    bones: tuple[tuple[int, int], ...] = ()
    events: tuple[Event, ...] = ()
    source: Source | None = None

    def __post_init__(self) -> None:
        if self.positions.ndim != 3 or self.positions.shape[1:] != (len(self.labels), 3):
            raise MocapError("positions must have shape (frames, markers, 3)")
        if len(set(self.labels)) != len(self.labels):
            raise MocapError("marker labels repeat in one take")
        if self.filled is not None and self.filled.shape != self.positions.shape[:2]:
            raise MocapError("filled must have shape (frames, markers)")
        self.check_time()

    @property
    def frames(self) -> int:
        """Number of frames."""
        return len(self.positions)

    @cached_property
    def index(self) -> dict[str, int]:
        """Marker index by label."""
        return {label: i for i, label in enumerate(self.labels)}

    @cached_property
    def missing(self) -> NDArray[np.bool_]:
        """(F, M) True where a marker has no position."""
        return np.asarray(np.isnan(self.positions).any(axis=2))

    def with_positions(
        self, positions: NDArray[np.float64], filled: NDArray[np.bool_] | None = None
    ) -> MarkerTake:
        """Return the same take with other samples of the same shape.

        Parameters
        ----------
        positions
            (F, M, 3) metres.
        filled
            (F, M) True where a position was completed just now; added to what was filled before.
        """
        before = self.filled
        both = before if filled is None else filled if before is None else before | filled
        return replace(self, positions=positions, filled=both)
