"""Contacts as a JSON file.

::

    {
      "take": "60_10.bvh", "fps": 120.0,
      "points": [{"joint": "lFoot", "point": "heel", "offset": [0.01, -0.03, -0.04]}, …],
      "contacts": [
        {"joint": "lFoot", "point": "heel", "start": 74, "end": 145,
         "target": [0.1, 0.01, 0.4], "confidence": 0.97, "kind": "floor", "id": "lFoot-heel-74"},
        {"joint": "lHand", "point": "palm", "start": 200, "end": 260, "target": [0.3, 0.9, 0.2],
         "confidence": 0.8, "kind": "following",
         "performer": "61_10", "follows": "rHand", "offset": [0.0, 0.02, 0.0]}, …
      ],
      "slide": {"before": 0.083, "after": 0.0004}
    }

Frames are 0-based at `fps` (at the take's own rate where it is missing), ends exclusive; lengths in
metres, `target` in the world; `slide` in metres a second. `joint`, `start` and `end` are needed;
`target` too, but for a contact that follows. `point` is heel, ball, toe, palm or null.

`kind` says what the target is: ``fixed`` (by default: the point stays at `target`), ``floor`` (it
stays on the plane through `target` with the unit `normal`, straight up by default, and does not
slide), ``line`` (it slides along `direction` through `target`), ``following`` (it stays with the
joint `follows` of `performer`, at `offset` in that joint's frame; `target` is where that is at
first). `drawn` is true where a person drew the contact: detecting again never touches it.
`points` are the performer's contact points where they were adjusted or are to be known.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

from mocapstudio.cleaning.contacts.json_places import element_lines
from mocapstudio.cleaning.contacts.model import Contact, ContactPoint
from mocapstudio.cleaning.contacts.records import (
    WrongRecordError,
    to_contact,
    to_point,
    to_record,
)
from mocapstudio.cleaning.ik.targets import holds
from mocapstudio.formats.atomic import write_whole
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.take import Take

_FASTEST = 1e6

Kind = TypeVar("Kind")


@dataclass(frozen=True, eq=False)
class ContactsFile:
    """What a file of contacts holds.

    Parameters
    ----------
    contacts
        In the file's order, frames at the rate of the take they were read for.
    points
        The contact points it names; empty where it names none.
    """

    contacts: tuple[Contact, ...]
    points: tuple[ContactPoint, ...] = ()


def write_contacts(
    path: Path | str,
    take: Take,
    contacts: Sequence[Contact],
    points: Sequence[ContactPoint],
    *,
    slide: Mapping[str, float] | None = None,
    others: Mapping[str, Take] | None = None,
    inputs: Iterable[Path] = (),
) -> None:
    """Write contacts of a take, its contact points, and what was measured.

    Parameters
    ----------
    slide
        ``before`` and ``after``, metres a second.
    others
        Takes of performers that are followed, by id.
    inputs
        Files that must not be replaced.

    Raises
    ------
    FileError
        If the file cannot be written, or is an input.
    MocapError
        If a contact does not fit the take.
    """
    record = contacts_record(take, contacts, points, others)
    if slide is not None:
        record["slide"] = dict(slide)
    text = json.dumps(record, indent=1, ensure_ascii=False, allow_nan=False)
    write_whole(path, [text.encode(), b"\n"], inputs=inputs)


def contacts_record(
    take: Take,
    contacts: Sequence[Contact],
    points: Sequence[ContactPoint],
    others: Mapping[str, Take] | None = None,
) -> dict[str, Any]:
    """Return contacts as the file holds them, without what was measured.

    Raises
    ------
    MocapError
        If a contact does not fit the take.
    """
    laid = holds(take, contacts, points, others or {})
    return {
        "take": take.source.path.name if take.source else take.name,
        "fps": float(take.rate),
        "points": [
            {"joint": p.joint, "point": p.point, "offset": [float(x) for x in p.offset]}
            for p in points
        ],
        "contacts": [to_record(hold) for hold in laid],
    }


def read_contacts(
    path: Path | str, take: Take, points: Sequence[ContactPoint] | None = None
) -> ContactsFile:
    """Read the contacts of a take.

    Parameters
    ----------
    path
        The file; frames at another rate than the take's are converted.
    take
        Whose contacts they are: joints and frames must be its own.
    points
        Those the performer has beside the file's; a contact of any other is an error. None lets
        every contact pass.

    Raises
    ------
    FileError
        If the file cannot be read, is no such file, or a contact does not fit the take; it names
        the line on which the contact begins.
    """
    path = Path(path)
    text, content = _parsed(path)
    if not isinstance(content, dict) or not isinstance(content.get("contacts"), list):
        raise FileError(path, 'holds no contacts: an object with a list "contacts" is wanted')
    scale = _scale(path, content, take)
    named = _each(path, text, content, "points", lambda one, _: to_point(one, take))
    known = None if points is None else {point.key for point in (*points, *named)}
    found = _each(
        path, text, content, "contacts", lambda one, i: to_contact(one, i, take, scale, known)
    )
    return ContactsFile(_renamed(found), tuple(named))


def _parsed(path: Path) -> tuple[str, Any]:
    try:
        text = path.read_text(encoding="utf-8-sig")
        return text, json.loads(text, parse_constant=_no_number)
    except OSError as cause:
        raise FileError(path, f"cannot be read: {cause.strerror}") from cause
    except UnicodeDecodeError as cause:
        raise FileError(path, "is no UTF-8 text", offset=cause.start) from cause
    except json.JSONDecodeError as cause:
        raise FileError(path, f"is no JSON: {cause.msg}", line=cause.lineno) from cause
    except RecursionError as cause:
        raise FileError(path, "is nested too deeply") from cause
    except ValueError as cause:
        raise FileError(path, f"is no JSON: {cause}") from cause


def _no_number(name: str) -> float:
    raise ValueError(f"{name} is no number")


def _scale(path: Path, content: Mapping[str, Any], take: Take) -> float:
    """Frames of the take a frame of the file."""
    fps = content.get("fps")
    if fps is None:
        return 1.0
    if isinstance(fps, bool) or not isinstance(fps, int | float) or not 0 < fps < _FASTEST:
        raise FileError(path, '"fps" is no frame rate')
    scale = float(take.rate) / fps
    # 119.88 stands for 120000/1001.
    return 1.0 if abs(scale - 1) < 1e-5 else scale


def _each(
    path: Path,
    text: str,
    content: Mapping[str, Any],
    key: str,
    read: Callable[[Mapping[str, Any], int], Kind],
) -> list[Kind]:
    elements = content.get(key, [])
    if not isinstance(elements, list):
        raise FileError(path, f'"{key}" is no list')
    found = []
    for i, element in enumerate(elements):
        try:
            if not isinstance(element, dict):
                raise WrongRecordError("is no object")
            found.append(read(element, i))
        except WrongRecordError as wrong:
            what = f"{key[:-1]} {i} {wrong}"
            raise FileError(path, what, line=element_lines(text, key)[i]) from wrong
    return found


def _renamed(found: Sequence[Contact]) -> tuple[Contact, ...]:
    """Make ids unique."""
    seen: set[str] = set()
    result = []
    for i, contact in enumerate(found):
        name = contact.id if contact.id not in seen else f"{contact.id}-{i}"
        seen.add(name)
        result.append(replace(contact, id=name))
    return tuple(result)
