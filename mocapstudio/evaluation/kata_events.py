"""The kata comparison of different performers against events that were marked by hand."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import permutations
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocapstudio import formats
from mocapstudio.comparison.kata import compare, performance_of
from mocapstudio.comparison.labels import Labels, labels_of, read_labels
from mocapstudio.comparison.matching import match
from mocapstudio.comparison.model import Segment
from mocapstudio.comparison.parameters import PAPER, ROOT, ComparisonParameters
from mocapstudio.comparison.timing import warping_function
from mocapstudio.evaluation.alignment_cases import read_labelled
from mocapstudio.evaluation.tables import Table
from mocapstudio.motion.progress import Progress, run
from mocapstudio.similarity.alignment.costs import PoseDistances
from mocapstudio.similarity.alignment.dtw import align

Array = NDArray[np.float64]
Marked = tuple[formats.Recording, tuple[Segment, ...]]

METHODS = {
    "ours": ComparisonParameters(),
    "ours, frame of the hips": ComparisonParameters(features=ROOT),
    "paper": PAPER,
}
PLAIN = "plain DTW"
"""As other libraries have it, of positions about the hips in metres."""


@dataclass(frozen=True)
class EventRow:
    """How well one method finds the events of one movement.

    Parameters
    ----------
    method, labels
        Its name and that of the file.
    pairs, events
        Ordered pairs of performances, and events in all of them.
    median, high
        Seconds between found and marked events: median and 90 % quantile.
    """

    method: str
    labels: str
    pairs: int
    events: int
    median: float
    high: float

    def to_json(self) -> dict[str, Any]:
        """Plain objects for JSON."""
        return asdict(self)


def found_events(
    data: Sequence[Path], labels: Sequence[Path]
) -> Generator[Progress, None, list[EventRow]]:
    """Align every two performances of a file of labels and carry the events over.

    The performances are aligned from the first segment's start to the last one's end, which do not
    count as events; those between do.

    Raises
    ------
    FileError
        If labels or a take cannot be read.
    SkeletonMismatchError
        If two performances have too little in common.
    """
    files = list(formats.find_takes(list(data)))
    errors: dict[tuple[str, str], list[Array]] = {}
    for i, path in enumerate(labels):
        marked = _marked(files, path)
        for one, other in permutations(marked, 2):
            yield Progress(i / len(labels), f"{path.stem.replace('_', ' ')}, events")
            for method, found in _misses(one, other).items():
                errors.setdefault((method, path.stem), []).append(found)
    rows = [_row(method, name, found) for (method, name), found in errors.items()]
    if len({row.labels for row in rows}) > 1:
        for method in (*METHODS, PLAIN):
            every = [each for (own, _), found in errors.items() if own == method for each in found]
            rows.append(_row(method, "all", every))
    return rows


def event_table(rows: Sequence[EventRow]) -> Table:
    """Table of the rows."""
    head = ("movement", "method", "pairs", "events", "median", "90 %")
    lines = tuple(
        (
            row.labels.replace("_", " "),
            row.method,
            str(row.pairs),
            str(row.events),
            f"{row.median:.3f} s",
            f"{row.high:.3f} s",
        )
        for row in rows
    )
    note = f"seconds from a marked event to where it was found; to reach: median 0.15. {PLAIN}: of"
    note += " positions about the hips, nothing scaled, no style taken out"
    return Table("Kata: events of different performers", head, lines, note)


def _marked(files: Sequence[Path], path: Path) -> list[Marked]:
    known = read_labels(path)
    marked = []
    for file in files:
        given = labels_of(file.name, known)
        if given is not None and len(given.segments) > 1:
            marked.append(_trimmed(file, given))
    return marked


def _trimmed(file: Path, given: Labels) -> Marked:
    take = read_labelled(file, given)
    segments = given.at_rate(take.rate).segments
    return replace(take, trim=(segments[0].start, segments[-1].end)), segments


def _misses(one: Marked, other: Marked) -> dict[str, Array]:
    """Seconds from each event of the reference to where the source's leads, by method."""
    (reference, marks), (source, own) = one, other
    wanted = {segment.name: segment.start for segment in marks[1:]}
    pairs = [(s.start, wanted[s.name]) for s in own[1:] if s.name in wanted]
    at, truth = np.array(pairs).reshape(-1, 2).T
    warps = {name: run(compare(reference, source, how)).warp for name, how in METHODS.items()}
    warps[PLAIN] = _plain_warp(reference, source)
    rate = float(reference.rate)
    return {name: np.abs(warp[at] - truth) / rate for name, warp in warps.items()}


def _plain_warp(reference: formats.Recording, source: formats.Recording) -> Array:
    """(S,) reference frame of each source frame within the trim, by DTW and nothing else."""
    one, other = performance_of(reference), performance_of(source)
    matched = match(one, other)
    poses = []
    for performance, rows in ((one, matched.reference), (other, matched.source)):
        start, end = performance.span
        local = performance.root.local(performance.positions[:, rows])[start:end]
        poses.append(local.reshape(len(local), -1).astype(np.float32))
    path = align(PoseDistances(*poses)).path
    warp = np.full(other.frames, np.nan)
    start, end = other.span
    warp[start:end] = warping_function(path, end - start) + one.span[0]
    return warp


def _row(method: str, name: str, errors: Sequence[Array]) -> EventRow:
    every = np.concatenate(errors)
    median, high = np.quantile(every, [0.5, 0.9])
    return EventRow(method, name, len(errors), len(every), float(median), float(high))
