"""From the frame time that a file states to frames a second, and back."""

from __future__ import annotations

import re
from fractions import Fraction

from mocapstudio.formats.report import Problem

NO_RATE = Fraction(100)
"""Frames a second where a file states none: the rate of the inertial suits that do so."""

_WHOLE_RATES = (120, 60, 30, 24, 25, 50, 100, 240, 200, 48, 90, 150, 250, 300, 500, 1000, 125, 360)
USUAL_RATES = (
    *map(Fraction, _WHOLE_RATES),
    *(Fraction(nominal * 1000, 1001) for nominal in (120, 60, 30, 24, 240)),
)
"""Frames a second of cameras and suits, the likelier ones first."""

# Seconds a frame (or milliseconds, or frames a second, where a file mistakes them).
_SHORTEST, _LONGEST = 1e-5, 1000.0


def rate_from_frame_time(text: str) -> Fraction:
    """Frames a second from a frame time as it is written.

    A usual rate counts as meant where its frame time, rounded or cut off to the decimals that are
    written, is the one written: ``.0083333`` is 120, ``0.008342`` is 120000/1001.

    Parameters
    ----------
    text
        A positive decimal number of seconds.
    """
    exact = Fraction(text)
    _, _, decimals = text.lower().partition("e")[0].partition(".")
    exponent = text.lower().partition("e")[2]
    ulp = Fraction(10) ** (int(exponent or 0) - len(decimals))
    if Fraction(1) / exact in USUAL_RATES:
        return 1 / exact
    near = [r for r in USUAL_RATES if round(1 / r / ulp) * ulp == exact]
    near += [r for r in USUAL_RATES if 1 / r // ulp * ulp == exact]
    if near and abs(near[0] * exact - 1) < Fraction(1, 20):
        return near[0]
    whole = round(1 / exact)
    if whole and round(Fraction(1, whole) / ulp) * ulp == exact:
        return Fraction(whole)
    close = [r for r in USUAL_RATES if abs(1 / r - exact) <= min(ulp, exact / 20_000)]
    return close[0] if close else (1 / exact).limit_denominator(1001)


def stated_rate(text: str, line: int | None = None) -> tuple[Fraction, Problem | None]:
    """Frames a second that a frame time as written stands for, and what was odd about it.

    Parameters
    ----------
    text
        As in the file; empty where the file states none.
    line
        1-based line of it, for the problem.

    Raises
    ------
    ValueError
        If the text is not a number at all.
    """
    if not text:
        return NO_RATE, _rate_problem(line, "'Frame Time:' is missing", NO_RATE)
    dotted = text.replace(",", ".")
    if not re.fullmatch(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,3})?", dotted):
        raise ValueError(f"'Frame Time: {text}' is not a number")
    value = float(dotted)
    what = f"'Frame Time: {text}'"
    if not _SHORTEST <= value <= _LONGEST:
        return NO_RATE, _rate_problem(line, f"{what} is no duration of a frame", NO_RATE)
    if value in (24, 25, 30, 50, 60, 100, 120, 240):
        rate = Fraction(int(value))
        return rate, _rate_problem(line, f"{what} looks like frames a second", rate)
    if value > 2:
        rate = rate_from_frame_time(f"{value / 1000:.9g}")
        return rate, _rate_problem(line, f"{what} looks like milliseconds", rate)
    return rate_from_frame_time(dotted), None


def _rate_problem(line: int | None, what: str, rate: Fraction) -> Problem:
    return Problem(line, what, f"guessed {float(rate):g} frames a second", "fps", guess=True)


def frame_time(rate: Fraction) -> str:
    """Seconds a frame lasts, with the digits from which `stated_rate` tells the rate again."""
    whole = f"{float(1 / rate):.12f}"
    short = whole.rstrip("0").ljust(8, "0")
    # Few digits may stand for a usual or whole rate as well.
    return short if rate_from_frame_time(short) == rate else whole
