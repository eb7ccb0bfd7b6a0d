"""Dynamic time warping of two performances: cost, path, open ends (paper 4, algorithm 1)."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.errors import ParameterError
from mocapstudio.motion.progress import Progress, run
from mocapstudio.similarity import parallel
from mocapstudio.similarity.alignment import kernels
from mocapstudio.similarity.alignment.costs import Costs

F32 = NDArray[np.float32]
Path = NDArray[np.int32]

Side = Literal["reference", "source"]

_CELLS = 700_000
_ROWS = 256
_SLOTS = 3
"""Pairs whose distances are computed at a time, at most how many rows they are, and how many times
that is kept: few enough for the cache, and enough to keep the processors busy."""


@dataclass(frozen=True)
class Ends:
    """Which of the two may begin late or end early; the other is aligned as a whole.

    Parameters
    ----------
    begin
        The side of which frames may be left out before the first pair; None for neither.
    end
        The same after the last pair.
    """

    begin: Side | None = None
    end: Side | None = None

    @property
    def free(self) -> tuple[bool, bool]:
        """Whether the path may begin at any reference frame, at any source frame."""
        return self.begin == "reference", self.begin == "source"


CLOSED = Ends()


@dataclass(frozen=True, eq=False)
class Alignment:
    """A warping path and what it costs.

    Parameters
    ----------
    path
        (P, 2) pairs of reference and source frames; ascending, in steps of (1, 1), (1, 0), (0, 1).
    costs
        (P,) cost of each pair.
    """

    path: Path
    costs: F32

    @property
    def cost(self) -> float:
        """Accumulated cost."""
        return float(np.sum(self.costs, dtype=np.float64))

    @property
    def mean_cost(self) -> float:
        """Mean cost of a pair."""
        return self.cost / len(self.path)


def align(costs: Costs, ends: Ends = CLOSED) -> Alignment:
    """Find the cheapest path; memory grows with the product of the lengths: two bits a pair."""
    return run(aligning(costs, ends))


def aligning(costs: Costs, ends: Ends = CLOSED) -> Generator[Progress, None, Alignment]:
    """Do as `align` and yield progress.

    Of the accumulated distance matrix M only the steps between its cells are kept, two bits each.
    """
    rows, columns = costs.shape
    steps = np.zeros((-(-rows // 4), columns), np.uint8)
    bottom, right = np.empty(columns, np.float32), np.empty(rows, np.float32)
    for block in accumulated(costs, ends):
        yield Progress(block.start / rows, "aligning")
        end = block.start + len(block.m)
        into = steps[block.start // 4 : -(-end // 4)]
        kernels.steps(block.m, block.above, block.corner, block.edge, into)
        right[block.start : end] = block.m[:, -1]
        bottom[:] = block.m[-1]
    path = np.empty((rows + columns, 2), np.int32)
    first = kernels.trace(steps, *last_cell(bottom, right, ends), *ends.free, path)
    path = path[first:].copy()
    return Alignment(path, costs.pairs(path))


class Block(NamedTuple):
    """Some rows of the accumulated distance matrix, valid until the next ones are asked for.

    Parameters
    ----------
    start
        The first of its n rows.
    m
        (n, S) accumulated distances.
    above, corner, edge
        (S,) the row before, what stands left of that, and left of the block's own rows.
    """

    start: int
    m: F32
    above: F32
    corner: float
    edge: float


def accumulated(costs: Costs, ends: Ends = CLOSED) -> Iterator[Block]:
    """Compute the accumulated distance matrix M (R, S) of algorithm 1, some rows at a time.

    The distances of the next rows are computed meanwhile, and all stays in the cache.
    """
    rows, columns = costs.shape
    corner, above, edge = borders(columns, ends)
    size = max(min(_CELLS // columns, _ROWS) // 4, 1) * 4
    slots = np.empty((min(_SLOTS, -(-rows // size)), min(size, rows), columns), np.float32)

    def block(k: int) -> F32:
        return slots[k % len(slots), : min(size, rows - k * size)]

    def work(k: int) -> None:
        costs.fill(k * size, min(rows, (k + 1) * size), block(k))

    for k in parallel.ahead(-(-rows // size), work, len(slots)):
        m = block(k)
        kernels.accumulate(m, above, corner, edge)
        yield Block(k * size, m, above, corner, edge)
        above, corner = m[-1].copy(), edge


def borders(columns: int, ends: Ends) -> tuple[float, F32, float]:
    """Return what stands around an accumulated matrix: corner, (columns,) row above, column left.

    Nothing where a path may begin, infinity where it may not.
    """
    rows_free, columns_free = ends.free
    above = np.full(columns, 0.0 if columns_free else np.inf, np.float32)
    return 0.0, above, 0.0 if rows_free else np.inf


def last_cell(last_row: F32, last_column: F32, ends: Ends) -> tuple[int, int]:
    """Return the cell where the cheapest path ends, from the last row (S,) and column (R,) of M."""
    row, column = len(last_column) - 1, len(last_row) - 1
    if ends.end == "reference":
        return int(np.argmin(last_column)), column
    return row, int(np.argmin(last_row)) if ends.end == "source" else column


def align_in_band(costs: Costs, band: int, ends: Ends = CLOSED) -> Alignment:
    """Find the cheapest path that keeps to a Sakoe-Chiba band; memory grows with R x band.

    Parameters
    ----------
    band
        Source frames that the path may be off the straight line from the first pair to the last;
        at least as many as one reference frame corresponds to.

    Raises
    ------
    ParameterError
        If the band is negative, or no path keeps to it.
    """
    if band < 0:
        raise ParameterError(f"a band must not be negative, as {band} is")
    rows, columns = costs.shape
    slope = (columns - 1) / max(rows - 1, 1)
    half = max(band, int(np.ceil(slope)))
    low = np.round(np.arange(rows) * slope).astype(np.int32) - np.int32(half)
    m = np.empty((rows, 2 * half + 1), np.float32)
    costs.fill_within(low, m)
    kernels.accumulate_within(m, low, *ends.free)
    right = np.array([_cell(m, low, i, columns - 1) for i in range(rows)], np.float32)
    bottom = np.array([_cell(m, low, rows - 1, j) for j in range(columns)], np.float32)
    end = last_cell(bottom, right, ends)
    if not np.isfinite(_cell(m, low, *end)):
        raise ParameterError(f"no path keeps to a band of {band} frames")
    path = np.empty((rows + columns, 2), np.int32)
    first = kernels.backtrack(m, low, *end, *ends.free, path)
    return Alignment(path[first:].copy(), costs.pairs(path[first:]))


def _cell(m: F32, low: Path, i: int, j: int) -> float:
    k = j - int(low[i])
    return float(m[i, k]) if 0 <= k < m.shape[1] else np.inf
