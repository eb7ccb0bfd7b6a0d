"""The frames of an AMC as spans of bytes, so that single values can be replaced."""

from __future__ import annotations

import re
from collections.abc import Iterator

from mocapstudio.formats.amc_read import AmcRecord

Cells = dict[tuple[int, str], dict[int, float]]
"""New values by frame and bone, and the place among the bone's values."""

_TOKEN = re.compile(rb"#[^\r\n]*|[^\s#]+")
_LINE_END = re.compile(rb"\r\n|\r|\n")
# Of an angle in degrees, ten times what 32-bit floats hold.
_DIGITS = 9


class AmcText:
    """Where the words of every frame stand in the source's text."""

    def __init__(self, record: AmcRecord) -> None:
        self.data = record.data
        channels = {bone.name: len(bone.dof) for bone in (*record.asf.bones, *record.asf.loose)}
        self.channels = {name: count for name, count in channels.items() if count}
        self.width = 1 + sum(1 + count for count in self.channels.values())
        self.frames = len(next(iter(record.values.values())))
        start = _line_start(self.data, record.line)
        self.spans = [
            word.span()
            for word in _TOKEN.finditer(self.data, start)
            if self.data[word.start()] != ord("#")
        ]

    def spliced(self, cells: Cells, span: tuple[int, int]) -> Iterator[bytes]:
        """Bytes of the frames of `span`, and of what stands before and after all frames.

        Parameters
        ----------
        cells
            New values.
        span
            Half-open, of frames.
        """
        first, last = span
        at = 0
        if first > 0:
            yield self.data[: self.spans[0][0]]
            at = self.spans[first * self.width][0]
        by_frame: dict[int, list[tuple[str, dict[int, float]]]] = {}
        for (frame, bone), values in cells.items():
            if first <= frame < last:
                by_frame.setdefault(frame, []).append((bone, values))
        for frame in sorted(by_frame):
            for start, end, text in self.replaced(frame, dict(by_frame[frame])):
                yield self.data[at:start]
                yield text
                at = end
        if last < self.frames:
            yield self.data[at : self.spans[last * self.width - 1][1]]
            at = self.spans[self.frames * self.width - 1][1]
        yield self.data[at:]

    def replaced(
        self, frame: int, new: dict[str, dict[int, float]]
    ) -> list[tuple[int, int, bytes]]:
        """Spans of bytes within a frame and what is put there, in their order."""
        found = []
        at = frame * self.width + 1
        while at < (frame + 1) * self.width:
            start, end = self.spans[at]
            name = self.name(self.data[start:end])
            for place, value in sorted(new.get(name, {}).items()):
                text = f"{value:.{_DIGITS}g}".encode()
                found.append((*self.spans[at + 1 + place], text))
            at += 1 + self.channels[name]
        return found

    def name(self, word: bytes) -> str:
        """Name of the bone that a word is."""
        for encoding in ("utf-8", "latin-1"):
            name = word.decode(encoding, "replace")
            if name in self.channels:
                return name
        raise KeyError(word)


def _line_start(data: bytes, line: int) -> int:
    ends = _LINE_END.finditer(data)
    at = 0
    for _ in range(line - 1):
        at = next(ends).end()
    return at
