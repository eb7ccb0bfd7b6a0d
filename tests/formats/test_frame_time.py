from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from mocapstudio.formats.frame_time import frame_time, rate_from_frame_time, stated_rate

NTSC = {n: Fraction(n * 1000, 1001) for n in (30, 60, 120, 240)}


@pytest.mark.parametrize(
    ("written", "rate"),
    [
        ("0.0083333", 120),
        (".0083333", 120),
        ("0.008333", 120),
        ("0.00833", 120),
        ("0.0083", 120),
        ("0.00833333333333", 120),
        ("8.33333e-3", 120),
        ("0.008342", NTSC[120]),
        ("0.00834167", NTSC[120]),
        ("0.0333333", 30),
        ("0.033333", 30),
        ("0.0333", 30),
        ("0.033", 30),
        ("0.0333667", NTSC[30]),
        ("0.033367", NTSC[30]),
        ("0.03336", NTSC[30]),
        ("0.0416667", 24),
        ("0.041667", 24),
        ("0.041708", Fraction(24_000, 1001)),
        ("0.016667", 60),
        ("0.0167", 60),
        ("0.0166", 60),
        ("0.016683", NTSC[60]),
        ("0.0041667", 240),
        ("0.01", 100),
        ("0.010000", 100),
        ("1e-2", 100),
        ("0.04", 25),
        ("0.02", 50),
        ("0.008", 125),
        ("0.005", 200),
        ("0.001", 1000),
        ("0.0066667", 150),
        ("0.011111", 90),
        ("0.027027", 37),
        ("0.5", 2),
        ("1", 1),
    ],
)
def test_rates(written: str, rate) -> None:
    assert rate_from_frame_time(written) == rate


@given(rate=st.integers(2, 500), decimals=st.integers(7, 12))
def test_whole_rates_survive_any_rounding(rate: int, decimals: int) -> None:
    assert rate_from_frame_time(f"{1 / rate:.{decimals}f}") == rate


@given(st.floats(1e-5, 2.0).map(lambda x: f"{x:.9f}"))
def test_the_rate_is_that_of_the_text(written: str) -> None:
    rate = rate_from_frame_time(written)
    assert abs(float(rate) * float(written) - 1) < 1e-3 or float(written) < 1e-4


@given(st.fractions(Fraction(1, 2), 1000, max_denominator=1001))
@example(Fraction(12500, 13))
def test_what_is_written_is_told_again(rate: Fraction) -> None:
    told, problem = stated_rate(frame_time(rate))
    assert abs(told / rate - 1) < Fraction(1, 1_000_000)
    assert problem is None


@pytest.mark.parametrize("text", ["fast", "nan", "inf", "0x1", "1_0", "1.2.3", "--1", "1e9999"])
def test_what_is_no_number(text: str) -> None:
    with pytest.raises(ValueError, match="is not a number"):
        stated_rate(text)


@pytest.mark.parametrize(
    ("text", "rate"), [("", 100), ("0", 100), ("-1", 100), ("1e-300", 100), ("8.3333", 120)]
)
def test_what_is_odd_is_told(text: str, rate: int) -> None:
    told, problem = stated_rate(text, line=7)
    assert told == rate
    assert problem is not None
    assert problem.guess
    assert (problem.line, problem.override) == (7, "fps")
