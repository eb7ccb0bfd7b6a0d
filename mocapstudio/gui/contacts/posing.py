"""Key poses: hands and feet dragged in the viewport, as an edit that fades out in time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.changes import as_proposals
from mocapstudio.cleaning.contacts.model import ContactPoint
from mocapstudio.cleaning.contacts.points import point_positions
from mocapstudio.cleaning.ik.drag import Drag, DragPose
from mocapstudio.gui.contacts.bridge import ContactsBridge
from mocapstudio.gui.contacts.reading import Readings
from mocapstudio.gui.viewport.cast import Part, Role
from mocapstudio.gui.viewport.world import Points, WorldMotion
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]

FALLOFF = 0.3
"""Seconds before and after the frame over which a key pose fades out."""


class Posing:
    """One drag of a hand or foot, from press to release; the feet that are not dragged stay.

    Parameters
    ----------
    bridge
        To the document.
    readings
        Points of the take under review.
    show
        Called when `shown` would say something else.
    """

    def __init__(
        self, bridge: ContactsBridge, readings: Readings, show: Callable[[], None]
    ) -> None:
        self._bridge, self._readings, self._show = bridge, readings, show
        self._drag: Drag | None = None
        self._pose: DragPose | None = None
        self._frame = 0

    def places(self, frame: int) -> tuple[list[str], Array]:
        """Names and (P, 3) places of hands and feet at a frame, as they are shown."""
        reading = self._readings.now
        if reading is None:
            return [], np.zeros((0, 3))
        names = [f"{point.joint} {point.point or ''}".strip() for point in reading.points]
        places = reading.places_after[min(frame, len(reading.places_after) - 1)]
        if self._pose is not None and frame == self._frame:
            places = point_positions(self._pose.take, reading.points)[0]
        return names, places

    def taken(self, name: str) -> bool:
        """Take hold of a hand or foot at the current frame."""
        reading, frame = self._readings.now, self._bridge.desk.state.frame
        if reading is None:
            return False
        names, _ = self.places(frame)
        point = reading.points[names.index(name)]
        pins = [one for one in reading.points if _foot(one) and one.joint != point.joint]
        self._frame = frame
        self._drag = Drag(reading.after, frame, point, pins=pins, ranges=reading.ranges)
        return True

    def dragged(self, place: Array) -> None:
        """Pose the frame with what is held at a place, or as near as it gets."""
        if self._drag is not None:
            self._pose = self._drag.to(place)
            self._show()

    def dropped(self) -> None:
        """Make an edit of it."""
        drag, self._drag = self._drag, None
        moved, self._pose = self._pose, None
        if drag is not None and moved is not None:
            result = drag.release(FALLOFF)
            proposals = as_proposals(result.take, result.declared)
            self._bridge.desk.document.add_key_pose(proposals)
        self._show()

    def cancelled(self) -> None:
        """Leave the take as it was."""
        if self._drag is not None:
            self._drag = self._pose = None
            self._show()

    def shown(self, roles: Sequence[Role]) -> tuple[Role, ...] | None:
        """Return the roles with the performer posed as it is dragged; None while nothing is."""
        if self._pose is None or not roles or roles[0].part is not Part.RESULT:
            return None
        motion = _Posed(roles[0].motion.take, self._frame, self._pose.take)
        return (replace(roles[0], motion=motion), *roles[1:])


class _Posed(WorldMotion):
    """A take with one frame posed otherwise."""

    def __init__(self, take: Take, frame: int, pose: Take) -> None:
        super().__init__(take)
        self._at, self._instead = frame, WorldMotion(pose)

    def points(self, frame: int) -> Points:
        """(J + E, 3) metres at a frame of the take, in the world."""
        return self._instead.points(0) if frame == self._at else super().points(frame)


def _foot(point: ContactPoint) -> bool:
    return point.point != "palm"
