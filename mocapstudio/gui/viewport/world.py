"""Where every joint and tip of a take is in the world, worked out as it is looked at."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import body_frame, hips_world
from mocapstudio.motion.kinematics import end_positions, take_pose
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

Points = NDArray[np.float32]

_BLOCK = 256
_FOLLOWED = 1.0
_UP = 1


class WorldMotion:
    """World positions of one take, filled a block of frames at a time and kept.

    The first look at a frame costs a block (a few milliseconds), every later one nothing. So a
    take that an edit has just replaced shows at once, however long it is.

    Parameters
    ----------
    take
        J joints and E tips; a point is a joint or, after them, a tip.
    """

    def __init__(self, take: Take) -> None:
        self.take = take
        self._blocks: dict[int, tuple[Points, NDArray[np.float64]]] = {}
        self._body = body_frame(take.skeleton)
        self._hips = topology(take.skeleton).hips

    def points(self, frame: int) -> Points:
        """(J + E, 3) metres at a frame of the take, in the world."""
        block, at = divmod(frame, _BLOCK)
        points: Points = self._block(block)[0][at]
        return points

    def heading(self, frame: int) -> float:
        """Radians about +Y that the hips face at a frame; 0 faces +Z."""
        block, at = divmod(frame, _BLOCK)
        return float(self._block(block)[1][at])

    def path(self, point: int, frames: NDArray[np.int64]) -> Points:
        """(len(frames), 3) metres: where one point is at several frames of the take."""
        return np.stack([self.points(int(frame))[point] for frame in frames])

    @cached_property
    def hips_path(self) -> NDArray[np.float64]:
        """(F, 3) metres: the hips."""
        return hips_world(self.take)[0]

    @cached_property
    def followed(self) -> NDArray[np.float64]:
        """(F, 3) metres: the hips, smoothed over about a second, for a camera that follows.

        Smoothed over time instead of by the camera's own inertia, so that it depends on the frame
        alone: scrubbing back and forth ends where it began.
        """
        width = max(1, round(_FOLLOWED * float(self.take.rate)))
        return _smooth(_smooth(self.hips_path, width), width)

    def _block(self, block: int) -> tuple[Points, NDArray[np.float64]]:
        if block not in self._blocks:
            start = block * _BLOCK
            positions, world = take_pose(self.take, start, start + _BLOCK)
            tips = end_positions(self.take.skeleton, positions, world)
            body = rot.multiply(world[:, self._hips], self._body)
            self._blocks[block] = (
                np.concatenate([positions, tips], axis=1).astype(np.float32),
                rot.twist_angle(body, _UP),
            )
        return self._blocks[block]


class StandIn(WorldMotion):
    """A take with one frame posed otherwise for now; everything else is looked up in its motion.

    Parameters
    ----------
    motion
        Of the take.
    frame
        The frame that is posed otherwise.
    points
        (J + E, 3) metres: that pose.
    """

    def __init__(self, motion: WorldMotion, frame: int, points: Points) -> None:
        super().__init__(motion.take)
        self._motion: WorldMotion = motion
        self._at, self._points = frame, points

    def pose(self, points: Points) -> None:
        """Pose the frame anew."""
        self._points = points

    def points(self, frame: int) -> Points:
        """(J + E, 3) metres at a frame of the take, in the world."""
        return self._points if frame == self._at else self._motion.points(frame)

    def heading(self, frame: int) -> float:
        """Radians about +Y that the hips face at a frame of the take; 0 faces +Z."""
        return self._motion.heading(frame)

    @cached_property
    def hips_path(self) -> NDArray[np.float64]:
        """(F, 3) metres: the hips of the take."""
        return self._motion.hips_path

    @cached_property
    def followed(self) -> NDArray[np.float64]:
        """(F, 3) metres: the hips of the take, smoothed, for a camera that follows."""
        return self._motion.followed


class WorldMotions:
    """The world positions of the takes in sight, one `WorldMotion` a take."""

    def __init__(self) -> None:
        self._motions: dict[Take, WorldMotion] = {}

    def of(self, take: Take) -> WorldMotion:
        """Return the take's world positions, the same object for the same take."""
        if take not in self._motions:
            self._motions[take] = WorldMotion(take)
        return self._motions[take]

    def keep(self, takes: Iterable[Take]) -> None:
        """Forget every take but these."""
        wanted = set(takes)
        self._motions = {take: one for take, one in self._motions.items() if take in wanted}


def _smooth(path: NDArray[np.float64], width: int) -> NDArray[np.float64]:
    width = min(width | 1, 2 * len(path) - 1)
    padded = np.pad(path, ((width // 2 + 1, width // 2), (0, 0)), mode="edge")
    sums = np.cumsum(padded, axis=0)
    result: NDArray[np.float64] = (sums[width:] - sums[:-width]) / width
    return result
