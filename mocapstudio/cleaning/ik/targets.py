"""Where each contact is held: targets as the contacts say them, laid out over their frames.

A contact with a floor says only that its point stands still on a plane; where on it, is chosen so
that the motion is disturbed least.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.model import (
    Contact,
    ContactPoint,
    Fixed,
    Floor,
    Line,
    Point,
)
from mocapstudio.cleaning.ik.objectives.position import across
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]

_SLOW = 0.05
"""Metres a second: frames in which the point is faster count less for where it stood."""


@dataclass(frozen=True, eq=False)
class Hold:
    """One contact in terms of a take.

    Attributes
    ----------
    contact
        The contact.
    joint, offset
        Index of the joint, and the point (3,) metres in its frame.
    place
        (m, 3) metres: where the point was over the contact's m frames, at first in the take, then
        where it could be brought.
    target
        (m, 3) metres: where it is to be.
    projection
        (r, 3) or (m, r, 3): rows span the directions in which it is held.
    """

    contact: Contact
    joint: int
    offset: Array
    place: Array
    target: Array
    projection: Array

    @property
    def frames(self) -> NDArray[np.int64]:
        """(m,) frames of the take."""
        return np.arange(self.contact.start, self.contact.end)

    def steps(self, place: Array) -> Array:
        """(m - 1,) metres a point that is at `place` (m, 3) slides from frame to frame."""
        away = place - self.target
        if isinstance(self.contact.target, Line):
            away = away @ self.projection.T
        return np.asarray(np.linalg.norm(np.diff(away, axis=0), axis=1))

    def gap(self, place: Array) -> Array:
        """(m,) metres between a point that is at `place` (m, 3) and the target."""
        away = place - self.target
        if isinstance(self.contact.target, Line):
            away = away @ self.projection.T
        return np.asarray(np.linalg.norm(away, axis=1))

    def unmet(self, place: Array) -> Array:
        """(m,) metres by which a point that is at `place` (m, 3) fails what the contact asks for.

        A floor asks that the point stands still on it, wherever; everything else asks for its
        target.
        """
        return chosen_again(self, place).gap(place)


def holds(
    take: Take,
    contacts: Sequence[Contact],
    points: Sequence[ContactPoint],
    others: Mapping[str, Take],
) -> tuple[Hold, ...]:
    """Lay contacts out over their frames.

    Parameters
    ----------
    take
        F frames.
    contacts
        In any order; spans inside the take.
    points
        The performer's contact points; a contact whose `point` is None and is not among them means
        the joint itself.
    others
        Takes of the performers that targets follow, by id: as many frames, at the same rate.

    Raises
    ------
    MocapError
        If a joint, point or performer is unknown, or a span is empty or leaves the take.
    """
    pose = take_pose(take)
    offsets = {point.key: np.asarray(point.offset, dtype=float) for point in points}
    return tuple(_hold(take, pose, contact, offsets, others) for contact in contacts)


def _hold(
    take: Take,
    pose: tuple[Array, Array],
    contact: Contact,
    offsets: Mapping[tuple[str, Point | None], Array],
    others: Mapping[str, Take],
) -> Hold:
    who = f"contact {contact.id}"
    if contact.joint not in take.skeleton.index:
        raise MocapError(f"{who}: {take.name} has no joint {contact.joint}")
    if not 0 <= contact.start < contact.end <= take.frames:
        raise MocapError(
            f"{who}: frames {contact.start} to {contact.end} are none of"
            f" {take.name}'s {take.frames}"
        )
    key = (contact.joint, contact.point)
    if key not in offsets and contact.point is not None:
        raise MocapError(f"{who}: {contact.joint} has no point {contact.point}")
    joint = take.skeleton.index[contact.joint]
    offset = offsets.get(key, np.zeros(3))
    span = slice(contact.start, contact.end)
    place = pose[0][span, joint] + rot.rotate(pose[1][span, joint], offset)
    return hold_at(take, contact, offset, place, others)


def hold_at(
    take: Take, contact: Contact, offset: Array, place: Array, others: Mapping[str, Take]
) -> Hold:
    """Lay one contact out whose point is known to be at `place`.

    Parameters
    ----------
    take
        F frames.
    contact
        A contact of one of its joints, inside its frames.
    offset
        (3,) metres: the point in the joint's frame.
    place
        (m, 3) metres: where it is in the world over the contact's m frames.
    others
        As for `holds`.

    Raises
    ------
    MocapError
        If what it follows is unknown or does not fit.
    """
    target, projection = _target(take, contact, place, others)
    joint = take.skeleton.index[contact.joint]
    return Hold(contact, joint, offset, place, target, projection)


def _target(
    take: Take, contact: Contact, place: Array, others: Mapping[str, Take]
) -> tuple[Array, Array]:
    target = contact.target
    if isinstance(target, Fixed):
        return np.broadcast_to(np.array(target.position), place.shape), np.eye(3)
    if isinstance(target, Line):
        direction = _unit(contact, target.direction)
        return np.broadcast_to(np.array(target.position), place.shape), across(direction)
    if isinstance(target, Floor):
        stand = on_floor(contact, standing_place(place, float(take.rate)))
        return np.broadcast_to(stand, place.shape), np.eye(3)
    other = others.get(target.performer)
    if other is None:
        raise MocapError(f"contact {contact.id}: no performer {target.performer}")
    if other.frames != take.frames or other.rate != take.rate:
        raise MocapError(f"contact {contact.id}: {other.name} is not as long as {take.name}")
    if target.joint not in other.skeleton.index:
        raise MocapError(f"contact {contact.id}: {other.name} has no joint {target.joint}")
    positions, world = take_pose(other, contact.start, contact.end)
    joint = other.skeleton.index[target.joint]
    return positions[:, joint] + rot.rotate(world[:, joint], np.array(target.offset)), np.eye(3)


def _unit(contact: Contact, direction: tuple[float, float, float]) -> Array:
    length = float(np.linalg.norm(direction))
    if not np.isfinite(length) or length < 1e-9:
        raise MocapError(f"contact {contact.id}: its direction has no length")
    return np.array(direction) / length


def standing_place(place: Array, rate: float) -> Array:
    """(3,) metres: where a point (m, 3) stood, its slow frames counting most."""
    if len(place) < 2:
        return np.asarray(place[0])
    speed = np.linalg.norm(np.gradient(place, axis=0), axis=1) * rate
    weight = 1.0 / (1.0 + (speed / _SLOW) ** 2)
    return np.asarray(weight @ place / weight.sum())


def on_floor(contact: Contact, place: Array) -> Array:
    """(3,) metres: `place` brought to the floor of a contact, straight along its normal."""
    floor = contact.target
    assert isinstance(floor, Floor)
    normal = _unit(contact, floor.normal)
    # The floor's height is that at the place itself, so that only its vertical share counts.
    return np.asarray(place + normal * (floor.height - place[1]) * normal[1])


def chosen_again(hold: Hold, place: Array) -> Hold:
    """Move a floor's target to where its point was brought, (m, 3) metres; others stay."""
    if not isinstance(hold.contact.target, Floor):
        return hold
    stand = on_floor(hold.contact, np.median(place, axis=0))
    return replace(hold, place=place, target=np.broadcast_to(stand, place.shape))
