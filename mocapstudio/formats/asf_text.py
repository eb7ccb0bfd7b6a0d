"""The text of Acclaim files: its encoding, its comments and its sections."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from mocapstudio.formats.bvh_rows import LARGEST
from mocapstudio.formats.report import Problem
from mocapstudio.motion.errors import FileError

Words = tuple[int, list[str]]
"""A line's 1-based number and its words."""

_BOM = b"\xef\xbb\xbf"
_COMMENT = re.compile(rb"#[^\n]*")
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)


@dataclass
class Section:
    """What stands below one ``:keyword``.

    Attributes
    ----------
    line
        1-based line of the keyword.
    lines
        Lines that are not empty; first what follows the keyword on its own line.
    """

    line: int
    lines: list[Words] = field(default_factory=list)


def plain_lines(data: bytes, path: Path, problems: list[Problem]) -> tuple[bytes, str]:
    """Bytes with bare newlines and without comments, and the encoding of what is left.

    Lines keep their numbers. Bytes that are not UTF-8, and a byte order mark, are reported.
    """
    where = f" in {path.name}"
    if data.startswith(_BOM):
        problems.append(Problem(1, f"byte order mark{where}", "skipped"))
        data = data[len(_BOM) :]
    data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    encoding = "utf-8"
    try:
        data.decode(encoding)
    except UnicodeDecodeError as bad:
        line = 1 + data.count(b"\n", 0, bad.start)
        problems.append(Problem(line, f"bytes that are not UTF-8{where}", "read as Latin-1"))
        encoding = "latin-1"
    return _COMMENT.sub(b"", data) if b"#" in data else data, encoding


def sections(text: str, path: Path) -> dict[str, Section]:
    """Sections of an ASF by keyword, lower case, in whatever order they come.

    Raises
    ------
    FileError
        If something stands before the first section.
    """
    found: dict[str, Section] = {}
    current: Section | None = None
    for number, line in enumerate(text.split("\n"), 1):
        words = line.split()
        if not words:
            continue
        if words[0].startswith(":"):
            current = found.setdefault(words[0][1:].lower(), Section(number))
            words = words[1:]
        elif current is None:
            cause = f"not ASF: {words[0][:24]!r} stands before the first section"
            raise FileError(path, cause, line=number)
        if words:
            current.lines.append((number, words))
    return found


def number(word: str, path: Path, line: int) -> float:
    """Return the number that a word is.

    Raises
    ------
    FileError
        If it is none, or one that no skeleton or motion holds.
    """
    if not _NUMBER.fullmatch(word):
        what = "instead of a number" if is_nan(word) else "is not a number"
        raise FileError(path, f"{word[:24]!r} {what}", line=line)
    value = float(word)
    if not abs(value) <= LARGEST:
        raise FileError(path, f"{word[:24]!r} is too large", line=line)
    return value


def is_nan(word: str) -> bool:
    """Tell whether a word is a way to write that a number is none."""
    return word.lower().lstrip("+-").startswith(("nan", "inf", "1.#"))
