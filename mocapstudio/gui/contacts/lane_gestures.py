"""What the mouse makes of contacts on the lanes: pure arithmetic, no Qt."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum, auto

from mocapstudio.cleaning.contacts.model import Contact
from mocapstudio.gui.contacts.lanes import key_of


class Part(Enum):
    """Where on a contact the mouse is."""

    START = auto()
    END = auto()
    BODY = auto()


@dataclass(frozen=True)
class Room:
    """Frames that a contact may take up without touching the next ones of its lane."""

    low: int
    high: int


def room_for(start: int, end: int, others: Sequence[Contact], frames: int) -> Room:
    """Return the free stretch round [start, end) among the other contacts of a lane."""
    low = max((one.end for one in others if one.end <= start), default=0)
    high = min((one.start for one in others if one.start >= end), default=frames)
    # Loaded contacts may overlap: then only the take's ends bound them.
    overlaps = any(one.start < end and start < one.end for one in others)
    return Room(0, frames) if overlaps else Room(low, high)


def others_of(contact: Contact, contacts: Sequence[Contact]) -> list[Contact]:
    """Return the other contacts of a contact's lane."""
    return [c for c in contacts if key_of(c) == key_of(contact) and c.id != contact.id]


def reshaped(contact: Contact, part: Part, by: int, room: Room) -> Contact:
    """Move a contact or one of its edges by frames, as far as there is room; one frame is left."""
    if part is Part.START:
        start = min(max(contact.start + by, room.low), contact.end - 1)
        return replace(contact, start=start)
    if part is Part.END:
        end = max(min(contact.end + by, room.high), contact.start + 1)
        return replace(contact, end=end)
    length = contact.end - contact.start
    start = min(max(contact.start + by, room.low), room.high - length)
    return replace(contact, start=start, end=start + length)


def swept(a: int, b: int, contacts: Sequence[Contact], frames: int) -> tuple[int, int] | None:
    """Half-open span between two frames, from `a` as far as the lane is free; None if it is not."""
    if any(one.start <= a < one.end for one in contacts):
        return None
    room = room_for(a, a + 1, contacts, frames)
    low, high = max(min(a, b), room.low), min(max(a, b) + 1, room.high)
    return (low, high) if low < high else None
