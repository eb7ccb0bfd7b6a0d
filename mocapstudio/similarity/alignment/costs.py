"""What a pair of frames costs: distances between poses, whole or with parts left out."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.errors import ParameterError
from mocapstudio.similarity import parallel
from mocapstudio.similarity.alignment import kernels

F32 = NDArray[np.float32]
Which = slice | NDArray[np.intp]

_AT_LEAST = 64


class Costs(Protocol):
    """The cost of every pair of a reference frame and a source frame, computed when asked for."""

    @property
    def shape(self) -> tuple[int, int]:
        """Frames of the reference and of the source."""

    def fill(self, start: int, end: int, out: F32) -> None:
        """Write the costs of reference frames [start, end) with all source frames into `out`.

        Several threads may do so at once, each into an `out` of its own.
        """

    def fill_within(self, low: NDArray[np.int32], out: F32) -> None:
        """Write the costs of a band (R, W) whose rows begin at the source frames `low` (R,)."""

    def pairs(self, path: NDArray[np.int32]) -> F32:
        """(P,) costs of the pairs of a path (P, 2)."""

    def part(self, rows: Which, columns: Which) -> Costs:
        """Return the costs of some frames, in the order in which they are given."""


class PoseDistances:
    """Euclidean distances between poses as points (paper 4).

    Parameters
    ----------
    reference, source
        (R, D) and (S, D).

    Raises
    ------
    ParameterError
        If a sequence is empty, or the poses differ in dimension.
    """

    def __init__(self, reference: F32, source: F32) -> None:
        _check(reference, source)
        self.reference, self.source = (
            np.ascontiguousarray(poses, np.float32) for poses in (reference, source)
        )
        self._rows = _padded(self.reference)
        self._chunks = _chunked(self.source, self._rows.shape[1])

    @property
    def shape(self) -> tuple[int, int]:
        """Frames of the reference and of the source."""
        return len(self.reference), len(self.source)

    def fill(self, start: int, end: int, out: F32) -> None:
        """Write the costs of reference frames [start, end) into `out` (end - start, S)."""
        kernels.distances(self._rows[start:end], self._chunks, out)

    def fill_within(self, low: NDArray[np.int32], out: F32) -> None:
        """Write the costs of a band (R, W) whose rows begin at the source frames `low` (R,)."""
        columns = np.ascontiguousarray(self.source.T)

        def work(first: int, last: int) -> None:
            rows = slice(first, last)
            kernels.distances_within(self._rows[rows], columns, low[rows], out[rows])

        parallel.for_blocks(len(self.reference), work, _AT_LEAST)

    def pairs(self, path: NDArray[np.int32]) -> F32:
        """(P,) costs of the pairs of a path (P, 2)."""
        out = np.empty(len(path), np.float32)
        kernels.pair_distances(self.reference, self.source, path, out)
        return out

    def part(self, rows: Which, columns: Which) -> PoseDistances:
        """Return the costs of some frames, in the order in which they are given."""
        return PoseDistances(self.reference[rows], self.source[columns])


class KnownCosts:
    """Costs that were computed before.

    Parameters
    ----------
    matrix
        (R, S).
    """

    def __init__(self, matrix: F32) -> None:
        self.matrix = matrix

    @property
    def shape(self) -> tuple[int, int]:
        """Frames of the reference and of the source."""
        return self.matrix.shape[0], self.matrix.shape[1]

    def fill(self, start: int, end: int, out: F32) -> None:
        """Write the costs of reference frames [start, end) into `out` (end - start, S)."""
        out[:] = self.matrix[start:end]

    def fill_within(self, low: NDArray[np.int32], out: F32) -> None:
        """Write the costs of a band (R, W) whose rows begin at the source frames `low` (R,)."""
        _cut_band(self, low, out)

    def pairs(self, path: NDArray[np.int32]) -> F32:
        """(P,) costs of the pairs of a path (P, 2)."""
        return np.asarray(self.matrix[path[:, 0], path[:, 1]])

    def part(self, rows: Which, columns: Which) -> KnownCosts:
        """Return the costs of some frames, in the order in which they are given."""
        return KnownCosts(self.matrix[rows][:, columns])


class ReliableDistances:
    """Distances over the rows that are reliable in both frames, scaled to all rows.

    With the squared gaps of n of N rows known, the square of the distance is their sum times
    N / n; pairs that share no reliable row cost what pairs cost in the mean.

    Parameters
    ----------
    reference, source
        (R, N, C) and (S, N, C): poses by row.
    reference_weight, source_weight
        (R, N) and (S, N): 1 where a row counts, 0 where it does not.

    Raises
    ------
    ParameterError
        If a sequence is empty, or shapes disagree.
    """

    def __init__(
        self,
        reference: NDArray[np.floating],
        source: NDArray[np.floating],
        reference_weight: NDArray[np.float64],
        source_weight: NDArray[np.float64],
    ) -> None:
        _check(reference, source)
        if (reference_weight.shape, source_weight.shape) != (reference.shape[:2], source.shape[:2]):
            raise ParameterError("weights must have one value a frame and row")
        self.reference, self.source = reference.astype(np.float64), source.astype(np.float64)
        self.weights = reference_weight, source_weight
        self._known = [
            weight[..., None] * poses
            for weight, poses in zip(self.weights, (self.reference, self.source), strict=True)
        ]
        self._squares = [
            weight * np.sum(poses**2, axis=2)
            for weight, poses in zip(self.weights, (self.reference, self.source), strict=True)
        ]

    @property
    def shape(self) -> tuple[int, int]:
        """Frames of the reference and of the source."""
        return len(self.reference), len(self.source)

    def fill(self, start: int, end: int, out: F32) -> None:
        """Write the costs of reference frames [start, end) into `out` (end - start, S)."""
        rows, (a, b) = slice(start, end), self.weights
        cross = self._known[0][rows].reshape(end - start, -1) @ self._known[1].reshape(len(b), -1).T
        total = self._squares[0][rows] @ b.T + a[rows] @ self._squares[1].T - 2 * cross
        out[:] = self._scaled(total, a[rows] @ b.T)

    def fill_within(self, low: NDArray[np.int32], out: F32) -> None:
        """Write the costs of a band (R, W) whose rows begin at the source frames `low` (R,)."""
        _cut_band(self, low, out)

    def pairs(self, path: NDArray[np.int32]) -> F32:
        """(P,) costs of the pairs of a path (P, 2)."""
        i, j = path.T
        weight = self.weights[0][i] * self.weights[1][j]
        squares = np.sum((self.reference[i] - self.source[j]) ** 2, axis=2)
        return self._scaled(np.sum(weight * squares, axis=1), weight.sum(axis=1))

    def part(self, rows: Which, columns: Which) -> ReliableDistances:
        """Return the costs of some frames, in the order in which they are given."""
        a, b = self.weights
        return ReliableDistances(self.reference[rows], self.source[columns], a[rows], b[columns])

    def _scaled(self, squares: NDArray[np.float64], known: NDArray[np.float64]) -> F32:
        count = self.reference.shape[1]
        cost = np.sqrt(np.maximum(squares, 0.0) * count / np.maximum(known, 1e-9))
        shared = known > 1e-6
        if not shared.all():
            cost[~shared] = cost[shared].mean() if shared.any() else 0.0
        return np.asarray(cost, np.float32)


def _cut_band(costs: Costs, low: NDArray[np.int32], out: F32) -> None:
    """Fill a band (R, W) from whole rows, a few at a time."""
    columns = costs.shape[1]
    block = np.empty((min(_AT_LEAST, len(out)), columns), np.float32)
    for start in range(0, len(out), len(block)):
        rows = block[: len(out) - start]
        costs.fill(start, start + len(rows), rows)
        for row, first, into in zip(rows, low[start:].tolist(), out[start:], strict=False):
            begin, end = max(first, 0), min(first + out.shape[1], columns)
            into[:] = np.inf
            if begin < end:
                into[begin - first : end - first] = row[begin:end]


def _check(reference: NDArray[np.floating], source: NDArray[np.floating]) -> None:
    if len(reference) == 0 or len(source) == 0:
        raise ParameterError("an empty sequence cannot be aligned")
    if reference.shape[1:] != source.shape[1:]:
        raise ParameterError("poses of different dimension cannot be aligned")


def _padded(poses: F32) -> F32:
    """Pad poses (F, D) with zeros to a multiple of the dimensions that the kernels take."""
    frames, own = poses.shape
    wanted = own + -own % kernels.DIMENSIONS
    if own == wanted:
        return poses
    padded = np.zeros((frames, wanted), np.float32)
    padded[:, :own] = poses
    return padded


def _chunked(poses: F32, dimensions: int) -> F32:
    """(chunks, dimensions, CHUNK) copy of poses (F, D), time last, filled up with zeros."""
    size = kernels.CHUNK
    chunks = np.zeros((-(-len(poses) // size), dimensions, size), np.float32)
    for chunk, start in zip(chunks, range(0, len(poses), size), strict=True):
        part = poses[start : start + size]
        chunk[: part.shape[1], : len(part)] = part.T
    return chunks
