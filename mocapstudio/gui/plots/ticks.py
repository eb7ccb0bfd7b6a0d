"""Where the marks of an axis stand and what they say. No Qt."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

_STEPS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 1200, 1800, 3600)


@dataclass(frozen=True)
class Tick:
    """One mark: its frame (not rounded), and its time in words, or "" for a minor mark."""

    frame: float
    label: str


def time_ticks(start: float, end: float, rate: float, most: int) -> list[Tick]:
    """Marks at round seconds between two frames, at most about `most` of them labelled.

    Parameters
    ----------
    start, end
        Visible frames.
    rate
        Frames a second.
    most
        How many labels there is room for.
    """
    first, last = start / rate, end / rate
    wanted = (last - first) / max(most, 1)
    step = next((s for s in _STEPS if s >= wanted), _STEPS[-1] * np.ceil(wanted / _STEPS[-1]))
    minor = step / (5 if f"{step:g}"[0] in "15" else 4 if f"{step:g}"[0] in "2" else 3)
    per_major = round(step / minor)
    ticks = []
    for number in range(int(np.ceil(first / minor)), int(np.floor(last / minor)) + 1):
        labelled = number % per_major == 0
        seconds = number * minor
        ticks.append(Tick(seconds * rate, clock(seconds, step) if labelled else ""))
    return ticks


def clock(seconds: float, step: float = 0.01) -> str:
    """Seconds as ``12.5 s``, from a minute on as ``1:12.5``; decimals as fine as `step`."""
    decimals = 0 if step >= 1 else 1 if step >= 0.1 else 2
    seconds = round(seconds, decimals) + 0.0
    if seconds < 60:
        return f"{seconds:.{decimals}f} s"
    minutes, rest = divmod(seconds, 60)
    width = 2 if decimals == 0 else 3 + decimals
    return f"{int(minutes)}:{rest:0{width}.{decimals}f}"


def value_ticks(low: float, high: float, most: int) -> list[tuple[float, str]]:
    """Round values between two, with their text; about `most` of them."""
    if not high > low:
        return []
    wanted = (high - low) / max(most, 1)
    power = 10.0 ** np.floor(np.log10(wanted))
    step = next(s * power for s in (1, 2, 5, 10) if s * power >= wanted * (1 - 1e-9))
    decimals = max(0, -int(np.floor(np.log10(step) + 1e-9)))
    numbers = range(int(np.ceil(low / step)), int(np.floor(high / step)) + 1)
    return [(n * step, f"{n * step + 0.0:.{decimals}f}".replace("-", "−")) for n in numbers]
