"""What stands above a table's names: rate, number of frames, unit, names of markers."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from mocapstudio.formats.options import parse_rate
from mocapstudio.formats.reading import Reading
from mocapstudio.formats.report import Problem
from mocapstudio.formats.table_sheet import Sheet, Span
from mocapstudio.formats.units import unit_of
from mocapstudio.motion.errors import ParameterError

_RATES = (
    *("frequency", "framerate", "exportframerate", "captureframerate", "datarate", "fps"),
    *("samplingrate", "samplerate", "samplingfrequency", "camerarate", "rate"),
)
_FRAMES = ("noofframes", "numframes", "nframes", "frames", "totalexportedframes")
_UNITS = ("units", "unit", "lengthunits", "lengthunit")
_NAMES = ("markernames",)
_INCLUDED = "dataincluded"
_NEXUS = ("trajectories", "modeloutputs", "joints")
_PLACES = frozenset({"3d", "6d"})


@dataclass
class Keys:
    """What the lines above a table's names state.

    Attributes
    ----------
    rate, rate_span
        Frames a second, and the bytes that state it.
    unit
        Metres per unit.
    frames
        Number of rows, with its keyword and 1-based line.
    names, names_line
        Labels, and their 0-based line.
    qualisys
        Whether it is laid out as Qualisys does.
    """

    rate: Fraction | None = None
    rate_span: Span | None = None
    unit: float | None = None
    frames: tuple[int, str, int] | None = None
    names: tuple[str, ...] = ()
    names_line: int = 0
    qualisys: bool = False


def read_keys(reading: Reading, sheet: Sheet, end: int) -> Keys:
    """Read keywords and their values in the lines before `end`.

    Raises
    ------
    FileError
        If the file says that it holds no positions.
    """
    keys = Keys()
    for i in range(end):
        words, spans = sheet.words(i), sheet.spans(i)
        for keyword, value, span in _pairs(words, spans):
            _take(reading, keys, i, keyword, value, span)
        keyword = _plain(words[0]) if words else ""
        if keyword in _NAMES:
            keys.names, keys.names_line, keys.qualisys = _trimmed(words[1:]), i, True
        elif keyword == _INCLUDED:
            included = [word for word in words[1:] if word]
            if included and not _PLACES & {word.lower() for word in included}:
                cause = f"no positions: it holds {', '.join(included)[:60]}"
                raise reading.error(int(sheet.starts[i]), cause)
        elif keyword in _NEXUS and i + 1 < end:
            # Nexus writes the rate alone on the line below.
            _take(reading, keys, i + 1, "rate", sheet.words(i + 1)[0], sheet.spans(i + 1)[0])
    return keys


def _pairs(words: Sequence[str], spans: Sequence[Span]) -> Iterator[tuple[str, str, Span]]:
    if len(words) >= 1 and re.search("[:=]", words[0]):
        word = words[0]
        name, _, value = word.partition("=" if "=" in word else ":")
        at = spans[0][1] - len(value.strip())
        yield name, value.strip(), (at, spans[0][1])
    for k in range(0, len(words) - 1, 2):
        yield words[k], words[k + 1], spans[k + 1]


def _take(reading: Reading, keys: Keys, line: int, keyword: str, value: str, span: Span) -> None:
    """Note one value if its keyword is known; the first of several counts."""
    word, keyword = keyword.strip("# "), _plain(keyword)
    if keyword in _RATES and keys.rate is None:
        text = re.sub(r"\s*(hz|fps)$", "", value.strip(), flags=re.IGNORECASE)
        try:
            keys.rate = parse_rate(text.replace(",", "."))
            keys.rate_span = (span[0], span[0] + len(text.encode()))
        except ParameterError:
            what = f"{word} {value[:24]!r} is no frame rate"
            reading.problems.append(Problem(line + 1, what, "ignored", "fps"))
    elif keyword in _FRAMES and keys.frames is None:
        if re.fullmatch(r"\d{1,12}", value):
            keys.frames = (int(value), word, line + 1)
    elif keyword in _UNITS and keys.unit is None:
        keys.unit = unit_of(value)


def _plain(keyword: str) -> str:
    return re.sub(r"[^a-z]", "", keyword.lower())


def _trimmed(words: Sequence[str]) -> tuple[str, ...]:
    found = list(words)
    while found and not found[-1]:
        found.pop()
    return tuple(found)
