"""The body while something is dragged: one frame posed anew, everything else as it was."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.model import ContactPoint
from mocapstudio.cleaning.contacts.points import point_positions
from mocapstudio.cleaning.ik.drag import Drag, DragPose, DragResult, KeptFrame
from mocapstudio.gui.contacts.reading import Reading
from mocapstudio.gui.viewport.world import Points, StandIn, WorldMotion
from mocapstudio.motion.kinematics import end_positions, take_pose

Array = NDArray[np.float64]


class Bending:
    """One drag of a point of the body, from press to the moment its edit is there.

    Parameters
    ----------
    motion
        Tells how the performer under review moves as it is shown.
    show
        Told how the performer is to move for now; None for as it does.
    """

    def __init__(
        self, motion: Callable[[], WorldMotion | None], show: Callable[[StandIn | None], None]
    ) -> None:
        self._motion, self._show = motion, show
        self._drag: Drag | None = None
        self._stand_in: StandIn | None = None
        self.frame = 0
        self.pose: DragPose | None = None

    def begin(
        self,
        reading: Reading,
        frame: int,
        point: ContactPoint,
        *,
        along: Sequence[ContactPoint] = (),
        pins: Sequence[ContactPoint] = (),
    ) -> None:
        """Take hold of a point of the body at a frame.

        Points in `along` go with it, points in `pins` stay where they are.
        """
        self.end()
        self.frame = frame
        self._drag = Drag(
            reading.after, frame, point, along=along, pins=pins, ranges=reading.ranges
        )

    def to(self, place: Array, along: Sequence[Array | None] = ()) -> DragPose | None:
        """Show the frame with the point at a place (3,) metres, or as near as it gets.

        `along` are places of what goes with it, see `Drag.to`.
        """
        motion = self._motion()
        if self._drag is None or motion is None:
            return None
        self.pose = self._drag.to(place, along)
        points = _points(self.pose)
        if self._stand_in is None:
            self._stand_in = StandIn(motion, self.frame, points)
            self._show(self._stand_in)
        else:
            self._stand_in.pose(points)
        return self.pose

    @property
    def shown(self) -> StandIn | None:
        """How the performer moves for now, or None while nothing is bent."""
        return self._stand_in

    def place_at(self, frame: int, point: ContactPoint | None = None) -> Array | None:
        """(3,) metres: where the dragged point, or another, got to; None at unbent frames."""
        if self.pose is None or frame != self.frame:
            return None
        return self.pose.point if point is None else carried(self.pose, [point])[0]

    @property
    def kept(self) -> KeptFrame | None:
        """The frame as it looks now, or None where nothing was moved."""
        return None if self._drag is None or self.pose is None else self._drag.kept

    def released(self, seconds: float) -> DragResult | None:
        """Make an edit of it that fades out within `seconds`, or None where nothing was moved."""
        return None if self._drag is None or self.pose is None else self._drag.release(seconds)

    def end(self) -> None:
        """Show the performer as it is."""
        bent, self._stand_in = self._stand_in, None
        self._drag = self.pose = None
        if bent is not None:
            self._show(None)


def carried(pose: DragPose, points: Sequence[ContactPoint]) -> Array:
    """(P, 3) metres: where contact points are in a pose."""
    return np.asarray(point_positions(pose.take, points)[0])


def _points(pose: DragPose) -> Points:
    positions, world = take_pose(pose.take)
    tips = end_positions(pose.take.skeleton, positions, world)
    points: Points = np.concatenate([positions, tips], axis=1)[0].astype(np.float32)
    return points
