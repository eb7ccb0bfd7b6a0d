"""TRC: from a file's bytes to a marker take and an import report."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

from mocapstudio.formats.options import ReadOptions
from mocapstudio.formats.reading import Reading
from mocapstudio.formats.report import ImportReport
from mocapstudio.formats.table_decimal import with_decimal
from mocapstudio.formats.table_motion import marker_take
from mocapstudio.formats.table_sheet import open_sheet
from mocapstudio.formats.trc_header import read_head
from mocapstudio.motion.markers import MarkerTake

_BEGINS = re.compile(rb"(?:\xef\xbb\xbf)?\s*\"?(?:PathFileType\b|DataRate\b)", re.IGNORECASE)


def looks_like_trc(head: bytes) -> bool:
    """Tell TRC by its first bytes."""
    return _BEGINS.match(head) is not None


def read_trc(
    path: Path, data: bytes, options: ReadOptions
) -> tuple[list[MarkerTake], ImportReport]:
    """Read the markers of a TRC, as Cortex and OpenSim write it and as others do.

    Raises
    ------
    FileError
        Where the bytes are no TRC, are cut off or hold values that are no numbers.
    """
    reading = Reading(path, data, options.lenient, [])
    head = read_head(reading, open_sheet(reading))
    sheet = with_decimal(reading, head.sheet, head.first)
    take = marker_take(reading, replace(head, sheet=sheet), options, "trc")
    problems = sorted(reading.problems, key=lambda p: (p.guess, p.line or 0))
    return [take], ImportReport(path, "trc", tuple(dict.fromkeys(problems)))
