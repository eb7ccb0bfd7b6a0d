"""What is known of a table between its text and the take that it becomes."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.options import ReadOptions, Up
from mocapstudio.formats.reading import Reading
from mocapstudio.formats.report import Problem
from mocapstudio.formats.table_columns import Columns
from mocapstudio.formats.table_rows import Rows
from mocapstudio.formats.table_sheet import Sheet, Span
from mocapstudio.motion.errors import FileError

Array = NDArray[np.float64]

_LARGEST_FRAME = 1e9
_MOST_REPEATED = 0.3
# Steps of a time column without a unit that are no seconds: 2 ms to a second.
_MILLISECONDS = (2.0, 1000.0)


@dataclass(frozen=True)
class Stated:
    """What the head of a file says; None where it says nothing.

    Attributes
    ----------
    rate, rate_span
        Frames a second, and the bytes that state it.
    unit
        Metres per unit.
    frames
        Number of rows, with the name it is given by and its 1-based line.
    usual_up
        Which axis points up in most files of the kind.
    """

    rate: Fraction | None = None
    rate_span: Span | None = None
    unit: float | None = None
    frames: tuple[int, str, int] | None = None
    usual_up: Up = "y"


@dataclass(frozen=True)
class Head:
    """What stands above the rows.

    Attributes
    ----------
    columns
        Where the markers are in a row.
    stated
        What is said of rate, unit and number of frames.
    first
        0-based line of the first row.
    sheet
        The lines, split as the rows are.
    """

    columns: Columns
    stated: Stated
    first: int
    sheet: Sheet


@dataclass(frozen=True, eq=False)
class TableRecord:
    """What the writer needs to copy a table's text.

    Attributes
    ----------
    sheet, columns, lines
        The cells, what they are, and the line of each frame.
    own_rate, rate_span
        Frames a second that the text itself tells, and the bytes that state it; or None.
    zeros
        Whether missing positions are written as zeros.
    strict
        Whether a row may have no more cells than there are columns.
    """

    sheet: Sheet
    columns: Columns
    lines: NDArray[np.int64]
    own_rate: Fraction | None
    rate_span: Span | None
    zeros: bool
    strict: bool


@dataclass
class Body:
    """The parts of one table on their way to a take.

    Attributes
    ----------
    reading, columns, stated, options
        The file, its columns, what its head says and what the user does.
    rows
        Its numbers.
    first
        Number of the first frame.
    times
        (F,) seconds, or None.
    tick
        Seconds per unit in which the times are written.
    """

    reading: Reading
    columns: Columns
    stated: Stated
    options: ReadOptions
    rows: Rows
    first: int = field(init=False)
    times: Array | None = field(init=False)
    tick: float = field(init=False)

    def __post_init__(self) -> None:
        values, at = self.rows.values, 0
        frames = values[:, 0] if self.columns.frame is not None else None
        at += frames is not None
        self.tick = self.columns.tick
        self.times = None
        if self.columns.time is not None:
            self.times = values[:, at] * self.seconds_of(values[:, at])
        self.first = self.first_frame(frames)

    def seconds_of(self, times: Array) -> float:
        """Seconds per unit of the times (F,); a step of many is one of milliseconds."""
        steps = np.diff(times)
        step = float(np.median(steps)) if len(steps) else 0.0
        if self.tick == 1.0 and _MILLISECONDS[0] <= step <= _MILLISECONDS[1]:
            self.tick = 1e-3
            self.guess(f"times rise by {step:g} a row", "milliseconds", "fps")
        return self.tick

    def note(self, row: int | None, what: str, done: str, override: str | None = None) -> None:
        """Tell of an oddity at a row, or of the whole."""
        line = None if row is None else int(self.rows.lines[row]) + 1
        self.reading.problems.append(Problem(line, what, done, override))

    def guess(self, what: str, done: str, override: str) -> None:
        """Tell of a guess, and by which option it is overridden."""
        problem = Problem(None, what, f"guessed {done}", override, guess=True)
        self.reading.problems.append(problem)

    def first_frame(self, frames: Array | None) -> int:
        """Return the number of the first frame, of the (F,) numbers of all, if there are any.

        Raises
        ------
        FileError
            If most frames come again and again: then a row is a marker's, not a frame's.
        """
        if frames is None:
            return 0
        whole = np.isfinite(frames) & (np.abs(frames) < _LARGEST_FRAME)
        if not whole[0] or frames[0] != round(frames[0]):
            self.note(0, "the first row has no frame number", "counted from 0")
            return 0
        steps = np.diff(frames)
        if len(steps) > 1 and (steps == 0).mean() > _MOST_REPEATED:
            cause = "frame numbers repeat: every row must hold one frame with all its markers"
            raise FileError(self.reading.path, cause, line=int(self.rows.lines[0]) + 1)
        odd = np.flatnonzero(~(steps == 1))
        if len(odd):
            what = f"frame {frames[odd[0] + 1]:g} follows frame {frames[odd[0]]:g}"
            self.note(int(odd[0]) + 1, what, "the rows' order counts")
        return int(frames[0])
