"""What becomes of a target when its kind is chosen anew, or it is dragged."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.model import (
    Contact,
    ContactPoint,
    Fixed,
    Floor,
    Following,
    Line,
    Target,
)
from mocapstudio.gui.contacts.lanes import key_of
from mocapstudio.gui.contacts.reading import Reading
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]
Triple = tuple[float, float, float]

KINDS = ("fixed", "floor", "line", "following")
_GRASP = 0.25
"""Metres within which a hand that is drawn in contact is taken to hold a partner's hand."""


def triple(place: Array) -> Triple:
    """Return three plain numbers."""
    x, y, z = (float(value) for value in place)
    return x, y, z


def kind_of(target: Target) -> str:
    """Return the kind of a target, one of `KINDS`."""
    return type(target).__name__.lower()


def place_at(reading: Reading, contact: Contact, frame: int) -> Array | None:
    """(3,) metres: where the target is at a frame (the nearest of the contact's); None if unmet."""
    # Where a floor is stood on, is told by the body as it is shown.
    hold = reading.hold_after(contact) if reading.solved else reading.hold(contact)
    if hold is None:
        return None
    at = min(max(frame, contact.start), contact.end - 1) - contact.start
    return np.asarray(hold.target[at], dtype=float)


def middle_of(reading: Reading, contact: Contact) -> Array:
    """(3,) metres: about where the contact's target is, or else its point."""
    hold = reading.hold(contact)
    return np.median(reading.place(contact) if hold is None else hold.target, axis=0)


def converted(reading: Reading, contact: Contact, kind: str, frame: int) -> Target | None:
    """Give a contact's target another kind, in its place; None where there is no partner.

    Parameters
    ----------
    frame
        At which a partner's joint is looked for.
    """
    place = middle_of(reading, contact)
    if kind == "fixed":
        return Fixed(triple(place))
    if kind == "floor":
        return floor_near(reading, contact, place)
    if kind == "line":
        way = np.ptp(reading.place(contact), axis=0)
        along = (1.0, 0.0, 0.0) if way[0] >= way[2] else (0.0, 0.0, 1.0)
        return Line(triple(place), along)
    at = min(max(frame, contact.start), contact.end - 1)
    here = reading.place(contact)[at - contact.start]
    found = nearest_joint(reading.others, here, at)
    return None if found is None else following(reading, contact, *found)


def floor_near(reading: Reading, contact: Contact, place: Array) -> Floor:
    """Return the floor under a contact: as high as its point lies while it rests."""
    places = reading.place(contact)
    speed = np.linalg.norm(np.gradient(places, axis=0), axis=1) if len(places) > 1 else np.zeros(1)
    slow = places[speed <= np.median(speed)]
    height = float(np.median(slow[:, 1])) if len(slow) else float(place[1])
    return Floor(height)


def following(reading: Reading, contact: Contact, performer: str, joint: str) -> Following:
    """Follow a joint as the point stays with it: the median of the way between them."""
    other = reading.others[performer]
    positions, world = take_pose(other, contact.start, contact.end)
    index = other.skeleton.index[joint]
    way = rot.rotate(rot.conjugate(world[:, index]), reading.place(contact) - positions[:, index])
    return Following(performer, joint, triple(np.median(way, axis=0)))


def nearest_joint(others: Mapping[str, Take], place: Array, frame: int) -> tuple[str, str] | None:
    """Return performer and joint that are nearest to a place at a frame, or None."""
    best: tuple[float, str, str] | None = None
    for name, other in others.items():
        positions = joints_at(other, frame)
        away = np.linalg.norm(positions - place, axis=1)
        nearest = int(np.argmin(away))
        if best is None or away[nearest] < best[0]:
            best = float(away[nearest]), name, other.skeleton.names[nearest]
    return None if best is None else best[1:]


def joints_at(take: Take, frame: int) -> Array:
    """(J, 3) metres: the joints of a take at a frame."""
    return np.asarray(take_pose(take, frame, frame + 1)[0][0])


def moved(reading: Reading, contact: Contact, place: Array, frame: int, *, upright: bool) -> Target:
    """Bring a target to a place.

    Parameters
    ----------
    place
        (3,) metres in the world.
    frame
        At which it is to be there.
    upright
        Whether only its height was changed: a floor then stays one. Else it becomes a point.
    """
    target = contact.target
    if isinstance(target, Floor):
        return replace(target, height=float(place[1])) if upright else Fixed(triple(place))
    if isinstance(target, Line):
        return replace(target, position=triple(place))
    if isinstance(target, Following) and target.performer in reading.others:
        other = reading.others[target.performer]
        positions, world = take_pose(other, frame, frame + 1)
        joint = other.skeleton.index[target.joint]
        way = rot.rotate(rot.conjugate(world[0, joint]), place - positions[0, joint])
        return replace(target, offset=triple(way))
    return Fixed(triple(place))


def gone_along(reading: Reading, contact: Contact, way: Array, frame: int) -> Target:
    """Bring a target as far as another one of the same foot went.

    Parameters
    ----------
    way
        (3,) metres in the world.
    frame
        At which the other one went that far.
    """
    target = contact.target
    if isinstance(target, Floor):
        return replace(target, height=target.height + float(way[1]))
    at = min(max(frame, contact.start), contact.end - 1)
    place = place_at(reading, contact, at)
    if place is None:
        return target
    return moved(reading, contact, place + way, at, upright=False)


def drawn_target(
    reading: Reading, point: ContactPoint, contact: Contact, known: tuple[Contact, ...]
) -> Target:
    """Say what a contact that was drawn by hand touches.

    Feet stand on the floor of the nearest contact of their lane; hands hold the partner's hand if
    it is near, else they stay where they are.
    """
    if point.point != "palm":
        own = [c for c in known if key_of(c) == point.key and isinstance(c.target, Floor)]
        if own:
            return min(own, key=lambda c: abs(c.start - contact.start)).target
        return floor_near(reading, contact, reading.place(contact)[0])
    places = reading.place(contact)
    best: tuple[float, Following] | None = None
    for name, other in reading.others.items():
        positions, world = take_pose(other, contact.start, contact.end)
        for palm in (one for one in reading.palms[name] if one.point == "palm"):
            joint = other.skeleton.index[palm.joint]
            there = positions[:, joint] + rot.rotate(world[:, joint], palm.offset)
            away = float(np.median(np.linalg.norm(there - places, axis=1)))
            if away < _GRASP and (best is None or away < best[0]):
                best = away, following(reading, contact, name, palm.joint)
    return Fixed(triple(np.median(places, axis=0))) if best is None else best[1]
