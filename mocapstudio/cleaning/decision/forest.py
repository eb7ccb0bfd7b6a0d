"""Boosted trees as plain arrays: stored without pickle, evaluated without scikit-learn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.decision import kernels
from mocapstudio.similarity.parallel import for_blocks

F32 = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Forest:
    """Gradient-boosted regression trees whose leaf values add up to a log-odds.

    Parameters
    ----------
    base
        Log-odds to start from.
    roots
        (n,) first node of each tree.
    feature
        (N,) int32 feature a node asks for, -1 for a leaf.
    threshold
        (N,) float32: left where the feature is not above it.
    left, right
        (N,) int32 child nodes.
    missing_left
        (N,) uint8: 1 where a missing value goes left.
    value
        (N,) float32 a leaf's contribution.
    """

    base: float
    roots: NDArray[np.int32]
    feature: NDArray[np.int32]
    threshold: F32
    left: NDArray[np.int32]
    right: NDArray[np.int32]
    missing_left: NDArray[np.uint8]
    value: F32

    @staticmethod
    def of(model: Any, columns: NDArray[np.int64]) -> Forest:
        """Copy the trees out of a fitted binary `HistGradientBoostingClassifier`.

        `columns` tells which features the model's own ones are.
        """
        nodes = [predictors[0].nodes for predictors in model._predictors]
        roots = np.concatenate([[0], np.cumsum([len(n) for n in nodes])[:-1]]).astype(np.int32)
        every = np.concatenate(nodes)
        shift = np.repeat(roots, [len(n) for n in nodes])
        leaf = every["is_leaf"].astype(bool)
        return Forest(
            float(np.ravel(model._baseline_prediction)[0]),
            roots,
            np.where(leaf, -1, columns[every["feature_idx"]]).astype(np.int32),
            _rounded_down(every["num_threshold"]),
            (every["left"] + shift).astype(np.int32),
            (every["right"] + shift).astype(np.int32),
            every["missing_go_to_left"].astype(np.uint8),
            every["value"].astype(np.float32),
        )

    def probability(self, features: F32) -> F32:
        """Probability of an error for rows of features, (..., n) to (...,)."""
        return as_probability(self.odds(features))

    def odds(self, features: F32) -> F32:
        """Log-odds of an error for rows of features, (..., n) to (...,)."""
        rows = np.ascontiguousarray(features.reshape(-1, features.shape[-1]), dtype=np.float32)
        odds = np.full(len(rows), self.base, dtype=np.float32)

        def work(first: int, last: int) -> None:
            kernels.add_trees(
                rows[first:last], self.roots, self.feature, self.threshold, self.left, self.right,
                self.missing_left, self.value, odds[first:last],
            )  # fmt: skip

        for_blocks(len(rows), work, at_least=512)
        return odds.reshape(features.shape[:-1])

    def arrays(self, prefix: str) -> dict[str, NDArray[Any]]:
        """All parts as arrays for an npz file."""
        names = ("roots", "feature", "threshold", "left", "right", "missing_left", "value")
        parts = {f"{prefix}{name}": getattr(self, name) for name in names}
        return {**parts, f"{prefix}base": np.array(self.base)}

    @staticmethod
    def from_arrays(arrays: Any, prefix: str) -> Forest:
        """Inverse of `arrays`; KeyError where a part is missing."""
        names = ("roots", "feature", "threshold", "left", "right", "missing_left", "value")
        return Forest(float(arrays[f"{prefix}base"]), *(arrays[f"{prefix}{n}"] for n in names))


def as_probability(odds: F32) -> F32:
    """Probabilities of log-odds, of any shape."""
    return np.asarray(1.0 / (1.0 + np.exp(-odds)), dtype=np.float32)


def _rounded_down(thresholds: NDArray[np.float64]) -> F32:
    """Largest float32 numbers not above `thresholds`: float32 features are told apart as before."""
    near = thresholds.astype(np.float32)
    return np.where(near > thresholds, np.nextafter(near, np.float32(-np.inf)), near)
