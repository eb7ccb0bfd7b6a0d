"""What a matrix of two motions shows: distances as fine as there is room for, costs, and parts."""

from __future__ import annotations

import numpy as np
import pytest
from made_comparison import comparison

from mocapstudio.review.matrix_model import ComparedMatrix, Picture, cropped

WHOLE = (-0.5, 299.5), (-0.5, 239.5)


@pytest.fixture(scope="module")
def matrix() -> ComparedMatrix:
    return ComparedMatrix(comparison((300, 240)))


def test_accumulated_costs_are_those_of_the_cheapest_way(matrix) -> None:
    distances = matrix.pooled(Picture.DISTANCES, *WHOLE, 300).values.astype(float)
    costs = matrix.pooled(Picture.ACCUMULATED, *WHOLE, 300).values
    expected = np.full((301, 241), np.inf)
    expected[0, 0] = 0.0
    for i in range(300):
        for j in range(240):
            before = min(expected[i, j], expected[i, j + 1], expected[i + 1, j])
            expected[i + 1, j + 1] = distances[i, j] + before
    np.testing.assert_allclose(costs, expected[1:, 1:], rtol=1e-4, atol=1e-4)


def test_a_part_is_cut_out_of_the_whole(matrix) -> None:
    whole = matrix.pooled(Picture.ACCUMULATED, *WHOLE, 300)
    part = cropped(whole, (99.5, 149.5), (9.5, 59.5))
    (first, step), (begin, width) = part.reference, part.source
    assert first <= 100
    assert first + step * part.values.shape[0] >= 150
    assert begin <= 10
    assert begin + width * part.values.shape[1] >= 60
    np.testing.assert_array_equal(part.values[0], whole.values[int(first), int(begin) :][:52])
    nothing = cropped(whole, (900.0, 950.0), (-90.0, -50.0))
    assert nothing.values.size > 0, "where nothing is in sight the nearest is"
