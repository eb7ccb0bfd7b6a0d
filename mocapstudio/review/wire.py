"""How the pieces of a sitting look in JSON; samples go into named arrays beside it.

Session file and journal share these records. Unknown fields are ignored when read, so that a
field may be added without a new version.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from numpy.typing import NDArray

from mocapstudio.cleaning.model import Flag, Kind, Neighbour
from mocapstudio.review import contact_wire
from mocapstudio.review.marker_wire import (
    MarkerEditRecord,
    pack_marker_edit,
    unpack_marker_edit,
)
from mocapstudio.review.model import Decision, Edit, Protected, Sitting, Verdict
from mocapstudio.review.records import Arrays, Record, samples


class NeighbourRecord(Record, frozen=True):
    """A `cleaning.model.Neighbour`."""

    take: str
    start: int
    end: int
    index: int
    # JSON has no NaN: null stands for it here and below.
    distance: float | None = None


class FlagRecord(Record, frozen=True):
    """A `cleaning.model.Flag`."""

    id: str
    joint: str
    joints: tuple[str, ...]
    start: int
    end: int
    peak_frame: int
    kind: Kind
    peak: float | None = None
    score: float | None = None


class EditRecord(Record, frozen=True):
    """A `review.model.Edit`; arrays ``edits/ID/rotations`` and ``edits/ID/translations``."""

    id: str
    performer: str
    rows: tuple[str, ...]
    joints: tuple[str, ...]
    start: int
    end: int
    method: str
    group: str
    author: str
    time: str
    donor: NeighbourRecord | None = None
    flag: str | None = None
    muted: bool = False


class DecisionRecord(Record, frozen=True):
    """A `review.model.Decision`."""

    performer: str
    flag: FlagRecord
    verdict: Verdict
    author: str
    time: str
    edit: str | None = None


class ProtectedRecord(Record, frozen=True):
    """A `review.model.Protected`; no joints means all."""

    performer: str
    joints: tuple[str, ...]
    start: int
    end: int
    author: str
    time: str


class TrimRecord(Record, frozen=True):
    """The trim of one performer."""

    performer: str
    start: int
    end: int


class SittingRecord(Record, frozen=True):
    """A `review.model.Sitting`."""

    edits: tuple[EditRecord, ...] = ()
    decisions: tuple[DecisionRecord, ...] = ()
    protected: tuple[ProtectedRecord, ...] = ()
    trims: tuple[TrimRecord, ...] = ()
    contacts: tuple[contact_wire.ContactRecord, ...] = ()
    points: tuple[contact_wire.PointsRecord, ...] = ()
    marker_edits: tuple[MarkerEditRecord, ...] = ()


def pack_flag(flag: Flag) -> FlagRecord:
    """Make a record of a flag."""
    return FlagRecord(
        flag.id,
        flag.joint,
        flag.joints,
        int(flag.start),
        int(flag.end),
        int(flag.peak_frame),
        flag.kind,
        float(flag.peak),
        float(flag.score),
    )


def unpack_flag(record: FlagRecord) -> Flag:
    """Make a flag of its record."""
    values = {name: getattr(record, name) for name in record.__struct_fields__}
    for name in ("peak", "score"):
        values[name] = math.nan if values[name] is None else values[name]
    return Flag(**values)


def pack(sitting: Sitting, arrays: Arrays) -> SittingRecord:
    """Make a record of a sitting, its samples put into `arrays`."""
    return SittingRecord(
        tuple(_pack_edit(e, arrays) for e in sitting.edits),
        tuple(_pack_decision(d) for d in sitting.decisions),
        tuple(_pack_protected(p) for p in sitting.protected),
        tuple(TrimRecord(performer, *span) for performer, span in sitting.trims),
        tuple(contact_wire.pack_contact(c) for c in sitting.contacts),
        tuple(contact_wire.pack_points(p) for p in sitting.points),
        tuple(pack_marker_edit(e, arrays) for e in sitting.marker_edits),
    )


def unpack(record: SittingRecord, arrays: Mapping[str, NDArray[Any]]) -> Sitting:
    """Make a sitting of its record and arrays.

    Raises
    ------
    MalformedError
        If samples are missing or of another shape than their edit says.
    """
    return Sitting(
        tuple(_unpack_edit(e, arrays) for e in record.edits),
        tuple(
            Decision(d.performer, unpack_flag(d.flag), d.verdict, d.author, d.time, d.edit)
            for d in record.decisions
        ),
        tuple(
            Protected(p.performer, frozenset(p.joints), p.start, p.end, p.author, p.time)
            for p in record.protected
        ),
        tuple((t.performer, (t.start, t.end)) for t in record.trims),
        tuple(contact_wire.unpack_contact(c) for c in record.contacts),
        tuple(contact_wire.unpack_points(p) for p in record.points),
        tuple(unpack_marker_edit(e, arrays) for e in record.marker_edits),
    )


def _pack_edit(edit: Edit, arrays: Arrays) -> EditRecord:
    arrays[f"edits/{edit.id}/rotations"] = edit.rotations
    if edit.translations is not None:
        arrays[f"edits/{edit.id}/translations"] = edit.translations
    return EditRecord(
        edit.id,
        edit.performer,
        edit.rows,
        edit.joints,
        int(edit.start),
        int(edit.end),
        edit.method,
        edit.group,
        edit.author,
        edit.time,
        None if edit.donor is None else _pack_donor(edit.donor),
        edit.flag,
        edit.muted,
    )


def _pack_donor(donor: Neighbour) -> NeighbourRecord:
    return NeighbourRecord(
        donor.take, int(donor.start), int(donor.end), int(donor.index), float(donor.distance)
    )


def _unpack_donor(record: NeighbourRecord) -> Neighbour:
    distance = math.nan if record.distance is None else record.distance
    return Neighbour(record.take, record.start, record.end, distance, record.index)


def _unpack_edit(record: EditRecord, arrays: Mapping[str, NDArray[Any]]) -> Edit:
    frames = record.end - record.start
    key = f"edits/{record.id}/translations"
    return Edit(
        record.id,
        record.performer,
        record.rows,
        record.joints,
        record.start,
        record.end,
        samples(arrays, f"edits/{record.id}/rotations", (frames, len(record.joints), 4)),
        samples(arrays, key, (frames, 3)) if key in arrays else None,
        record.method,
        None if record.donor is None else _unpack_donor(record.donor),
        record.flag,
        record.group,
        record.author,
        record.time,
        record.muted,
    )


def _pack_decision(decision: Decision) -> DecisionRecord:
    return DecisionRecord(
        decision.performer,
        pack_flag(decision.flag),
        decision.verdict,
        decision.author,
        decision.time,
        decision.edit,
    )


def _pack_protected(one: Protected) -> ProtectedRecord:
    rows = tuple(sorted(one.joints))
    return ProtectedRecord(one.performer, rows, one.start, one.end, one.author, one.time)
