"""The rows of a MOTION section: where they stand, and the strict parser of their numbers."""

from __future__ import annotations

import re
from array import array
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.reading import Reading
from mocapstudio.formats.report import Problem
from mocapstudio.motion.errors import FileError

Array = NDArray[np.float64]
Span = tuple[int, int]

LARGEST = 1e12
"""Beyond it a number of a motion file is damage: squares of it no longer add up."""

_NUMERIC = b"0123456789+-.eE \t\r\n\f\v"
_FUSED = re.compile(rb"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_PLAIN = re.compile(rb"[^\s,]+")
_COMMA = re.compile(rb"\S+")


@dataclass(frozen=True)
class MotionBlock:
    """Where the parts of one MOTION section stand in the file's bytes.

    Attributes
    ----------
    frames
        Rows read.
    columns
        Values in a row.
    frame_time
        As written, empty where absent.
    section
        Byte after the keyword MOTION.
    frames_span, frame_time_span
        Bytes of those two numbers.
    start, end
        Bytes of the rows.
    line
        1-based line of `start`.
    regular
        True where each row is one line.
    decimal
        ``b"."`` or ``b","``.
    fused
        True where numbers touch, as in ``0.0-7.509``.
    """

    frames: int
    columns: int
    frame_time: str
    section: int
    frames_span: Span
    frame_time_span: Span
    start: int
    end: int
    line: int
    regular: bool = True
    decimal: bytes = b"."
    fused: bool = False

    @property
    def cell(self) -> re.Pattern[bytes]:
        """The pattern of one number."""
        if self.fused:
            return _FUSED
        return _COMMA if self.decimal == b"," else _PLAIN


def is_sane(numbers: Array) -> bool:
    """Tell whether every number is one that a motion may hold."""
    return bool(numbers.min() >= -LARGEST and numbers.max() <= LARGEST)


def parse_rows(
    reading: Reading, head: MotionBlock, end: int, stated: int
) -> tuple[MotionBlock, Array]:
    """Read the rows in bytes [head.start, end), exact about what is wrong and where.

    Returns
    -------
    block
        `head` with what the rows turned out to be like.
    numbers
        (rows, columns), where rows is `stated` unless the reading is lenient.

    Raises
    ------
    FileError
        At the line of whatever is no whole row of numbers.
    """
    return _Rows(reading, head, end, stated).parse()


class _Rows:
    def __init__(self, reading: Reading, head: MotionBlock, end: int, stated: int) -> None:
        self.reading, self.head, self.stated = reading, head, stated
        self.end = end
        # An array of doubles: a list of floats would weigh four times as much.
        self.values = array("d")
        self.ends: list[int] = []
        self.lines: list[int] = []
        self.decimal, self.fused = b".", False

    def parse(self) -> tuple[MotionBlock, Array]:
        columns = self.head.columns
        text = self.reading.data[self.head.start : self.end]
        if b"," in text:
            text = self.without_commas(text)
        self.read_lines(text)
        count = self.count_rows()
        if count == 0:
            raise self.fail(self.head.line, "no frames: the motion is empty")
        numbers = np.array(self.values)[: count * columns].reshape(count, columns)
        if not is_sane(numbers):
            row = int(np.flatnonzero(~(np.abs(numbers) <= LARGEST).all(axis=1))[0])
            line = self.lines[int(np.searchsorted(self.ends, row * columns, side="right"))]
            raise self.fail(line, "a value is too large for an angle or a position")
        regular = self.ends == list(range(columns, len(self.values) + 1, columns))
        if not regular and len(self.values) == count * columns:
            self.note(self.head.line, "rows are broken over several lines", "read as whole rows")
        block = replace(
            self.head, end=self.end, regular=regular, decimal=self.decimal, fused=self.fused
        )
        return block, numbers

    def without_commas(self, text: bytes) -> bytes:
        if b"." in text:
            self.note(self.head.line, "values are separated by commas", "read as separate values")
            return text.replace(b",", b" ")
        self.decimal = b","
        self.note(self.head.line, "decimal commas", "read as decimal points")
        return text.replace(b",", b".")

    def read_lines(self, text: bytes) -> None:
        for number, line in enumerate(text.splitlines(), self.head.line):
            cells = line.split()
            if not cells:
                continue
            try:
                self.values.extend(self.floats(cells, line))
            except _CellError as bad:
                if len(self.values) == self.stated * self.head.columns and bad.column == 0:
                    self.trailing(number, text)
                    return
                raise self.fail(number, f"{bad.what} in column {bad.column + 1}") from None
            self.ends.append(len(self.values))
            self.lines.append(number)

    def floats(self, cells: list[bytes], line: bytes) -> list[float]:
        if not line.translate(None, _NUMERIC):
            try:
                return list(map(float, cells))
            except ValueError:
                pass
        values: list[float] = []
        for cell in cells:
            parts = _FUSED.findall(cell)
            split_at_signs = all(part[:1] in b"+-" for part in parts[1:])
            if not parts or b"".join(parts) != cell or not split_at_signs:
                raise _CellError(_what(cell), len(values))
            self.fused = self.fused or len(parts) > 1
            values += map(float, parts)
        return values

    def trailing(self, number: int, text: bytes) -> None:
        lines = text.splitlines(keepends=True)
        self.end = self.head.start + sum(map(len, lines[: number - self.head.line]))
        self.note(number, "text after the last row", "ignored, kept in the file")

    def count_rows(self) -> int:
        columns, total = self.head.columns, len(self.values)
        ends = set(self.ends)
        # A row must start on a fresh line: a value missing here and one too many there is no break.
        broken = next((n for n in range(columns, total + 1, columns) if n not in ends), None)
        if broken is None and total % columns == 0:
            rows = total // columns
            if rows == self.stated or self.reading.lenient:
                return rows
            line = self.reading.line(self.head.frames_span[0])
            raise self.fail(line, f"'Frames: {self.stated}', but there are {rows} rows")
        at = next(
            i
            for i, (a, b) in enumerate(zip([0, *self.ends], self.ends, strict=False))
            if b - a != columns
        )
        has = self.ends[at] - ([0, *self.ends][at])
        if at == len(self.ends) - 1 and has < columns:
            if self.reading.lenient:
                self.note(self.lines[at], "the last row is cut off", "left out")
                return total // columns
            raise self.fail(self.lines[at], f"cut off: the last row has {has} of {columns} values")
        raise self.fail(self.lines[at], f"the row has {has} values, its joints need {columns}")

    def note(self, line: int, what: str, done: str) -> None:
        self.reading.problems.append(Problem(line, what, done))

    def fail(self, line: int, cause: str) -> FileError:
        return FileError(self.reading.path, cause, line=line)


class _CellError(Exception):
    def __init__(self, what: str, column: int) -> None:
        self.what, self.column = what, column
        super().__init__(what)


def _what(cell: bytes) -> str:
    word = cell[:24].decode("latin-1")
    if cell.lower().lstrip(b"+-").startswith((b"nan", b"inf", b"1.#", b"-1.#")):
        return f"{word} instead of a number"
    return f"{word!r} is not a number,"
