"""The compiled parser against Python's own `float`."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mocapstudio.formats.motion_kernel import parse_regular

DECIMALS = st.builds(
    lambda sign, whole, part: f"{sign}{whole}{part}",
    st.sampled_from(["", "-", "+"]),
    st.integers(0, 99_999).map(str),
    st.sampled_from(["", "."]) | st.integers(0, 9_999_999).map(lambda n: f".{n:07d}"),
)
ANY_NUMBER = (
    DECIMALS
    | st.floats(-1e6, 1e6).map(repr)
    | st.builds("{}e{:+d}".format, DECIMALS, st.integers(-30, 30))
    | st.sampled_from([".5", "-.25", "5.", "-0", "-0.0", "000.100", "1E5", "12345678901234567890"])
)


def parse(text: str, columns: int, stated: int):
    data = text.encode()
    return parse_regular(data, 0, len(data), columns, stated)


@settings(max_examples=300, deadline=None)
@given(st.lists(st.tuples(ANY_NUMBER, ANY_NUMBER, ANY_NUMBER), min_size=1, max_size=20))
def test_every_bit_is_that_of_float(rows) -> None:
    text = "\n".join(" ".join(row) for row in rows)
    found = parse(text, 3, len(rows))
    expected = np.array([[float(cell) for cell in row] for row in rows])
    if found is not None:
        np.testing.assert_array_equal(found, expected)
        np.testing.assert_array_equal(np.signbit(found), np.signbit(expected))


@given(st.lists(st.tuples(DECIMALS, DECIMALS), min_size=1, max_size=20))
def test_plain_decimals_are_never_left_to_the_slow_parser(rows) -> None:
    assert parse("\n".join(" ".join(row) for row in rows), 2, len(rows)) is not None


@pytest.mark.parametrize(
    "text",
    [
        *("1 2 3\n1 2\n", "1 2\n", "1 2 3 4\n", "1\n2 3\n", "1 2 3\n4 5 6\n7", "1 2 x\n"),
        *("1 2 nan\n", "1 2 inf\n", "1 2 3_0\n", "1 2 -\n", "1 2 .\n", "1 2 1e\n", "1 2 1.2.3\n"),
        *("1 2 0x1\n", "1,2,3\n", "1 2 0.0-7.5\n", "1 2 --3\n", "1 2 1e99999\n", "1 2 \x00\n"),
        *("1 2 3\n4 5 6\n7 8 9\n# end", "1 2 ३\n"),
    ],
)
def test_anything_unusual_is_left_to_the_strict_parser(text: str) -> None:
    assert parse(text, 3, 2) is None


def test_a_stated_billion_is_not_allocated() -> None:
    found = parse("1 2 3\n4 5 6\n", 3, 10**9)
    assert found is not None
    assert found.base.nbytes < 1000


def test_rows_beyond_those_stated_are_not_lost_silently() -> None:
    found = parse("1 2\n" * 10, 2, 5)
    assert found is None or len(found) != 5
