"""The MOTION section of BVH: number of frames, frame time, and the rows of numbers."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.bvh_rows import MotionBlock, Span, is_sane, parse_rows
from mocapstudio.formats.reading import Reading
from mocapstudio.formats.report import Problem

Array = NDArray[np.float64]

# Below this the plain parser is quicker than loading the compiled one.
KERNEL_FROM_BYTES = 1_000_000

_FRAMES = re.compile(rb"\s*Frames[ \t]*:?[ \t]*([^\s]*)[^\r\n]*", re.IGNORECASE)
_FRAME_TIME = re.compile(rb"\s*Frame[ \t]*Time[ \t]*:?[ \t]*([^\s]*)[^\r\n]*", re.IGNORECASE)
_REST_OF_LINE = re.compile(rb"[ \t]*(\r\n|\n|\r|$)")


def parse_motion(reading: Reading, start: int, end: int, columns: int) -> tuple[MotionBlock, Array]:
    """Read the section whose bytes after the keyword MOTION are [start, end).

    Returns
    -------
    block
        Where everything stands.
    numbers
        (frames, columns) as in the file.

    Raises
    ------
    FileError
        At a missing, non-numeric or infinite value, at a frame count unlike the rows (unless
        lenient), and where there is no frame.
    """
    head = _head(reading, start, end, columns)
    stated = _stated_frames(reading, head)
    numbers: Array | None = None
    if end - head.start >= KERNEL_FROM_BYTES:
        # Loading numba takes longer than reading a short take.
        from mocapstudio.formats.motion_kernel import parse_regular

        numbers = parse_regular(reading.data, head.start, end, columns, stated)
    block = head
    if numbers is None or not _good(numbers, stated, lenient=reading.lenient):
        block, numbers = parse_rows(reading, head, end, stated)
    if len(numbers) != stated:
        reading.problems.append(
            Problem(
                reading.line(head.frames_span[0]),
                f"'Frames: {stated}', but {len(numbers)} rows",
                f"read {len(numbers)} frames",
            )
        )
    return replace(block, frames=len(numbers)), numbers


def _good(numbers: Array, stated: int, *, lenient: bool) -> bool:
    return len(numbers) > 0 and (lenient or len(numbers) == stated) and is_sane(numbers)


def _head(reading: Reading, start: int, end: int, columns: int) -> MotionBlock:
    spans: dict[str, Span] = {}
    at = start
    for _ in range(2):
        for name, pattern in (("frames", _FRAMES), ("time", _FRAME_TIME)):
            match = pattern.match(reading.data, at, end)
            if match and name not in spans:
                spans[name], at = match.span(1), match.end()
    if "frames" not in spans:
        raise reading.error(start, "'Frames:' missing after MOTION")
    time = spans.get("time", (at, at))
    rest = _REST_OF_LINE.match(reading.data, at, end)
    at = rest.end() if rest else at
    text = reading.data[slice(*time)].decode("latin-1")
    line = reading.line(at)
    return MotionBlock(0, columns, text, start, spans["frames"], time, at, end, line)


def _stated_frames(reading: Reading, head: MotionBlock) -> int:
    text = reading.data[slice(*head.frames_span)]
    if not re.fullmatch(rb"\d{1,18}(\.0*)?", text):
        word = text.decode("latin-1")
        raise reading.error(head.frames_span[0], f"'Frames: {word}' is not a number of frames")
    stated = int(text.split(b".")[0])
    if stated == 0 and not reading.lenient:
        raise reading.error(head.frames_span[0], "'Frames: 0': there is no motion in it")
    return stated
