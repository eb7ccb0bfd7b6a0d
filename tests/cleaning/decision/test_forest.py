"""Boosted trees evaluated without scikit-learn: the same probabilities."""

from __future__ import annotations

import numpy as np
import pytest
from sklearn.ensemble import HistGradientBoostingClassifier
from threadpoolctl import threadpool_limits

from mocapstudio.cleaning.decision.forest import Forest


def examples(n: int, columns: int, seed: int, missing: float) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    rows = rng.normal(size=(n, columns)).astype(np.float32)
    labels = (rows[:, 0] * rows[:, 1] + rows[:, 2] + 0.3 * rng.normal(size=n) > 0).astype(int)
    rows[rng.random((n, columns)) < missing] = np.nan
    return rows, labels


def fitted(rows: np.ndarray, labels: np.ndarray, **options: int) -> HistGradientBoostingClassifier:
    model = HistGradientBoostingClassifier(max_iter=15, random_state=0, early_stopping=False)
    with threadpool_limits(1):
        return model.set_params(**options).fit(rows, labels)


@pytest.fixture(scope="module")
def small() -> HistGradientBoostingClassifier:
    """Trees of three columns, some of whose values were missing."""
    return fitted(*examples(700, 3, 6, 0.1))


@pytest.mark.parametrize("missing", [0.0, 0.2])
@pytest.mark.parametrize("seed", [0, 1])
def test_probabilities_are_scikit_learns(missing: float, seed: int) -> None:
    rows, labels = examples(1500, 6, seed, missing)
    model = fitted(rows, labels)
    forest = Forest.of(model, np.arange(6))
    unseen, _ = examples(800, 6, seed + 10, 0.2)
    for some in (rows, unseen):
        expected = model.predict_proba(some)[:, 1]
        np.testing.assert_allclose(forest.probability(some), expected, atol=2e-6)


def test_missing_values_go_where_they_went_in_learning() -> None:
    """A column that is missing exactly where the answer is yes."""
    rng = np.random.default_rng(3)
    rows = rng.normal(size=(600, 2)).astype(np.float32)
    labels = rng.integers(0, 2, 600)
    rows[labels == 1, 0] = np.nan
    model = fitted(rows, labels)
    forest = Forest.of(model, np.arange(2))
    found = forest.probability(rows)
    np.testing.assert_allclose(found, model.predict_proba(rows)[:, 1], atol=2e-6)
    assert found[labels == 1].min() > 0.8 > 0.2 > found[labels == 0].max()


def test_values_a_rounding_apart_are_told_apart() -> None:
    """Thresholds lie half way between neighbouring float32 numbers, where float32 has none."""
    one = np.float32(1.0)
    values = [one]
    for _ in range(9):
        values.append(np.nextafter(values[-1], np.float32(2.0)))
    rows = np.repeat(np.array(values, dtype=np.float32), 60)[:, None]
    labels = np.repeat(np.arange(10) % 2, 60)
    model = fitted(rows, labels, min_samples_leaf=5)
    expected = model.predict_proba(rows)[:, 1]
    assert expected[labels == 1].min() > 0.5 > expected[labels == 0].max()
    np.testing.assert_allclose(
        Forest.of(model, np.arange(1)).probability(rows), expected, atol=2e-6
    )


def test_columns_of_the_model_may_lie_anywhere_in_the_rows() -> None:
    rows, labels = examples(800, 4, 5, 0.1)
    columns = np.array([7, 2, 5, 0])
    wide = np.full((800, 9), np.nan, dtype=np.float32)
    wide[:, columns] = rows
    model = fitted(rows, labels)
    found = Forest.of(model, columns).probability(wide)
    np.testing.assert_allclose(found, model.predict_proba(rows)[:, 1], atol=2e-6)


@pytest.mark.parametrize("shape", [(0,), (1,), (511,), (513,), (40, 30), (0, 4)])
def test_any_shape_of_rows(small: HistGradientBoostingClassifier, shape: tuple[int, ...]) -> None:
    forest = Forest.of(small, np.arange(3))
    some = np.random.default_rng(7).normal(size=(*shape, 3)).astype(np.float32)
    found = forest.probability(some)
    assert found.shape == shape
    if some.size:
        expected = small.predict_proba(some.reshape(-1, 3))[:, 1]
        np.testing.assert_allclose(found.ravel(), expected, atol=2e-6)


def test_a_forest_is_kept_as_arrays(small: HistGradientBoostingClassifier) -> None:
    rows, _ = examples(700, 3, 8, 0.1)
    forest = Forest.of(small, np.arange(3))
    again = Forest.from_arrays(forest.arrays("some "), "some ")
    np.testing.assert_array_equal(again.probability(rows), forest.probability(rows))
    with pytest.raises(KeyError):
        Forest.from_arrays(forest.arrays("some "), "other ")
