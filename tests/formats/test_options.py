from __future__ import annotations

from fractions import Fraction

import pytest

from mocapstudio.formats.options import parse_rate, parse_unit
from mocapstudio.motion.errors import ParameterError


@pytest.mark.parametrize(
    ("text", "rate"),
    [
        ("30", 30),
        ("119.88", Fraction(120_000, 1001)),
        ("29.97", Fraction(30_000, 1001)),
        ("23.976", Fraction(24_000, 1001)),
        ("120000/1001", Fraction(120_000, 1001)),
        ("12.5", Fraction(25, 2)),
        ("59.5", Fraction(119, 2)),
    ],
)
def test_rates(text: str, rate) -> None:
    assert parse_rate(text) == rate


@pytest.mark.parametrize(
    "text",
    ["", "fast", "0", "-30", "1/0", "nan", "inf", "1e99", "1e-99", "1e-999999999", "1E+999999999"],
)
def test_what_is_no_rate(text: str) -> None:
    with pytest.raises(ParameterError):
        parse_rate(text)


@pytest.mark.parametrize(
    ("text", "unit"), [("m", 1.0), ("cm", 0.01), ("in", 0.0254), ("asf", 0.0254 / 0.45), ("3", 3)]
)
def test_units(text: str, unit: float) -> None:
    assert parse_unit(text) == unit


@pytest.mark.parametrize("text", ["", "ell", "0", "-1", "nan", "inf"])
def test_what_is_no_unit(text: str) -> None:
    with pytest.raises(ParameterError):
        parse_unit(text)
