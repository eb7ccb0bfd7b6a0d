"""Compiled reader of regular rows of decimal numbers, exact to the last bit."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

_POWERS = 10.0 ** np.arange(23)
_EXACT = 2**53


def parse_regular(
    data: bytes, start: int, end: int, columns: int, stated: int
) -> NDArray[np.float64] | None:
    """Numbers of the rows in bytes [start, end), or None where anything at all is unusual.

    Rows are lines of exactly `columns` numbers; blank lines are skipped. Numbers are correctly
    rounded, as `float` does it: up to 15 digits and powers of ten up to 22 are exact in doubles
    (Clinger 1990), anything longer is left to the caller.

    Returns
    -------
    (rows, columns), where rows may differ from `stated`, or None.
    """
    # A row takes two bytes a value at least, so a stated billion of frames allocates nothing.
    rows = min(stated, (end - start + 1) // (2 * columns)) + 1
    values = np.empty(rows * columns)
    text = np.frombuffer(data, dtype=np.uint8)
    found = _parse(text, start, end, columns, values, _POWERS)
    if found < 0:
        return None
    return values[:found].reshape(-1, columns)


@njit(cache=True, nogil=True)
def _mantissa(text, at, end):  # type: ignore[no-untyped-def]
    """Digits at a byte: where they end, their number, its power of ten; -1 where none or many."""
    mantissa, digits, scale, seen, point = 0, 0, 0, 0, False
    while at < end:
        byte = text[at]
        if 48 <= byte <= 57:
            mantissa = mantissa * 10 + (byte - 48)
            seen += 1
            digits += 1 if mantissa > 0 else 0
            scale -= 1 if point else 0
            if digits > 18:
                return -1, 0, 0
        elif byte == 46 and not point:
            point = True
        else:
            break
        at += 1
    if seen == 0 or mantissa > _EXACT:
        return -1, 0, 0
    return at, mantissa, scale


@njit(cache=True, nogil=True)
def _exponent(text, at, end):  # type: ignore[no-untyped-def]
    """The exponent at a byte, if there is one: where it ends (-1 where broken), and its value."""
    if at == end or not (text[at] == 101 or text[at] == 69):
        return at, 0
    at += 1
    minus = at < end and text[at] == 45
    if at < end and (text[at] == 45 or text[at] == 43):
        at += 1
    exponent, places = 0, 0
    while at < end and 48 <= text[at] <= 57 and places < 4:
        exponent = exponent * 10 + (text[at] - 48)
        places += 1
        at += 1
    return (at if places else -1), (-exponent if minus else exponent)


@njit(
    "int64(Array(uint8, 1, 'C', readonly=True), int64, int64, int64, float64[::1], float64[::1])",
    cache=True,
    nogil=True,
)
def _parse(text, start, end, columns, values, powers):  # type: ignore[no-untyped-def]
    count, in_row, at = 0, 0, start
    while at < end:
        byte = text[at]
        if byte == 32 or byte == 9:
            at += 1
            continue
        if byte == 10 or byte == 13:
            if in_row != 0 and in_row != columns:
                return -1
            in_row = 0
            at += 1
            continue
        if count == values.size or in_row == columns:
            return -1
        negative = byte == 45
        if byte == 45 or byte == 43:
            at += 1
        at, mantissa, scale = _mantissa(text, at, end)
        if at < 0:
            return -1
        at, exponent = _exponent(text, at, end)
        if at < 0 or (at < end and not (text[at] == 32 or 9 <= text[at] <= 13)):
            return -1
        scale += exponent
        if scale < -22 or scale > 22:
            if mantissa != 0:
                return -1
            scale = 0
        value = mantissa / powers[-scale] if scale < 0 else mantissa * powers[scale]
        values[count] = -value if negative else value
        count += 1
        in_row += 1
    if in_row != 0 and in_row != columns:
        return -1
    return count
