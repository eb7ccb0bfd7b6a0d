"""Distances between all poses of two performances, pooled to what a picture can show."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison.model import Comparison

Floats = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class PooledDistances:
    """Pose distances of blocks of frames.

    Parameters
    ----------
    values
        (A, B) Euclidean distances of whole poses, all rows as one point; reference blocks down,
        source blocks across.
    reference, source
        First frame of the first block, and frames a block holds.
    """

    values: Floats
    reference: tuple[float, float]
    source: tuple[float, float]


def pooled_distances(
    comparison: Comparison,
    reference: tuple[float, float],
    source: tuple[float, float],
    most: int = 240,
) -> PooledDistances:
    """Compute the distances between the mean poses of blocks of frames.

    What would be tens of megabytes for a whole kata is a picture of at most `most` × `most`
    blocks; the nearer one looks, the fewer frames a block holds.

    Parameters
    ----------
    reference, source
        Frames in sight: left and right edge.
    most
        Blocks along either side at most.
    """
    ours, first, step = _blocks(comparison.reference_poses, reference, most)
    theirs, begin, width = _blocks(comparison.source_poses, source, most)
    squares = (ours**2).sum(axis=1)[:, None] + (theirs**2).sum(axis=1)[None]
    values = np.sqrt(np.maximum(squares - 2.0 * ours @ theirs.T, 0.0))
    return PooledDistances(values.astype(np.float32), (first, step), (begin, width))


def _blocks(poses: Floats, edges: tuple[float, float], most: int) -> tuple[Floats, int, int]:
    """Mean poses (blocks, features) of the blocks in sight, the first frame, frames a block."""
    frames = len(poses)
    start = min(max(int(np.floor(edges[0])), 0), frames - 1)
    end = min(max(int(np.ceil(edges[1])) + 1, start + 1), frames)
    step = max(1, -(-(end - start) // most))
    start = start // step * step
    part = np.nan_to_num(poses[start:end].reshape(end - start, -1), nan=0.5)
    starts = np.arange(0, len(part), step)
    count = np.diff(np.append(starts, len(part)))[:, None]
    means = np.add.reduceat(part, starts, axis=0) / count
    return means.astype(np.float32), start, step
