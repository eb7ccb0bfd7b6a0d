"""How a comparison looks in session file and journal."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec

from mocapstudio.comparison.model import Segment
from mocapstudio.comparison.parameters import ComparisonParameters
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take
from mocapstudio.review.comparing_kept import KeptComparison
from mocapstudio.review.comparing_segments import check
from mocapstudio.review.marker_model import MarkerPerformer
from mocapstudio.review.model import Performer
from mocapstudio.review.records import Arrays, MalformedError, Record, check_unique
from mocapstudio.review.take_record import TakeRecord, absolute, moved, refer, relative_to

Recording = Take | MarkerTake

COMPARED = "compared/"
"""Ids of compared takes begin so, which no name of a take in the scene does."""


class SegmentRecord(Record, frozen=True):
    """A `Segment`."""

    name: str
    start: int
    end: int


class SourceRecord(Record, frozen=True):
    """A source and the name it goes by."""

    id: str
    take: TakeRecord


class ComparisonRecord(Record, frozen=True):
    """A `KeptComparison`; the samples of takes without a file lie in arrays ``takes/ID/…``."""

    reference: TakeRecord | None = None
    sources: tuple[SourceRecord, ...] = ()
    parameters: dict[str, Any] = msgspec.field(default_factory=dict)
    segments: tuple[SegmentRecord, ...] = ()
    labels: str | None = None
    labels_beside: str | None = None
    unsaved: bool = False
    chosen: str = ""
    row: str | None = None
    segment: int | None = None
    frame: int = 0
    source_frame: int = 0
    shown: tuple[float, float] = (-0.5, 0.5)


class Absent(Record, frozen=True):
    """What was not found: sources, and all of a comparison whose reference is missing."""

    sources: tuple[SourceRecord, ...] = ()
    whole: ComparisonRecord | None = None


def pack_comparison(
    kept: KeptComparison,
    folder: Path | None,
    arrays: Arrays,
    name: Callable[[Recording], str],
) -> ComparisonRecord:
    """Return the record of a comparison; takes without a file are put into `arrays`.

    Parameters
    ----------
    folder
        Where the session file lies; paths are kept relative to it.
    name
        Gives each performance an id that no other take of the session has.
    """
    absent = kept.absent if isinstance(kept.absent, Absent) else Absent()
    if kept.reference is None and absent.whole is not None:
        return _moved(absent.whole, folder)

    def told(take: Recording) -> TakeRecord:
        performer = MarkerPerformer if isinstance(take, MarkerTake) else Performer
        return refer(performer(name(take), take), folder, arrays)  # type: ignore[arg-type]

    labels = None if kept.labels is None else absolute(kept.labels)
    return ComparisonRecord(
        reference=None if kept.reference is None else told(kept.reference),
        sources=(
            *(SourceRecord(one, told(take)) for one, take in kept.sources),
            *(SourceRecord(one.id, moved(one.take, folder)) for one in absent.sources),
        ),
        parameters=dataclasses.asdict(kept.parameters),
        segments=tuple(SegmentRecord(s.name, s.start, s.end) for s in kept.segments),
        labels=None if labels is None else str(labels),
        labels_beside=None if labels is None else relative_to(labels, folder),
        unsaved=kept.unsaved,
        chosen=kept.chosen,
        row=kept.row,
        segment=kept.segment,
        frame=kept.frame,
        source_frame=kept.source_frame,
        shown=kept.shown,
    )


def unpack_comparison(
    record: ComparisonRecord,
    folder: Path | None,
    find: Callable[[TakeRecord], Recording | None],
    tell: Callable[[str], None],
) -> KeptComparison:
    """Return the comparison of a record.

    Parameters
    ----------
    find
        Finds and reads a take; None where it is missing.
    tell
        Told what cannot be as it was.
    """
    reference = None if record.reference is None else find(record.reference)
    if reference is None and record.reference is not None:
        return KeptComparison(absent=Absent(whole=record))
    found, absent = [], []
    for one in record.sources:
        take = find(one.take)
        if take is None:
            absent.append(one)
        else:
            found.append((one.id, take))
    segments = tuple(Segment(one.name, one.start, one.end) for one in record.segments)
    if reference is not None:
        segments = check(segments, reference.frames)
    at = record.segment
    return KeptComparison(
        reference=reference,
        sources=tuple(found),
        parameters=_parameters(record.parameters, tell),
        segments=segments if reference is not None else (),
        labels=_labels(record, folder),
        unsaved=record.unsaved,
        chosen=record.chosen,
        row=record.row,
        segment=at if at is not None and 0 <= at < len(segments) else None,
        frame=record.frame,
        source_frame=record.source_frame,
        shown=record.shown,
        absent=Absent(tuple(absent)) if absent else None,
    )


def check_comparison(record: ComparisonRecord) -> None:
    """Check that a record can be true.

    Raises
    ------
    MalformedError
        Naming the first contradiction.
    """
    check_unique((one.id for one in record.sources), "source")
    frames = 0 if record.reference is None else record.reference.frames
    try:
        check([Segment(s.name, s.start, s.end) for s in record.segments], frames)
    except MocapError as error:
        raise MalformedError(str(error)) from error


def _parameters(kept: dict[str, Any], tell: Callable[[str], None]) -> ComparisonParameters:
    default = ComparisonParameters()
    known = {name: value for name, value in kept.items() if hasattr(default, name)}
    try:
        return dataclasses.replace(default, **known)
    except (MocapError, TypeError) as error:
        tell(f"its comparison is made by the defaults: {error}")
        return default


def _labels(record: ComparisonRecord, folder: Path | None) -> Path | None:
    if record.labels is None:
        return None
    if folder is not None and record.labels_beside is not None:
        beside = folder / record.labels_beside
        if beside.exists():
            return absolute(beside)
    return Path(record.labels)


def _moved(record: ComparisonRecord, folder: Path | None) -> ComparisonRecord:
    sources = tuple(SourceRecord(one.id, moved(one.take, folder)) for one in record.sources)
    reference = None if record.reference is None else moved(record.reference, folder)
    return msgspec.structs.replace(record, reference=reference, sources=sources)
