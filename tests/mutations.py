"""Files spoilt at random."""

from __future__ import annotations

import random
from collections.abc import Sequence


def mutated(data: bytes, chance: random.Random, snippets: Sequence[bytes], header: int) -> bytes:
    """Change a file in one to eight places; a third of the changes land in its header."""
    text = bytearray(data)
    for _ in range(chance.choice([1, 1, 1, 2, 3, 8])):
        limit = header if chance.random() < 0.35 else len(text)
        at = chance.randrange(max(1, min(limit, len(text))))
        kind = chance.randrange(7)
        if kind == 0:
            text[at : at + 1] = bytes([chance.randrange(256)])
        elif kind == 1:
            del text[at : at + chance.choice([1, 1, 5, 50])]
        elif kind == 2:
            text[at:at] = chance.choice(snippets)
        elif kind == 3:
            del text[at:]
        elif kind == 4:
            end = at + chance.choice([1, 20, 200])
            text[at:at] = text[at:end]
        elif kind == 5:
            words = bytes(text).split()
            word = chance.choice(words) if words else b"0"
            text = bytearray(bytes(text).replace(word, chance.choice(snippets), 1))
        else:
            lines = bytes(text).splitlines(keepends=True)
            chance.shuffle(lines) if chance.random() < 0.1 else lines.pop(
                chance.randrange(len(lines))
            )
            text = bytearray(b"".join(lines))
        if not text:
            return b""
    return bytes(text)
