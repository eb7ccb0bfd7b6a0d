"""The rows of numbers of a table: bulk where they are plain, strict where they are not."""

from __future__ import annotations

from array import array
from dataclasses import dataclass
from operator import itemgetter

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.asf_text import is_nan
from mocapstudio.formats.bvh_rows import LARGEST
from mocapstudio.formats.reading import Reading
from mocapstudio.formats.report import Problem
from mocapstudio.formats.table_columns import Columns
from mocapstudio.formats.table_sheet import Sheet, plain, split_cells
from mocapstudio.motion.errors import FileError

Array = NDArray[np.float64]

_NUMERIC = b"0123456789+-.eE \t,;\r\n\f\v"
_LATEST = 1e20
_ABSENT = frozenset({b"-", b"--", b"na", b"n/a", b"null", b"none", b"#n/a"})


@dataclass(frozen=True, eq=False)
class Rows:
    """The numbers of a table.

    Attributes
    ----------
    lines
        (F,) 0-based line of each row.
    values
        (F, C) numbers of the wanted columns; NaN in blank cells.
    blanks
        Whether any of them was blank or missing.
    """

    lines: NDArray[np.int64]
    values: Array
    blanks: bool


def parse_rows(
    reading: Reading, sheet: Sheet, first: int, columns: Columns, *, strict: bool
) -> Rows:
    """Read the rows from line `first` on.

    Parameters
    ----------
    reading
        The file, and where problems are told.
    sheet
        Its lines.
    first
        0-based line of the first row.
    columns
        Which cells are wanted.
    strict
        Whether a cell beyond the last column is an error.

    Raises
    ------
    FileError
        At a cell that is no number, at a last row that is cut off (unless lenient), and where
        there is no row.
    """
    return _Rows(reading, sheet, columns, strict).parse(first)


class _Rows:
    def __init__(self, reading: Reading, sheet: Sheet, columns: Columns, strict: bool) -> None:
        self.reading, self.sheet, self.strict = reading, sheet, strict
        self.columns, self.width, self.clock = columns.wanted, columns.width, columns.time
        self.pick = itemgetter(*self.columns)
        self.needed = max(self.columns) + 1
        # An array of doubles: a list of floats would weigh four times as much.
        self.values, self.lines = array("d"), array("q")
        self.short: list[int] = []
        self.odd: list[int] = []
        self.blanks = False

    def parse(self, first: int) -> Rows:
        sheet, last, pause = self.sheet, self.last_line(first), False
        for i in range(first, last + 1):
            line = sheet.line(i)
            if not line.strip(b" \t,;"):
                pause = True
                continue
            numbers = self.bulk(line)
            if numbers is None:
                if pause and self.lines and self.is_text(line):
                    self.note(i, "text after the last row", "ignored, kept in the file")
                    break
                numbers = self.strictly(line, i, last=i == last)
                if numbers is None:
                    break
            self.values.extend(numbers)
            self.lines.append(i)
        if not self.lines:
            raise self.fail(min(first, max(len(sheet) - 1, 0)), "no rows of numbers")
        self.tell()
        values = np.array(self.values).reshape(len(self.lines), len(self.columns))
        lines = np.array(self.lines, dtype=np.int64)
        # Times since 1970 in microseconds or nanoseconds are large and meant.
        limits = np.where(np.array(self.columns) == self.clock, _LATEST, LARGEST)
        large = np.abs(values) > limits
        if large.any():
            i = int(lines[np.flatnonzero(large.any(axis=1))[0]])
            raise self.fail(i, "a value is too large for a position or a time")
        return Rows(lines, values, self.blanks)

    def last_line(self, first: int) -> int:
        last = len(self.sheet) - 1
        while last > first and not self.sheet.line(last).strip(b" \t,;"):
            last -= 1
        return last

    def bulk(self, line: bytes) -> list[float] | None:
        """Numbers of a plain row, or None where anything about it is doubtful."""
        if self.sheet.decimal == b",":
            line = line.replace(b",", b".")
        cells = line.split(self.sheet.delimiter)
        if len(cells) < self.needed or (self.strict and len(cells) > self.width):
            return None
        wanted = self.pick(cells)
        if b"".join(wanted).translate(None, _NUMERIC):
            return None
        try:
            return list(map(float, wanted))
        except ValueError:
            pass
        self.blanks = True
        try:
            return [float(c) if c and not c.isspace() else np.nan for c in wanted]
        except ValueError:
            return None

    def is_text(self, line: bytes) -> bool:
        cells = [c for c in map(plain, split_cells(line, self.sheet.delimiter)) if c]
        return bool(cells) and not _is_number(cells[0])

    def strictly(self, line: bytes, i: int, *, last: bool) -> list[float] | None:
        """Numbers of a row that is not plain; None where it is cut off and may be."""
        cells = [plain(cell) for cell in split_cells(line, self.sheet.delimiter)]
        while len(cells) > self.width and not cells[-1]:
            cells.pop()
        if self.strict and len(cells) > self.width:
            raise self.fail(i, f"the row has {len(cells)} cells, its labels need {self.width}")
        if len(cells) < self.width and self.is_cut(len(cells), i, last=last):
            if self.reading.lenient and self.lines:
                self.note(i, "the last row is cut off", "left out")
                return None
            raise self.fail(i, f"cut off: the last row has {len(cells)} of {self.width} cells")
        if len(cells) < self.needed:
            if self.sheet.delimiter is None:
                raise self.fail(i, f"the row has {len(cells)} values, {self.width} are needed")
            self.short.append(i)
            self.blanks = True
            cells += [b""] * (self.needed - len(cells))
        return [self.number(cells[column], i, column) for column in self.columns]

    def is_cut(self, cells: int, i: int, *, last: bool) -> bool:
        ended = self.sheet.ends[i] < len(self.sheet.data)
        return last and not self.short and (not ended or cells < 3 or self.sheet.delimiter is None)

    def number(self, cell: bytes, i: int, column: int) -> float:
        if not cell or cell.lower() in _ABSENT:
            self.blanks = True
            return np.nan
        text = cell.replace(b",", b".") if self.sheet.decimal == b"," else cell
        if not text.translate(None, _NUMERIC):
            try:
                return float(text)
            except ValueError:
                pass
        word = cell[:24].decode(self.sheet.encoding, "replace")
        if is_nan(word):
            self.odd.append(i)
            return np.nan
        raise self.fail(i, f"{word!r} is not a number, in column {column + 1}")

    def tell(self) -> None:
        if self.short:
            many = f"{len(self.short)} rows have" if len(self.short) > 1 else "a row has"
            self.note(self.short[0], f"{many} fewer cells than others", "the rest is missing")
        if self.odd:
            many = "a cell is" if len(self.odd) == 1 else f"{len(self.odd)} cells are"
            self.note(self.odd[0], f"{many} NaN or infinite", "read as missing")

    def note(self, i: int, what: str, done: str) -> None:
        self.reading.problems.append(Problem(i + 1, what, done))

    def fail(self, i: int, cause: str) -> FileError:
        return FileError(self.reading.path, cause, line=i + 1)


def _is_number(cell: bytes) -> bool:
    try:
        float(cell.replace(b",", b"."))
    except ValueError:
        return False
    return True
