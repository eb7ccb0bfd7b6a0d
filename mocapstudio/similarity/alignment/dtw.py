"""Dynamic time warping of two performances: cost, path, open ends (paper 4, algorithm 1)."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.errors import ParameterError
from mocapstudio.motion.progress import Progress, run
from mocapstudio.similarity import parallel
from mocapstudio.similarity.alignment import kernels

F32 = NDArray[np.float32]

Side = Literal["reference", "source"]
SIDES: tuple[Side, ...] = ("reference", "source")

_LANES = 4
_BLOCK = 512
_AT_LEAST = 64


@dataclass(frozen=True)
class Ends:
    """Which of the two may begin late or end early.

    Parameters
    ----------
    begin
        The side of which frames may be skipped before the first pair; None for neither.
    end
        The same after the last pair.
    """

    begin: Side | None = None
    end: Side | None = None


CLOSED = Ends()


@dataclass(frozen=True, eq=False)
class Alignment:
    """A warping path and what it costs.

    Parameters
    ----------
    path
        (P, 2) pairs of reference and source frames; ascending, in steps of (1, 1), (1, 0), (0, 1).
    costs
        (P,) distance of each pair.
    """

    path: NDArray[np.int32]
    costs: F32

    @property
    def cost(self) -> float:
        """Accumulated distance."""
        return float(np.sum(self.costs, dtype=np.float64))

    @property
    def mean_cost(self) -> float:
        """Mean distance of a pair."""
        return self.cost / len(self.path)


def align(reference: F32, source: F32, ends: Ends = CLOSED) -> Alignment:
    """Find the cheapest path between two sequences of poses; memory grows with R x S.

    Parameters
    ----------
    reference, source
        (R, D) and (S, D): poses as points; the cost of a pair is their Euclidean distance.
    ends
        Which side may be skipped at the beginning and at the end.

    Raises
    ------
    ParameterError
        If a sequence is empty, or the poses differ in dimension.
    """
    return run(aligning(reference, source, ends))


def aligning(
    reference: F32, source: F32, ends: Ends = CLOSED
) -> Generator[Progress, None, Alignment]:
    """Do as `align` and yield progress."""
    accumulated = yield from accumulating(reference, source, ends)
    path = traced(accumulated, ends)
    gaps = reference[path[:, 0]].astype(np.float32) - source[path[:, 1]].astype(np.float32)
    return Alignment(path, np.linalg.norm(gaps, axis=1))


def accumulating(
    reference: F32, source: F32, ends: Ends = CLOSED
) -> Generator[Progress, None, F32]:
    """Compute the accumulated distance matrix M (R, S) of algorithm 1, yielding progress."""
    rows, columns = lanes(reference), np.ascontiguousarray(lanes(source).T)
    if rows.shape[1] != columns.shape[0]:
        raise ParameterError("poses of different dimension cannot be aligned")
    if not len(rows) or not columns.shape[1]:
        raise ParameterError("an empty sequence cannot be aligned")
    m = np.empty((len(rows), columns.shape[1]), np.float32)
    edge = 0.0 if ends.begin == "reference" else np.inf
    above = np.full(m.shape[1], 0.0 if ends.begin == "source" else np.inf, np.float32)
    corner = 0.0
    for start in range(0, len(m), _BLOCK):
        yield Progress(start / len(m), "aligning")
        block = m[start : start + _BLOCK]
        fill_distances(rows[start : start + _BLOCK], columns, block)
        kernels.accumulate(block, above, corner, edge)
        above, corner = block[-1], edge
    return m


def traced(accumulated: F32, ends: Ends = CLOSED) -> NDArray[np.int32]:
    """(P, 2) cheapest path through an accumulated distance matrix (R, S)."""
    last = accumulated.shape[0] - 1, accumulated.shape[1] - 1
    if ends.end == "reference":
        last = int(np.argmin(accumulated[:, -1])), last[1]
    elif ends.end == "source":
        last = last[0], int(np.argmin(accumulated[-1]))
    path = np.empty((sum(accumulated.shape), 2), np.int32)
    first = kernels.backtrack(
        accumulated, *last, ends.begin == "reference", ends.begin == "source", path
    )
    return path[first:].copy()


def fill_distances(reference: F32, source: F32, out: F32) -> None:
    """Compute distances (n, S) of poses (n, D) and (D, S), several blocks of rows at once."""

    def work(start: int, end: int) -> None:
        kernels.distances(reference[start:end], source, out[start:end])

    parallel.for_blocks(len(reference), work, _AT_LEAST)


def lanes(poses: F32) -> F32:
    """Pad poses (F, D) with zeros to the multiple of dimensions that the kernels take."""
    poses = np.asarray(poses, np.float32)
    more = -poses.shape[1] % _LANES
    return np.ascontiguousarray(np.pad(poses, ((0, 0), (0, more))) if more else poses)
