"""What stands in a journal, and what it makes of a session when it is replayed.

One record a line: eight hexadecimal digits (CRC-32 of the rest), a space, a JSON object with its
``type``, a line feed. The first record is a `Head`; the order of the others is that of events.
Samples are npz files in base64.
"""

from __future__ import annotations

import base64
import binascii
import zipfile
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar

import msgspec

from mocapstudio.motion.errors import FileError
from mocapstudio.review.comparing_wire import ComparisonRecord
from mocapstudio.review.contact_wire import ContactRecord, PointsRecord
from mocapstudio.review.history import History, Step
from mocapstudio.review.manner import MannerRecord
from mocapstudio.review.marker_wire import MarkerEditRecord
from mocapstudio.review.model import Sitting
from mocapstudio.review.records import (
    Arrays,
    MalformedError,
    Record,
    arrays_from_bytes,
    arrays_to_bytes,
)
from mocapstudio.review.take_record import TakeRecord
from mocapstudio.review.wire import (
    DecisionRecord,
    EditRecord,
    ProtectedRecord,
    SittingRecord,
    TrimRecord,
    pack,
    unpack,
)

FORMAT = "mocapstudio journal"
VERSION = 1
_PARTS = ("edits", "decisions", "protected", "trims", "contacts", "points", "marker_edits")

Item = TypeVar("Item")


class Splice(Record, Generic[Item], frozen=True):
    """In a list, `removed` items from `start` on give way to `inserted`."""

    start: int = 0
    removed: int = 0
    inserted: tuple[Item, ...] = ()


class Delta(Record, frozen=True):
    """What turns one sitting into the next."""

    edits: Splice[EditRecord] = Splice()
    decisions: Splice[DecisionRecord] = Splice()
    protected: Splice[ProtectedRecord] = Splice()
    trims: Splice[TrimRecord] = Splice()
    contacts: Splice[ContactRecord] = Splice()
    points: Splice[PointsRecord] = Splice()
    marker_edits: Splice[MarkerEditRecord] = Splice()
    samples: str = ""


class Head(Record, frozen=True, tag="head"):
    """First record: which session file this follows, by the id of its last save; "" for none."""

    format: str
    version: int
    base: str = ""


class Opened(Record, frozen=True, tag="opened"):
    """A take was opened; `samples` where it has no file."""

    take: TakeRecord
    samples: str = ""


class Closed(Record, frozen=True, tag="closed"):
    """A performer was closed."""

    performer: str


class Stepped(Record, frozen=True, tag="stepped"):
    """A step was done."""

    label: str
    delta: Delta


class Undone(Record, frozen=True, tag="undone"):
    """A step was undone; `delta` leads back."""

    label: str
    delta: Delta


class Redone(Record, frozen=True, tag="redone"):
    """A step was done again."""

    label: str
    delta: Delta


class Settled(Record, frozen=True, tag="settled"):
    """What lasts but cannot be undone, as it is now; offsets and partners by performer id."""

    active: str
    context: tuple[str, ...]
    parameters: dict[str, Any]
    places: dict[str, tuple[float, bool]]
    manner: MannerRecord = MannerRecord()


class Compared(Record, frozen=True, tag="compared"):
    """What is compared, as it is now; `samples` of takes without a file, where they are new."""

    comparison: ComparisonRecord
    samples: str = ""


Event = Opened | Closed | Stepped | Undone | Redone | Settled | Compared
_decoder: msgspec.json.Decoder[Head | Event] = msgspec.json.Decoder(Head | Event)


def encode(record: Head | Event) -> bytes:
    """Return the line of a record."""
    text = msgspec.json.encode(record)
    return b"%08x %s\n" % (zlib.crc32(text), text)


@dataclass(frozen=True)
class Found:
    """What could be read of a journal.

    Parameters
    ----------
    base
        Id of the save that it follows.
    events
        Up to the first damaged record.
    length
        Bytes up to there.
    lost
        Bytes after that.
    """

    path: Path
    base: str
    events: tuple[Event, ...]
    length: int
    lost: int


