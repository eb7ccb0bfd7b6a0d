"""Names made short: what all of them share is left out. No Qt."""

from __future__ import annotations

import re
from collections.abc import Sequence

_PIECE = re.compile(r"[^_\-. ]+[_\-. ]*|[_\-. ]+")


def short_names(names: Sequence[str]) -> dict[str, str]:
    """Return each name without the words that all begin with, and those that all end with.

    ``take_bow_angry_001`` beside ``take_bow_old_001`` is ``angry``. A single name stays whole.
    """
    pieces = [_PIECE.findall(name) for name in names]
    if len(set(names)) < 2 or not all(pieces):
        return {name: name for name in names}
    least = min(len(one) for one in pieces)
    first = _differing(pieces, least)
    # A number alone says little: the word before it stays.
    if first and all(one[first:] and one[first].strip("_-. ").isdigit() for one in pieces):
        first -= 1
    room = least - first
    last = next(
        (k for k in range(room) if len({one[-1 - k] for one in pieces}) > 1), max(room - 1, 0)
    )
    short = {}
    for name, one in zip(names, pieces, strict=True):
        kept = "".join(one[first : len(one) - last]).strip("_-. ")
        short[name] = kept or name
    return short if len(set(short.values())) == len(set(names)) else {n: n for n in names}


def _differing(pieces: Sequence[Sequence[str]], least: int) -> int:
    """Position of the first piece that is not the same in all."""
    return next((k for k in range(least) if len({one[k] for one in pieces}) > 1), least - 1)
