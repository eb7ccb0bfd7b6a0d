"""What may move: the unknowns of a frame, and how stiff each of them is."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.ik.ranges import JointRanges
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]

ROOT_STIFFNESS = np.array([200.0, 100.0, 200.0])
"""Per metre, against 1 per radian of a joint that turns as widely as a hip: the hips give way
where a leg is nearly straight, and hardly elsewhere."""


@dataclass(frozen=True, eq=False)
class Freedom:
    """The n unknowns of a frame: how far the body departs from the motion as it was.

    First, where it `moves`, the displacement of the body in the world (3, metres; near its reach
    the more of it is asked for, the less it yields, see `displacement`); then three a joint
    of `joints`: the rotation vector, in the joint's own frame and along its natural axes, by which
    it is turned further than before (radians). All zeros is the motion as it was.

    Parameters
    ----------
    joints
        (m,) indices of the joints that may turn, parents before children.
    axes
        (m, 3, 3): columns are the natural axes of each joint in its own frame.
    stiffness
        (n,) cost of each unknown: per metre or per radian.
    reach
        Metres: the body as a whole is displaced by less than this; 0 where it stays.
    """

    joints: tuple[int, ...]
    axes: Array
    stiffness: Array
    reach: float = 0.0

    @property
    def moves(self) -> bool:
        """Whether the body as a whole may be displaced."""
        return self.reach > 0

    @property
    def first(self) -> int:
        """How many unknowns stand before those of the first joint."""
        return 3 if self.moves else 0

    @property
    def size(self) -> int:
        """Number of unknowns in a frame."""
        return len(self.stiffness)

    def displacement(self, unknowns: Array) -> Array:
        """(F, 3) metres that the body is displaced: ``x / sqrt(1 + |x|^2 / reach^2)``."""
        if not self.moves:
            return np.zeros((len(unknowns), 3))
        x = unknowns[:, :3]
        return np.asarray(x / self._bend(x)[:, None])

    def displacement_partials(self, unknowns: Array) -> Array:
        """(F, 3, 3) derivative of `displacement` by its unknowns."""
        x = unknowns[:, :3]
        bend = self._bend(x)[:, None, None]
        outer = x[:, :, None] * x[:, None, :] / self.reach**2
        return np.asarray((np.eye(3) - outer / bend**2) / bend)

    def _bend(self, x: Array) -> Array:
        return np.asarray(np.sqrt(1.0 + np.sum(x * x, axis=1) / self.reach**2))

    def columns(self, joint: int) -> slice:
        """Where the three unknowns of a joint stand."""
        at = self.first + 3 * self.joints.index(joint)
        return slice(at, at + 3)


def freedom(
    joints: Iterable[int],
    ranges: JointRanges,
    *,
    reach: float = 0.0,
    place_stiffness: Array = ROOT_STIFFNESS,
) -> Freedom:
    """Let some joints turn, each the more easily about an axis the more it turns about it anyway.

    Parameters
    ----------
    joints
        Indices of the joints.
    ranges
        How far each joint of the skeleton turns (see `ranges.joint_ranges`).
    reach
        Metres that the body may be displaced, or 0.
    place_stiffness
        (3,) per metre: that of the body's place, along x, y, z.
    """
    chosen = tuple(sorted(set(joints)))
    at = list(chosen)
    place = place_stiffness if reach > 0 else np.zeros(0)
    stiffness = np.concatenate([place, ranges.stiffness[at].ravel()])
    return Freedom(chosen, np.ascontiguousarray(ranges.axes[at]), stiffness, reach)


def chain(skeleton: Skeleton, joint: int, ranges: JointRanges) -> tuple[int, ...]:
    """Joints that bring `joint` to a place: its limb's, from the limb's start down to itself.

    Joints that never turn, such as the halves of a hip that some systems record, stay rigid; a
    joint of the trunk is reached by the trunk from the hips on. Joints above the hips move the
    world and never turn.
    """
    parts = topology(skeleton)
    if joint in parts.above_hips:
        return ()
    limb = parts.limb_of(joint)
    up = [joint, *skeleton.ancestors(joint)]
    below_hips = [j for j in up if j not in parts.above_hips]
    inside = [j for j in below_hips if j in limb.joints]
    if limb.name == "head":
        inside = [j for j in below_hips if j != parts.hips]
    turning = [j for j in inside if not ranges.rigid[j]]
    return tuple(sorted(turning or inside))
