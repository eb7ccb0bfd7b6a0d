"""Other libraries' dynamic time warping, beside ours: the extra ``peers`` installs them."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Answer = tuple[float, NDArray[np.int64] | None]
Peer = Callable[[Array, Array], Answer]
"""Given the poses (R, D) of the reference and (S, D) of the source: cost, and path (P, 2)."""


def tslearn(reference: Array, source: Array) -> Answer:
    """Accumulated Euclidean distance and path by tslearn."""
    from tslearn.metrics import dtw_path_from_metric

    path, cost = dtw_path_from_metric(reference, source, metric="euclidean")
    return float(cost), np.asarray(path)


def dtw_python(reference: Array, source: Array) -> Answer:
    """Accumulated Euclidean distance and path by dtw-python, distances by scipy."""
    from dtw import dtw
    from scipy.spatial.distance import cdist

    found = dtw(cdist(reference, source), step_pattern="symmetric1")
    return float(found.distance), np.stack([found.index1, found.index2], axis=1)


def dtaidistance(reference: Array, source: Array) -> Answer:
    """Root of the accumulated squared distance by dtaidistance, which knows no other; no path."""
    from dtaidistance import dtw_ndim

    return float(dtw_ndim.distance_fast(reference, source)), None


def peers() -> dict[str, Peer]:
    """Return those that are installed, by name."""
    known: dict[str, tuple[str, Peer]] = {
        "tslearn": ("tslearn", tslearn),
        "dtw-python": ("dtw", dtw_python),
        "dtaidistance (no path)": ("dtaidistance", dtaidistance),
    }
    return {name: peer for name, (module, peer) in known.items() if find_spec(module)}
