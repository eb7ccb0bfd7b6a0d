"""The body in a window of frames, posed by the unknowns, with its derivatives.

Bones keep their length by construction: only rotations and the body's place change.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.ik import kernels, turns
from mocapstudio.cleaning.ik.freedom import Freedom
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import carrier
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Window:
    """The motion as it was over F frames, of the joints that matter.

    Attributes
    ----------
    joints
        Indices of the joints that are placed, parents before children.
    parents
        (j,) position in `joints` of each one's parent, -1 for the root.
    rotations
        (F, j, 3, 3) local rotations.
    offsets
        (F, j, 3) metres: local translations.
    carrier
        Position in `joints` of the joint that carries the body.
    """

    joints: tuple[int, ...]
    parents: NDArray[np.int64]
    rotations: Array
    offsets: Array
    carrier: int

    @property
    def frames(self) -> int:
        """Number of frames."""
        return len(self.rotations)


def window(take: Take, start: int, end: int, joints: Iterable[int]) -> Window:
    """Cut the frames [start, end) of a take down to `joints` and those above them."""
    skeleton = take.skeleton
    carries = take.translated[carrier(take)]
    wanted = {carries, *joints}
    placed = sorted(wanted.union(*(skeleton.ancestors(j) for j in wanted)))
    parents = [int(skeleton.parents[j]) for j in placed]
    offsets = np.broadcast_to(skeleton.offsets, (end - start, len(skeleton), 3)).copy()
    offsets[:, list(take.translated)] = take.translations[start:end]
    return Window(
        tuple(placed),
        np.array([placed.index(p) if p >= 0 else -1 for p in parents], dtype=np.int64),
        np.ascontiguousarray(rot.to_matrix(take.rotations[start:end][:, placed])),
        np.ascontiguousarray(offsets[:, placed]),
        placed.index(carries),
    )


class Posed:
    """The joints of a window in the world, for given unknowns.

    Parameters
    ----------
    window
        F frames.
    freedom
        n unknowns a frame.
    unknowns
        (F, n) departures from the motion as it was.
    """

    def __init__(self, window: Window, freedom: Freedom, unknowns: Array) -> None:
        self.window = window
        self.freedom = freedom
        self.unknowns = unknowns
        along = unknowns[:, freedom.first :].reshape(len(unknowns), -1, 3)
        turn, self._jacobian = turns.exp(np.einsum("mab,fmb->fma", freedom.axes, along))
        moving = np.array([window.joints.index(j) for j in freedom.joints], dtype=np.int64)
        self._local = window.rotations.copy()
        kernels.turn_locals(self._local, moving, turn)
        self.positions = np.empty_like(window.offsets)
        self.rotations = np.empty_like(window.rotations)
        displacement = freedom.displacement(unknowns)
        kernels.place(
            self._local,
            window.offsets,
            window.parents,
            window.carrier,
            displacement,
            self.positions,
            self.rotations,
        )
        # (F, m, 3, 3): angular velocity in the world that each unknown of a joint gives.
        self._gains = np.empty_like(self._jacobian)
        kernels.angular_gains(self.rotations, moving, self._jacobian, freedom.axes, self._gains)

    def at(self, joint: int) -> int:
        """Position of a joint of the skeleton among those that are placed."""
        return self.window.joints.index(joint)

    def point(self, joint: int, offset: Array, frames: NDArray[np.int64] | None = None) -> Array:
        """(m, 3) metres in the world: a point in the frame of `joint`, at some frames or all."""
        at = self.at(joint)
        which = slice(None) if frames is None else frames
        result: Array = self.positions[which, at] + self.rotations[which, at] @ offset
        return result

    def local(self, joint: int) -> Array:
        """(F, 3, 3): local rotation of a joint."""
        return self._local[:, self.at(joint)]

    def local_partials(self, joint: int) -> Array:
        """(F, 3, 3): turn in the joint's own frame that each of its own unknowns gives."""
        at = self.freedom.joints.index(joint)
        result: Array = self._jacobian[:, at] @ self.freedom.axes[at]
        return result

    def _above(self, joint: int) -> list[int]:
        """Positions in `freedom.joints` of those that carry `joint`, itself among them."""
        up = set()
        at = self.at(joint)
        while at >= 0:
            up.add(self.window.joints[at])
            at = int(self.window.parents[at])
        return [i for i, j in enumerate(self.freedom.joints) if j in up]

    def angular_partials(self, joint: int, frames: NDArray[np.int64]) -> Array:
        """(m, 3, n): angular velocity of a joint in the world by the unknowns, at `frames`."""
        result = np.zeros((len(frames), 3, self.freedom.size))
        for i in self._above(joint):
            result[:, :, self.freedom.columns(self.freedom.joints[i])] = self._gains[frames, i]
        return result

    def point_partials(self, joint: int, point: Array, frames: NDArray[np.int64]) -> Array:
        """(m, 3, n): velocity of a point (m, 3) fixed to `joint` by the unknowns, at `frames`."""
        result = np.zeros((len(frames), 3, self.freedom.size))
        if self.freedom.moves:
            result[:, :, :3] = self.freedom.displacement_partials(self.unknowns[frames])
        which = self._above(joint)
        at = np.array([self.at(self.freedom.joints[i]) for i in which], dtype=np.int64)
        kernels.point_partials(
            np.ascontiguousarray(point),
            frames,
            self.positions,
            self._gains,
            np.array(which, dtype=np.int64),
            at,
            self.freedom.first,
            result,
        )
        return result
