"""Units of length as files name them."""

from __future__ import annotations

import math

METRES = {"mm": 0.001, "cm": 0.01, "dm": 0.1, "m": 1.0, "in": 0.0254, "ft": 0.3048}
"""Metres per unit by short name."""

_LONG = {
    "mm": "millimeter millimetre millimeters millimetres",
    "cm": "centimeter centimetre centimeters centimetres",
    "dm": "decimeter decimetre decimeters decimetres",
    "m": "meter metre meters metres",
    "in": "inch inches",
    "ft": "foot feet",
}
_BY_NAME = {name: METRES[s] for s, long in _LONG.items() for name in (s, *long.split())}


def unit_of(text: str) -> float | None:
    """Metres per unit of a name such as ``mm``, ``(m)`` or ``Millimeters``; None if it is none."""
    return _BY_NAME.get(text.strip(" []()").lower())


def name_of(metres: float) -> str | None:
    """Short name of the unit that has so many metres, or None."""
    return next((s for s, m in METRES.items() if math.isclose(m, metres, rel_tol=1e-9)), None)
