"""Tables of markers written from their source text: only cells of changed samples are replaced."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.marker_changes import check_declared, marker_changes
from mocapstudio.formats.splicing import Splice, spliced
from mocapstudio.formats.table_layout import off_origin
from mocapstudio.formats.table_model import TableRecord
from mocapstudio.formats.table_motion import as_read
from mocapstudio.formats.table_sheet import Sheet
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.markers import MarkerTake

Array = NDArray[np.float64]

# Metres: what the last digit must tell.
_TOLD = 1e-6
_TIME_DECIMALS = 6


def patched(take: MarkerTake, declared: Sequence[Declared]) -> Iterator[bytes]:
    """Bytes of the source with the changed samples of `take` in their cells.

    Parameters
    ----------
    take
        A take that was read from a table, with the frames and markers that it had then.
    declared
        Which markers may differ from the source, over which frames.

    Raises
    ------
    MocapError
        If anything else differs, or the take does not correspond to its source.
    """
    source = take.source
    assert source is not None
    record: TableRecord = source.record
    changed = marker_changes(take, take.labels, as_read(source))
    check_declared(take, changed, declared)
    splices = list(_rate_splices(take, record))
    back = rot.conjugate(source.to_inside)
    for frame in np.flatnonzero(changed.any(axis=1)):
        line = int(record.lines[frame])
        markers = np.flatnonzero(changed[frame])
        values = rot.rotate(back, take.positions[frame, markers]) / source.unit
        cells: dict[int, bytes] = {}
        for marker, value in zip(markers, values, strict=True):
            texts = _texts(value, record, line, source.unit)
            cells.update(zip(record.columns.places[marker], texts, strict=True))
        splices += _replaced(record.sheet, line, cells)
    return spliced(record.sheet.data, sorted(splices))


def _texts(value: Array, record: TableRecord, line: int, unit: float) -> list[bytes]:
    """Cells of one position; empty, or zeros where the file writes those, where it is missing."""
    sheet = record.sheet
    cells = sheet.cells(line)
    places = [c for place in record.columns.places for c in place if c < len(cells)]
    decimals = max(math.ceil(math.log10(unit / _TOLD)), 0)
    decimals = max([decimals, *(_decimals(cells[c], sheet.decimal) for c in places)])
    if np.isnan(value).any():
        if not record.zeros and sheet.delimiter is not None:
            return [b"", b"", b""]
        value = np.zeros(3)
    else:
        value = off_origin(np.round(value, decimals) + 0.0, decimals)
    texts = (f"{number:.{decimals}f}" for number in value)
    return [text.encode().replace(b".", sheet.decimal) for text in texts]


def _decimals(cell: bytes, decimal: bytes) -> int:
    return len(cell.lower().partition(b"e")[0].partition(decimal)[2])


def _replaced(sheet: Sheet, line: int, cells: dict[int, bytes]) -> Iterator[Splice]:
    spans = sheet.spans(line)
    for column, text in cells.items():
        if column < len(spans):
            yield (*spans[column], text)
    if max(cells) >= len(spans):
        # The row leaves out cells at its end: those up to the last that is needed are added.
        assert sheet.delimiter is not None
        end = int(sheet.ends[line])
        added = [cells.get(column, b"") for column in range(len(spans), max(cells) + 1)]
        yield (end, end, b"".join(sheet.delimiter + text for text in added))


def _rate_splices(take: MarkerTake, record: TableRecord) -> Iterator[Splice]:
    """State another rate than the source's, in its head and in its times."""
    if record.own_rate is None or take.rate == record.own_rate:
        return
    sheet, column = record.sheet, record.columns.time
    if record.rate_span is not None:
        text = f"{float(take.rate):.10g}".encode().replace(b".", sheet.decimal)
        yield (*record.rate_span, text)
    if column is None:
        return
    begin = _number(sheet, int(record.lines[0]), column)
    for frame, line in enumerate(record.lines):
        spans = sheet.spans(int(line))
        if column < len(spans):
            old = sheet.data[slice(*spans[column])]
            decimals = max(_TIME_DECIMALS, _decimals(old, sheet.decimal))
            time = begin + frame / float(take.rate) / record.columns.tick
            text = f"{time:.{decimals}f}".encode().replace(b".", sheet.decimal)
            yield (*spans[column], text)


def _number(sheet: Sheet, line: int, column: int) -> float:
    cells = sheet.cells(line)
    text = cells[column].replace(sheet.decimal, b".") if column < len(cells) else b""
    try:
        return float(text)
    except ValueError:
        return 0.0
