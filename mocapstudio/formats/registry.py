"""Which formats there are. One entry a format; each format is a module of its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from mocapstudio.formats.bvh_read import looks_like_bvh, read_bvh
from mocapstudio.formats.options import ReadOptions
from mocapstudio.formats.report import ImportReport
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.take import Take

Reader = Callable[[Path, bytes, ReadOptions], tuple[list[Take], ImportReport]]

_SNIFFED = 4096


@dataclass(frozen=True)
class Format:
    """One file format.

    Attributes
    ----------
    name
        Short name, as in `Source.format`.
    suffixes
        Lower case, with the dot.
    looks_like
        Tells the format by a file's first bytes.
    read
        From a file's bytes to takes.
    """

    name: str
    suffixes: tuple[str, ...]
    looks_like: Callable[[bytes], bool]
    read: Reader


FORMATS = (Format("bvh", (".bvh",), looks_like_bvh, read_bvh),)


def readable_suffixes() -> tuple[str, ...]:
    """Suffixes of the files that can be read, lower case, with the dot."""
    return tuple(suffix for one in FORMATS for suffix in one.suffixes)


def read(path: Path | str, options: ReadOptions | None = None) -> tuple[list[Take], ImportReport]:
    """Read a motion file: one take a performer, and what was odd about the file.

    The format is told by the suffix, or by the content where the suffix tells nothing.

    Raises
    ------
    FileError
        If the file cannot be opened, is of no known format, or is not what it should be.
    """
    path = Path(path)
    try:
        data = path.read_bytes()
    except OSError as bad:
        raise FileError(path, (bad.strerror or str(bad)).lower()) from bad
    return _format_of(path, data[:_SNIFFED]).read(path, data, options or ReadOptions())


def _format_of(path: Path, head: bytes) -> Format:
    for one in FORMATS:
        if path.suffix.lower() in one.suffixes:
            return one
    for one in FORMATS:
        if one.looks_like(head):
            return one
    known = ", ".join(readable_suffixes())
    raise FileError(path, f"format {path.suffix or 'without suffix'!r} is not known: {known}")
