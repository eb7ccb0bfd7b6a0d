"""Key poses: hands and feet dragged in the viewport, as an edit that fades out in time."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.changes import as_proposals
from mocapstudio.cleaning.contacts.model import ContactPoint
from mocapstudio.gui.contacts.bending import Bending, carried
from mocapstudio.gui.contacts.bridge import ContactsBridge
from mocapstudio.gui.contacts.reading import Readings

Array = NDArray[np.float64]

FALLOFF = 0.3
"""Seconds before and after the frame over which a key pose fades out."""

_COARSE = 5
"""Millimetres: while something is dragged, words need not change with every one of them."""


class Posing:
    """One drag of a hand or foot, from press to release; the feet that are not dragged stay.

    Parameters
    ----------
    bridge
        To the document.
    readings
        Points of the take under review.
    bending
        Shows the body as it is dragged.
    """

    def __init__(self, bridge: ContactsBridge, readings: Readings, bending: Bending) -> None:
        self._bridge, self._readings, self._bending = bridge, readings, bending

    def places(self, frame: int) -> tuple[list[str], Array]:
        """Names and (P, 3) places of hands and feet at a frame, as they are shown."""
        reading, pose = self._readings.now, self._bending.pose
        if reading is None:
            return [], np.zeros((0, 3))
        names = [f"{point.joint} {point.point or ''}".strip() for point in reading.points]
        if pose is not None and frame == self._bending.frame:
            return names, carried(pose, reading.points)
        return names, reading.places_after[min(frame, len(reading.places_after) - 1)]

    def taken(self, name: str) -> bool:
        """Take hold of a hand or foot at the current frame."""
        reading, frame = self._readings.now, self._bridge.desk.state.frame
        if reading is None:
            return False
        names, _ = self.places(frame)
        point = reading.points[names.index(name)]
        pins = [one for one in reading.points if _foot(one) and one.joint != point.joint]
        self._bending.begin(reading, frame, point, pins=pins)
        return True

    def dragged(self, place: Array) -> str:
        """Pose the frame with what is held at a place; says how far it falls short."""
        pose = self._bending.to(place)
        return "" if pose is None else short_by(pose.gap)

    def dropped(self) -> None:
        """Make an edit of it."""
        result = self._bending.released(FALLOFF)
        if result is not None:
            proposals = as_proposals(result.take, result.declared)
            self._bridge.desk.document.add_key_pose(proposals)
        self._bending.end()

    def cancelled(self) -> None:
        """Leave the take as it was."""
        self._bending.end()


def short_by(gap: float) -> str:
    """Say how far a dragged point stays short of the mouse, metres; nothing within reach."""
    return (
        f"out of reach by {_COARSE * max(1, round(1000 * gap / _COARSE))} mm" if gap > 1e-3 else ""
    )


def _foot(point: ContactPoint) -> bool:
    return point.point != "palm"
