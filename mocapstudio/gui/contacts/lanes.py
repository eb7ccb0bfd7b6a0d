"""The lanes: one for each point of the body that may touch something."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from mocapstudio.cleaning.contacts.model import Contact, ContactPoint, Point
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.topology import topology

Key = tuple[str, Point | None]


@dataclass(frozen=True)
class Lane:
    """One end effector.

    Parameters
    ----------
    key
        Joint and point.
    name
        As shown.
    """

    key: Key
    name: str


def key_of(contact: Contact) -> Key:
    """Return the lane of a contact."""
    return contact.joint, contact.point


def lanes_of(
    skeleton: Skeleton, points: Sequence[ContactPoint], contacts: Sequence[Contact]
) -> tuple[Lane, ...]:
    """Return a lane for each point, left before right as a body is read, and for odd contacts."""
    keys = list(dict.fromkeys([*(point.key for point in points), *map(key_of, contacts)]))
    names = {key: _name(skeleton, key) for key in keys}
    often = Counter(names.values())
    lanes = [
        Lane(key, name if often[name] == 1 else f"{key[0]} {key[1] or ''}".strip())
        for key, name in names.items()
    ]
    return tuple(sorted(lanes, key=_left_first))


def _name(skeleton: Skeleton, key: Key) -> str:
    joint, point = key
    if point is None or joint not in skeleton.index:
        return joint
    limb = topology(skeleton).limb_of(skeleton.index[joint]).name.lower()
    side = next((side for side in ("left", "right") if side in limb), "")
    return f"{side} {point}".strip().capitalize()


def _left_first(lane: Lane) -> tuple[bool, bool]:
    return lane.key[1] == "palm", "right" in lane.name.lower()
