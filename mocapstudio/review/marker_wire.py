"""How edits of marker takes look in JSON: in the session file and in the journal."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import msgspec
from numpy.typing import NDArray

from mocapstudio.review.marker_model import MarkerEdit, MarkerEditKind
from mocapstudio.review.records import Arrays, MalformedError, Record, samples


class MarkerEditRecord(Record, frozen=True):
    """A `MarkerEdit`; array ``marker_edits/ID/positions`` where it fills a gap."""

    id: str
    performer: str
    kind: MarkerEditKind
    markers: tuple[str, ...]
    start: int
    end: int
    method: str
    group: str
    author: str
    time: str
    parameters: dict[str, int | float | str] = msgspec.field(default_factory=dict)
    muted: bool = False


def pack_marker_edit(edit: MarkerEdit, arrays: Arrays) -> MarkerEditRecord:
    """Make a record of an edit, its samples put into `arrays`."""
    if edit.positions is not None:
        arrays[_key(edit.id)] = edit.positions
    return MarkerEditRecord(
        edit.id,
        edit.performer,
        edit.kind,
        edit.markers,
        int(edit.start),
        int(edit.end),
        edit.method,
        edit.group,
        edit.author,
        edit.time,
        dict(edit.parameters),
        edit.muted,
    )


def unpack_marker_edit(record: MarkerEditRecord, arrays: Mapping[str, NDArray[Any]]) -> MarkerEdit:
    """Make an edit of its record and arrays.

    Raises
    ------
    MalformedError
        If samples are missing or of another shape than the edit says, or markers of an exchange
        are not two.
    """
    if not record.markers or (
        record.kind is MarkerEditKind.EXCHANGE and len(set(record.markers)) != 2
    ):
        raise MalformedError(f"edit {record.id} has odd markers")
    positions = None
    if record.kind is MarkerEditKind.FILL:
        shape = (record.end - record.start, len(record.markers), 3)
        positions = samples(arrays, _key(record.id), shape)
    return MarkerEdit(
        record.id,
        record.performer,
        record.kind,
        record.markers,
        record.start,
        record.end,
        positions,
        record.method,
        record.group,
        record.author,
        record.time,
        MappingProxyType(dict(record.parameters)),
        record.muted,
    )


def _key(edit_id: str) -> str:
    return f"marker_edits/{edit_id}/positions"
