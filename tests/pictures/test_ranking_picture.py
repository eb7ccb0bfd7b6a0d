"""Several performances beside one reference, the most alike first."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from made_takes import paced, walking

from mocapstudio.comparison.kata import compare
from mocapstudio.comparison.model import Comparison
from mocapstudio.comparison.parameters import ComparisonParameters
from mocapstudio.motion.progress import run
from mocapstudio.pictures.ranking_picture import ranking_picture


@pytest.fixture(scope="module")
def comparisons() -> list[Comparison]:
    take = walking(4.0, variation=0.3)
    even, uneven = np.ones(90), np.concatenate([np.full(30, 2.0), np.full(50, 0.5)])
    found = []
    for name, pace in (("uneven", uneven), ("even", even)):
        source = replace(paced(take, pace), name=f"a performance with a long name, {name}")
        found.append(run(compare(take, source, ComparisonParameters(true_speed=True))))
    return found


def test_the_most_alike_stands_first(comparisons: list[Comparison]) -> None:
    uneven, even = comparisons
    assert even.dissimilarity < uneven.dissimilarity
    text = ranking_picture(comparisons, svg=True).png.decode()
    first, second = text.index("1  …"), text.index("2  …")
    assert "even" in text[first : first + 40] and "uneven" not in text[first : first + 40]
    assert "uneven" in text[second : second + 40]
    assert f"dissimilarity {even.dissimilarity:.3f}" in text


def test_every_performance_has_a_row_of_its_own(comparisons: list[Comparison]) -> None:
    def height(count: int) -> int:
        png = ranking_picture(comparisons[:count]).png
        return int.from_bytes(png[20:24], "big")

    assert height(2) > height(1) + 100
