"""Lines between markers where the file names none. No Qt."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_SAMPLES = 120
_UNSTEADY = 8.0
_LONGEST = 4.0


def guess_bones(positions: NDArray[np.floating]) -> tuple[tuple[int, int], ...]:
    """Join markers that lie near each other and keep their distance, as a tree.

    Parameters
    ----------
    positions
        (F, M, 3) metres; NaN where a marker is missing.

    Returns
    -------
    Pairs of marker indices. What is far from all others stays without a line.
    """
    from scipy.sparse.csgraph import minimum_spanning_tree

    every = max(1, len(positions) // _SAMPLES)
    few = positions[::every].astype(np.float64)
    apart = np.linalg.norm(few[:, :, None] - few[:, None, :], axis=3)
    known = np.isfinite(apart)
    count = known.sum(axis=0)
    safe = np.where(known, apart, 0.0)
    mean = safe.sum(axis=0) / np.maximum(count, 1)
    spread = np.sqrt(np.maximum((safe**2).sum(axis=0) / np.maximum(count, 1) - mean**2, 0.0))
    cost = mean + _UNSTEADY * spread
    cost[count < 2] = 0.0
    np.fill_diagonal(cost, 0.0)
    tree = minimum_spanning_tree(cost).tocoo()
    pairs = [(int(a), int(b)) for a, b in zip(tree.row, tree.col, strict=True)]
    if not pairs:
        return ()
    usual = float(np.median([mean[a, b] for a, b in pairs]))
    return tuple((a, b) for a, b in pairs if mean[a, b] <= _LONGEST * max(usual, 1e-6))
