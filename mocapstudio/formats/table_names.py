"""What the names of a table's columns say: whose, which quantity, which axis, which unit."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field

from mocapstudio.formats.units import unit_of

POSITION = "positions"

_KINDS = {
    POSITION: "d p t pos position positions trans translation loc location coord coordinates",
    "rotations": "r q rot rotation rotations euler angle angles quat quaternion ori orientation",
    "accelerations": "a acc accel acceleration accelerometer",
    "velocities": "v vel velocity g gyro gyroscope",
    "forces": "f force m moment mag",
}
_KIND_OF = {word: kind for kind, words in _KINDS.items() for word in words.split()}
_SEPARATORS = " ._:-/|"
_BEFORE_AXIS = re.compile(rf"(\s+[-|/:]\s+|:\s+|\s+|[{re.escape(_SEPARATORS)}])$")
"""One separator: a label may end with another."""
_WORD = re.compile(rf"(?:^|[{re.escape(_SEPARATORS)}])([A-Za-z]+)$")
_CAMEL = re.compile(r"(?<=[a-z0-9])(Position|Pos|Rotation|Rot|Translation|Acceleration|Acc)$")
_UNIT = re.compile(r"\s*[\[(]([^\])]*)[\])]\s*$")
_PREFIX = re.compile(rf"([xyz])[{re.escape(_SEPARATORS)}]?(.+)", re.IGNORECASE)

_FRAME = re.compile(r"frames?[ _]?(#|no\.?|nr\.?|number|index|id)?|#|index|sample", re.IGNORECASE)
_TIME = re.compile(r"time([ _]?stamp)?|t|seconds?|elapsed([ _]time)?", re.IGNORECASE)
_TIMECODE = re.compile(r"smpte|time[ _]?code|tc", re.IGNORECASE)
_TICKS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9}
_TICK = re.compile(r"[ _]*[\[(]?(ms|us|µs|ns|s|sec(?:onds)?|milliseconds)[\])]?$", re.IGNORECASE)


@dataclass(frozen=True)
class Name:
    """What the name of one column says.

    Attributes
    ----------
    base
        Whose it is.
    kind
        ``"positions"`` or another quantity.
    axis
        x, y, z or w.
    unit
        Metres per unit, or None where the name says nothing of it.
    """

    base: str
    kind: str
    axis: str
    unit: float | None = None


@dataclass
class Triple:
    """Columns of one quantity of one marker or joint.

    Attributes
    ----------
    base, kind, unit
        As in `Name`.
    cells
        Column of each axis.
    """

    base: str
    kind: str
    unit: float | None
    cells: dict[str, int] = field(default_factory=dict)

    @property
    def whole(self) -> bool:
        """Whether all three axes are there."""
        return {"x", "y", "z"} <= self.cells.keys()


@dataclass(frozen=True)
class Leading:
    """Columns that are no positions.

    Attributes
    ----------
    frame, time, timecode
        Column of each, or None.
    tick
        Seconds per unit of the times.
    """

    frame: int | None = None
    time: int | None = None
    timecode: int | None = None
    tick: float = 1.0


def read_name(text: str) -> Name | None:
    """Take a name with an axis at its end apart: ``Hips X``, ``Hips.Dx``, ``hip_pos_x (mm)``."""
    found = _UNIT.search(text)
    unit = unit_of(found.group(1)) if found else None
    text = text[: found.start()].rstrip() if found else text.rstrip()
    if not text or text[-1].lower() not in "xyzw":
        return None
    stem = _BEFORE_AXIS.sub("", text[:-1])
    separated = len(stem) < len(text) - 1
    base, kind = stem, POSITION
    word = _WORD.search(stem)
    if word and (len(word.group(1)) > 1 or not separated):
        known = _KIND_OF.get(word.group(1).lower())
        if known:
            base, kind = stem[: word.start()], known
    camel = _CAMEL.search(stem)
    if base == stem and camel:
        base, kind = stem[: camel.start()], _KIND_OF[camel.group(1).lower()]
    return Name(base.lstrip(_SEPARATORS).rstrip(), kind, text[-1].lower(), unit)


def triples(names: Sequence[Name | None]) -> list[Triple]:
    """Gather columns by whose and what they are; quaternions count as rotations.

    Only those with all of x, y and z are returned, in the order of their first columns.
    """
    found: list[Triple] = []
    last: dict[tuple[str, str], Triple] = {}
    for column, name in enumerate(names):
        if name is None:
            continue
        one = last.get((name.base, name.kind))
        # A name that comes again belongs to another marker of the same label.
        if one is None or name.axis in one.cells:
            one = Triple(name.base, name.kind, name.unit)
            last[name.base, name.kind] = one
            found.append(one)
        one.cells[name.axis] = column
    for one in found:
        if "w" in one.cells:
            one.kind = "rotations"
    return [one for one in found if one.whole]


def named_triples(words: Sequence[str]) -> list[Triple]:
    """Gather the columns of a row of names, with the axis at the names' end or else beginning."""
    found = triples([read_name(word) for word in words])
    if found:
        return found
    matches = [_PREFIX.fullmatch(word.strip()) for word in words]
    return triples([Name(m.group(2), POSITION, m.group(1).lower()) if m else None for m in matches])


def leading_columns(words: Sequence[str]) -> Leading:
    """Find the columns of frame number, time and timecode in a row of names."""
    frame = time = timecode = None
    tick = 1.0
    for column, word in enumerate(map(str.strip, words)):
        ticked = _TICK.search(word)
        bare = word[: ticked.start()] if ticked else word
        if frame is None and _FRAME.fullmatch(word):
            frame = column
        elif timecode is None and _TIMECODE.fullmatch(word):
            timecode = column
        elif time is None and (_TIME.fullmatch(word) or (bare and _TIME.fullmatch(bare))):
            time = column
            tick = _tick(ticked.group(1)) if ticked and not _TIME.fullmatch(word) else 1.0
    return Leading(frame, time, timecode, tick)


def _tick(text: str) -> float:
    text = text.lower()
    return _TICKS["ms"] if text.startswith("milli") else _TICKS.get(text, 1.0)
