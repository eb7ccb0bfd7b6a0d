"""C3D: from a file's bytes to marker takes and an import report."""

from __future__ import annotations

import hashlib
from collections import Counter
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.c3d_events import read_events
from mocapstudio.formats.c3d_kinds import MARKER, kinds
from mocapstudio.formats.c3d_layout import Layout, check_header, lay_out, rate
from mocapstudio.formats.c3d_parameters import Parameters, parse_parameters
from mocapstudio.formats.c3d_points import Points, read_points
from mocapstudio.formats.c3d_space import Space, find_space
from mocapstudio.formats.c3d_subjects import subjects
from mocapstudio.formats.options import ReadOptions
from mocapstudio.formats.report import ImportReport, Problem
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.markers import Event, MarkerTake
from mocapstudio.motion.take import Source

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class C3dRecord:
    """What the writer needs to copy a take's file: the bytes, and where its samples stand.

    Attributes
    ----------
    data
        The whole file.
    layout
        Where its samples lie.
    labels
        The take's markers as they were read.
    points
        Index in the file of each of them.
    units
        Metres per unit of each of them.
    parameters
        For what states frames and rate.
    """

    data: bytes
    layout: Layout
    labels: tuple[str, ...]
    points: NDArray[np.int64]
    units: Array
    parameters: Parameters


def read_c3d(
    path: Path, data: bytes, options: ReadOptions
) -> tuple[list[MarkerTake], ImportReport]:
    """Read the markers of every subject of a C3D file.

    Raises
    ------
    FileError
        At the byte where the bytes are no C3D, or are cut off; if there are no markers.
    """
    problems: list[Problem] = []
    check_header(path, data)
    parameters = parse_parameters(path, data, lenient=options.lenient, problems=problems)
    layout = lay_out(path, data, parameters, lenient=options.lenient, problems=problems)
    points = read_points(data, layout)
    labels = _labels(layout.points, parameters, problems)
    found = kinds(labels, parameters, points, problems)
    markers = {i: label for i, label in enumerate(labels) if found[i] == MARKER}
    if not markers:
        raise FileError(path, f"none of its {layout.points} points is a marker")
    _tell_missing(points, list(markers), problems)
    space = find_space(points, markers, parameters, options, problems)
    takes = _takes(path, data, layout, parameters, points, markers, space, options, problems)
    problems.sort(key=lambda problem: problem.guess)
    return takes, ImportReport(path, "c3d", tuple(dict.fromkeys(problems)))


def _labels(points: int, parameters: Parameters, problems: list[Problem]) -> list[str]:
    """One unique label a point."""
    stated = list(parameters.texts("POINT", "LABELS"))
    if len(stated) != points:
        what = f"{len(stated)} labels for {points} points"
        done = "the last labels ignored" if len(stated) > points else "the others named by number"
        problems.append(Problem(None, what, done))
    stated = stated[:points] + [""] * (points - len(stated))
    named = [label or f"point {i}" for i, label in enumerate(stated, 1)]
    labels: list[str] = []
    seen: Counter[str] = Counter()
    taken = set(named)
    for label in named:
        seen[label] += 1
        unique, number = label, seen[label]
        while number > 1 and (unique := f"{label}#{number}") in taken:
            number += 1
        taken.add(unique)
        labels.append(unique)
    twice = [label for label, count in seen.items() if count > 1]
    if twice:
        what = f"labels repeat: {', '.join(twice[:6])}"
        problems.append(Problem(None, what, "numbered #2, #3 and so on"))
    return labels


def _tell_missing(points: Points, markers: list[int], problems: list[Problem]) -> None:
    for mask, what in (
        (points.no_number, "whose coordinates are no numbers"),
        (points.zero, "at exactly (0, 0, 0)"),
        (points.invalid, "marked as invalid"),
    ):
        of_markers = mask[:, markers]
        samples, some = int(of_markers.sum()), int(of_markers.any(axis=0).sum())
        if samples:
            which = f"{samples} samples of {some} markers {what}"
            problems.append(Problem(None, which, "taken as missing"))


def _takes(
    path: Path,
    data: bytes,
    layout: Layout,
    parameters: Parameters,
    points: Points,
    markers: dict[int, str],
    space: Space,
    options: ReadOptions,
    problems: list[Problem],
) -> list[MarkerTake]:
    digest = hashlib.sha256(data).hexdigest()
    stated = rate(data, parameters, problems)
    frequency = options.fps or stated
    events = read_events(data, parameters, layout.first_frame, layout.frames, stated, problems)
    takes = []
    for performer, (name, chosen) in enumerate(subjects(markers, parameters, problems)):
        own = np.array(chosen, dtype=np.int64)
        named = tuple(markers[i] for i in chosen)
        record = C3dRecord(data, layout, named, own, space.units[own], parameters)
        filled = points.filled(own)
        source = Source(path, "c3d", digest, space.unit, space.to_inside, performer, record)
        takes.append(
            MarkerTake(
                name=f"{path.stem} {name}".rstrip(),
                labels=named,
                positions=points.positions(own, record.units, source.to_inside),
                rate=frequency,
                first_frame=layout.first_frame,
                filled=filled,
                events=_at_rate(events, stated, frequency),
                source=source,
            )
        )
    return takes


def _at_rate(events: tuple[Event, ...], stated: Fraction, used: Fraction) -> tuple[Event, ...]:
    """Keep events at their frames where the user states another rate."""
    if stated == used:
        return events
    return tuple(Event(event.name, event.time * float(stated / used)) for event in events)
