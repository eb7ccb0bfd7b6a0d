"""Where a table's rows begin, and which columns hold whose positions."""

from __future__ import annotations

import re
from collections.abc import Sequence

from mocapstudio.formats.options import Up
from mocapstudio.formats.reading import Reading
from mocapstudio.formats.report import Problem
from mocapstudio.formats.table_columns import Columns
from mocapstudio.formats.table_decimal import with_decimal
from mocapstudio.formats.table_keys import Keys, read_keys
from mocapstudio.formats.table_labels import unique_labels
from mocapstudio.formats.table_model import Head, Stated
from mocapstudio.formats.table_names import (
    POSITION,
    Leading,
    Name,
    Triple,
    leading_columns,
    named_triples,
    read_name,
    triples,
)
from mocapstudio.formats.table_sheet import Sheet
from mocapstudio.formats.units import unit_of

_NUMBER = re.compile(rb"[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][+-]?\d+)?|nan", re.IGNORECASE)
_AXIS = re.compile(r"[tdp]?([xyz])\d*", re.IGNORECASE)
_LOOKED_AT = 60
_FEWEST_CELLS = 3
_DELIMITERS = (b"\t", b";", b",", None)


def first_row(sheet: Sheet) -> tuple[Sheet, int] | None:
    """Return the sheet split as its rows are, and the first of them; None where there is none."""
    for delimiter in _DELIMITERS:
        split = sheet.split_by(delimiter)
        for i in range(min(_LOOKED_AT, len(sheet))):
            if _is_row(split, i) and (i + 1 >= len(sheet) or _is_row(split, i + 1, last=True)):
                return split, i
    return None


def read_head(reading: Reading, sheet: Sheet) -> Head:
    """Find the rows of a table and what its columns are.

    Raises
    ------
    FileError
        If there are no rows of numbers, no names above them, or no positions among them.
    """
    found = first_row(sheet)
    if found is None:
        raise reading.error(0, "no table of motion: no rows of numbers")
    sheet, first = found
    keys = read_keys(reading, sheet, first)
    sheet = with_decimal(reading, sheet, first)
    width = len(sheet.cells(first))
    whose, names_line = _positions(reading, sheet, first, keys, width)
    unnamed = names_line == keys.names_line and bool(keys.names)
    leading = _unnamed(_first_position(whose)) if unnamed else _leading(sheet, names_line, first)
    labels = unique_labels([one.base for one in whose], names_line + 1, reading.problems)
    places = tuple((one.cells["x"], one.cells["y"], one.cells["z"]) for one in whose)
    columns = Columns(
        labels, places, width, leading.frame, leading.time, leading.timecode, leading.tick
    )
    named = next((one.unit for one in whose if one.unit is not None), None)
    unit = named or keys.unit or _unit_row(sheet, first, places)
    usual: Up = "z" if keys.qualisys else "y"
    stated = Stated(keys.rate, keys.rate_span, unit, keys.frames, usual)
    return Head(columns, stated, first, sheet)


def _is_row(sheet: Sheet, i: int, *, last: bool = False) -> bool:
    cells = sheet.cells(i)
    filled = [cell for cell in cells if cell]
    if not filled:
        return last
    numbers = sum(_NUMBER.fullmatch(cell) is not None for cell in filled)
    return len(cells) >= _FEWEST_CELLS and numbers >= 0.6 * len(filled)


def _positions(
    reading: Reading, sheet: Sheet, first: int, keys: Keys, width: int
) -> tuple[list[Triple], int]:
    """Return the columns of positions, and the line of their names."""
    best: list[Triple] = []
    line = first - 1
    for i in range(first - 1, -1, -1):
        found = _stacked(sheet, i) or named_triples(sheet.words(i))
        if len(found) > len(best):
            best, line = found, i
    if not best and keys.names and 0 <= width - 3 * len(keys.names) <= 3:
        lead = width - 3 * len(keys.names)
        cells = ({"x": c, "y": c + 1, "z": c + 2} for c in range(lead, width, 3))
        pairs = zip(keys.names, cells, strict=True)
        return [Triple(name, POSITION, None, three) for name, three in pairs], keys.names_line
    at = int(sheet.starts[max(line, 0)])
    if not best:
        raise reading.error(at, "no columns of X, Y and Z of markers or joints")
    places = [one for one in best if one.kind == POSITION and max(one.cells.values()) < width]
    others = sorted({one.kind for one in best} - {POSITION})
    if not places:
        raise reading.error(at, f"no positions: it holds {' and '.join(others) or 'nothing'}")
    if others:
        what = f"columns of {' and '.join(others)}"
        reading.problems.append(Problem(line + 1, what, "not read, kept in the file"))
    return places, line


