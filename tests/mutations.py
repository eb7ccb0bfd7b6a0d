"""Files spoilt at random, and what reading them costs."""

from __future__ import annotations

import random
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

LONGEST, LARGEST = 2.0, 200
"""Seconds of one file, and megabytes that all of them may add to the process."""


def peak() -> float:
    """Megabytes that the process held at most so far; 0 where the system does not tell."""
    if sys.platform == "win32":
        return 0.0
    import resource

    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return most / (1 << 20 if sys.platform == "darwin" else 1 << 10)


@dataclass
class Watch:
    """How many spoilt files were read, got past the header, and what they cost."""

    files: int = 0
    read: int = 0
    past: int = 0
    longest: float = 0.0
    slowest: int = -1
    start: float = field(default_factory=peak)

    @contextmanager
    def file(self, seed: int) -> Iterator[None]:
        """Measure what reads one file: no longer than `LONGEST`."""
        began = time.process_time()
        try:
            yield
        finally:
            took = time.process_time() - began
            self.files += 1
            if took > self.longest:
                self.longest, self.slowest = took, seed
            assert took < LONGEST, f"seed {seed}"

    def accepted(self) -> None:
        """Count a file that was read."""
        self.read += 1
        self.past += 1

    def refused(self, place: int | None, header: int) -> None:
        """Count a file refused at a line or byte."""
        self.past += (place or 0) > header

    def judge(self, name: str) -> None:
        """Tell what was seen; fail where it tells nothing or memory grew."""
        grown = peak() - self.start
        print(
            f"{name}: {self.files} files, {self.read} read, {self.past / self.files:.0%} past the"
            f" header, longest {self.longest:.3f} s (seed {self.slowest}), {grown:.0f} MB more"
        )
        assert grown < LARGEST
        assert self.past >= 0.3 * self.files, "too few get past the header to tell anything"
        assert self.files // 20 < self.read < self.files, "too hard or too mild to tell anything"


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
