"""Bytes of a file with some of them replaced."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

Splice = tuple[int, int, bytes]
"""Half-open span of bytes, and what stands in its place."""


def spliced(data: bytes, splices: Sequence[Splice]) -> Iterator[bytes]:
    """Yield `data` with its splices, which are sorted and do not overlap."""
    at = 0
    for start, end, text in splices:
        yield data[at:start]
        yield text
        at = end
    yield data[at:]
