"""The frames of an AMC: a bulk parser, and a strict one that names what is wrong and where."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.asf_text import number
from mocapstudio.formats.bvh_rows import is_sane
from mocapstudio.formats.report import Problem
from mocapstudio.motion.errors import FileError

Array = NDArray[np.float64]

_MOST_DIGITS = 9
_NAMED = 4


@dataclass(frozen=True)
class Body:
    """The part of an AMC after its keywords.

    Attributes
    ----------
    path
        The file.
    data
        Without comments, with bare newlines.
    line
        1-based line of its first byte.
    encoding
        Of the names.
    channels
        Number of values of each bone that has any.
    lenient
        Leave out a last frame that is cut off.
    """

    path: Path
    data: bytes
    line: int
    encoding: str
    channels: dict[str, int]
    lenient: bool


def parse_frames(body: Body, problems: list[Problem]) -> tuple[int, dict[str, Array]]:
    """Read all frames.

    Returns
    -------
    first
        Number of the first frame.
    values
        (F, values) of each bone.

    Raises
    ------
    FileError
        At the line of whatever is no whole frame.
    """
    return _bulk(body) or _Frames(body, problems).parse()


def _bulk(body: Body) -> tuple[int, dict[str, Array]] | None:
    """Read frames that are laid out alike; None where they are not, or a value is doubtful."""
    tokens = body.data.split()
    width = 1 + len(body.channels) + sum(body.channels.values())
    columns = _columns(body, tokens[:width])
    if columns is None or not tokens or len(tokens) % width:
        return None
    names = [name.encode(body.encoding, "replace") for name in columns]
    frames = len(tokens) // width
    # int() and float() take underscores, which belong to names alone.
    if body.data.count(b"_") != frames * sum(name.count(b"_") for name in names):
        return None
    values: dict[str, Array] = {}
    try:
        numbers = list(map(int, tokens[::width]))
        for (name, at), word in zip(columns.items(), names, strict=True):
            if set(tokens[at::width]) != {word}:
                return None
            table = np.empty((frames, body.channels[name]))
            for c in range(table.shape[1]):
                table[:, c] = list(map(float, tokens[at + 1 + c :: width]))
            if not is_sane(table):
                return None
            values[name] = table
    except ValueError:
        return None
    if numbers[0] < 0 or numbers != list(range(numbers[0], numbers[0] + frames)):
        return None
    return numbers[0], values


def _columns(body: Body, tokens: list[bytes]) -> dict[str, int] | None:
    """Column of each bone's name, as the first frame has it."""
    by_word = {name.encode(body.encoding, "replace"): name for name in body.channels}
    columns: dict[str, int] = {}
    at = 1
    while at < len(tokens):
        name = by_word.pop(tokens[at], None)
        if name is None:
            return None
        columns[name] = at
        at += 1 + body.channels[name]
    return None if by_word else columns


class _Frames:
    def __init__(self, body: Body, problems: list[Problem]) -> None:
        self.body, self.problems = body, problems
        self.frame: dict[str, list[float]] = {}
        self.number = self.line = self.end = -1
        self.first = -1
        self.done: dict[str, list[list[float]]] = {name: [] for name in body.channels}

    def parse(self) -> tuple[int, dict[str, Array]]:
        text = self.body.data.decode(self.body.encoding)
        lines = [
            (i, words)
            for i, line in enumerate(text.split("\n"), self.body.line)
            if (words := line.split())
        ]
        if not lines:
            raise self.fail(self.body.line, "no frames")
        self.end = last = lines[-1][0]
        for line, words in lines:
            if len(words) == 1 and words[0].isascii() and words[0].isdigit():
                self.begin(words[0], line)
            elif self.line < 0:
                raise self.fail(line, f"{words[0][:24]!r} stands before the first frame")
            elif not self.values(words, line, last=line == last):
                break
        self.close(last=True)
        frames = len(next(iter(self.done.values())))
        if not frames:
            raise self.fail(self.end, "cut off: not one whole frame")
        return self.first, {n: np.array(v).reshape(frames, -1) for n, v in self.done.items()}

    def begin(self, word: str, line: int) -> None:
        if len(word) > _MOST_DIGITS:
            raise self.fail(line, f"{word[:24]} is no frame number")
        found = int(word)
        if self.line < 0:
            self.first = found
        else:
            self.close()
            if found != self.number + 1:
                raise self.fail(line, f"frame {found} follows frame {self.number}")
        self.number, self.line = found, line

    def values(self, words: list[str], line: int, *, last: bool) -> bool:
        """Take a bone's values; False where the file is cut off in them."""
        name, channels = words[0], self.body.channels
        if last and self.is_cut(name, len(words) - 1):
            self.end = line
            return False
        if name not in channels:
            raise self.fail(line, f"{name[:40]!r} is no bone with degrees of freedom")
        if name in self.frame:
            raise self.fail(line, f"bone {name} is twice in frame {self.number}")
        if len(words) - 1 != channels[name]:
            cause = f"bone {name} has {len(words) - 1} values, its skeleton {channels[name]}"
            raise self.fail(line, cause)
        self.frame[name] = [number(word, self.body.path, line) for word in words[1:]]
        return True

    def is_cut(self, name: str, values: int) -> bool:
        """Tell whether a last line ends within a bone's name or values."""
        if name in self.body.channels:
            return values < self.body.channels[name]
        return values == 0 and any(known.startswith(name) for known in self.body.channels)

    def close(self, *, last: bool = False) -> None:
        missing = [name for name in self.body.channels if name not in self.frame]
        if not missing:
            for name, values in self.frame.items():
                self.done[name].append(values)
        elif last and self.body.lenient:
            what = f"frame {self.number} is cut off"
            self.problems.append(Problem(self.line, what, "left out"))
        else:
            some = ", ".join(missing[:_NAMED]) + (" and more" if len(missing) > _NAMED else "")
            line, cut = (self.end, "cut off: ") if last else (self.line, "")
            raise self.fail(line, f"{cut}frame {self.number} lacks {some}")
        self.frame = {}

    def fail(self, line: int, cause: str) -> FileError:
        return FileError(self.body.path, cause, line=line)
