"""One contact, and one contact point, as records of JSON; see `files` for what they mean."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any, get_args

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
from mocapstudio.cleaning.ik.targets import Hold
from mocapstudio.motion.take import Take

_KINDS = ("fixed", "floor", "line", "following")
_UP = (0.0, 1.0, 0.0)
_MOST = 1e6
_MOST_FRAMES = 1e12


class WrongRecordError(ValueError):
    """What is wrong with one record, as a phrase that follows its name."""


def to_record(hold: Hold) -> dict[str, Any]:
    """Return the record of a contact as it is laid out over its take."""
    contact = hold.contact
    record: dict[str, Any] = {
        "joint": contact.joint,
        "point": contact.point,
        "start": contact.start,
        "end": contact.end,
        "target": [float(x) for x in hold.target[0]],
        "confidence": contact.confidence,
        "id": contact.id,
        "drawn": contact.drawn,
    }
    target = contact.target
    if isinstance(target, Floor):
        # The plane is told by a point of it; its height is that of the point as it was set.
        record["target"][1] = target.height
        return record | {"kind": "floor", "normal": list(target.normal)}
    if isinstance(target, Line):
        record["target"] = list(target.position)
        return record | {"kind": "line", "direction": list(target.direction)}
    if isinstance(target, Following):
        return record | {
            "kind": "following",
            "performer": target.performer,
            "follows": target.joint,
            "offset": list(target.offset),
        }
    return record | {"kind": "fixed"}


def to_point(one: Mapping[str, Any], take: Take) -> ContactPoint:
    """Return the contact point of a record.

    Raises
    ------
    WrongRecordError
        If it is none, or its joint is not in the take.
    """
    return ContactPoint(_joint(one, take), _name(one), np.array(_vector(one, "offset")))


def to_contact(
    one: Mapping[str, Any],
    number: int,
    take: Take,
    scale: float,
    known: Collection[tuple[str, Point | None]] | None = None,
) -> Contact:
    """Return the contact of a record.

    Parameters
    ----------
    number
        Which of the file's contacts it is; names it where it has no id.
    take
        Joint and frames must be its own.
    scale
        Frames of the take a frame of the record.
    known
        Joint and name of the points there are; None for any.

    Raises
    ------
    WrongRecordError
        If it is none, or does not fit the take.
    """
    start, end = _frame(one, "start", scale), _frame(one, "end", scale)
    if scale != 1.0:
        end = min(max(end, start + 1), max(take.frames, end - 1))
    if not 0 <= start < end <= take.frames:
        raise WrongRecordError(f"has frames {start}:{end}, none of the take's {take.frames}")
    key = (_joint(one, take), _name(one))
    if known is not None and key[1] is not None and key not in known:
        raise WrongRecordError(f"is of a {key[1]} that joint {key[0]} does not have")
    confidence = one.get("confidence", 1.0)
    if isinstance(confidence, bool) or not isinstance(confidence, int | float):
        raise WrongRecordError('has a "confidence" that is no number')
    if not 0 <= confidence <= 1:
        raise WrongRecordError('has a "confidence" outside 0..1')
    name = _text(one, "id") if "id" in one else f"contact-{number}"
    return Contact(
        name,
        *key,
        start,
        end,
        _target(one),
        float(confidence),
        bool(one.get("drawn", False)),
    )


def _target(one: Mapping[str, Any]) -> Target:
    kind = one.get("kind", "fixed")
    if kind == "fixed":
        return Fixed(_vector(one, "target"))
    if kind == "floor":
        return Floor(_vector(one, "target")[1], _direction(one, "normal", _UP))
    if kind == "line":
        return Line(_vector(one, "target"), _direction(one, "direction", None))
    if kind == "following":
        return Following(
            _text(one, "performer"), _text(one, "follows"), _vector(one, "offset", (0.0, 0.0, 0.0))
        )
    raise WrongRecordError(f'has a "kind" that is none of {", ".join(_KINDS)}')


def _joint(one: Mapping[str, Any], take: Take) -> str:
    joint = _text(one, "joint")
    if joint not in take.skeleton.index:
        raise WrongRecordError(f"is of joint {joint}, which {take.name} does not have")
    return joint


def _name(one: Mapping[str, Any]) -> Point | None:
    for name in get_args(Point):
        if one.get("point") == name:
            found: Point = name
            return found
    if one.get("point") is None:
        return None
    raise WrongRecordError(f'has a "point" that is none of {", ".join(get_args(Point))}')


def _text(one: Mapping[str, Any], key: str) -> str:
    value = one.get(key)
    if value is None:
        raise WrongRecordError(f'has no "{key}"')
    # Half of a surrogate pair passes as JSON and cannot be written again.
    if not isinstance(value, str) or any("\ud800" <= sign <= "\udfff" for sign in value):
        raise WrongRecordError(f'has a "{key}" that is no text')
    return value


def _frame(one: Mapping[str, Any], key: str, scale: float) -> int:
    value = one.get(key)
    if isinstance(value, bool) or not isinstance(value, int):
        cause = f'has no "{key}"' if value is None else f'has a "{key}" that is no frame number'
        raise WrongRecordError(cause)
    if abs(value) > _MOST_FRAMES:
        raise WrongRecordError(f'has a "{key}" that is no frame number')
    return round(value * scale)


def _vector(
    one: Mapping[str, Any], key: str, missing: tuple[float, float, float] | None = None
) -> tuple[float, float, float]:
    value = one.get(key, missing)
    if value is None:
        raise WrongRecordError(f'has no "{key}"')
    numbers = isinstance(value, list | tuple) and all(
        isinstance(x, int | float) and not isinstance(x, bool) and abs(x) < _MOST for x in value
    )
    if not numbers or len(value) != 3:
        raise WrongRecordError(f'has a "{key}" that is not three numbers of metres')
    x, y, z = (float(x) for x in value)
    return x, y, z


def _direction(
    one: Mapping[str, Any], key: str, missing: tuple[float, float, float] | None
) -> tuple[float, float, float]:
    vector = np.array(_vector(one, key, missing))
    length = float(np.linalg.norm(vector))
    if length < 1e-9:
        raise WrongRecordError(f'has a "{key}" without length')
    # What is a unit already stays bit for bit.
    x, y, z = vector if abs(length - 1) < 1e-9 else vector / length
    return float(x), float(y), float(z)
