"""Takes as a session refers to them, and how they are found again."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Any, Literal, cast

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats import ReadOptions, read
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import FileError, MocapError
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Source, Take
from mocapstudio.review.model import Performer
from mocapstudio.review.wire import Arrays, MalformedError, Record

Relocate = Callable[[Path], Path | None]


class TakeRecord(Record, frozen=True):
    """A performer: where its take lies, how it was read, and what it must hold.

    A take without a file (`absolute` is None) lies in arrays ``takes/ID/…``.
    """

    id: str
    name: str
    frames: int
    rate: str
    joints: tuple[str, ...]
    offset: float = 0.0
    partner: bool = False
    relative: str | None = None
    absolute: str | None = None
    digest: str = ""
    performer: int = 0
    unit: float = 1.0
    up: str | None = None
    mean_w: float = 0.0
    translated: tuple[int, ...] = (0,)
    first_frame: int = 0
    timecode: str | None = None
    trim: tuple[int, int] | None = None


@dataclass(frozen=True)
class Found:
    """A take that was looked for: None where it is missing or is another one by now."""

    take: Take | None
    problem: str | None = None


def refer(performer: Performer, folder: Path | None, arrays: Arrays) -> TakeRecord:
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
        take.skeleton.names,
        performer.offset,
        performer.partner,
        mean_w=_mean_w(take),
        translated=take.translated,
        first_frame=take.first_frame,
        timecode=take.timecode,
        trim=take.trim,
    )
    if source is None:
        arrays |= _take_arrays(performer.id, take)
        return record
    path = absolute(source.path)
    return _changed(
        record,
        relative=relative_to(path, folder),
        absolute=str(path),
        digest=source.digest,
        performer=source.performer,
        unit=source.unit,
        up=_up(source),
    )


def moved(record: TakeRecord, folder: Path | None) -> TakeRecord:
    """Return the record with its path relative to another folder."""
    if record.absolute is None:
        return record
    return _changed(record, relative=relative_to(Path(record.absolute), folder))


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


class Finder:
    """Finds the takes of one session: beside it, where they were, or where the user says.

    Parameters
    ----------
    folder
        Where the session file lies, or None.
    relocate
        Asked for a missing file; returns where it, or a folder that holds it, lies now, or None.
        What it answers for one take is tried for the others first.
    """

    def __init__(self, folder: Path | None, relocate: Relocate | None = None) -> None:
        self._folder = folder
        self._relocate = relocate
        # Folders that were moved, and where to.
        self._moves: list[tuple[Path, Path]] = []

    def find(self, record: TakeRecord, arrays: Mapping[str, NDArray[Any]]) -> Found:
        """Find and read one take.

        Raises
        ------
        MalformedError
            If a take that the session holds itself is damaged.
        """
        if record.absolute is None:
            return Found(_take_from(record, arrays))
        path = self.path(record.relative, record.absolute, record.digest)
        if path is None:
            return Found(None, f"{record.absolute} is missing")
        try:
            take = _read_alike(path, record)
        except MocapError as error:
            return Found(None, str(error))
        if take is None:
            return Found(None, f"{path} holds another take than the one in this session")
        changed = _digest_of(take) != record.digest
        note = f"{path} has changed since the session was saved" if changed else None
        return Found(take, note)

    def path(self, relative: str | None, before: str, digest: str = "") -> Path | None:
        """Where a file lies now: the first place whose content fits, else the first there is."""
        old = Path(before)
        places = [] if relative is None or self._folder is None else [self._folder / relative]
        places += [old, *(new / old.name for _, new in self._moves)]
        places += [new / old.relative_to(root) for root, new in self._moves if root in old.parents]
        there = [absolute(place) for place in places if place.is_file()]
        if not there:
            return self._ask(old)
        fitting = (place for place in there if not digest or _digest(place) == digest)
        return next(fitting, there[0])

    def _ask(self, old: Path) -> Path | None:
        if self._relocate is None:
            return None
        answer = self._relocate(old)
        if answer is None:
            return None
        new = answer / old.name if answer.is_dir() else answer
        if not new.is_file():
            return None
        self._moves += _roots(old, new)
        return absolute(new)


def _roots(old: Path, new: Path) -> list[tuple[Path, Path]]:
    """Folders that were moved, if `old` is `new` now: the nearest first, then those above."""
    pairs = [(old.parent, new.parent)]
    while pairs[-1][0].name and pairs[-1][0].name == pairs[-1][1].name:
        before, after = pairs[-1]
        pairs.append((before.parent, after.parent))
    return pairs


def _digest(path: Path) -> str:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return ""


def _read_alike(path: Path, record: TakeRecord) -> Take | None:
    """Read a take as it was read when the session was saved; None where it does not fit."""
    try:
        take = _pick(path, record, ReadOptions())
    except FileError:
        # It was opened once: leniently, then.
        take = _pick(path, record, ReadOptions(lenient=True))
    if take is None or take.source is None:
        return None
    rate, up = Fraction(record.rate), _up(take.source)
    wanted = ReadOptions(
        fps=None if take.rate == rate else rate,
        unit=None if take.source.unit == record.unit else record.unit,
        up=None if record.up in (None, up) else cast("Literal['x', 'y', 'z']", record.up),
        lenient=take.frames != record.frames,
    )
    if wanted != ReadOptions():
        take = _pick(path, record, wanted)
    if take is not None and not _same_motion(take, record):
        other = _pick(path, record, replace(wanted, angles="radians"))
        take = other if other is not None and _same_motion(other, record) else take
    if take is None or take.frames != record.frames:
        return None
    return _named(take, record)


def _pick(path: Path, record: TakeRecord, options: ReadOptions) -> Take | None:
    takes, _ = read(path, options)
    for take in takes:
        if take.source is not None and take.source.performer == record.performer:
            return take
    return None


def _named(take: Take, record: TakeRecord) -> Take | None:
    names = take.skeleton.names
    if names != record.joints:
        if len(names) != len(record.joints) or _digest_of(take) != record.digest:
            return None
        # The same file: its joints had been renamed by a joint map.
        take = replace(take, skeleton=replace(take.skeleton, names=record.joints))
    return replace(take, name=record.name, trim=record.trim)


def _digest_of(take: Take) -> str:
    return take.source.digest if take.source is not None else ""


def _mean_w(take: Take) -> float:
    """Tell takes apart that were read with angles in another unit."""
    return float(np.nan_to_num(np.abs(take.rotations[..., 3])).mean())


def _same_motion(take: Take, record: TakeRecord) -> bool:
    return abs(_mean_w(take) - record.mean_w) < 1e-6


def _up(source: Source) -> str | None:
    """Axis of the file that became our Y; None where it is none of the three."""
    turned = rot.rotate(np.broadcast_to(source.to_inside, (3, 4)), np.eye(3))
    axis = int(turned[:, 1].argmax())
    return "xyz"[axis] if turned[axis, 1] > 1 - 1e-6 else None


def _take_arrays(performer: str, take: Take) -> Arrays:
    skeleton = take.skeleton
    arrays = {
        "parents": skeleton.parents,
        "offsets": skeleton.offsets,
        "end_parents": skeleton.end_parents,
        "end_offsets": skeleton.end_offsets,
        "rotations": take.rotations,
        "translations": take.translations,
    }
    return {f"takes/{performer}/{name}": array for name, array in arrays.items()}


def _take_from(record: TakeRecord, arrays: Mapping[str, NDArray[Any]]) -> Take:
    try:
        part = {
            name: arrays[f"takes/{record.id}/{name}"]
            for name in (
                "parents",
                "offsets",
                "end_parents",
                "end_offsets",
                "rotations",
                "translations",
            )
        }
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
    except (KeyError, ValueError, IndexError, MocapError) as error:
        raise MalformedError(f"the take {record.name} inside is damaged ({error})") from error


def _changed(record: TakeRecord, **changes: Any) -> TakeRecord:
    values = {name: getattr(record, name) for name in record.__struct_fields__}
    return TakeRecord(**(values | changes))
