"""The smallest local minima: over breaks, barred spans and flat stretches."""

from __future__ import annotations

import naive
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from mocapstudio.similarity import kernels

FAR = 1e30


def run(
    values: list[float], breaks: list[int], keep: int, barred: tuple[int, int] = (0, 0)
) -> list[int]:
    found = np.full(keep, -7, dtype=np.int64)
    count = kernels.smallest_minima(
        np.array(values, dtype=np.float32),
        np.array(breaks, dtype=np.int64),
        keep,
        np.array(barred, dtype=np.int64),
        found,
    )
    assert np.all(found[count:] == -7)
    return found[:count].tolist()


@settings(max_examples=400)
@given(st.data())
def test_they_are_those_of_the_definition(data: st.DataObject) -> None:
    size = data.draw(st.integers(1, 40))
    # Few levels, so that ties and flat stretches abound.
    value = st.sampled_from([1.0, 2.0, 3.0, 4.0, FAR])
    values = data.draw(st.lists(value, min_size=size, max_size=size))
    others = data.draw(st.sets(st.integers(1, size), max_size=4))
    begin = data.draw(st.integers(-3, size + 3))
    barred = (begin, begin + data.draw(st.integers(0, 8)))
    breaks = [0, *sorted(b for b in others if b < size)]
    keep = data.draw(st.integers(1, 6))
    assert run(values, breaks, keep, barred) == naive.minima(values, breaks, keep, barred)


@settings(max_examples=50)
@given(st.integers(0, 10**6), st.integers(1, 8))
def test_they_are_those_of_the_definition_on_long_curves(seed: int, keep: int) -> None:
    rng = np.random.default_rng(seed)
    values = np.abs(np.cumsum(rng.normal(size=300))).astype(np.float32).tolist()
    breaks = [0, *sorted(rng.choice(np.arange(1, 300), 3, replace=False).tolist())]
    assert run(values, breaks, keep, (100, 130)) == naive.minima(values, breaks, keep, (100, 130))


def test_a_minimum_does_not_look_across_a_break() -> None:
    values = [3.0, 2.0, 1.0, 2.0, 3.0]
    assert run(values, [0], 3) == [2]
    assert run(values, [0, 2], 3) == [2, 1]
    assert run(values, [0, 3], 3) == [2, 3]


def test_a_slope_beside_a_barred_span_is_no_minimum() -> None:
    values = [3.0, 2.0, 1.0, 0.0, 1.0, 2.0, 3.0]
    assert run(values, [0], 3, (2, 5)) == []


def test_a_flat_stretch_counts_where_it_is_a_bottom() -> None:
    assert run([3.0, 1.0, 1.0, 1.0, 3.0], [0], 3) == [1]
    assert run([3.0, 2.0, 2.0, 1.0, 2.0], [0], 3) == [3]
    assert run([1.0, 1.0, 1.0], [0], 3) == [0]
