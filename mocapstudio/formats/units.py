"""Units of length as files name them."""

from __future__ import annotations

import math

_NAMES = {
    "mm": (0.001, "millimeter", "millimetre", "millimeters", "millimetres"),
    "cm": (0.01, "centimeter", "centimetre", "centimeters", "centimetres"),
    "dm": (0.1, "decimeter", "decimetre", "decimeters", "decimetres"),
    "m": (1.0, "meter", "metre", "meters", "metres"),
    "in": (0.0254, "inch", "inches"),
    "ft": (0.3048, "foot", "feet"),
}
METRES = {short: metres for short, (metres, *_) in _NAMES.items()}
"""Metres per unit by short name."""

_BY_NAME = {name: METRES[short] for short, (_, *long) in _NAMES.items() for name in (short, *long)}


def unit_of(text: str) -> float | None:
    """Metres per unit of a name such as ``mm``, ``(m)`` or ``Millimeters``; None if it is none."""
    return _BY_NAME.get(text.strip(" []()").lower())


def name_of(metres: float) -> str | None:
    """Short name of the unit that has so many metres, or None."""
    return next((s for s, m in METRES.items() if math.isclose(m, metres, rel_tol=1e-9)), None)
