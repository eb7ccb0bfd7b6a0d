"""Quality of an alignment: the share of path cells whose segments agree (paper 3, equation 5)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mocapstudio.comparison.labels import Labels
from mocapstudio.comparison.online import Variant
from mocapstudio.comparison.online_features import F32, F64, I32
from mocapstudio.comparison.online_reference import Reference
from mocapstudio.motion.errors import MocapError
from mocapstudio.similarity.online import kernels
from mocapstudio.similarity.parallel import for_blocks

SHARES = tuple(share / 10 for share in range(1, 11))
"""Shares of the movement after which the quality is measured."""

_KEPT_BYTES = 768 * 2**20
_LANES = 16


@dataclass(frozen=True, eq=False)
class Example:
    """A labelled performance.

    Parameters
    ----------
    name, performer
        Of the take, and who it is; empty where nobody knows.
    rows
        (S, N, 4) as `Reference.rows`.
    segments
        (S,) number of each frame's segment, -1 where it has none.
    """

    name: str
    performer: str
    rows: F32
    segments: I32


class Trials:
    """Aligns examples with a reference under many sets of weights.

    The distances of single joints are computed once and kept as long as they fit into memory.

    Parameters
    ----------
    reference
        R frames.
    segments
        (R,) number of each of its frames' segment.
    examples
        Performances to align.
    shares
        K shares of each performance to be seen, ascending.
    """

    def __init__(
        self,
        reference: Reference,
        segments: I32,
        examples: Sequence[Example],
        shares: Sequence[float] = SHARES,
    ) -> None:
        self.reference = reference
        self.examples = tuple(examples)
        self.shares = tuple(shares)
        self._segments = segments
        self._planes = np.ascontiguousarray(reference.rows.transpose(1, 2, 0))
        cell = 4 * self._planes.shape[0] * len(reference)
        fits = cell * sum(len(one.rows) for one in self.examples) <= _KEPT_BYTES
        self._kept = [self._distances(one) for one in self.examples] if fits else None

    def qualities(
        self, weights: F32, variant: Variant = Variant.PLAIN, *, closed: bool = False
    ) -> F64:
        """Qualities (N, P, K) of N examples under P sets of weights after K shares.

        Parameters
        ----------
        weights
            (P, D), at least 0.
        variant
            How paths are accumulated.
        closed
            Whether every path ends at the reference's end, as offline alignment does; of use
            where the whole movement is seen.
        """
        sets = len(weights)
        if sets > _LANES // 2:
            weights = weights[np.minimum(np.arange(-(-sets // _LANES) * _LANES), sets - 1)]
        out = np.empty((len(self.examples), len(weights), len(self.shares)))
        columns = np.ascontiguousarray(weights.T, dtype=np.float32)
        by_length, diagonal = variant is Variant.PATH_LENGTH, 1.0 + (variant is Variant.DIAGONAL)

        def work(start: int, end: int) -> None:
            for i in range(start, end):
                example = self.examples[i]
                distances = self._distances(example) if self._kept is None else self._kept[i]
                rows, frames, size = distances.shape
                costs = (distances.reshape(rows, -1).T @ columns).reshape(frames, size, -1)
                kernels.path_qualities(
                    costs,
                    example.segments,
                    self._segments,
                    _seen(frames, self.shares),
                    by_length,
                    diagonal,
                    closed,
                    out[i],
                )

        for_blocks(len(self.examples), work, at_least=1)
        return out[:, :sets]

    def _distances(self, example: Example) -> F32:
        frames, width, _ = example.rows.shape
        out = np.empty((width, frames, len(self.reference)), np.float32)
        rows = np.ascontiguousarray(example.rows)
        kernels.row_distances(rows, self._planes, self.reference.directions, out)
        return out


def segments_of(reference: Reference, labels: Labels, names: Sequence[str]) -> I32:
    """(R,) number in `names` of the segment of each frame of a reference, -1 for none.

    Raises
    ------
    MocapError
        If no frame lies in a segment.
    """
    numbers = {name: i for i, name in enumerate(names)}
    found = reference.segment_names(labels)
    codes = np.array([numbers.get(name, -1) if name else -1 for name in found], np.int32)
    if (codes < 0).all():
        raise MocapError(f"{reference.name}: no frame lies in a labelled segment")
    return codes


def example_of(
    performance: Reference, labels: Labels, names: Sequence[str], performer: str = ""
) -> Example:
    """Make a labelled example of a performance that was prepared like a reference.

    Raises
    ------
    MocapError
        If no frame lies in a segment.
    """
    codes = segments_of(performance, labels, names)
    return Example(performance.name, performer, performance.rows, codes)


def _seen(frames: int, shares: Sequence[float]) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    counts = [min(frames, max(1, round(share * frames))) for share in shares]
    return np.array(counts, np.int64)
