"""Growing boosted trees from rows of features with labels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.decision.examples import TooLittleToLearnError
from mocapstudio.cleaning.decision.forest import Forest

F32 = NDArray[np.float32]

_NEGATIVES = 60_000


@dataclass(frozen=True)
class Size:
    """How much trees can learn: their number, leaves, step, and samples a leaf at least."""

    trees: int
    leaves: int
    rate: float
    least: int


@dataclass(frozen=True, eq=False)
class Rows:
    """Rows of features with sure labels."""

    rows: F32
    labels: NDArray[np.int8]

    @staticmethod
    def of(parts: Sequence[tuple[F32, NDArray[np.int8]]]) -> Rows:
        """Join features (..., n) and labels (...,); rows of doubtful labels (-1) are left out."""
        rows = np.concatenate([f.reshape(-1, f.shape[-1]) for f, _ in parts])
        labels = np.concatenate([label.ravel() for _, label in parts])
        sure = labels >= 0
        return Rows(rows[sure], labels[sure])


def grow(
    examples: Rows, rng: np.random.Generator, size: Size, negatives: int = _NEGATIVES
) -> Forest:
    """Grow trees that tell erroneous rows from right ones.

    Parameters
    ----------
    examples
        Rows with sure labels.
    rng
        Chooses which right rows are left out where there are more than `negatives`.
    size
        How much the trees can learn.
    negatives
        Most right rows to learn from.

    Raises
    ------
    TooLittleToLearnError
        If one of the two labels is missing.
    """
    # Imported here: scikit-learn takes a second, and only learning needs it.
    from sklearn.ensemble import HistGradientBoostingClassifier
    from threadpoolctl import threadpool_limits

    right, wrong = (np.flatnonzero(examples.labels == value) for value in (0, 1))
    if not len(wrong) or not len(right):
        raise TooLittleToLearnError("the context is too short to learn from")
    kept = rng.choice(right, min(len(right), negatives), replace=False)
    rows = np.concatenate([wrong, kept])
    model = HistGradientBoostingClassifier(
        max_iter=size.trees,
        learning_rate=size.rate,
        max_leaf_nodes=size.leaves,
        min_samples_leaf=size.least,
        l2_regularization=1.0,
        early_stopping=False,
        random_state=0,
    )
    # Waiting OpenMP threads spin: on a busy machine one thread is faster than two.
    with threadpool_limits(1):
        # What does not exist in this context, such as other takes, is no column to learn from.
        there = np.flatnonzero(np.isfinite(examples.rows[rows]).any(axis=0))
        model.fit(examples.rows[np.ix_(rows, there)], examples.labels[rows])
    forest = Forest.of(model, there)
    # What was left out of the right rows is put back into the odds: weights would do the same,
    # but make scikit-learn's binning several times slower.
    return replace(forest, base=forest.base - float(np.log(len(right) / len(kept))))
