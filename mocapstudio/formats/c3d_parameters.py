"""The parameter section of a C3D file: groups of named values."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.c3d_numbers import FIRST_PROCESSOR, Numbers
from mocapstudio.formats.report import Problem
from mocapstudio.motion.errors import FileError

BLOCK = 512
_MOST_BLOCKS = 255
_CHARACTER, _BYTE, _INTEGER, _REAL = -1, 1, 2, 4
_SIZES = {_CHARACTER: 1, _BYTE: 1, _INTEGER: 2, _REAL: 4}
_NO_PROCESSORS = {1: 84, 2: 85, 3: 86}


@dataclass(frozen=True, eq=False)
class Parameter:
    """One parameter.

    Attributes
    ----------
    texts
        Strings without the blanks that pad them, or None where it holds numbers.
    numbers
        Flat, as floats, in the file's order (the first dimension varies fastest), or None.
    shape
        Dimensions as in the file; empty for a single value.
    at
        Byte of its first value.
    kind
        -1 characters, 1 bytes, 2 integers, 4 reals.
    """

    texts: tuple[str, ...] | None
    numbers: NDArray[np.float64] | None
    shape: tuple[int, ...]
    at: int
    kind: int


class Parameters:
    """All parameters of a file, by group and name in capitals."""

    def __init__(self, numbers: Numbers) -> None:
        self.layout = numbers
        self.groups: dict[str, dict[str, Parameter]] = {}

    def get(self, group: str, name: str) -> Parameter | None:
        """Return a parameter, or None where there is none."""
        return self.groups.get(group, {}).get(name)

    def texts(self, group: str, name: str) -> tuple[str, ...]:
        """Strings of a parameter and of those that go on with it (``LABELS2``, ``LABELS3``…)."""
        found: tuple[str, ...] = ()
        number = 1
        while (one := self.get(group, name if number == 1 else f"{name}{number}")) is not None:
            found += one.texts or ()
            number += 1
        return found

    def text(self, group: str, name: str) -> str:
        """First string of a parameter, or an empty one."""
        return next(iter(self.texts(group, name)), "")

    def values(self, group: str, name: str) -> NDArray[np.float64]:
        """Numbers of a parameter, flat; (0,) where there is none."""
        one = self.get(group, name)
        return np.empty(0) if one is None or one.numbers is None else one.numbers

    def value(self, group: str, name: str) -> float | None:
        """First number of a parameter, or None."""
        values = self.values(group, name)
        return float(values[0]) if len(values) else None

    def count(self, group: str, name: str) -> int | None:
        """First number as a count: 16-bit integers are taken as unsigned."""
        one, value = self.get(group, name), self.value(group, name)
        if one is None or value is None or not np.isfinite(value):
            return None
        whole = int(value)
        return whole & 0xFFFF if one.kind == _INTEGER else whole


def parse_parameters(
    path: Path, data: bytes, *, lenient: bool, problems: list[Problem]
) -> Parameters:
    """Read the parameter section.

    Raises
    ------
    FileError
        At the byte where it is not what it should be.
    """
    start = (data[0] - 1) * BLOCK
    if len(data) < start + 4:
        raise FileError(path, "cut off before the parameters", offset=len(data))
    processor = _NO_PROCESSORS.get(data[start + 3], data[start + 3])
    if not FIRST_PROCESSOR <= processor <= FIRST_PROCESSOR + 2:
        raise FileError(
            path, f"unknown processor type {processor}: 84, 85 or 86 needed", offset=start + 3
        )
    section = _Section(path, data, start, Numbers(processor), lenient, problems)
    return section.parse()


class _Section:
    def __init__(
        self,
        path: Path,
        data: bytes,
        start: int,
        numbers: Numbers,
        lenient: bool,
        problems: list[Problem],
    ) -> None:
        self.path, self.data, self.numbers = path, data, numbers
        self.lenient, self.problems = lenient, problems
        self.start = start
        # The stated number of blocks is often wrong; no section has more than this.
        self.end = min(start + _MOST_BLOCKS * BLOCK, len(data))
        self.names: dict[int, str] = {}
        self.found: dict[int, dict[str, Parameter]] = {}

    def parse(self) -> Parameters:
        at = self.start + 4
        while at + 2 <= self.end:
            length = abs(int(np.int8(self.data[at : at + 1][0] - 256 * (self.data[at] > 127))))
            group = self.data[at + 1] - 256 * (self.data[at + 1] > 127)
            if length == 0 or group == 0:
                break
            name_end = at + 2 + length
            if name_end + 2 > self.end:
                raise self.fail(at, "the parameters are cut off within a name")
            name = decode(self.data[at + 2 : name_end]).upper()
            step = self.numbers.word(self.data, name_end)
            following = name_end + step if step else self.end
            if following > self.end:
                raise self.fail(name_end, f"{name[:24]} points {step} bytes on, past the end")
            if step and step < 2:
                raise self.fail(name_end, f"{name[:24]} points {step} bytes on, into itself")
            if group < 0:
                self.names.setdefault(-group, name)
            else:
                parameter = self.parameter(name[:24], name_end + 2, following)
                self.found.setdefault(group, {}).setdefault(name, parameter)
            if not step:
                break
            at = following
        parameters = Parameters(self.numbers)
        for group, inside in self.found.items():
            parameters.groups.setdefault(self.names.get(group, f"#{group}"), {}).update(inside)
        return parameters

    def parameter(self, name: str, at: int, following: int) -> Parameter:
        if at + 2 > following:
            raise self.fail(at, f"parameter {name} is cut off")
        kind = self.data[at] - 256 * (self.data[at] > 127)
        if kind not in _SIZES:
            raise self.fail(at, f"parameter {name} is of unknown type {kind}")
        dimensions = self.data[at + 1]
        values = at + 2 + dimensions
        if values > following:
            raise self.fail(at + 1, f"parameter {name} has {dimensions} dimensions, more than fit")
        shape = tuple(self.data[at + 2 : values])
        size = _SIZES[kind]
        for extent in shape:
            size *= extent
        end = values + size
        if end > following:
            raise self.fail(values, f"parameter {name} holds {size} bytes, more than fit")
        self.check_description(name, end, following)
        raw = self.data[values:end]
        if kind == _CHARACTER:
            return Parameter(_strings(raw, shape), None, shape, values, kind)
        return Parameter(None, self.read(raw, kind), shape, values, kind)

    def check_description(self, name: str, at: int, following: int) -> None:
        if at < following and at + 1 + self.data[at] <= following:
            return
        cause = f"parameter {name} has no length of its description"
        if at < following:
            cause = f"the description of parameter {name} is longer than fits"
        if not self.lenient:
            raise self.fail(at, cause)
        self.problems.append(Problem(None, f"byte {at}: {cause}", "read without it"))

    def read(self, raw: bytes, kind: int) -> NDArray[np.float64]:
        if kind == _BYTE:
            return np.frombuffer(raw, dtype=np.uint8).astype(np.float64)
        if kind == _INTEGER:
            return self.numbers.words(raw).astype(np.float64)
        return self.numbers.floats(raw).astype(np.float64)

    def fail(self, at: int, cause: str) -> FileError:
        return FileError(self.path, cause, offset=at)


def decode(raw: bytes) -> str:
    """Text without the blanks and null bytes that pad it; UTF-8, else Latin-1.

    Control characters, which would break a line of a report, become replacement characters.
    """
    raw = raw.split(b"\x00", 1)[0].strip()
    try:
        text = raw.decode("utf-8")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")
    return text if text.isprintable() else "".join(c if c.isprintable() else "\ufffd" for c in text)


def _strings(raw: bytes, shape: tuple[int, ...]) -> tuple[str, ...]:
    width = shape[0] if shape else 1
    if not width:
        return ()
    return tuple(decode(raw[i : i + width]) for i in range(0, len(raw), width))