def read(path: Path) -> Found:
    """Read a journal up to its end or its first damaged record.

    Raises
    ------
    FileError
        If the file cannot be read, is no journal, or comes from a newer version.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise FileError(path, f"cannot be read: {error.strerror or error}") from error
    records: list[Head | Event] = []
    length = 0
    while length < len(data):
        end = data.find(b"\n", length) + 1
        record = _decoded(data[length:end]) if end > 0 else None
        if record is None or isinstance(record, Head) != (not records):
            break
        records.append(record)
        length = end
    if not records:
        if not data.strip(b"\0"):
            return Found(path, "", (), 0, len(data))
        raise FileError(path, "is no journal of mocapstudio, or its beginning is damaged")
    head, *events = records
    assert isinstance(head, Head)
    if head.format != FORMAT:
        raise FileError(path, "is no journal of mocapstudio")
    if head.version > VERSION:
        raise FileError(path, f"comes from a newer version (journal {head.version})")
    found = tuple(e for e in events if not isinstance(e, Head))
    return Found(path, head.base, found, length, len(data) - length)


def _decoded(line: bytes) -> Head | Event | None:
    text = line[9:-1]
    if line[:9] != b"%08x " % zlib.crc32(text):
        return None
    try:
        return _decoder.decode(text)
    except msgspec.DecodeError:
        return None


def difference(before: Sitting, after: Sitting) -> Delta:
    """Return what leads from one sitting to another."""
    spans = {name: _changed(getattr(before, name), getattr(after, name)) for name in _PARTS}
    inserted = Sitting(
        **{
            name: getattr(after, name)[start : start + new]
            for name, (start, _, new) in spans.items()
        }
    )
    arrays: Arrays = {}
    record = pack(inserted, arrays)
    splices: dict[str, Any] = {
        name: Splice(start, old, getattr(record, name)) for name, (start, old, _) in spans.items()
    }
    return Delta(**splices, samples=to_text(arrays))


def _changed(before: Sequence[object], after: Sequence[object]) -> tuple[int, int, int]:
    """Start of what differs, and its length before and after."""
    shorter = min(len(before), len(after))
    start = 0
    while start < shorter and before[start] is after[start]:
        start += 1
    tail = 0
    while tail < shorter - start and before[-1 - tail] is after[-1 - tail]:
        tail += 1
    return start, len(before) - tail - start, len(after) - tail - start


def applied(sitting: Sitting, delta: Delta) -> Sitting:
    """Return the sitting that a difference leads to.

    Raises
    ------
    MalformedError
        If the difference does not fit.
    """
    record = SittingRecord(*(getattr(delta, name).inserted for name in _PARTS))
    inserted = unpack(record, from_text(delta.samples))
    parts: dict[str, Any] = {}
    for name in _PARTS:
        splice, old = getattr(delta, name), getattr(sitting, name)
        end = splice.start + splice.removed
        if not 0 <= splice.start <= end <= len(old):
            raise MalformedError(f"a step changes {name} that are not there")
        parts[name] = (*old[: splice.start], *getattr(inserted, name), *old[end:])
    return Sitting(**parts)


def advanced(history: History, event: Event) -> History:
    """Return the history after one event.

    Raises
    ------
    MalformedError
        If the event does not fit.
    """
    match event:
        case Stepped(label, delta):
            return history.push(label, applied(history.present, delta))
        case Undone(label, delta):
            if history.past:
                return history.undo()
            # The step was done before the last save: it is only known from here on.
            future = (*history.future, Step(label, history.present))
            return History(applied(history.present, delta), (), future)
        case Redone(label, delta):
            if history.future:
                return history.redo()
            past = (*history.past, Step(label, history.present))
            return History(applied(history.present, delta), past)
        case Closed(performer):
            return history.forget(performer)
    return history


def to_text(arrays: Arrays) -> str:
    """Return named arrays as text; "" for none."""
    return base64.b64encode(arrays_to_bytes(arrays)).decode() if arrays else ""


def from_text(text: str) -> Arrays:
    """Return named arrays from their text.

    Raises
    ------
    MalformedError
        If the text is damaged.
    """
    if not text:
        return {}
    try:
        return arrays_from_bytes(base64.b64decode(text, validate=True))
    except (ValueError, OSError, EOFError, zlib.error, binascii.Error, zipfile.BadZipFile) as bad:
        raise MalformedError(f"samples are damaged ({bad})") from bad
