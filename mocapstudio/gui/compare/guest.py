"""Somebody whose frames arrive one by one, drawn with the reference's skeleton. No Qt."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from mocapstudio.gui.compare import placing
from mocapstudio.gui.compare.placing import Placing
from mocapstudio.gui.stage.actors import JointActor
from mocapstudio.gui.viewport.figure import Figure
from mocapstudio.gui.viewport.solids import Detail, Floats
from mocapstudio.gui.viewport.world import Points
from mocapstudio.motion.kinematics import end_positions, global_pose
from mocapstudio.motion.topology import topology
from mocapstudio.review.live_feeds import Rotation

Followed = NDArray[np.float64]

_FOLLOWED = 0.08


class Guest:
    """Answers what actors answer, about the one pose it was given last.

    Joints that were not sent stay as they were; without a root it stands where the reference
    begins.

    Parameters
    ----------
    host
        The reference, whose skeleton it borrows.
    name
        Who performs.
    """

    frames = 1

    def __init__(self, host: JointActor, name: str) -> None:
        self.host, self.name = host, name
        self.take = host.take
        self.names, self.owners = host.names, host.owners
        self.level, self.size = host.level, host.size
        self.seconds: float | None = None
        self._hips = topology(host.take.skeleton).hips
        self._rotations = host.take.rotations[:1].copy()
        self._places = host.take.translations[:1].copy()
        self._points: Points = host.points(0).copy()
        self._placing: Placing = placing.IN_PLACE
        self._followed: Followed = self._points[self._hips].astype(np.float64)

    def pose(self, joints: Mapping[str, Rotation], root: tuple[float, float, float] | None) -> None:
        """Take another pose: local rotations by joint, and metres."""
        skeleton = self.take.skeleton
        for name, rotation in joints.items():
            at = skeleton.index.get(name)
            if at is not None:
                self._rotations[0, at] = rotation
        if root is not None:
            self._places[0, 0] = root
        positions, world = global_pose(
            skeleton, self._rotations, self._places, self.take.translated
        )
        tips = end_positions(skeleton, positions, world)
        self._points = np.concatenate([positions, tips], axis=1)[0].astype(np.float32)
        there = self._placing(self._points[self._hips][None])[0]
        self._followed += _FOLLOWED * (there - self._followed)

    def stand(self, frame: int | None) -> None:
        """Stand onto the reference at one of its frames from now on, or None: as recorded."""
        self._placing = placing.IN_PLACE
        if frame is not None:
            self._placing = placing.fit(self._points, self.host.points(frame))
        self._followed = self._placing(self._points[self._hips][None])[0].astype(np.float64)

    # -- what actors answer

    @property
    def followed(self) -> Followed:
        """(1, 3) metres: the hips, a little behind."""
        return self._followed.reshape(1, 3)

    def points(self, _frame: int) -> Points:
        """(J + E, 3) metres."""
        return self._placing(self._points)

    def swell(self, _frame: int) -> Floats | None:
        """Every joint is always there."""
        return None

    def figure(self, detail: Detail) -> Figure:
        """Shape a body like the reference's."""
        return self.host.figure(detail)

    def heading(self, _frame: int) -> float:
        """Radians about +Y that the reference's hips face as it begins."""
        return self.host.heading(0)
