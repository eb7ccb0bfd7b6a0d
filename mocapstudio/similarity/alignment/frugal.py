"""The cheapest path of long performances in memory that grows with their length (Hirschberg).

The path is cut where it crosses the middle of the reference: there the sum of the cheapest way
from its beginning and the cheapest way to its end is smallest. Each half is cut again until it is
small. That costs twice the time of the whole matrix, at none of its memory.
"""

from __future__ import annotations

from collections.abc import Generator

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.progress import Progress
from mocapstudio.similarity.alignment.costs import Costs
from mocapstudio.similarity.alignment.dtw import (
    CLOSED,
    Alignment,
    Ends,
    Path,
    accumulated,
    aligning,
    last_cell,
)

F32 = NDArray[np.float32]

CELLS = 4_000_000
"""Pairs that are aligned at once."""


def aligning_frugally(
    costs: Costs, ends: Ends = CLOSED, cells: int = CELLS
) -> Generator[Progress, None, Alignment]:
    """Find the cheapest path and yield progress; memory grows with the sum of the lengths.

    Parameters
    ----------
    cells
        Pairs whose accumulated costs may be held at once.
    """
    first, last = (0, 0), (costs.shape[0] - 1, costs.shape[1] - 1)
    if ends.end is not None:
        bottom, right = yield from _last(costs, Ends(ends.begin), 0.0, 0.2)
        last = last_cell(bottom, right, ends)
    if ends.begin is not None:
        rest = costs.part(_back(0, last[0]), _back(0, last[1]))
        backwards = Ends(end=ends.begin)
        bottom, right = yield from _last(rest, CLOSED, 0.2, 0.4)
        start = last_cell(bottom, right, backwards)
        first = last[0] - start[0], last[1] - start[1]
    pieces: list[Path] = []
    todo = [(first, last)]
    whole = max(1, (last[0] - first[0] + 1) * (last[1] - first[1] + 1))
    done = 0
    while todo:
        (i0, j0), (i1, j1) = todo.pop()
        size = (i1 - i0 + 1) * (j1 - j0 + 1)
        part = costs.part(slice(i0, i1 + 1), slice(j0, j1 + 1))
        if i1 - i0 < 2 or size <= cells:
            alignment = yield from _quietly(aligning(part), 0.4 + 0.6 * done / whole)
            pieces.append(alignment.path + np.array([i0, j0], np.int32))
            done += size
            continue
        middle = (i1 - i0) // 2
        end, begin = yield from _cut(part, middle, 0.4 + 0.6 * done / whole)
        todo.append(((i0 + middle + 1, j0 + begin), (i1, j1)))
        todo.append(((i0, j0), (i0 + middle, j0 + end)))
        done += size - (middle + 1) * (end + 1) - (i1 - i0 - middle) * (j1 - j0 - begin + 1)
    path = np.concatenate(pieces)
    return Alignment(path, costs.pairs(path))


def _cut(costs: Costs, middle: int, done: float) -> Generator[Progress, None, tuple[int, int]]:
    """Return the source frames between which the path goes from row `middle` to the next."""
    rows, columns = costs.shape
    above = costs.part(slice(0, middle + 1), slice(0, columns))
    below = costs.part(_back(middle + 1, rows - 1), _back(0, columns - 1))
    forth, _ = yield from _last(above, CLOSED, done, done)
    back, _ = yield from _last(below, CLOSED, done, done)
    back = back[::-1].astype(np.float64)
    straight = forth + back
    slanted = forth[:-1] + back[1:]
    at = int(np.argmin(straight))
    if columns > 1 and slanted.min() <= straight[at]:
        at = int(np.argmin(slanted))
        return at, at + 1
    return at, at


def _last(
    costs: Costs, ends: Ends, done: float, until: float
) -> Generator[Progress, None, tuple[F32, F32]]:
    """Compute the last row (S,) and the last column (R,) of the accumulated distances."""
    rows, columns = costs.shape
    bottom, right = np.empty(columns, np.float32), np.empty(rows, np.float32)
    for block in accumulated(costs, ends):
        yield Progress(done + (until - done) * block.start / rows, "aligning")
        right[block.start : block.start + len(block.m)] = block.m[:, -1]
        bottom[:] = block.m[-1]
    return bottom, right


def _quietly(
    work: Generator[Progress, None, Alignment], done: float
) -> Generator[Progress, None, Alignment]:
    """Go on with work whose own progress is only a small part of the whole's."""
    while True:
        try:
            progress = next(work)
        except StopIteration as stop:
            result: Alignment = stop.value
            return result
        yield Progress(done, progress.what)


def _back(first: int, last: int) -> slice:
    """Return the slice from `last` down to `first`."""
    return slice(last, first - 1 if first > 0 else None, -1)
