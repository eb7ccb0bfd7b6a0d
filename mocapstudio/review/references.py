"""How the takes of a session are found again."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from mocapstudio.formats import ReadOptions, Recording, read_any
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take
from mocapstudio.review.reading_wire import unpack_reading
from mocapstudio.review.take_record import TakeRecord, absolute, held

Relocate = Callable[[Path], Path | None]


@dataclass(frozen=True)
class Found:
    """A take that was looked for: None where it is missing or is another one by now."""

    take: Recording | None
    problem: str | None = None


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
            return Found(held(record, arrays))
        path = self.path(record.relative, record.absolute, record.digest)
        if path is None:
            return Found(None, f"{record.absolute} is missing")
        try:
            take = self._read(path, record)
        except MocapError as error:
            return Found(None, str(error))
        if take is None:
            return Found(None, f"{path} holds another take than the one in this session")
        changed = _digest_of(take) != record.digest
        note = f"{path} has changed since the session was saved" if changed else None
        return Found(take, note)

    def _read(self, path: Path, record: TakeRecord) -> Recording | None:
        """Read a take as it was read when the session was saved; None where it does not fit."""
        options = ReadOptions()
        if record.reading is not None:
            options = unpack_reading(record.reading, self.path)
        take = _pick(path, record, options)
        if take is None or take.frames != record.frames:
            return None
        return _named(take, record)

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


def _pick(path: Path, record: TakeRecord, options: ReadOptions) -> Recording | None:
    takes, _ = read_any(path, options)
    kind = Take if record.labels is None else MarkerTake
    for take in takes:
        if (
            isinstance(take, kind)
            and take.source is not None
            and take.source.performer == record.performer
        ):
            return take
    return None


def _named(take: Recording, record: TakeRecord) -> Recording | None:
    if isinstance(take, MarkerTake):
        fits = take.labels == record.labels
        return replace(take, name=record.name, trim=record.trim) if fits else None
    names = take.skeleton.names
    if names != record.joints:
        if len(names) != len(record.joints) or _digest_of(take) != record.digest:
            return None
        # The same file: its joints had been renamed by a joint map.
        take = replace(take, skeleton=replace(take.skeleton, names=record.joints))
    return replace(take, name=record.name, trim=record.trim)


def _digest_of(take: Recording) -> str:
    return take.source.digest if take.source is not None else ""
