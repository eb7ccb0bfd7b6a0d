"""The body in a window of frames, posed by the unknowns, with its derivatives.

Bones keep their length by construction: only rotations and the body's place change.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.ik import turns
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
        Position in `joints` of each one's parent, -1 for the root.
    rotations
        (F, j, 3, 3) local rotations.
    offsets
        (F, j, 3) metres: local translations.
    carrier
        Position in `joints` of the joint that carries the body.
    """

    joints: tuple[int, ...]
    parents: tuple[int, ...]
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
        tuple(placed.index(p) if p >= 0 else -1 for p in parents),
        rot.to_matrix(take.rotations[start:end][:, placed]),
        offsets[:, placed],
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
        first = 3 if freedom.moves else 0
        along = unknowns[:, first:].reshape(len(unknowns), -1, 3)
        self._turn = np.einsum("mab,fmb->fma", freedom.axes, along)
        self._local = window.rotations
        moving = [window.joints.index(j) for j in freedom.joints]
        if moving:
            self._local = window.rotations.copy()
            self._local[:, moving] = window.rotations[:, moving] @ turns.exp(self._turn)
        self.positions, self.rotations = self._place()
        self._gains = self._angular_gains(moving)

    def _place(self) -> tuple[Array, Array]:
        window = self.window
        positions, world = np.empty_like(window.offsets), np.empty_like(window.rotations)
        for at, parent in enumerate(window.parents):
            if parent < 0:
                positions[:, at], world[:, at] = window.offsets[:, at], self._local[:, at]
            else:
                step = np.einsum("fab,fb->fa", world[:, parent], window.offsets[:, at])
                positions[:, at] = positions[:, parent] + step
                world[:, at] = world[:, parent] @ self._local[:, at]
            if at == window.carrier and self.freedom.moves:
                positions[:, at] += self.freedom.displacement(self.unknowns)
        return positions, world

    def _angular_gains(self, moving: list[int]) -> Array:
        """(F, m, 3, 3): angular velocity in the world that each unknown of a joint gives."""
        return self.rotations[:, moving] @ turns.right_jacobian(self._turn) @ self.freedom.axes

    def at(self, joint: int) -> int:
        """Position of a joint of the skeleton among those that are placed."""
        return self.window.joints.index(joint)

    def point(self, joint: int, offset: Array) -> Array:
        """(F, 3) metres: a point in the frame of `joint`, in the world."""
        at = self.at(joint)
        result: Array = self.positions[:, at] + self.rotations[:, at] @ offset
        return result

    def local(self, joint: int) -> Array:
        """(F, 3, 3): local rotation of a joint."""
        return self._local[:, self.at(joint)]

    def local_partials(self, joint: int) -> Array:
        """(F, 3, 3): turn in the joint's own frame that each of its own unknowns gives."""
        at = self.freedom.joints.index(joint)
        result: Array = turns.right_jacobian(self._turn[:, at]) @ self.freedom.axes[at]
        return result

    def _above(self, joint: int) -> list[int]:
        """Positions in `freedom.joints` of those that carry `joint`, itself among them."""
        up = set()
        at = self.at(joint)
        while at >= 0:
            up.add(self.window.joints[at])
            at = self.window.parents[at]
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
        for i in self._above(joint):
            turning = self.freedom.joints[i]
            arm = point - self.positions[frames, self.at(turning)]
            gain = self._gains[frames, i]
            result[:, :, self.freedom.columns(turning)] = np.cross(
                gain, arm[:, :, None], axisa=1, axisb=1, axisc=1
            )
        return result
