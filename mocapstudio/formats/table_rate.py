"""Frames a second of a table: what the user, its head and its column of times say."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.table_model import Body
from mocapstudio.formats.table_sheet import Sheet
from mocapstudio.formats.table_times import Clock, can_resample, departure, read_clock
from mocapstudio.motion.errors import NoRateError

Array = NDArray[np.float64]

_MOST_DECIMALS = 9


def read_rate(body: Body, sheet: Sheet) -> tuple[Fraction, Fraction | None, bool]:
    """Tell the rate of a table from the options, its head and its times, in this order.

    Returns
    -------
    rate
        Frames a second.
    own_rate
        What the text itself tells, or None.
    moved
        Whether rows must be put where their times say.

    Raises
    ------
    NoRateError
        If nothing tells the rate.
    """
    stated, times = body.stated.rate, body.times
    resolution = _resolution(body, sheet)
    clock = Clock(None, why="no times") if times is None else read_clock(times, resolution)
    own = stated or clock.rate
    if body.options.fps is not None:
        return body.options.fps, own, False
    if own is None:
        raise NoRateError(body.reading.path, f"no frame rate ({clock.why}): --fps tells it")
    if stated is None:
        return own, own, _must_move(body, own, clock)
    if times is None or _agrees(times, stated, resolution):
        return stated, own, False
    if clock.rate is None or clock.uniform:
        what = clock.why or f"times tell {float(clock.rate or 0):.6g} frames a second"
        body.note(None, f"{what}, the head {float(stated):.6g}", "the head counts", "fps")
        return stated, own, False
    return stated, own, _must_move(body, stated, clock)


def _agrees(times: Array, rate: Fraction, resolution: float) -> bool:
    step = 1 / float(rate)
    return bool(np.isfinite(times).all()) and departure(times, step) <= 0.1 * step + resolution


def _must_move(body: Body, rate: Fraction, clock: Clock) -> bool:
    if clock.uniform:
        return False
    assert body.times is not None
    what = f"times are not even: up to {clock.departure:.3g} s from {float(rate):.6g} a second"
    if can_resample(body.times, rate):
        body.note(None, what, "rows put where their times say, linearly; --fps keeps them", "fps")
        return True
    body.note(None, what, "rows taken as they are", "fps")
    return False


def _resolution(body: Body, sheet: Sheet) -> float:
    """Seconds of the last digit with which times are written."""
    column = body.columns.time
    if column is None:
        return 0.0
    cells = [sheet.cells(int(i)) for i in body.rows.lines[:20]]
    texts = [row[column].lower() for row in cells if len(row) > column]
    if not texts or any(b"e" in text for text in texts):
        return 0.0
    decimals = max(len(text.partition(sheet.decimal)[2]) for text in texts)
    return float(10.0 ** -min(decimals, _MOST_DECIMALS)) * body.tick
