"""A target while it is dragged: where it snaps, what becomes of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.model import Contact, Floor, Following, Target
from mocapstudio.gui.contacts.bridge import ContactsBridge
from mocapstudio.gui.contacts.reading import Reading, Readings
from mocapstudio.gui.contacts.targets import joints_at, moved, triple
from mocapstudio.gui.viewport.camera import Turntable
from mocapstudio.gui.viewport.picking import joint_at
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.kinematics import take_pose

Array = NDArray[np.float64]

_FLOOR = 0.03
"""Metres within which a target snaps to the floor."""


class Holding:
    """Carries the chosen contact's target from press to release.

    Parameters
    ----------
    bridge
        Is told of the contact as it looks while it is dragged.
    readings
        Points of the take under review.
    camera, size
        Through which the scene is seen, and the picture's width and height in pixels.
    """

    def __init__(
        self,
        bridge: ContactsBridge,
        readings: Readings,
        camera: Turntable,
        size: Callable[[], tuple[int, int]],
    ) -> None:
        self._bridge, self._readings = bridge, readings
        self._camera, self._size = camera, size
        self._contact: Contact | None = None

    def taken(self, contact_id: str) -> bool:
        """Take hold of a contact's target."""
        self._contact = self._bridge.contact(contact_id)
        return self._contact is not None and self._readings.now is not None

    def dragged(self, place: Array, lock: int | None, mouse: tuple[float, float]) -> str:
        """Bring the target to a place; returns what it snapped to, in words."""
        reading, contact = self._readings.now, self._contact
        if reading is None or contact is None:
            return ""
        frame = min(max(self._bridge.desk.state.frame, contact.start), contact.end - 1)
        words, target = "", None
        if self._bridge.ui.snap:
            words, target = self._snapped(reading, contact, place, lock, mouse, frame)
        if target is None:
            target = moved(reading, contact, place, frame, upright=lock == 1)
        self._bridge.set_ui(held=replace(contact, target=target, drawn=True, confidence=1.0))
        return words

    def dropped(self) -> None:
        """Let the change become a step of the sitting."""
        held, self._contact = self._bridge.ui.held, None
        self._bridge.set_ui(held=None)
        if held is not None:
            self._bridge.desk.document.change_contact(held.id, "Move target", target=held.target)

    def cancelled(self) -> None:
        """Leave the contact as it was."""
        self._contact = None
        self._bridge.set_ui(held=None)

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
            for name, other in reading.others.items():
                spots = [(joint, np.zeros(3)) for joint in other.skeleton.names]
                places = joints_at(other, frame)
                world = take_pose(other, frame, frame + 1)[1][0]
                for palm in reading.palms[name]:
                    at = other.skeleton.index[palm.joint]
                    there = places[at] + rot.rotate(world[at], palm.offset)
                    places = np.concatenate([places, there[None]])
                    spots.append((palm.joint, palm.offset))
                found = joint_at(self._camera, places, mouse, self._size())
                if found is not None:
                    joint, offset = spots[found]
                    return f"{joint} of {name}", Following(name, joint, triple(offset))
        floor = self._floor(contact)
        if lock in (None, 1) and floor is not None and abs(place[1] - floor) < _FLOOR:
            level = np.array([place[0], floor, place[2]])
            return "floor", moved(reading, contact, level, frame, upright=lock == 1)
        return "", None

    def _floor(self, contact: Contact) -> float | None:
        """Metres: the floor of the contacts of this point, or else of all."""
        floors = [c for c in self._bridge.kept if isinstance(c.target, Floor)]
        own = [c for c in floors if (c.joint, c.point) == (contact.joint, contact.point)]
        heights = [c.target.height for c in (own or floors) if isinstance(c.target, Floor)]
        return float(np.median(heights)) if heights else None
