"""Tables of positions (CSV, TSV): from a file's bytes to a marker take and an import report."""

from __future__ import annotations

from pathlib import Path

from mocapstudio.formats.options import ReadOptions
from mocapstudio.formats.reading import Reading
from mocapstudio.formats.report import ImportReport
from mocapstudio.formats.table_header import first_row, read_head
from mocapstudio.formats.table_motion import marker_take
from mocapstudio.formats.table_names import named_triples
from mocapstudio.formats.table_sheet import open_sheet
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.markers import MarkerTake


def looks_like_csv(head: bytes) -> bool:
    """Tell a table with commas or semicolons between its cells by its first bytes."""
    return _delimiter(head) in (b",", b";")


def looks_like_tsv(head: bytes) -> bool:
    """Tell a table with tabs or spaces between its cells by its first bytes."""
    return _delimiter(head) in (b"\t", b" ")


def read_csv(
    path: Path, data: bytes, options: ReadOptions
) -> tuple[list[MarkerTake], ImportReport]:
    """Read the positions of markers or joints in a CSV.

    Raises
    ------
    FileError
        Where no names and rows of positions are found, or a row is not what it should be.
    NoRateError
        If neither the file nor the options tell frames a second.
    """
    return _read(path, data, options, "csv")


def read_tsv(
    path: Path, data: bytes, options: ReadOptions
) -> tuple[list[MarkerTake], ImportReport]:
    """Read the positions of markers or joints in a TSV, such as those of Qualisys.

    Raises
    ------
    FileError, NoRateError
        As `read_csv`.
    """
    return _read(path, data, options, "tsv")


def _read(
    path: Path, data: bytes, options: ReadOptions, form: str
) -> tuple[list[MarkerTake], ImportReport]:
    reading = Reading(path, data, options.lenient, [])
    take = marker_take(reading, read_head(reading, open_sheet(reading)), options, form)
    problems = sorted(reading.problems, key=lambda p: (p.guess, p.line or 0))
    return [take], ImportReport(path, form, tuple(dict.fromkeys(problems)))


def _delimiter(head: bytes) -> bytes | None:
    """Return what stands between the cells of a table of motion, or None where it is none."""
    reading = Reading(Path(), head, True, [])
    try:
        found = first_row(open_sheet(reading))
    except FileError:
        return None
    if found is None:
        return None
    sheet, first = found
    named = any(named_triples(sheet.words(i)) for i in range(first))
    stacked = any(sheet.cells(i).count(b"X") > 0 for i in range(first))
    return (sheet.delimiter or b" ") if named or stacked else None
