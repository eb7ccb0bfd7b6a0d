"""How contacts of a sitting look in JSON: in the session file and in the journal."""

from __future__ import annotations

from collections.abc import Callable

import msgspec
import numpy as np

from mocapstudio.cleaning.contacts.model import (
    Contact,
    ContactPoint,
    Fixed,
    Floor,
    Following,
    Line,
    Point,
    Target,
)
from mocapstudio.review.model import OwnContact, OwnPoints

Triple = tuple[float, float, float]


class _Record(msgspec.Struct, frozen=True, omit_defaults=True):
    pass


class FixedRecord(_Record, frozen=True, tag="fixed"):
    """A `Fixed`."""

    position: Triple


class FloorRecord(_Record, frozen=True, tag="floor"):
    """A `Floor`."""

    height: float
    normal: Triple = (0.0, 1.0, 0.0)


class LineRecord(_Record, frozen=True, tag="line"):
    """A `Line`."""

    position: Triple
    direction: Triple


class FollowingRecord(_Record, frozen=True, tag="following"):
    """A `Following`."""

    performer: str
    joint: str
    offset: Triple = (0.0, 0.0, 0.0)


class ContactRecord(_Record, frozen=True):
    """A `Contact` of one performer."""

    performer: str
    id: str
    joint: str
    point: Point | None
    start: int
    end: int
    target: FixedRecord | FloorRecord | LineRecord | FollowingRecord
    confidence: float = 1.0
    drawn: bool = False


class PointRecord(_Record, frozen=True):
    """A `ContactPoint`: metres in the joint's frame."""

    joint: str
    point: Point | None
    offset: Triple


class PointsRecord(_Record, frozen=True):
    """The adjusted contact points of one performer."""

    performer: str
    points: tuple[PointRecord, ...]


def pack_contact(own: OwnContact) -> ContactRecord:
    """Make a record of a contact."""
    one = own.contact
    return ContactRecord(
        own.performer,
        one.id,
        one.joint,
        one.point,
        int(one.start),
        int(one.end),
        _PACKED[type(one.target)](one.target),
        float(one.confidence),
        one.drawn,
    )


def unpack_contact(record: ContactRecord) -> OwnContact:
    """Make a contact of its record."""
    return OwnContact(
        record.performer,
        Contact(
            record.id,
            record.joint,
            record.point,
            record.start,
            record.end,
            _target(record.target),
            record.confidence,
            record.drawn,
        ),
    )


def pack_points(own: OwnPoints) -> PointsRecord:
    """Make a record of contact points."""
    return PointsRecord(
        own.performer,
        tuple(PointRecord(p.joint, p.point, _triple(tuple(p.offset))) for p in own.points),
    )


def unpack_points(record: PointsRecord) -> OwnPoints:
    """Make contact points of their record."""
    return OwnPoints(
        record.performer,
        tuple(ContactPoint(p.joint, p.point, np.array(p.offset)) for p in record.points),
    )


def _triple(values: tuple[float, ...]) -> Triple:
    x, y, z = (float(value) for value in values)
    return x, y, z


_PACKED: dict[type, Callable[..., FixedRecord | FloorRecord | LineRecord | FollowingRecord]] = {
    Fixed: lambda t: FixedRecord(_triple(t.position)),
    Floor: lambda t: FloorRecord(float(t.height), _triple(t.normal)),
    Line: lambda t: LineRecord(_triple(t.position), _triple(t.direction)),
    Following: lambda t: FollowingRecord(t.performer, t.joint, _triple(t.offset)),
}


def _target(record: FixedRecord | FloorRecord | LineRecord | FollowingRecord) -> Target:
    match record:
        case FixedRecord(position):
            return Fixed(position)
        case FloorRecord(height, normal):
            return Floor(height, normal)
        case LineRecord(position, direction):
            return Line(position, direction)
        case FollowingRecord(performer, joint, offset):
            return Following(performer, joint, offset)
