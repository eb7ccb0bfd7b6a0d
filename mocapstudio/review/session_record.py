"""The record that a session file consists of, and the bytes of the file."""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import msgspec

from mocapstudio.motion.errors import FileError, MocapError
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.review.comparing_wire import ComparisonRecord, check_comparison
from mocapstudio.review.manner import MannerRecord
from mocapstudio.review.records import (
    Arrays,
    MalformedError,
    Record,
    arrays_from_bytes,
    arrays_to_bytes,
    check_unique,
)
from mocapstudio.review.take_record import TakeRecord
from mocapstudio.review.wire import FlagRecord, ProtectedRecord, SittingRecord

FORMAT = "mocapstudio session"
VERSION = 1
_JSON, _SAMPLES = "session.json", "samples.npz"


class Head(Record, frozen=True):
    """What is asked of a session file first."""

    format: str = ""
    version: int = 0


class PathRecord(Record, frozen=True):
    """A file or folder of the context."""

    absolute: str
    relative: str | None = None


class SessionRecord(Record, frozen=True):
    """All of a session but its samples."""

    format: str
    version: int
    # Names this save: a journal says which one it follows.
    save: str = ""
    program: str = ""
    saved: str = ""
    takes: tuple[TakeRecord, ...] = ()
    sitting: SittingRecord = SittingRecord()
    context: tuple[PathRecord, ...] = ()
    parameters: dict[str, Any] = msgspec.field(default_factory=dict)
    manner: MannerRecord = MannerRecord()
    active: str = ""
    frame: int = 0
    joints: tuple[str, ...] = ()
    span: tuple[int, int] | None = None
    flag: str | None = None
    flags: dict[str, tuple[FlagRecord, ...]] = msgspec.field(default_factory=dict)
    choices: dict[str, dict[str, int | None]] = msgspec.field(default_factory=dict)
    comparison: ComparisonRecord = ComparisonRecord()


def to_bytes(record: SessionRecord, arrays: Arrays) -> bytes:
    """Return the session file of a record and its samples."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr(_JSON, msgspec.json.format(msgspec.json.encode(record), indent=1))
        # Compressed inside already.
        file.writestr(_SAMPLES, arrays_to_bytes(arrays), zipfile.ZIP_STORED)
    return buffer.getvalue()


def read(path: Path) -> tuple[SessionRecord, Arrays]:
    """Read a session file and check that its parts fit together.

    Raises
    ------
    FileError
        If it cannot be read, is no session, is damaged, or comes from a newer version.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise FileError(path, (error.strerror or str(error)).lower()) from error
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as file:
            text, samples = file.read(_JSON), file.read(_SAMPLES)
    except KeyError as error:
        raise FileError(path, "is no session of mocapstudio") from error
    except (zipfile.BadZipFile, zlib.error, EOFError, OSError, ValueError, RuntimeError) as error:
        raise FileError(path, f"is no session, or a damaged one ({error})") from error
    try:
        head = msgspec.json.decode(text, type=Head)
        if head.format != FORMAT:
            raise FileError(path, "is no session of mocapstudio")
        if head.version > VERSION:
            raise FileError(
                path, f"comes from a newer version (session format {head.version}, known {VERSION})"
            )
        record = msgspec.json.decode(text, type=SessionRecord)
        arrays = arrays_from_bytes(samples)
        check(record)
    except FileError:
        raise
    except (ValueError, EOFError, OSError, zlib.error, zipfile.BadZipFile, MocapError) as error:
        raise FileError(path, f"is damaged: {error}") from error
    return record, arrays


def check(record: SessionRecord) -> None:
    """Check that what a session says of its takes can be true of them.

    Raises
    ------
    MalformedError
        Naming the first contradiction.
    """
    check_unique((t.id for t in record.takes), "performer")
    check_unique((e.id for e in record.sitting.edits), "edit")
    check_unique((e.id for e in record.sitting.marker_edits), "edit")
    check_unique((f"{c.id} of {c.performer}" for c in record.sitting.contacts), "contact")
    check_comparison(record.comparison)
    checks = _Checks(record.takes)
    checks.sitting(record.sitting)
    for performer, flags in record.flags.items():
        for one in flags:
            checks.flag(performer, one)
    if record.active:
        checks.span(record.active, record.joints, *(record.span or (0, 1)))


class _Checks:
    """Checks against the takes of a session."""

    def __init__(self, takes: Iterable[TakeRecord]) -> None:
        self._takes = {take.id: take for take in takes}
        self._rows = {
            one.id: {*one.joints, *ROOT_ROWS} if one.labels is None else set()
            for one in self._takes.values()
        }

    def sitting(self, record: SittingRecord) -> None:
        for edit in record.edits:
            self.span(edit.performer, (*edit.rows, *edit.joints), edit.start, edit.end)
            if set(edit.joints) & set(ROOT_ROWS):
                raise MalformedError(f"edit {edit.id} turns a row that is no joint")
        for decision in record.decisions:
            self.flag(decision.performer, decision.flag)
        for protected in record.protected:
            self.protected(protected)
        for trim in record.trims:
            self.span(trim.performer, (), trim.start, trim.end)
        for contact in record.contacts:
            self.span(contact.performer, (contact.joint,), contact.start, contact.end)
        for change in record.marker_edits:
            self.span(change.performer, (), change.start, change.end)
            labels = self._takes[change.performer].labels or ()
            for label in set(change.markers).difference(labels):
                raise MalformedError(f"{change.performer} has no marker {label}")
        for own in record.points:
            self.span(own.performer, (point.joint for point in own.points), 0, 1)

    def protected(self, one: ProtectedRecord) -> None:
        self.span(one.performer, (), one.start, one.end)
        labels = self._takes[one.performer].labels
        rows = self._rows[one.performer] if labels is None else set(labels)
        for row in set(one.joints) - rows:
            what = "joint" if labels is None else "marker"
            raise MalformedError(f"{one.performer} has no {what} {row}")

    def flag(self, performer: str, one: FlagRecord) -> None:
        self.span(performer, (one.joint, *one.joints), one.start, one.end)
        if not one.start <= one.peak_frame < one.end:
            raise MalformedError(f"flag {one.id} peaks outside its frames")

    def span(self, performer: str, rows: Iterable[str], start: int, end: int) -> None:
        if performer not in self._takes:
            raise MalformedError(f"performer {performer} is unknown")
        if not 0 <= start < end <= self._takes[performer].frames:
            raise MalformedError(f"frames {start} to {end} of {performer} do not exist")
        for row in rows:
            if row not in self._rows[performer]:
                raise MalformedError(f"{performer} has no joint {row}")
