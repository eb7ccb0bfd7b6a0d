"""BVH: from a file's bytes to takes and an import report."""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.bvh_hierarchy import Hierarchy, parse_hierarchy
from mocapstudio.formats.bvh_motion import parse_motion
from mocapstudio.formats.bvh_rows import MotionBlock
from mocapstudio.formats.bvh_take import Layout, lay_out, motion
from mocapstudio.formats.frame_time import stated_rate
from mocapstudio.formats.guesses import (
    guess_unit,
    guess_up,
    synthetic_start,
    turn_to_inside,
)
from mocapstudio.formats.options import ReadOptions, Up
from mocapstudio.formats.reading import Reading
from mocapstudio.formats.report import ImportReport, Problem
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Source, Take

Array = NDArray[np.float64]

_MOTION = re.compile(rb"(?:^|[\r\n}])[ \t]*(MOTION)\b", re.IGNORECASE)
_BEGINS = re.compile(rb"\s*HIERARCHY\b", re.IGNORECASE)
_BOM = b"\xef\xbb\xbf"


@dataclass(frozen=True, eq=False)
class BvhRecord:
    """What the writer needs to copy a take's text: the bytes, and where its numbers stand."""

    data: bytes
    block: MotionBlock
    layout: Layout


def looks_like_bvh(head: bytes) -> bool:
    """Tell BVH by its first bytes."""
    return _BEGINS.match(head.removeprefix(_BOM)) is not None


def read_bvh(path: Path, data: bytes, options: ReadOptions) -> tuple[list[Take], ImportReport]:
    """Read every performer and every motion of a BVH file.

    Raises
    ------
    FileError
        Where the bytes are no BVH, are cut off or hold values that are no numbers.
    """
    reading = Reading(path, data, options.lenient, [])
    sections = _sections(reading)
    digest = hashlib.sha256(data).hexdigest()
    takes: list[Take] = []
    for hierarchies, block, numbers in sections:
        for hierarchy in hierarchies:
            takes.append(_take(reading, hierarchy, block, numbers, options, digest, len(takes)))
    takes = _named(takes)
    problems = sorted(reading.problems, key=lambda p: (p.guess, p.line or 0))
    return takes, ImportReport(path, "bvh", tuple(dict.fromkeys(problems)))


def _sections(reading: Reading) -> list[tuple[list[Hierarchy], MotionBlock, Array]]:
    data = reading.data
    start = len(_BOM) if data.startswith(_BOM) else 0
    if start:
        reading.problems.append(Problem(1, "byte order mark", "skipped, kept in the file"))
    if not _BEGINS.match(data, start):
        raise reading.error(start, "not BVH: it does not begin with HIERARCHY")
    sections: list[tuple[list[Hierarchy], MotionBlock, Array]] = []
    hierarchies, columns = list[Hierarchy](), 0
    while start < len(data):
        # One byte back: the keyword needs the end of a line, or a brace, before it.
        keyword = _MOTION.search(data, max(start - 1, 0))
        if keyword is None:
            raise reading.error(len(data.rstrip()), "cut off: no MOTION after the hierarchy")
        if _BEGINS.match(data, start):
            text = _decode(reading, start, keyword.start(1))
            hierarchies, columns = parse_hierarchy(
                text, reading.path, reading.line(start), reading.problems
            )
        end = _next_section(data, keyword.end(1))
        block, numbers = parse_motion(reading, keyword.end(1), end, columns)
        sections.append((hierarchies, block, numbers))
        start = end
    return sections


def _next_section(data: bytes, start: int) -> int:
    found = [_line_with(word, data, start) for word in (b"MOTION", b"HIERARCHY")]
    return min((at for at in found if at >= 0), default=len(data))


def _line_with(word: bytes, data: bytes, start: int) -> int:
    """Byte at which a line begins with `word`, or -1. A plain search is many times faster."""
    at = data.find(word, start)
    while at >= 0:
        before = max(data.rfind(b"\n", start, at), data.rfind(b"\r", start, at))
        if before >= 0 and not data[before:at].strip():
            return at
        at = data.find(word, at + 1)
    return -1


def _decode(reading: Reading, start: int, end: int) -> str:
    raw = reading.data[start:end]
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError as bad:
        line = reading.line(start + bad.start)
        what = "bytes that are not UTF-8"
        reading.problems.append(Problem(line, what, "read as Latin-1, kept in the file"))
        return raw.decode("latin-1")


