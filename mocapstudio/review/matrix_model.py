"""What a matrix of two motions set against each other shows, whatever aligned them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.neighbour_alignment import NeighbourAlignment
from mocapstudio.comparison.model import Comparison
from mocapstudio.comparison.online_path import OnlinePath
from mocapstudio.review.comparing_matrix import PooledDistances, pooled_distances
from mocapstudio.similarity.alignment.costs import KnownCosts
from mocapstudio.similarity.alignment.dtw import accumulated

Floats = NDArray[np.float32]
Edges = tuple[float, float]

_WHOLE = 480


class Picture(StrEnum):
    """Which matrix is drawn."""

    DISTANCES = "distances"
    ACCUMULATED = "accumulated"


class Matrix(Protocol):
    """Two motions, one down and one across, with the path through the distances of their poses."""

    @property
    def frames(self) -> tuple[int, int]:
        """Frames of the reference and of the source."""

    @property
    def rates(self) -> tuple[float, float]:
        """Frames a second of each."""

    @property
    def path(self) -> NDArray[np.integer]:
        """(P, 2) pairs of frames."""

    def pooled(
        self, picture: Picture, reference: Edges, source: Edges, most: int
    ) -> PooledDistances:
        """Return what is in sight between left and right edges, in at most `most` blocks a side."""


class ComparedMatrix:
    """The matrix of a comparison after the fact.

    Parameters
    ----------
    comparison
        What was compared.
    """

    def __init__(self, comparison: Comparison) -> None:
        self._comparison = comparison
        self._whole: PooledDistances | None = None

    @property
    def frames(self) -> tuple[int, int]:
        """Frames of the reference and of the source."""
        return len(self._comparison.reference_poses), len(self._comparison.source_poses)

    @property
    def rates(self) -> tuple[float, float]:
        """Frames a second of each."""
        return float(self._comparison.reference_rate), float(self._comparison.source_rate)

    @property
    def path(self) -> NDArray[np.int32]:
        """(P, 2) pairs of frames."""
        return self._comparison.path

    def pooled(
        self, picture: Picture, reference: Edges, source: Edges, most: int
    ) -> PooledDistances:
        """Distances are as fine as there is room for; accumulated costs as fine as the whole."""
        if picture is Picture.DISTANCES:
            return pooled_distances(self._comparison, reference, source, most)
        if self._whole is None:
            rows, columns = ((-0.5, frames - 0.5) for frames in self.frames)
            plain = pooled_distances(self._comparison, rows, columns, _WHOLE)
            blocks = accumulated(KnownCosts(plain.values))
            values = np.concatenate([one.m.copy() for one in blocks])
            self._whole = PooledDistances(values, plain.reference, plain.source)
        return cropped(self._whole, reference, source)


@dataclass(frozen=True, eq=False)
class KnownMatrix:
    """A matrix of which everything is known.

    Parameters
    ----------
    frames, rates, path
        See `Matrix`.
    distances, accumulated
        Of all pairs of blocks.
    """

    frames: tuple[int, int]
    rates: tuple[float, float]
    path: NDArray[np.integer]
    distances: PooledDistances
    accumulated: PooledDistances

    def pooled(
        self, picture: Picture, reference: Edges, source: Edges, most: int
    ) -> PooledDistances:
        """Return what is in sight, as fine as it is known."""
        whole = self.distances if picture is Picture.DISTANCES else self.accumulated
        return cropped(whole, reference, source)


def online_matrix(found: OnlinePath) -> KnownMatrix:
    """Return the matrix of an online alignment."""
    place = (found.reference_at, found.source_at)
    return KnownMatrix(
        found.frames,
        found.rates,
        found.path,
        PooledDistances(found.distances, *place),
        PooledDistances(found.accumulated, *place),
    )


def cropped(whole: PooledDistances, reference: Edges, source: Edges) -> PooledDistances:
    """Return the blocks between left and right edges, in frames."""
    rows, columns = (
        _blocks_in(edges, place, count)
        for edges, place, count in zip(
            (reference, source), (whole.reference, whole.source), whole.values.shape, strict=True
        )
    )
    (first, step), (begin, width) = whole.reference, whole.source
    return PooledDistances(
        whole.values[rows, columns],
        (first + rows.start * step, step),
        (begin + columns.start * width, width),
    )


def _blocks_in(edges: Edges, place: tuple[float, float], count: int) -> slice:
    first, step = place
    low = int(np.floor((edges[0] - first) / step))
    high = int(np.ceil((edges[1] - first) / step)) + 1
    low = min(max(low, 0), count - 1)
    return slice(low, min(max(high, low + 1), count))


def neighbour_matrix(found: NeighbourAlignment) -> KnownMatrix:
    """Return the matrix of a flagged span (up) and a neighbour (across).

    Frames count from the first of the span's margin, and from the first of the neighbour's.
    """
    each = found.own[1], found.theirs[1]
    place = (0.0, each[0]), (0.0, each[1])
    rows, columns = found.distances.shape
    return KnownMatrix(
        (round(rows * each[0]), round(columns * each[1])),
        found.rates,
        np.rint(found.path * np.array(each)).astype(np.int64),
        PooledDistances(found.distances, *place),
        PooledDistances(found.accumulated, *place),
    )
