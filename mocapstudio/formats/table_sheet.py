"""A text file as rows of cells, each of which knows where it stands in the bytes."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.reading import Reading
from mocapstudio.formats.report import Problem

Span = tuple[int, int]

_BOM = b"\xef\xbb\xbf"
_WIDE = (b"\xff\xfe", b"\xfe\xff")


@dataclass(frozen=True, eq=False)
class Sheet:
    """The lines of a text file and how their cells are set apart.

    Attributes
    ----------
    data
        The file's bytes.
    starts, ends
        (L,) byte at which each line begins, and past its last one without the line's end.
    delimiter
        What stands between cells, or None for any white space.
    decimal
        ``b"."`` or ``b","``.
    encoding
        Of the words.
    """

    data: bytes
    starts: NDArray[np.int64]
    ends: NDArray[np.int64]
    delimiter: bytes | None = b"\t"
    decimal: bytes = b"."
    encoding: str = "utf-8"

    def __len__(self) -> int:
        return len(self.starts)

    def line(self, i: int) -> bytes:
        """Bytes of 0-based line `i` without its end."""
        return self.data[self.starts[i] : self.ends[i]]

    def cells(self, i: int) -> list[bytes]:
        """Cells of line `i`, without the white space and quotes around them."""
        return [plain(cell) for cell in split_cells(self.line(i), self.delimiter)]

    def words(self, i: int) -> list[str]:
        """Cells of line `i` as text."""
        return [cell.decode(self.encoding, "replace") for cell in self.cells(i)]

    def spans(self, i: int) -> list[Span]:
        """Bytes of what stands in each cell of line `i`; an empty one is where it would stand."""
        line, at, found = self.line(i), int(self.starts[i]), []
        if self.delimiter is None:
            for cell in line.split():
                at = self.data.index(cell, at)
                found.append((at, at + len(cell)))
                at += len(cell)
            return found
        for cell in split_cells(line, self.delimiter):
            inner = plain(cell)
            start = at + cell.index(inner) if inner else at
            found.append((start, start + len(inner)))
            at += len(cell) + len(self.delimiter)
        return found

    def split_by(self, delimiter: bytes | None) -> Sheet:
        """Return the same lines with cells set apart otherwise."""
        return replace(self, delimiter=delimiter)


def plain(cell: bytes) -> bytes:
    """Return a cell without the white space and the quotes around it."""
    cell = cell.strip()
    if len(cell) > 1 and cell[:1] == cell[-1:] == b'"':
        cell = cell[1:-1].strip()
    return cell


def split_cells(line: bytes, delimiter: bytes | None) -> list[bytes]:
    """Split a line; a delimiter within quotes sets nothing apart."""
    if delimiter is None:
        return line.split()
    pieces = line.split(delimiter)
    if b'"' not in line:
        return pieces
    cells: list[bytes] = []
    for piece in pieces:
        # A cell with an odd number of quotes is still open.
        if cells and cells[-1].count(b'"') % 2:
            cells[-1] += delimiter + piece
        else:
            cells.append(piece)
    return cells


def open_sheet(reading: Reading) -> Sheet:
    """Find the lines of a file, and tell of its encoding.

    Raises
    ------
    FileError
        If it is UTF-16, which has no bytes that could be kept cell by cell.
    """
    data = reading.data
    if data.startswith(_WIDE) or b"\x00" in data[:512]:
        raise reading.error(0, "UTF-16 or binary bytes: save it as UTF-8 text")
    first = len(_BOM) if data.startswith(_BOM) else 0
    if first:
        reading.problems.append(Problem(1, "byte order mark", "skipped, kept in the file"))
    encoding = "utf-8"
    try:
        data[first:].decode(encoding)
    except UnicodeDecodeError as bad:
        line = reading.line(first + bad.start)
        what = "bytes that are not UTF-8"
        reading.problems.append(Problem(line, what, "read as Latin-1, kept in the file"))
        encoding = "latin-1"
    lines = data.splitlines(keepends=True)
    lengths = np.array([len(line) for line in lines], dtype=np.int64)
    bare = np.array([len(line.rstrip(b"\r\n")) for line in lines], dtype=np.int64)
    starts = np.concatenate([[0], np.cumsum(lengths)[:-1]]) if lines else np.zeros(0, np.int64)
    ends = starts + bare
    if first and len(starts):
        starts[0] = first
    return Sheet(data, starts, ends, encoding=encoding)
