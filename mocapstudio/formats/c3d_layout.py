"""The header of a C3D file and where its samples lie, checked against its size."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

import numpy as np

from mocapstudio.formats.c3d_numbers import Numbers
from mocapstudio.formats.c3d_parameters import BLOCK, Parameters
from mocapstudio.formats.options import parse_rate
from mocapstudio.formats.report import Problem
from mocapstudio.motion.errors import FileError, ParameterError

_KEY = 0x50
_NO_RATE = Fraction(100)
_FULL = 0xFFFF
_SAME_RATE = 0.2
_BEST_FOUNDED = ("TRIAL", "POINT:LONG_FRAMES", "POINT:FRAMES", "the header")


@dataclass(frozen=True, eq=False)
class Layout:
    """Where the samples of a file lie.

    Attributes
    ----------
    numbers
        How numbers are laid out.
    start
        Byte of the first sample.
    frames, points
        How many there are.
    analog
        Analogue samples that follow the points of each frame.
    real
        True for 32-bit floats, False for 16-bit integers times `scale`.
    scale
        Units of the file per step of an integer; of residuals in either case.
    first_frame
        The number that the file gives its first frame.
    """

    numbers: Numbers
    start: int
    frames: int
    points: int
    analog: int
    real: bool
    scale: float
    first_frame: int

    @property
    def width(self) -> int:
        """Bytes of one number."""
        return 4 if self.real else 2

    @property
    def stride(self) -> int:
        """Bytes of one frame."""
        return (4 * self.points + self.analog) * self.width


def looks_like_c3d(head: bytes) -> bool:
    """Tell C3D by its first bytes."""
    return len(head) > 1 and head[0] >= 2 and head[1] == _KEY


def check_header(path: Path, data: bytes) -> None:
    """Refuse what cannot be C3D.

    Raises
    ------
    FileError
        At the byte that tells.
    """
    if len(data) < 2 or data[1] != _KEY:
        raise FileError(path, "not C3D: its second byte is not 80", offset=min(1, len(data)))
    if len(data) < BLOCK:
        raise FileError(path, "cut off within the header", offset=len(data))
    if data[0] < 1:
        raise FileError(path, "no block of parameters is named", offset=0)


def lay_out(
    path: Path, data: bytes, parameters: Parameters, *, lenient: bool, problems: list[Problem]
) -> Layout:
    """Find the samples, and count frames where header, parameters and size disagree.

    Raises
    ------
    FileError
        If there are no points or the samples are cut off.
    """
    numbers = parameters.layout
    points = _points(path, data, parameters, problems)
    scale = parameters.value("POINT", "SCALE")
    if scale is None or not math.isfinite(scale) or scale == 0:
        scale = float(numbers.floats(data[12:16])[0])
    if not math.isfinite(scale) or scale == 0 or abs(scale) > 1e9:
        raise FileError(path, f"the scale of the points is {scale:g}", offset=12)
    start = _start(path, data, parameters, problems)
    analog = numbers.word(data, 4)
    layout = Layout(numbers, start, 0, points, analog, scale < 0, abs(scale), 1)
    there = max(0, (len(data) - start) // layout.stride)
    first, frames = _frames(data, parameters, there, layout, problems)
    if frames > there:
        what = f"cut off: {frames} frames of {layout.stride} bytes stated, {there} are there"
        if not lenient or not there:
            raise FileError(path, what, offset=len(data))
        problems.append(Problem(None, what, "read what is there"))
        frames = there
    if frames < 1:
        raise FileError(path, "no frames", offset=start)
    return Layout(numbers, start, frames, points, analog, scale < 0, abs(scale), first)


def _points(path: Path, data: bytes, parameters: Parameters, problems: list[Problem]) -> int:
    header, stated = parameters.layout.word(data, 2), parameters.count("POINT", "USED")
    points = header if stated is None else stated
    if stated is not None and stated != header:
        what = f"the header states {header} points, POINT:USED {stated}"
        # Each frame is laid out as the header says; more labels than that have no data.
        points = header or stated
        problems.append(Problem(None, what, f"read {points}"))
    if points == 0:
        raise FileError(path, "holds no points, only other data", offset=2)
    return points


def _start(path: Path, data: bytes, parameters: Parameters, problems: list[Problem]) -> int:
    header = parameters.layout.word(data, 16)
    stated = parameters.count("POINT", "DATA_START") or header
    block = header or stated
    if block < 2:
        raise FileError(path, f"samples cannot begin at block {block}", offset=16)
    if stated != header:
        what = f"samples begin at block {header} as the header has it, {stated} as POINT:DATA_START"
        problems.append(Problem(None, what, f"read from block {block}"))
    start = (block - 1) * BLOCK
    if start >= len(data):
        raise FileError(path, f"cut off: samples begin at byte {start}", offset=len(data))
    return start


def _frames(
    data: bytes, parameters: Parameters, there: int, layout: Layout, problems: list[Problem]
) -> tuple[int, int]:
    """Number of the first frame and count of frames."""
    numbers = parameters.layout
    first, last = numbers.word(data, 6), numbers.word(data, 8)
    # 16 bits hold no more than 65,535, which some programs write for 'more'.
    counts = {"the header": last - first + 1} if last < _FULL else {}
    begin, end = (_long(parameters, f"ACTUAL_{name}_FIELD") for name in ("START", "END"))
    if begin is not None and end is not None and end >= begin:
        counts["TRIAL"] = end - begin + 1
        first = begin
    for name in ("LONG_FRAMES", "FRAMES"):
        stated = parameters.count("POINT", name)
        if stated is not None and stated > 0:
            counts[f"POINT:{name}"] = stated
    ranked = [counts[key] for key in _BEST_FOUNDED if counts.get(key, 0) > 0]
    if max(ranked, default=_FULL) == _FULL:
        return first, _unstated(data, there, layout, problems)
    chosen = _fitting(ranked, there)
    apart = {k: n for k, n in counts.items() if n != chosen and (chosen < _FULL or n > _FULL)}
    if apart:
        stated_by = ", ".join(f"{key} {count}" for key, count in counts.items())
        what = f"frames are stated differently: {stated_by}; {there} are there"
        problems.append(Problem(None, what, f"read {chosen}"))
    return first, chosen


def _unstated(data: bytes, there: int, layout: Layout, problems: list[Problem]) -> int:
    """Count the frames that are there, without the zeros that fill the last block."""
    end = layout.start + there * layout.stride
    least = max(there - BLOCK // layout.stride, 1)
    while there > least and not any(data[end - layout.stride : end]):
        there, end = there - 1, end - layout.stride
    if there != _FULL:
        what = f"no number of frames below {_FULL} is stated, {there} are there"
        problems.append(Problem(None, what, f"read {there}"))
    return there


def _fitting(ranked: list[int], there: int) -> int:
    """The count that leaves no whole block unread, else the best founded that fits at all."""
    exact = [n for n in ranked if n == there]
    fitting = [n for n in ranked if n <= there]
    return (exact or fitting or ranked)[0]


def _long(parameters: Parameters, name: str) -> int | None:
    """A number of a frame, kept as two words, the low one first, or as a float."""
    one = parameters.get("TRIAL", name)
    values = parameters.values("TRIAL", name)
    if one is None or not len(values) or not np.isfinite(values[:2]).all():
        return None
    if one.kind != 2:
        return int(values[0])
    low = int(values[0]) & _FULL
    return low + ((int(values[1]) & _FULL) << 16 if len(values) > 1 else 0)


def rate(data: bytes, parameters: Parameters, problems: list[Problem]) -> Fraction:
    """Frames a second, as the header or the parameters state it."""
    header = float(parameters.layout.floats(data[20:24])[0])
    own = parameters.value("POINT", "RATE")
    for value in (own, header, parameters.value("TRIAL", "CAMERA_RATE")):
        try:
            found = parse_rate("" if value is None else f"{value:.9g}")
        except ParameterError:
            continue
        if own == value and header > 0 and abs(header - float(found)) > _SAME_RATE:
            what = f"the header states {header:g} frames a second, POINT:RATE {own:g}"
            problems.append(Problem(None, what, f"read as {own:g}", "fps"))
        return found
    done = f"guessed {float(_NO_RATE):g} frames a second"
    problems.append(Problem(None, "no frame rate stated", done, "fps", guess=True))
    return _NO_RATE
