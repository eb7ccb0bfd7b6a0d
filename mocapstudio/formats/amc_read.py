"""AMC: from a file's bytes and the skeleton beside it to a take and an import report."""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.amc_rows import Body, parse_frames
from mocapstudio.formats.amc_take import Layout, lay_out, motion
from mocapstudio.formats.asf_find import find_skeleton
from mocapstudio.formats.asf_read import Angles, Asf, read_asf
from mocapstudio.formats.asf_text import plain_lines
from mocapstudio.formats.bvh_read import in_metres, turn_inside
from mocapstudio.formats.guesses import guess_unit, guess_up, turn_to_inside
from mocapstudio.formats.options import ReadOptions, Up, parse_rate
from mocapstudio.formats.report import ImportReport, Problem
from mocapstudio.motion.errors import FileError, ParameterError
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Source, Take

Array = NDArray[np.float64]

_USUAL_RATE = Fraction(120)
_INCH = 0.0254
_BEGINS = re.compile(
    rb"(?:\xef\xbb\xbf)?(?:\s|#[^\r\n]*)*:(?:FULLY-SPECIFIED|DEGREES|RADIANS|SAMPLES-PER-SECOND)\b",
    re.IGNORECASE,
)
_FIRST_FRAME = re.compile(rb"^[ \t]*\d+[ \t]*$", re.MULTILINE)


@dataclass(frozen=True, eq=False)
class AmcRecord:
    """What the writer needs to copy a take's text.

    Attributes
    ----------
    data
        The whole file.
    line
        1-based line of its first frame.
    asf
        The skeleton's file.
    layout
        How values move that skeleton.
    values
        (F, values) as read, of each bone that has any.
    """

    data: bytes
    line: int
    asf: Asf
    layout: Layout
    values: dict[str, Array]


@dataclass
class _Header:
    angles: Angles | None = None
    rate: Fraction | None = None
    problems: list[Problem] = field(default_factory=list)


def looks_like_amc(head: bytes) -> bool:
    """Tell AMC by its first bytes."""
    return _BEGINS.match(head) is not None


def read_amc(path: Path, data: bytes, options: ReadOptions) -> tuple[list[Take], ImportReport]:
    """Read an AMC with the ASF that the options name, or the one beside it (`find_skeleton`).

    Raises
    ------
    FileError
        Where one of the two files is not what it should be, is cut off or holds values that are
        no numbers, or where there is no skeleton, or several that might be the right one.
    """
    problems: list[Problem] = []
    plain, encoding = plain_lines(data, path, problems)
    start = _FIRST_FRAME.search(plain)
    header = _header(plain[: start.start() if start else len(plain)].decode(encoding), path)
    if start is None:
        raise FileError(path, "not AMC, or cut off: no line holds a frame number")
    asf = read_asf(options.skeleton or find_skeleton(path), problems)
    channels = {bone.name: len(bone.dof) for bone in (*asf.bones, *asf.loose) if bone.dof}
    if not channels:
        raise FileError(asf.path, "no bone has a degree of freedom")
    line = 1 + plain.count(b"\n", 0, start.start())
    body = Body(path, plain[start.start() :], line, encoding, channels, options.lenient)
    problems += header.problems
    first, values = parse_frames(body, problems)
    angles = _angles(asf, header, options, problems)
    layout = _layout(asf, angles, options)
    rotations, translations = motion(layout, values)
    skeleton = layout.skeleton
    up = _up(layout, rotations, translations, options, problems)
    source = Source(
        path,
        "amc",
        # The same motion on another skeleton is another take.
        hashlib.sha256(data + asf.data).hexdigest(),
        _unit(asf, skeleton, options, problems),
        turn_to_inside(up, options.forward),
        record=AmcRecord(data, line, asf, layout, values),
    )
    take = Take(
        name=path.stem,
        skeleton=in_metres(skeleton, source.unit),
        rotations=rotations,
        translations=turn_inside(rotations, translations, source),
        rate=_rate(header, options, problems),
        translated=layout.translated,
        first_frame=first,
        source=source,
    )
    problems = sorted(problems, key=lambda p: p.guess)
    return [take], ImportReport(path, "amc", tuple(dict.fromkeys(problems)))


def _header(text: str, path: Path) -> _Header:
    header = _Header()
    for number, line in enumerate(text.split("\n"), 1):
        words = line.split()
        if not words:
            continue
        keyword = words[0].lower()
        if not keyword.startswith(":"):
            raise FileError(path, f"not AMC: {words[0][:24]!r} before the first frame", line=number)
        if keyword in (":degrees", ":radians"):
            if header.angles is not None:
                raise FileError(path, "the unit of angles is given twice", line=number)
            header.angles = "degrees" if keyword == ":degrees" else "radians"
        elif keyword == ":samples-per-second":
            try:
                header.rate = parse_rate(words[1] if len(words) > 1 else "")
            except ParameterError as bad:
                raise FileError(path, str(bad), line=number) from None
        elif keyword != ":fully-specified":
            header.problems.append(Problem(number, f"unknown keyword {words[0][:24]}", "ignored"))
    return header


def _angles(asf: Asf, header: _Header, options: ReadOptions, problems: list[Problem]) -> Angles:
    stated = header.angles or asf.angles
    if stated is not None:
        return stated
    done = f"guessed {options.angles}"
    problems.append(Problem(None, "no unit of angles stated", done, "angles", guess=True))
    return options.angles


def _layout(asf: Asf, angles: Angles, options: ReadOptions) -> Layout:
    axes = asf.angles or options.angles
    return lay_out(asf, radians=angles == "radians", axes_in_radians=axes == "radians")


def _unit(asf: Asf, skeleton: Skeleton, options: ReadOptions, problems: list[Problem]) -> float:
    if options.unit is not None:
        return options.unit
    if asf.scale is None or asf.scale == 1:
        what = "no length scale stated" if asf.scale is None else "length scale 1"
        unit, why = guess_unit(skeleton)
    else:
        what, unit, why = f"length scale {asf.scale:g}", _INCH / asf.scale, "inches over the scale"
    done = f"guessed 1 unit = {unit:.4g} m ({why})"
    problems.append(Problem(None, f"{what} in {asf.path.name}", done, "unit", guess=True))
    return unit


def _up(
    layout: Layout,
    rotations: Array,
    translations: Array,
    options: ReadOptions,
    problems: list[Problem],
) -> Up:
    if options.up is not None:
        return options.up
    up, why = guess_up(layout.skeleton, rotations, translations, layout.translated)
    done = f"guessed {up.upper()} up ({why})"
    problems.append(Problem(None, "no up axis stated", done, "up", guess=True))
    return up


def _rate(header: _Header, options: ReadOptions, problems: list[Problem]) -> Fraction:
    rate = options.fps or header.rate
    if rate is not None:
        return rate
    done = f"guessed {_USUAL_RATE} frames a second"
    problems.append(Problem(None, "no frame rate stated", done, "fps", guess=True))
    return _USUAL_RATE
