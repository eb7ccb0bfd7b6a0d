"""The head of a TRC: its keywords and values, and the labels of its markers."""

from __future__ import annotations

import re
from collections.abc import Sequence
from fractions import Fraction

from mocapstudio.formats.options import parse_rate
from mocapstudio.formats.reading import Reading
from mocapstudio.formats.report import Problem
from mocapstudio.formats.table_columns import Columns
from mocapstudio.formats.table_labels import unique_labels
from mocapstudio.formats.table_model import Head, Stated
from mocapstudio.formats.table_sheet import Sheet, Span
from mocapstudio.formats.units import unit_of
from mocapstudio.motion.errors import ParameterError

_LABELS = re.compile(rb'\s*"?frame\s*#?"?[\s,;]', re.IGNORECASE)
_AXIS = re.compile(r"[xyz]\d*", re.IGNORECASE)
_LOOKED_AT = 40
_LEADING = 2


def read_head(reading: Reading, sheet: Sheet) -> Head:
    """Read the lines above the first row; any but the one with the labels may be absent.

    Raises
    ------
    FileError
        If there is no line of labels, which begins with ``Frame#``, or no marker.
    """
    at = _labels_line(sheet)
    if at is None:
        raise reading.error(0, "not TRC: no line of labels, which begins with Frame#")
    tabs = b"\t" in sheet.line(at)
    names = sheet.split_by(b"\t" if tabs else None).words(at)[_LEADING:]
    if not tabs:
        problem = Problem(at + 1, "labels are set apart by spaces", "each word is one label")
        reading.problems.append(problem)
    first, axes = _first_row(sheet, at)
    body = sheet.split_by(b"\t" if first < len(sheet) and b"\t" in sheet.line(first) else None)
    if body.delimiter is None and tabs:
        reading.problems.append(Problem(first + 1, "cells are set apart by spaces", "split there"))
    keys = _keywords(sheet, at)
    markers = _marker_names(names)
    in_rows = _width(body, first)
    markers = _fitted(reading, markers, in_rows, axes, keys, at)
    if not markers:
        raise reading.error(int(sheet.starts[at]), "no markers: no labels after Frame# and Time")
    _tell_of_count(reading, keys, len(markers))
    places = tuple((c, c + 1, c + 2) for c in range(_LEADING, _LEADING + 3 * len(markers), 3))
    columns = Columns(
        unique_labels(markers, at + 1, reading.problems), places, places[-1][2] + 1, 0, 1
    )
    return Head(columns, _stated(reading, keys), first, body)


def _labels_line(sheet: Sheet) -> int | None:
    some = range(min(_LOOKED_AT, len(sheet)))
    return next((i for i in some if _LABELS.match(sheet.line(i) + b"\t")), None)


def _first_row(sheet: Sheet, at: int) -> tuple[int, int]:
    """Line of the first row, and the number of axes that the line between names."""
    axes = 0
    for i in range(at + 1, len(sheet)):
        words = sheet.line(i).decode(sheet.encoding, "replace").replace(",", " ").split()
        if not words:
            continue
        if all(_AXIS.fullmatch(word) for word in words):
            axes = max(axes, len(words))
            continue
        return i, axes
    return len(sheet), axes


Keywords = dict[str, tuple[str, int, Span]]
"""Value, 0-based line and bytes of what each keyword (lower case) states."""


def _keywords(sheet: Sheet, labels: int) -> Keywords:
    found: Keywords = {}
    for i in range(labels - 1):
        if not sheet.line(i).lower().lstrip(b'\xef\xbb\xbf "').startswith(b"datarate"):
            continue
        tabs = b"\t" in sheet.line(i) and b"\t" in sheet.line(i + 1)
        split = sheet.split_by(b"\t" if tabs else None)
        for name, value, span in zip(
            split.words(i), split.words(i + 1), split.spans(i + 1), strict=False
        ):
            if name and value:
                found.setdefault(name.lower(), (value, i + 1, span))
    return found


def _marker_names(cells: Sequence[str]) -> list[str]:
    """Labels of a line whose cells are one or three a marker."""
    cells = list(cells)
    while cells and not cells[-1]:
        cells.pop()
    padded = cells + [""] * (-len(cells) % 3)
    by_three = [padded[i : i + 3] for i in range(0, len(padded), 3)]
    if all(not b and not c for _, b, c in by_three):
        return [a for a, _, _ in by_three]
    if all(a == b == c for a, b, c in by_three):
        return [a for a, _, _ in by_three]
    return [cell for cell in cells if cell]


def _width(body: Sheet, first: int) -> int:
    """Count the markers whose cells the first row has."""
    if first >= len(body):
        return 0
    cells = body.cells(first)
    while cells and not cells[-1]:
        cells.pop()
    return max(0, -((_LEADING - len(cells)) // 3))


def _fitted(
    reading: Reading, names: list[str], in_rows: int, axes: int, keys: Keywords, at: int
) -> list[str]:
    """Return as many names as there are markers."""
    if len(names) == in_rows or in_rows == 0:
        return names
    if axes % 3 == 0 and axes // 3 == in_rows and len(names) > in_rows:
        what = f"{len(names)} labels, but {in_rows} markers"
        reading.problems.append(Problem(at + 1, what, "labels cannot be told apart: numbered"))
        return [f"marker {i}" for i in range(1, in_rows + 1)]
    return names + [""] * (in_rows - len(names))


def _tell_of_count(reading: Reading, keys: Keywords, markers: int) -> None:
    if "nummarkers" not in keys:
        return
    text, line, _ = keys["nummarkers"]
    if _whole(text) != markers:
        what = f"NumMarkers {text[:24]}, but {markers} markers"
        reading.problems.append(Problem(line + 1, what, f"read {markers} markers"))


def _stated(reading: Reading, keys: Keywords) -> Stated:
    rate, rate_span = _rate(reading, keys)
    frames = None
    if "numframes" in keys:
        text, line, _ = keys["numframes"]
        count = _whole(text)
        if count is None:
            what = f"NumFrames {text[:24]!r} is no number of frames"
            reading.problems.append(Problem(line + 1, what, "rows are counted"))
        else:
            frames = (count, "NumFrames", line + 1)
    unit = None
    if "units" in keys:
        text, line, _ = keys["units"]
        unit = unit_of(text)
        if unit is None:
            problem = Problem(line + 1, f"Units {text[:24]!r} is no unit", "ignored", "unit")
            reading.problems.append(problem)
    return Stated(rate, rate_span, unit, frames)


def _rate(reading: Reading, keys: Keywords) -> tuple[Fraction | None, Span | None]:
    for name in ("datarate", "camerarate"):
        if name not in keys:
            continue
        text, line, span = keys[name]
        try:
            return parse_rate(text.replace(",", ".")), span
        except ParameterError:
            what = f"{text[:24]!r} is no frame rate"
            reading.problems.append(Problem(line + 1, what, "ignored", "fps"))
    return None, None


def _whole(text: str) -> int | None:
    if re.fullmatch(r"\d{1,12}([.,]0*)?", text):
        return int(re.split("[.,]", text)[0])
    return None
