"""A BVH file's cells, read by nothing but string splitting: what the exported text really says."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np


@dataclass(frozen=True)
class Cells:
    """Everything above the motion, the channels, and the motion as text and as numbers."""

    head: str
    channels: tuple[tuple[str, str], ...]
    """Joint and channel of each column."""
    texts: tuple[tuple[str, ...], ...]

    @property
    def numbers(self) -> np.ndarray:
        """(frames, channels)."""
        return np.array(self.texts, dtype=float)


def read_cells(path: Path) -> Cells:
    """Read a file."""
    head, _, body = path.read_text().partition("MOTION")
    channels: list[tuple[str, str]] = []
    joint = ""
    for line in head.splitlines():
        words = line.split()
        if words[:1] in (["ROOT"], ["JOINT"]):
            joint = words[1]
        elif words[:1] == ["CHANNELS"]:
            channels += [(joint, word) for word in words[2:]]
    rows = [tuple(line.split()) for line in body.strip().splitlines()[2:]]
    return Cells(head, tuple(channels), tuple(row for row in rows if row))


def changed_cells(before: Cells, after: Cells) -> set[tuple[str, str, int]]:
    """Joint, channel and 0-based frame of every cell whose text differs."""
    return {
        (*before.channels[column], frame)
        for frame, (old, new) in enumerate(zip(before.texts, after.texts, strict=True))
        for column, (a, b) in enumerate(zip(old, new, strict=True))
        if a != b
    }
