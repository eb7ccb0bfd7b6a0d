"""Performers to be drawn, of joints or of markers: where their points are, and their shape.

Both kinds of actor answer the same questions. `names` are those of the first points, which can be
selected; tips come after them, and `owners` says of each point whose colour it takes.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mocapstudio.gui.stage.marker_bones import guess_bones
from mocapstudio.gui.viewport.figure import Figure
from mocapstudio.gui.viewport.scene3d import floor_level
from mocapstudio.gui.viewport.shaping import build_figure, stature
from mocapstudio.gui.viewport.solids import BONE, Detail, Floats, triangles
from mocapstudio.gui.viewport.world import Points, WorldMotion
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take

_FOLLOWED = 1.0
_MISSING = 0.45
_BALL, _BONE = 0.0085, 0.0035


class JointActor:
    """A performance of joints."""

    def __init__(self, take: Take) -> None:
        self.take = take
        self.names = take.skeleton.names
        self.frames = take.frames
        parents = take.skeleton.end_parents
        self.owners = np.concatenate([np.arange(len(take.skeleton)), parents]).astype(np.int64)
        self._motion = WorldMotion(take)

    @cached_property
    def size(self) -> float:
        """About the performer's height, metres."""
        return stature(self.take.skeleton, self.points(0))

    @cached_property
    def level(self) -> float:
        """Height of the floor, metres."""
        return floor_level(self._motion, self.size)

    @property
    def followed(self) -> NDArray[np.float64]:
        """(F, 3) metres: the hips, smoothed."""
        return self._motion.followed

    def points(self, frame: int) -> Points:
        """(J + E, 3) metres."""
        return self._motion.points(frame)

    def swell(self, _frame: int) -> Floats | None:
        """Every joint is always there."""
        return None

    def figure(self, detail: Detail) -> Figure:
        """Shape a body."""
        return build_figure(self.take.skeleton, self.points(0), detail)

    def heading(self, frame: int) -> float:
        """Radians about +Y that the hips face."""
        return self._motion.heading(frame)


class MarkerActor:
    """A performance of markers: balls and lines. What is missing is drawn small, on its way."""

    def __init__(self, take: MarkerTake) -> None:
        self.take = take
        self.names = take.labels
        self.frames = take.frames
        self.owners = np.arange(len(take.labels))
        self._missing = take.missing
        self._seen: NDArray[np.bool_] = np.asarray(~self._missing.all(axis=0))
        self._bones = take.bones or guess_bones(take.positions)

    @cached_property
    def _positions(self) -> Points:
        """(F, M, 3) metres, straight across what is missing."""
        positions = self.take.positions.astype(np.float32)
        frames = np.arange(self.frames)
        middle = np.nanmedian(positions, axis=(0, 1)) if self._seen.any() else np.zeros(3)
        for marker in range(positions.shape[1]):
            gone = self._missing[:, marker]
            if not self._seen[marker]:
                positions[:, marker] = middle
            elif gone.any():
                for axis in range(3):
                    known = positions[~gone, marker, axis]
                    positions[gone, marker, axis] = np.interp(frames[gone], frames[~gone], known)
        return positions

    @cached_property
    def size(self) -> float:
        """About the performer's height, metres."""
        seen = self._positions[:: max(1, self.frames // 48), self._seen]
        return max(float(np.percentile(np.ptp(seen[..., 1], axis=1), 90)), 1e-3)

    @cached_property
    def level(self) -> float:
        """Height of the floor, metres."""
        lowest = self._positions[:, self._seen, 1].min(axis=1)
        level = float(np.percentile(lowest, 10))
        return 0.0 if abs(level) < 0.1 * self.size else level

    @cached_property
    def followed(self) -> NDArray[np.float64]:
        """(F, 3) metres: the middle of all markers, smoothed."""
        middle = self._positions[:, self._seen].mean(axis=1).astype(np.float64)
        width = max(1, round(_FOLLOWED * float(self.take.rate))) | 1
        width = min(width, 2 * self.frames - 1)
        padded = np.pad(middle, ((width // 2, width // 2), (0, 0)), mode="edge")
        kernel = np.hanning(width + 2)[1:-1]
        kernel /= kernel.sum()
        return np.stack([np.convolve(padded[:, k], kernel, "valid") for k in range(3)], axis=1)

    def points(self, frame: int) -> Points:
        """(M, 3) metres."""
        points: Points = self._positions[frame]
        return points

    def swell(self, frame: int) -> Floats | None:
        """What is missing is small, what is never seen nothing."""
        if not self._missing[frame].any():
            return None
        small = np.where(self._missing[frame], _MISSING, 1.0)
        return np.where(self._seen, small, 0.0).astype(np.float32)

    def figure(self, detail: Detail) -> Figure:
        """Shape balls and lines."""
        seen = np.flatnonzero(self._seen)
        bones = [(a, b) for a, b in self._bones if self._seen[a] and self._seen[b]]
        ends = np.array(bones, dtype=np.int64).reshape(-1, 2)
        rings = np.full((len(ends), len(BONE)), _BONE * self.size, np.float32)
        place = np.broadcast_to(BONE[:, 0], rings.shape).astype(np.float32)
        return Figure(
            joints=len(self.names),
            middles=np.zeros((0, 2), dtype=np.int64),
            owners=np.zeros(0, dtype=np.int64),
            starts=ends[:, 0],
            ends=ends[:, 1],
            balls=seen,
            ball_radius=np.full(len(seen), _BALL * self.size, np.float32),
            rings=rings,
            ring_place=place.copy(),
            triangles=triangles(len(seen), len(ends), detail),
            detail=detail,
        )

    def heading(self, _frame: int) -> float:
        """Nobody says where markers face."""
        return 0.0


Actor = JointActor | MarkerActor


def actor_of(take: Take | MarkerTake) -> Actor:
    """Make the actor of a performance."""
    return MarkerActor(take) if isinstance(take, MarkerTake) else JointActor(take)
