"""Marker labels taken apart: subject, side and part."""

from __future__ import annotations

import re

_SIDE = re.compile(r"^(left|right|l|r)(?=.)")


def bare(label: str) -> str:
    """Return a label without subject, suffix and punctuation, in lower case: ``"lfhd"``."""
    name = label.split(":")[-1].lower().removesuffix("_study")
    return re.sub(r"[^a-z0-9#]", "", name)


def split_side(name: str) -> tuple[str, str]:
    """Split a bare label into ``"left"``, ``"right"`` or ``""``, and the part."""
    found = _SIDE.match(name)
    if not found:
        return "", name
    return ("left" if found[1][0] == "l" else "right"), name[found.end() :]