def _take(
    reading: Reading,
    hierarchy: Hierarchy,
    block: MotionBlock,
    numbers: Array,
    options: ReadOptions,
    digest: str,
    performer: int,
) -> Take:
    layout = lay_out(
        hierarchy,
        numbers,
        radians=options.angles == "radians",
        add_root=options.root_offset == "add",
    )
    rotations, translations = motion(layout, numbers)
    _tell_of_offsets(reading, layout, options)
    rate = _rate(reading, block, options)
    unit = _unit(reading, layout.skeleton, options)
    up = _up(reading, layout, rotations, translations, options)
    record = BvhRecord(reading.data, block, layout)
    source = Source(
        reading.path, "bvh", digest, unit, turn_to_inside(up, options.forward), performer, record
    )
    return Take(
        name=reading.path.stem,
        skeleton=in_metres(layout.skeleton, unit),
        rotations=rotations,
        translations=turn_inside(rotations, translations, source),
        rate=rate,
        translated=layout.translated,
        trim=_trim(reading, block, rotations, options),
        source=source,
    )


def _tell_of_offsets(reading: Reading, layout: Layout, options: ReadOptions) -> None:
    if layout.additive:
        what = "position channels below the root are all but zero"
        reading.problems.append(Problem(None, what, "guessed: added to the OFFSETs", guess=True))
    root = layout.hierarchy.joints[0]
    if root.moves and any(root.offset) and options.root_offset == "replace":
        what = f"root {root.name} has an OFFSET beside its position channels"
        done = "guessed: the channels hold the whole position"
        reading.problems.append(Problem(root.line, what, done, "root_offset", guess=True))


def in_metres(skeleton: Skeleton, unit: float) -> Skeleton:
    """Scale a skeleton from units of its file to metres."""
    return replace(
        skeleton, offsets=skeleton.offsets * unit, end_offsets=skeleton.end_offsets * unit
    )


def turn_inside(rotations: Array, translations: Array, source: Source) -> Array:
    """Turn a motion in units and axes of its file into metres and our axes, in place.

    Parameters
    ----------
    rotations, translations
        (F, J, 4) and (F, T, 3), see `Take`; the root is the first of both.
    source
        Which unit and which turn.

    Returns
    -------
    The translations.
    """
    translations *= source.unit
    if not np.array_equal(source.to_inside, rot.IDENTITY):
        rotations[:, 0] = rot.multiply(source.to_inside, rotations[:, 0])
        translations[:, 0] = rot.rotate(source.to_inside, translations[:, 0])
    return translations


def _rate(reading: Reading, block: MotionBlock, options: ReadOptions) -> Fraction:
    at = block.frame_time_span[0]
    try:
        stated, problem = stated_rate(block.frame_time, reading.line(at))
    except ValueError as bad:
        raise reading.error(at, str(bad)) from None
    if options.fps is not None:
        return options.fps
    if problem:
        reading.problems.append(problem)
    return stated


def _unit(reading: Reading, skeleton: Skeleton, options: ReadOptions) -> float:
    if options.unit is not None:
        return options.unit
    unit, why = guess_unit(skeleton)
    done = f"guessed 1 unit = {unit:.4g} m ({why})"
    reading.problems.append(Problem(None, "no unit stated", done, "unit", guess=True))
    return unit


def _up(
    reading: Reading, layout: Layout, rotations: Array, translations: Array, options: ReadOptions
) -> Up:
    if options.up is not None:
        return options.up
    up, why = guess_up(layout.skeleton, rotations, translations, layout.translated)
    done = f"guessed {up.upper()} up ({why})"
    reading.problems.append(Problem(None, "no up axis stated", done, "up", guess=True))
    return up


def _trim(
    reading: Reading, block: MotionBlock, rotations: Array, options: ReadOptions
) -> tuple[int, int] | None:
    rows = synthetic_start(rotations)
    if rows == 0 or not options.trim_start:
        return None
    what = "the first row is" if rows == 1 else f"the first {rows} rows are"
    problem = Problem(
        block.line, f"{what} a synthetic T-pose", "guessed; trimmed", "trim_start", guess=True
    )
    reading.problems.append(problem)
    return rows, len(rotations)


def _named(takes: list[Take]) -> list[Take]:
    if len(takes) < 2:
        return takes
    return [replace(take, name=f"{take.name} #{i}") for i, take in enumerate(takes, 1)]
