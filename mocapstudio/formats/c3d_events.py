"""What a C3D file marks in time, such as foot strikes."""

from __future__ import annotations

from fractions import Fraction

from mocapstudio.formats.c3d_numbers import Numbers
from mocapstudio.formats.c3d_parameters import Parameters, decode
from mocapstudio.formats.report import Problem
from mocapstudio.motion.markers import Event

_HEADER_KEY = 12345
_MOST = 18
# Seconds; no recording lasts so long.
_LATEST = 1e7
# The context of what belongs to no side.
_NO_SIDE = "General"


def read_events(
    data: bytes,
    parameters: Parameters,
    first_frame: int,
    frames: int,
    rate: Fraction,
    problems: list[Problem],
) -> tuple[Event, ...]:
    """Events in the order of time, from the group EVENT or else from the header.

    Times count from the start of the recording, of which the file may hold a later part; where
    they do not fit that, they count from the file's first frame.
    """
    stated = _of_group(parameters) or _of_header(data, parameters.layout)
    found = [(name, time) for name, time in stated if abs(time) < _LATEST]
    if len(found) < len(stated):
        what = f"{len(stated) - len(found)} events without a time"
        problems.append(Problem(None, what, "left out"))
    before = (first_frame - 1) / float(rate)
    slack = 1 / float(rate)
    inside = all(before - slack <= t <= before + frames / float(rate) + slack for _, t in found)
    shift = before if inside else 0.0
    events = [Event(name, time - shift) for name, time in found]
    return tuple(sorted(events, key=lambda event: event.time))


def _of_group(parameters: Parameters) -> list[tuple[str, float]]:
    labels = parameters.texts("EVENT", "LABELS")
    contexts = parameters.texts("EVENT", "CONTEXTS")
    times = parameters.values("EVENT", "TIMES")
    used = parameters.count("EVENT", "USED")
    pairs = times[: len(times) // 2 * 2].reshape(-1, 2)
    found = []
    for i, (minutes, seconds) in enumerate(pairs[:used]):
        label = labels[i] if i < len(labels) else f"Event {i + 1}"
        context = contexts[i].replace(_NO_SIDE, "") if i < len(contexts) else ""
        found.append((f"{context} {label}".strip(), 60.0 * float(minutes) + float(seconds)))
    return found


def _of_header(data: bytes, numbers: Numbers) -> list[tuple[str, float]]:
    """Up to 18 events with labels of four letters, in words 150 to 234."""
    count = numbers.word(data, 300)
    if numbers.word(data, 298) != _HEADER_KEY or not 0 < count <= _MOST:
        return []
    times = numbers.floats(data[304 : 304 + 4 * count])
    found = []
    for i, time in enumerate(times):
        name = decode(data[396 + 4 * i : 400 + 4 * i])
        found.append((name or f"Event {i + 1}", float(time)))
    return found
