"""How the way in which files were read looks in JSON."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Literal

from mocapstudio.formats import ReadOptions
from mocapstudio.formats.options import Forward, Up, parse_rate
from mocapstudio.motion.errors import ParameterError
from mocapstudio.review.records import MalformedError, Record


class ReadingRecord(Record, frozen=True):
    """A `ReadOptions`; `skeleton` is an absolute path, `beside` the same from the session file."""

    fps: str | None = None
    unit: float | None = None
    up: Up | None = None
    forward: Forward | None = None
    angles: Literal["degrees", "radians"] = "degrees"
    root_offset: Literal["replace", "add"] = "replace"
    trim_start: bool = True
    lenient: bool = False
    skeleton: str | None = None
    beside: str | None = None


def pack_reading(
    options: ReadOptions, relative: Callable[[Path], str | None] | None = None
) -> ReadingRecord:
    """Make a record of how a file was read.

    Parameters
    ----------
    relative
        Returns a path from the session file; None where there is none.
    """
    skeleton = None if options.skeleton is None else options.skeleton.absolute()
    return ReadingRecord(
        None if options.fps is None else str(options.fps),
        options.unit,
        options.up,
        options.forward,
        options.angles,
        options.root_offset,
        options.trim_start,
        options.lenient,
        None if skeleton is None else str(skeleton),
        None if skeleton is None or relative is None else relative(skeleton),
    )


def unpack_reading(
    record: ReadingRecord, find: Callable[[str | None, str], Path | None] | None = None
) -> ReadOptions:
    """Make options of their record.

    Parameters
    ----------
    find
        Tells where a file lies now, from its path beside the session and its absolute one.

    Raises
    ------
    MalformedError
        If the rate is none.
    """
    skeleton = None if record.skeleton is None else Path(record.skeleton)
    if record.skeleton is not None and find is not None:
        skeleton = find(record.beside, record.skeleton) or skeleton
    try:
        fps = None if record.fps is None else parse_rate(record.fps)
    except ParameterError as error:
        raise MalformedError(str(error)) from error
    return ReadOptions(
        fps,
        record.unit,
        record.up,
        record.forward,
        record.angles,
        record.root_offset,
        record.trim_start,
        record.lenient,
        skeleton,
    )
