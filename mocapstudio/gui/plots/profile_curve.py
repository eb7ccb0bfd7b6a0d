"""A distance profile as it is drawn: where its marks lie, what each place says. No Qt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mocapstudio.gui.plots.ticks import clock

if TYPE_CHECKING:
    from mocapstudio.cleaning.distance_profile import DistanceProfile, TakeDistances

F64 = NDArray[np.float64]

_LEAST_TOP = 5.0
_SHOWN = 97.0


@dataclass(frozen=True)
class Mark:
    """One of the K chosen minima.

    Parameters
    ----------
    number
        0 for the nearest neighbour.
    index
        Which take it lies in, as in `TakeDistances.index`.
    place
        Which value of that take.
    frame
        Frame of that take, fractional.
    degrees
        Distance there.
    """

    number: int
    index: int
    place: int
    frame: float
    degrees: float


def marks_of(profile: DistanceProfile) -> tuple[Mark, ...]:
    """Return the chosen minima, nearest first."""
    marks = []
    for number, at in enumerate(profile.minima):
        for part in profile.takes:
            place = int(at) - part.first
            if 0 <= place < len(part.degrees):
                frame, degrees = float(part.frames[place]), float(part.degrees[place])
                marks.append(Mark(number, part.index, place, frame, degrees))
    return tuple(marks)


def top_of(profile: DistanceProfile) -> float:
    """Upper end of an axis that shows the profile from 0 on, degrees.

    The farthest places of the context are cut off: minima are what the curve is looked at for.
    """
    every = np.concatenate([part.degrees for part in profile.takes])
    highest = float(np.percentile(every, _SHOWN)) if len(every) else 0.0
    return max(1.12 * highest, _LEAST_TOP)


def place_at(part: TakeDistances, frame: float) -> int | None:
    """Which value of a take lies at a frame, or None beyond its ends."""
    if not len(part.frames):
        return None
    each = float(part.frames[1] - part.frames[0]) if len(part.frames) > 1 else 1.0
    place = round((frame - float(part.frames[0])) / each)
    return place if 0 <= place < len(part.frames) else None


def read_out(part: TakeDistances, place: int, mark: Mark | None, choosable: bool) -> str:
    """Say take, time, the file's frame number and distance of a place, as lines."""
    frame = min(max(round(float(part.frames[place])), 0), part.take.frames - 1)
    when = f"{clock(part.take.seconds(frame))} · frame {part.take.first_frame + frame}"
    far = f"{part.degrees[place]:.1f}° root mean square joint angle from the flagged span"
    lines = [f"{part.take.name}\n{when}\n{far}"]
    if mark is not None:
        number = mark.number + 1
        use = f"click, or press {number}, to preview it" if number <= 5 else "click to preview it"
        lines.append(f"neighbour {number}: {use}" if choosable else f"neighbour {number}")
    elif part.barred[place]:
        lines.append("no neighbour: it overlaps the flagged span, or is flagged itself")
    return "\n".join(lines)


def envelope(x: F64, y: F64) -> tuple[F64, F64]:
    """Reduce a curve in pixels to what can be seen: first, lowest and highest of each column.

    Parameters
    ----------
    x, y
        (n,) pixels, x ascending.

    Returns
    -------
    The same where there are few values a column, else two values a column.
    """
    column = np.floor(x).astype(np.int64)
    if len(x) < 2 or 2 * (column[-1] - column[0] + 1) >= len(x):
        return x, y
    starts = np.flatnonzero(np.diff(column, prepend=column[0] - 1))
    low, high = np.minimum.reduceat(y, starts), np.maximum.reduceat(y, starts)
    return np.repeat(x[starts], 2), np.stack([low, high], axis=-1).ravel()
