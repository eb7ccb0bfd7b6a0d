"""Which sign stands between whole numbers and decimals in the rows of a table."""

from __future__ import annotations

import re
from dataclasses import replace

from mocapstudio.formats.reading import Reading
from mocapstudio.formats.report import Problem
from mocapstudio.formats.table_sheet import Sheet

_WITH_COMMA = re.compile(rb"[+-]?\d*,\d+(?:[eE][+-]?\d+)?")


def with_decimal(reading: Reading, sheet: Sheet, first: int) -> Sheet:
    """Return the sheet with the decimal sign of the rows from line `first` on."""
    if sheet.delimiter == b"," or first >= len(sheet):
        return sheet
    for i in range(first, len(sheet)):
        if b"," not in sheet.line(i):
            continue
        if b"." in sheet.line(i) or not any(map(_WITH_COMMA.fullmatch, sheet.cells(i))):
            return sheet
        reading.problems.append(Problem(i + 1, "decimal commas", "read as decimal points"))
        return replace(sheet, decimal=b",")
    return sheet
