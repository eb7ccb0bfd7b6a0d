"""Segment labels: the named parts of a performance, in a JSON file of their own.

A file holds one object ``{"take", "fps", "segments": [{"name", "start", "end"}]}`` or a list of
such objects; frames are 0-based at that rate, ends exclusive.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison.model import Segment
from mocapstudio.formats.atomic import write_whole
from mocapstudio.formats.json_file import read_json
from mocapstudio.formats.options import parse_rate
from mocapstudio.formats.registry import readable_suffixes
from mocapstudio.motion.errors import FileError, MocapError


@dataclass(frozen=True)
class Labels:
    """The segments of one take.

    Parameters
    ----------
    take
        Name of the take: the stem of its file.
    rate
        Frames a second at which the segments count.
    segments
        In order of time, none overlapping another; what lies between them has no name.

    Raises
    ------
    MocapError
        If a segment is empty, begins before frame 0, or overlaps the one before.
    """

    take: str
    rate: Fraction
    segments: tuple[Segment, ...]

    def __post_init__(self) -> None:
        last = 0
        for i, segment in enumerate(self.segments):
            if segment.start >= segment.end:
                raise MocapError(f"segment {i} ({segment.name}) ends before it begins")
            if segment.start < last:
                before = "frame 0" if i == 0 else f"the end of segment {i - 1}"
                raise MocapError(f"segment {i} ({segment.name}) begins before {before}")
            last = segment.end

    @property
    def names(self) -> tuple[str, ...]:
        """The different names, in order of first appearance."""
        return tuple(dict.fromkeys(segment.name for segment in self.segments))

    def at(self, frame: int) -> str | None:
        """Name of the segment that holds a frame, or None between segments."""
        for segment in self.segments:
            if segment.start <= frame < segment.end:
                return segment.name
        return None

    def at_rate(self, rate: Fraction) -> Labels:
        """Return the same labels counted at another rate; every segment keeps a frame at least."""
        if rate == self.rate:
            return self
        scale, moved, last = rate / self.rate, [], 0
        for segment in self.segments:
            start = max(round(segment.start * scale), last)
            last = max(round(segment.end * scale), start + 1)
            moved.append(Segment(segment.name, start, last))
        return Labels(self.take, rate, tuple(moved))

    def codes(self, names: Sequence[str], frames: int) -> NDArray[np.int32]:
        """(frames,) position in `names` of each frame's segment, -1 between segments.

        Names that are not among `names` raise a ValueError.
        """
        codes = np.full(frames, -1, np.int32)
        for segment in self.segments:
            codes[segment.start : segment.end] = names.index(segment.name)
        return codes

    def to_json(self) -> dict[str, Any]:
        """Plain objects for JSON."""
        rate = self.rate
        fps = int(rate) if rate.denominator == 1 else float(rate)
        segments = [{"name": s.name, "start": s.start, "end": s.end} for s in self.segments]
        return {"take": self.take, "fps": fps, "segments": segments}


def read_labels(path: Path) -> list[Labels]:
    """Read the labels of one take or several.

    Raises
    ------
    FileError
        If the file cannot be read, is no JSON, or does not hold labels.
    """
    content = read_json(path, "segment labels")
    objects = content if isinstance(content, list) else [content]
    try:
        return [_labels(one) for one in objects]
    except MocapError as cause:
        raise FileError(path, f"does not hold segment labels: {cause}") from cause


def labels_of(take: str, labels: Iterable[Labels]) -> Labels | None:
    """Return the labels of a take by its name, or None.

    Folders and the endings of motion files do not count: ``takes/squat_1.bvh`` is ``squat_1``.
    """
    return next((one for one in labels if _bare(one.take) == _bare(take)), None)


def _bare(take: str) -> str:
    # A name such as mawashi.geri.left.1 has dots of its own.
    path = Path(take)
    return path.stem if path.suffix.lower() in readable_suffixes() else path.name


def write_labels(labels: Labels | Sequence[Labels], path: Path) -> None:
    """Write the labels of one take, or of several as a list.

    Raises
    ------
    FileError
        If the file cannot be written; an older file of that name is then left as it was.
    """
    # A take a line, so that a person can read and change them.
    many = [labels] if isinstance(labels, Labels) else labels
    lines = ",\n ".join(json.dumps(one.to_json(), ensure_ascii=False) for one in many)
    text = lines if isinstance(labels, Labels) else f"[{lines}]"
    write_whole(path, [(text + "\n").encode()])


def _labels(content: Any) -> Labels:
    if not isinstance(content, dict):
        raise MocapError("an object with take, fps and segments is wanted")
    take, fps, segments = (content.get(key) for key in ("take", "fps", "segments"))
    if not isinstance(take, str) or not take:
        raise MocapError("take must be a name")
    if isinstance(fps, bool) or not isinstance(fps, int | float):
        raise MocapError("fps must be a number")
    if not isinstance(segments, list):
        raise MocapError("segments must be a list")
    found = tuple(_segment(i, one) for i, one in enumerate(segments))
    return Labels(take, parse_rate(str(fps)), found)


def _segment(i: int, content: Any) -> Segment:
    if not isinstance(content, dict):
        raise MocapError(f"segment {i} must be an object with name, start and end")
    name, start, end = (content.get(key) for key in ("name", "start", "end"))
    if not isinstance(name, str) or not name:
        raise MocapError(f"segment {i} has no name")
    for key, value in (("start", start), ("end", end)):
        if isinstance(value, bool) or not isinstance(value, int):
            raise MocapError(f"{key} of segment {i} ({name}) must be a whole number")
    assert isinstance(start, int)
    assert isinstance(end, int)
    return Segment(name, start, end)
