"""The skeleton: joints as parallel arrays, parents before children."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.errors import MocapError, SkeletonMismatchError


@dataclass(frozen=True, eq=False)
class Skeleton:
    """A hierarchy of joints in its rest pose.

    In the rest pose every local rotation is the identity, so `offsets` alone place the joints.

    Parameters
    ----------
    names
        One unique name a joint, as in the file.
    parents
        (J,) index of each joint's parent, -1 for the root; parents come before their children.
    offsets
        (J, 3) metres, from the parent, in the parent's frame.
    end_parents, end_offsets
        (E,) and (E, 3): the tips (BVH end sites) and the joint that carries each.
    axes
        For each joint the (d, 3) unit axes that its file lets it turn about, outermost first, in
        the parent's frame: its local rotation is the product of a turn about each. None where
        the file does not tell.

    Raises
    ------
    MocapError
        If names repeat or a parent does not come before its child.
    """

    names: tuple[str, ...]
    parents: NDArray[np.int64]
    offsets: NDArray[np.float64]
    end_parents: NDArray[np.int64]
    end_offsets: NDArray[np.float64]
    axes: tuple[NDArray[np.float64], ...] | None = None

    def __post_init__(self) -> None:
        if len(set(self.names)) != len(self.names):
            raise MocapError("joint names repeat in one skeleton")
        order = np.arange(len(self.names))
        if len(self.names) == 0 or self.parents[0] != -1 or np.any(self.parents[1:] >= order[1:]):
            raise MocapError("a skeleton needs a root, and parents before their children")

    def __len__(self) -> int:
        return len(self.names)

    @cached_property
    def index(self) -> dict[str, int]:
        """Joint index by name."""
        return {name: i for i, name in enumerate(self.names)}

    @cached_property
    def children(self) -> tuple[tuple[int, ...], ...]:
        """Indices of each joint's children."""
        lists: list[list[int]] = [[] for _ in self.names]
        for joint, parent in enumerate(self.parents):
            if parent >= 0:
                lists[parent].append(joint)
        return tuple(tuple(one) for one in lists)

    def descendants(self, joint: int) -> list[int]:
        """All joints below `joint`, itself first, in skeleton order."""
        inside = {joint}
        result = [joint]
        for other in range(joint + 1, len(self)):
            if int(self.parents[other]) in inside:
                inside.add(other)
                result.append(other)
        return result

    def ancestors(self, joint: int) -> list[int]:
        """The joints above `joint`, nearest first, root last."""
        result = []
        parent = int(self.parents[joint])
        while parent >= 0:
            result.append(parent)
            parent = int(self.parents[parent])
        return result

    @cached_property
    def rest_positions(self) -> NDArray[np.float64]:
        """(J, 3) metres: joint positions in the rest pose, root at its own offset."""
        positions = self.offsets.copy()
        for joint in range(1, len(self)):
            positions[joint] += positions[self.parents[joint]]
        return positions

    def match(self, other: Skeleton) -> NDArray[np.int64]:
        """For each joint of this skeleton its index in `other`, matched by name, -1 where absent.

        Raises
        ------
        SkeletonMismatchError
            If no joint, or fewer than half of this skeleton's joints, have a namesake.
        """
        found = np.array([other.index.get(name, -1) for name in self.names])
        missing = [name for name, at in zip(self.names, found, strict=True) if at < 0]
        if len(missing) * 2 > len(self):
            raise SkeletonMismatchError(
                f"another skeleton: {len(missing)} of {len(self)} joints have no namesake"
                f" ({_listing(missing)})"
            )
        return found


def _listing(names: Iterable[str], most: int = 4) -> str:
    names = list(names)
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more
