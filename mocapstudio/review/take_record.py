"""Takes as a session refers to them: by their file, or whole where they have none."""

from __future__ import annotations

import os
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats import ReadOptions
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Source, Take
from mocapstudio.review.marker_model import MarkerPerformer
from mocapstudio.review.model import Performer
from mocapstudio.review.reading_wire import ReadingRecord, pack_reading
from mocapstudio.review.records import Arrays, MalformedError, Record

_PARTS = ("parents", "offsets", "end_parents", "end_offsets", "rotations", "translations")


class TakeRecord(Record, frozen=True):
    """A performer: where its take lies, how it was read, and what it must hold.

    A take without a file (`absolute` is None) lies in arrays ``takes/ID/…``. A marker take has
    `labels` and no joints. Without `reading` a file is read as it stands.
    """

    id: str
    name: str
    frames: int
    rate: str
    joints: tuple[str, ...] = ()
    offset: float = 0.0
    partner: bool = False
    relative: str | None = None
    absolute: str | None = None
    digest: str = ""
    performer: int = 0
    translated: tuple[int, ...] = (0,)
    first_frame: int = 0
    timecode: str | None = None
    trim: tuple[int, int] | None = None
    reading: ReadingRecord | None = None
    labels: tuple[str, ...] | None = None


def refer(
    performer: Performer | MarkerPerformer, folder: Path | None, arrays: Arrays
) -> TakeRecord:
    """Make a record of a performer; a take that has no file is put into `arrays`.

    Parameters
    ----------
    folder
        Where the session file lies; paths are kept relative to it.
    """
    take, source = performer.take, performer.take.source
    record = TakeRecord(
        performer.id,
        take.name,
        take.frames,
        str(take.rate),
        first_frame=take.first_frame,
        timecode=take.timecode,
        trim=take.trim,
    )
    if isinstance(take, MarkerTake):
        record = changed(record, labels=take.labels)
    else:
        record = changed(
            record,
            joints=take.skeleton.names,
            translated=take.translated,
        )
    if isinstance(performer, Performer):
        record = changed(record, offset=performer.offset, partner=performer.partner)
    if source is None:
        arrays |= _arrays_of(performer.id, take)
        return record
    return _with_source(record, source, folder)


def moved(record: TakeRecord, folder: Path | None) -> TakeRecord:
    """Return the record with its paths relative to another folder."""
    if record.absolute is None:
        return record
    reading = record.reading
    if reading is not None and reading.skeleton is not None:
        beside = relative_to(Path(reading.skeleton), folder)
        reading = ReadingRecord(**(_values(reading) | {"beside": beside}))
    relative = relative_to(Path(record.absolute), folder)
    return changed(record, relative=relative, reading=reading)


def absolute(path: Path | str) -> Path:
    """Absolute path without ``..``; links are kept as the user named them."""
    return Path(os.path.abspath(path))  # noqa: PTH100


def relative_to(path: Path, folder: Path | None) -> str | None:
    """Path from a folder, with slashes; None without a folder, or on another drive."""
    if folder is None:
        return None
    try:
        return Path(os.path.relpath(path, absolute(folder))).as_posix()
    except ValueError:
        return None


def held(record: TakeRecord, arrays: Mapping[str, NDArray[Any]]) -> Take | MarkerTake:
    """Return a take that the session itself holds.

    Raises
    ------
    MalformedError
        If it is damaged.
    """
    try:
        return _marker_take(record, arrays) if record.labels is not None else _take(record, arrays)
    except (KeyError, ValueError, IndexError, MocapError) as error:
        raise MalformedError(f"the take {record.name} inside is damaged ({error})") from error


def changed(record: TakeRecord, **changes: Any) -> TakeRecord:
    """Return a record with other fields."""
    return TakeRecord(**(_values(record) | changes))


def _values(record: Record) -> dict[str, Any]:
    return {name: getattr(record, name) for name in record.__struct_fields__}


def _with_source(record: TakeRecord, source: Source, folder: Path | None) -> TakeRecord:
    path = absolute(source.path)
    reading = None
    if isinstance(source.options, ReadOptions):
        reading = pack_reading(source.options, lambda one: relative_to(one, folder))
    return changed(
        record,
        relative=relative_to(path, folder),
        absolute=str(path),
        digest=source.digest,
        performer=source.performer,
        reading=reading,
    )


def _arrays_of(performer: str, take: Take | MarkerTake) -> Arrays:
    if isinstance(take, MarkerTake):
        found = {"positions": take.positions, "bones": np.array(take.bones).reshape(-1, 2)}
        if take.filled is not None:
            found["filled"] = take.filled
    else:
        skeleton = take.skeleton
        found = {
            "parents": skeleton.parents,
            "offsets": skeleton.offsets,
            "end_parents": skeleton.end_parents,
            "end_offsets": skeleton.end_offsets,
            "rotations": take.rotations,
            "translations": take.translations,
        }
    return {f"takes/{performer}/{name}": array for name, array in found.items()}


def _take(record: TakeRecord, arrays: Mapping[str, NDArray[Any]]) -> Take:
    part: dict[str, Any] = {name: arrays[f"takes/{record.id}/{name}"] for name in _PARTS}
    rotations, translations = part.pop("rotations"), part.pop("translations")
    return Take(
        record.name,
        Skeleton(record.joints, **part),
        rotations,
        translations,
        Fraction(record.rate),
        record.translated,
        record.first_frame,
        record.timecode,
        record.trim,
    )


def _marker_take(record: TakeRecord, arrays: Mapping[str, NDArray[Any]]) -> MarkerTake:
    assert record.labels is not None
    bones = arrays[f"takes/{record.id}/bones"]
    return MarkerTake(
        record.name,
        record.labels,
        arrays[f"takes/{record.id}/positions"],
        Fraction(record.rate),
        record.first_frame,
        record.timecode,
        record.trim,
        arrays.get(f"takes/{record.id}/filled"),
        tuple((int(a), int(b)) for a, b in bones),
    )
