"""From rows of numbers to a marker take: what is missing, rate, unit, axes."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.guesses import turn_to_inside
from mocapstudio.formats.marker_guesses import guess_marker_unit, guess_marker_up
from mocapstudio.formats.options import ReadOptions, Up
from mocapstudio.formats.reading import Reading
from mocapstudio.formats.report import Problem
from mocapstudio.formats.table_rows import Rows, parse_rows
from mocapstudio.formats.table_sheet import Sheet, Span
from mocapstudio.formats.table_times import (
    Clock,
    can_resample,
    departure,
    read_clock,
    resampled,
)
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import NoRateError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Source

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_NAMED = 4
_MOST_DECIMALS = 9
_LARGEST_FRAME = 1e9


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
class _Body:
    """The parts of one table on their way to a take."""

    reading: Reading
    columns: Columns
    stated: Stated
    options: ReadOptions
    rows: Rows
    first: int = field(init=False)
    times: Array | None = field(init=False)

    def __post_init__(self) -> None:
        values, at = self.rows.values, 0
        frames = values[:, 0] if self.columns.frame is not None else None
        at += frames is not None
        self.times = values[:, at] * self.columns.tick if self.columns.time is not None else None
        self.first = self.first_frame(frames)

    def note(self, row: int | None, what: str, done: str, override: str | None = None) -> None:
        line = None if row is None else int(self.rows.lines[row]) + 1
        self.reading.problems.append(Problem(line, what, done, override))

    def guess(self, what: str, done: str, override: str) -> None:
        problem = Problem(None, what, f"guessed {done}", override, guess=True)
        self.reading.problems.append(problem)

    def first_frame(self, frames: Array | None) -> int:
        if frames is None:
            return 0
        whole = np.isfinite(frames) & (np.abs(frames) < _LARGEST_FRAME)
        if not whole[0] or frames[0] != round(frames[0]):
            self.note(0, "the first row has no frame number", "counted from 0")
            return 0
        odd = np.flatnonzero(~(np.diff(frames) == 1))
        if len(odd):
            what = f"frame {frames[odd[0] + 1]:g} follows frame {frames[odd[0]]:g}"
            self.note(int(odd[0]) + 1, what, "the rows' order counts")
        return int(frames[0])


def marker_take(
    reading: Reading,
    sheet: Sheet,
    first: int,
    columns: Columns,
    stated: Stated,
    options: ReadOptions,
    form: str,
) -> MarkerTake:
    """Read the rows from line `first` on as a marker take.

    Raises
    ------
    FileError
        Where a row is not what it should be.
    NoRateError
        If neither the file nor the options tell frames a second.
    """
    strict = form == "trc"
    rows = parse_rows(reading, sheet, first, columns.wanted, columns.width, strict)
    body = _Body(reading, columns, stated, options, rows)
    _tell_of_count(body)
    positions, zeros = _present(body)
    rate, own_rate, moved = _rate(body, sheet)
    unit = _unit(body, positions)
    up = _up(body, positions)
    digest = hashlib.sha256(reading.data).hexdigest()
    record: TableRecord | None = None
    if moved:
        assert body.times is not None
        positions = resampled(positions, body.times, rate)
    else:
        style = zeros and not rows.blanks
        record = TableRecord(sheet, columns, rows.lines, own_rate, stated.rate_span, style, strict)
    to_inside = turn_to_inside(up, options.forward)
    source = Source(reading.path, form, digest, unit, to_inside, record=record)
    return MarkerTake(
        name=reading.path.stem,
        labels=columns.labels,
        positions=inside(positions, source),
        rate=rate,
        first_frame=body.first,
        timecode=_timecode(sheet, columns, rows),
        source=source,
    )


def inside(positions: Array, source: Source) -> Array:
    """Turn positions in units and axes of a file into metres and our axes."""
    positions = positions * source.unit
    if np.array_equal(source.to_inside, rot.IDENTITY):
        return positions
    return rot.rotate(source.to_inside, positions)


def as_read(source: Source) -> Array:
    """Return the positions that a table was read as, from the bytes that were kept of it."""
    record: TableRecord = source.record
    reading = Reading(source.path, record.sheet.data, True, [])
    columns = record.columns
    rows = parse_rows(
        reading, record.sheet, int(record.lines[0]), columns.wanted, columns.width, record.strict
    )
    return inside(_places(columns, rows)[0], source)


def _places(columns: Columns, rows: Rows) -> tuple[Array, Mask, Mask]:
    """Return positions; where all three cells are zero; where only some of them are blank."""
    markers = len(columns.places)
    positions = rows.values[:, -3 * markers :].reshape(-1, markers, 3).copy()
    absent = np.isnan(positions)
    zeros: Mask = np.asarray((positions == 0).all(axis=2))
    partial: Mask = np.asarray(absent.any(axis=2) & ~absent.all(axis=2))
    positions[zeros | partial] = np.nan
    return positions, zeros, partial


def _present(body: _Body) -> tuple[Array, bool]:
    positions, zeros, partial = _places(body.columns, body.rows)
    blank: Mask = np.isnan(positions).all(axis=2) & ~zeros & ~partial
    for mask, what in (
        (blank, "{} positions are blank"),
        (zeros, "{} positions are exactly 0 0 0"),
        (partial, "{} positions lack a coordinate"),
    ):
        if mask.any():
            row = int(np.flatnonzero(mask.any(axis=1))[0])
            body.note(row, what.format(int(mask.sum())), "read as missing")
    never_seen: Mask = np.asarray(np.isnan(positions).all(axis=(0, 2)))
    unseen = [label for label, never in zip(body.columns.labels, never_seen, strict=True) if never]
    if unseen:
        some = ", ".join(unseen[:_NAMED]) + (" and more" if len(unseen) > _NAMED else "")
        body.note(None, f"{len(unseen)} markers are never seen: {some}", "kept, always missing")
    _tell_of_held_rows(body, positions)
    return positions, bool(zeros.any())


def _tell_of_held_rows(body: _Body, positions: Array) -> None:
    absent = np.isnan(positions[1:])
    same = (positions[1:] == positions[:-1]) | (absent & np.isnan(positions[:-1]))
    held = same.all(axis=(1, 2)) & ~absent.all(axis=(1, 2))
    if len(held) > 1 and held.mean() > 0.5:
        what = f"{held.mean():.0%} of rows repeat the one before"
        body.note(None, what, "kept; what was captured is slower than the rate")


def _tell_of_count(body: _Body) -> None:
    if body.stated.frames is None:
        return
    count, name, line = body.stated.frames
    found = len(body.rows.lines)
    if count != found:
        what = f"{name} {count}, but {found} rows"
        problem = Problem(line, what, f"read {found} frames")
        body.reading.problems.append(problem)


def _rate(body: _Body, sheet: Sheet) -> tuple[Fraction, Fraction | None, bool]:
    """Return frames a second; what the text tells; whether rows move to where their times say."""
    stated, times = body.stated.rate, body.times
    resolution = _resolution(body, sheet)
    clock = Clock(None, why="no times") if times is None else read_clock(times, resolution)
    own = stated or clock.rate
    if body.options.fps is not None:
        return body.options.fps, own, False
    if own is None:
        raise NoRateError(body.reading.path, f"no frame rate ({clock.why}): --fps tells it")
    if stated is None:
        return own, own, _must_move(body, own, clock)
    if times is None or _agrees(times, stated, resolution):
        return stated, own, False
    if clock.rate is None or clock.uniform:
        what = clock.why or f"times tell {float(clock.rate or 0):.6g} frames a second"
        body.note(None, f"{what}, the head {float(stated):.6g}", "the head counts", "fps")
        return stated, own, False
    return stated, own, _must_move(body, stated, clock)


def _agrees(times: Array, rate: Fraction, resolution: float) -> bool:
    step = 1 / float(rate)
    return bool(np.isfinite(times).all()) and departure(times, step) <= 0.1 * step + resolution


def _must_move(body: _Body, rate: Fraction, clock: Clock) -> bool:
    if clock.uniform:
        return False
    assert body.times is not None
    what = f"times are not even: up to {clock.departure:.3g} s from {float(rate):.6g} a second"
    if can_resample(body.times, rate):
        body.note(None, what, "rows put where their times say, linearly; --fps keeps them", "fps")
        return True
    body.note(None, what, "rows taken as they are", "fps")
    return False


def _resolution(body: _Body, sheet: Sheet) -> float:
    """Seconds of the last digit with which times are written."""
    column = body.columns.time
    if column is None:
        return 0.0
    cells = [sheet.cells(int(i)) for i in body.rows.lines[:20]]
    texts = [row[column].lower() for row in cells if len(row) > column]
    if not texts or any(b"e" in text for text in texts):
        return 0.0
    decimals = max(len(text.partition(sheet.decimal)[2]) for text in texts)
    return float(10.0 ** -min(decimals, _MOST_DECIMALS)) * body.columns.tick


def _unit(body: _Body, positions: Array) -> float:
    if body.options.unit is not None:
        return body.options.unit
    if body.stated.unit is not None:
        return body.stated.unit
    unit, why = guess_marker_unit(positions)
    body.guess("no unit stated", f"1 unit = {unit:.4g} m ({why})", "unit")
    return unit


def _up(body: _Body, positions: Array) -> Up:
    if body.options.up is not None:
        return body.options.up
    up, why = guess_marker_up(positions, body.columns.labels, body.stated.usual_up)
    body.guess("no up axis stated", f"{up.upper()} up ({why})", "up")
    return up


def _timecode(sheet: Sheet, columns: Columns, rows: Rows) -> str | None:
    if columns.timecode is None:
        return None
    words = sheet.words(int(rows.lines[0]))
    return words[columns.timecode] or None if len(words) > columns.timecode else None