def _stacked(sheet: Sheet, i: int) -> list[Triple]:
    """Columns of a head whose axes are in line `i`, with labels above the first of every three."""
    axes = [_AXIS.fullmatch(word.strip()) for word in sheet.words(i)]
    if sum(axis is not None for axis in axes) < 3:
        return []
    starts = [c for c, axis in enumerate(axes) if axis and axis.group(1).lower() == "x"]
    above = [sheet.words(k) for k in range(max(0, i - 6), i)]
    labels = _label_row(above, starts)
    if labels is None:
        return []
    kinds = [_kind_row(row, len(axes)) for row in above]
    names: list[Name | None] = []
    label = ""
    for column, axis in enumerate(axes):
        label = (labels[column].strip() if column < len(labels) else "") or label
        kind = next((row[column] for row in kinds if row and row[column]), POSITION)
        if axis is None:
            # The fourth of a quaternion, or a column of its own.
            fourth = sheet.words(i)[column].strip().lower() == "w"
            names.append(Name(label, kind, "w") if fourth else None)
        else:
            names.append(Name(label, kind, axis.group(1).lower()))
    return triples(names)


def _label_row(above: Sequence[Sequence[str]], starts: Sequence[int]) -> Sequence[str] | None:
    """Return the row that names most of the blocks apart, the upper one of equals."""
    best: Sequence[str] | None = None
    most = 0
    for row in above:
        apart = len({row[c].strip() for c in starts if c < len(row)} - {""})
        if apart > most:
            best, most = row, apart
    return best


def _kind_row(row: Sequence[str], width: int) -> list[str] | None:
    """Return the quantity that a row such as ``Rotation,,,,Position,,,`` names in each column."""
    found: list[str] = []
    for cell in (*row, *[""] * (width - len(row))):
        name = read_name(f"_.{cell.strip()}.x") if len(cell.strip()) > 1 else None
        known = name is not None and name.base == "_"
        if cell.strip() and not known and found and any(found):
            return None
        found.append(name.kind if name is not None and known else "")
    return found if any(found) else None


def _first_position(whose: Sequence[Triple]) -> int:
    """First column that holds a position."""
    return min(cell for one in whose for cell in one.cells.values())


def _unnamed(columns: int) -> Leading:
    """Columns before the positions of a table without a row of names, as Qualisys orders them."""
    return Leading(0 if columns else None, 1 if columns > 1 else None)


def _leading(sheet: Sheet, names_line: int, first: int) -> Leading:
    """Find frame, time and timecode by their names; a time that is no number is a timecode."""
    best = Leading()
    for i in range(first):
        found = leading_columns(sheet.words(i))
        if i == names_line or (found.frame is not None and found.time is not None):
            best = found
    cells = sheet.cells(first)
    if best.time is not None and not _is_number(cells, best.time):
        best = Leading(best.frame, None, best.timecode or best.time, 1.0)
    if best.frame is not None and not _is_number(cells, best.frame):
        best = Leading(None, best.time, best.timecode, best.tick)
    return best


def _is_number(cells: Sequence[bytes], column: int) -> bool:
    return column < len(cells) and _NUMBER.fullmatch(cells[column]) is not None


def _unit_row(sheet: Sheet, first: int, places: Sequence[tuple[int, int, int]]) -> float | None:
    """Metres per unit from a row of units right above the numbers."""
    words = sheet.words(first - 1) if first else []
    units = {unit_of(words[c]) for place in places for c in place if c < len(words)}
    return units.pop() if len(units) == 1 else None
