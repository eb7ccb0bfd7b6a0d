"""A target while it is dragged: where it snaps, what becomes of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.model import Contact, Floor, Following, Target
from mocapstudio.cleaning.contacts.stance import standing_with
from mocapstudio.gui.contacts.bending import Bending
from mocapstudio.gui.contacts.bridge import ContactsBridge
from mocapstudio.gui.contacts.posing import short_by
from mocapstudio.gui.contacts.reading import Reading, Readings
from mocapstudio.gui.contacts.targets import gone_along, moved, place_at, triple
from mocapstudio.gui.viewport.camera import Turntable
from mocapstudio.gui.viewport.picking import joint_at
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]

_FLOOR = 0.03
"""Metres within which a target snaps to the floor."""


class Holding:
    """Carries the chosen contact's target from press to release.

    What stands with it on the same foot goes along, unless it is dragged alone.

    Parameters
    ----------
    bridge
        Is told of the contact as it looks while it is dragged.
    readings
        Points of the take under review.
    bending
        Shows the body as it reaches for the target.
    camera, size
        Through which the scene is seen, and the picture's width and height in pixels.
    """

    def __init__(
        self,
        bridge: ContactsBridge,
        readings: Readings,
        bending: Bending,
        camera: Turntable,
        size: Callable[[], tuple[int, int]],
    ) -> None:
        self._bridge, self._readings, self._bending = bridge, readings, bending
        self._camera, self._size = camera, size
        self._contact: Contact | None = None
        self._along: tuple[Contact, ...] = ()
        self._way = np.zeros(3)
        # Where a partner is at the frame that is dragged.
        self._known: dict[str, tuple[Take, int, list[tuple[str, Array]], Array]] = {}

    def taken(self, contact_id: str, alone: bool = False) -> bool:
        """Take hold of a contact's target; the body follows where the contact is in force."""
        contact, reading = self._bridge.contact(contact_id), self._readings.now
        # What was let go just now is still being met.
        if contact is None or reading is None or self._bridge.ui.held is not None:
            return False
        self._contact, self._way = contact, np.zeros(3)
        self._along = () if alone else self.company(contact)
        frame = self._bridge.desk.state.frame
        if contact.start <= frame < contact.end and not reading.trouble(contact):
            along = [reading.point(one) for one in self._along]
            self._bending.begin(reading, frame, reading.point(contact), along=along)
        return True

    def company(self, contact: Contact) -> tuple[Contact, ...]:
        """Contacts that stand with one on the same foot, and so go where it goes."""
        reading = self._readings.now
        if reading is None:
            return ()
        found = standing_with(reading.source.skeleton, contact, self._bridge.kept)
        return tuple(one for one in found if not reading.trouble(one))

    def place(self, contact: Contact, frame: int) -> Array | None:
        """(3,) metres: where a target is at a frame, as it is shown; None where it cannot be."""
        reading = self._readings.now
        place = None if reading is None else place_at(reading, contact, frame)
        if place is None or contact not in self._bridge.ui.along:
            return place
        # Along a floor its target does not tell how far it went.
        level = self._way * [1.0, 0.0, 1.0]
        return place + level if isinstance(contact.target, Floor) else place

    def dragged(self, place: Array, lock: int | None, mouse: tuple[float, float]) -> str:
        """Bring the target to a place; returns what it snapped to and how far the body gets."""
        reading, contact = self._readings.now, self._contact
        if reading is None or contact is None:
            return ""
        frame = min(max(self._bridge.desk.state.frame, contact.start), contact.end - 1)
        words, target = "", None
        if self._bridge.ui.snap:
            words, target = self._snapped(reading, contact, place, lock, mouse, frame)
        if target is None:
            target = moved(reading, contact, place, frame, upright=lock == 1)
        held = replace(contact, target=target, drawn=True, confidence=1.0)
        there, was = place_at(reading, held, frame), place_at(reading, contact, frame)
        if there is not None and was is not None:
            self._way = there - was
        self._bridge.set_ui(held=held, along=self._gone(reading, frame))
        pose = None if there is None else self._bending.to(there, self._goals(reading, there))
        short = "" if pose is None else short_by(pose.gap)
        return " · ".join(filter(None, (words and f"on {words}", short)))

    def dropped(self) -> Contact | None:
        """Let go; returns the contact with its new target, which is shown until it is met."""
        self._contact = None
        return self._bridge.ui.held

    def cancelled(self) -> None:
        """Leave the contact as it was."""
        self._contact = None
        self._bending.end()
        self._bridge.set_ui(held=None)

    def _gone(self, reading: Reading, frame: int) -> tuple[Contact, ...]:
        return tuple(
            replace(
                one,
                target=gone_along(reading, one, self._way, frame),
                drawn=True,
                confidence=1.0,
            )
            for one in self._along
        )

    def _goals(self, reading: Reading, there: Array) -> list[Array | None]:
        """(3,) metres for each that goes along and touches at the frame: where it is to be."""
        contact, frame = self._contact, self._bending.frame
        assert contact is not None
        goals: list[Array | None] = []
        for one in self._along:
            goal = None
            if one.start <= frame < one.end and contact.start <= frame < contact.end:
                if isinstance(one.target, Floor):
                    here = reading.place(one, after=True)[frame - one.start]
                    goal = there + here - reading.place(contact, after=True)[frame - contact.start]
                else:
                    was = place_at(reading, one, frame)
                    goal = None if was is None else was + self._way
            goals.append(goal)
        return goals

    def _snapped(
        self,
        reading: Reading,
        contact: Contact,
        place: Array,
        lock: int | None,
        mouse: tuple[float, float],
        frame: int,
    ) -> tuple[str, Target | None]:
        if lock is None:
            for name in reading.others:
                spots, places = self._spots(reading, name, frame)
                found = joint_at(self._camera, places, mouse, self._size())
                if found is not None:
                    joint, offset = spots[found]
                    return f"{joint} of {name}", Following(name, joint, triple(offset))
        floor = self._floor(contact)
        if lock in (None, 1) and floor is not None and abs(place[1] - floor) < _FLOOR:
            level = np.array([place[0], floor, place[2]])
            return "the floor", moved(reading, contact, level, frame, upright=lock == 1)
        return "", None

    def _spots(
        self, reading: Reading, name: str, frame: int
    ) -> tuple[list[tuple[str, Array]], Array]:
        """Joints and palms of a partner with their offsets, and (N, 3) where they are."""
        other = reading.others[name]
        known = self._known.get(name)
        if known is None or known[0] is not other or known[1] != frame:
            spots = [(joint, np.zeros(3)) for joint in other.skeleton.names]
            positions, world = (one[0] for one in take_pose(other, frame, frame + 1))
            places = [positions]
            for palm in reading.palms[name]:
                at = other.skeleton.index[palm.joint]
                places.append((positions[at] + rot.rotate(world[at], palm.offset))[None])
                spots.append((palm.joint, palm.offset))
            known = self._known[name] = other, frame, spots, np.concatenate(places)
        return known[2:]

    def _floor(self, contact: Contact) -> float | None:
        """Metres: the floor of the contacts of this point, or else of all."""
        floors = [c for c in self._bridge.kept if isinstance(c.target, Floor)]
        own = [c for c in floors if (c.joint, c.point) == (contact.joint, contact.point)]
        heights = [c.target.height for c in (own or floors) if isinstance(c.target, Floor)]
        return float(np.median(heights)) if heights else None
