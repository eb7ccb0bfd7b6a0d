"""From rows of numbers to a marker take: what is missing, rate, unit, axes."""

from __future__ import annotations

import hashlib
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.guesses import turn_to_inside
from mocapstudio.formats.marker_guesses import guess_marker_unit, guess_marker_up
from mocapstudio.formats.options import ReadOptions, Up
from mocapstudio.formats.reading import Reading
from mocapstudio.formats.report import Problem
from mocapstudio.formats.table_columns import Columns
from mocapstudio.formats.table_model import Body, Head, TableRecord
from mocapstudio.formats.table_rate import read_rate
from mocapstudio.formats.table_rows import Rows, parse_rows
from mocapstudio.formats.table_sheet import Sheet
from mocapstudio.formats.table_times import resampled
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Source

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_NAMED = 4


def marker_take(reading: Reading, head: Head, options: ReadOptions, form: str) -> MarkerTake:
    """Read the rows below a head as a marker take.

    Raises
    ------
    FileError
        Where a row is not what it should be.
    NoRateError
        If neither the file nor the options tell frames a second.
    """
    sheet, columns, stated = head.sheet, head.columns, head.stated
    strict = form == "trc"
    rows = parse_rows(reading, sheet, head.first, columns, strict=strict)
    body = Body(reading, columns, stated, options, rows)
    _tell_of_count(body)
    positions, zeros = _present(body)
    rate, own_rate, moved = read_rate(body, sheet)
    unit = _unit(body, positions)
    up = _up(body, positions)
    digest = hashlib.sha256(reading.data).hexdigest()
    record: TableRecord | None = None
    if moved:
        assert body.times is not None
        positions = resampled(positions, body.times, rate)
    else:
        style = zeros and not rows.blanks
        columns = replace(columns, tick=body.tick)
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
    """Turn positions (F, M, 3) in units and axes of a file into metres and our axes."""
    positions = positions * source.unit
    if np.array_equal(source.to_inside, rot.IDENTITY):
        return positions
    return rot.rotate(source.to_inside, positions)


def as_read(source: Source) -> Array:
    """(F, M, 3) metres that a table was read as, from the bytes that were kept of it."""
    record: TableRecord = source.record
    reading = Reading(source.path, record.sheet.data, True, [])
    first = int(record.lines[0])
    rows = parse_rows(reading, record.sheet, first, record.columns, strict=record.strict)
    return inside(_places(record.columns, rows)[0], source)


def _places(columns: Columns, rows: Rows) -> tuple[Array, Mask, Mask]:
    """Return positions; where all three cells are zero; where only some of them are blank."""
    markers = len(columns.places)
    positions = rows.values[:, -3 * markers :].reshape(-1, markers, 3).copy()
    absent = np.isnan(positions)
    zeros: Mask = np.asarray((positions == 0).all(axis=2))
    partial: Mask = np.asarray(absent.any(axis=2) & ~absent.all(axis=2))
    positions[zeros | partial] = np.nan
    return positions, zeros, partial


def _present(body: Body) -> tuple[Array, bool]:
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


def _tell_of_held_rows(body: Body, positions: Array) -> None:
    absent = np.isnan(positions[1:])
    same = (positions[1:] == positions[:-1]) | (absent & np.isnan(positions[:-1]))
    held = same.all(axis=(1, 2)) & ~absent.all(axis=(1, 2))
    if len(held) > 1 and held.mean() > 0.5:
        what = f"{held.mean():.0%} of rows repeat the one before"
        body.note(None, what, "kept; what was captured is slower than the rate")


def _tell_of_count(body: Body) -> None:
    if body.stated.frames is None:
        return
    count, name, line = body.stated.frames
    found = len(body.rows.lines)
    if count != found:
        what = f"{name} {count}, but {found} rows"
        problem = Problem(line, what, f"read {found} frames")
        body.reading.problems.append(problem)


def _unit(body: Body, positions: Array) -> float:
    if body.options.unit is not None:
        return body.options.unit
    if body.stated.unit is not None:
        return body.stated.unit
    unit, why = guess_marker_unit(positions)
    body.guess("no unit stated", f"1 unit = {unit:.4g} m ({why})", "unit")
    return unit


def _up(body: Body, positions: Array) -> Up:
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
