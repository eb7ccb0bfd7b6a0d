"""Which row of the map lies where: limbs in the order of the body, rows in whole pixels. No Qt."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.topology import topology

_WIDEST_ROW = 26
_WIDEST_GAP = 6


@dataclass(frozen=True)
class Group:
    """A limb and its rows, in the order of drawing."""

    name: str
    rows: tuple[str, ...]


def limb_groups(skeleton: Skeleton, rows: tuple[str, ...]) -> tuple[Group, ...]:
    """Sort the rows of a map into limbs: spine, head, arms, legs, others, then the root rows."""
    left = dict.fromkeys(rows)
    groups = []
    for limb in topology(skeleton).limbs:
        names = tuple(skeleton.names[j] for j in limb.joints if skeleton.names[j] in left)
        groups.append(Group(limb.name, names))
        for name in names:
            del left[name]
    root = tuple(name for name in ROOT_ROWS if name in left)
    groups.append(Group("other", tuple(name for name in left if name not in ROOT_ROWS)))
    groups.append(Group("root", root))
    return tuple(group for group in groups if group.rows)


class RowLayout:
    """Rows stacked into a height of whole pixels, with gaps between limbs.

    Parameters
    ----------
    groups
        N rows in G groups.
    height
        Pixels there are.

    Attributes
    ----------
    names
        The N rows, top to bottom.
    tops
        (N,) upper edge of each row, pixels.
    row_height
        Height of every row, pixels.
    """

    def __init__(self, groups: tuple[Group, ...], height: int) -> None:
        self.groups = groups
        self.names = tuple(name for group in groups for name in group.rows)
        self.index = {name: i for i, name in enumerate(self.names)}
        count, gaps = len(self.names), max(len(groups) - 1, 0)
        gap = 3 if count * 6 + gaps * 3 <= height else 1
        fitting = (height - gap * gaps) // max(count, 1)
        self.row_height = min(max(fitting, 1), _WIDEST_ROW)
        spare = height - count * self.row_height - gap * gaps
        extra = min(max(spare, 0) // max(gaps, 1), _WIDEST_GAP) if gaps else 0
        tops = []
        top = 0
        for group in groups:
            for _ in group.rows:
                tops.append(top)
                top += self.row_height
            top += gap + extra
        self.tops: NDArray[np.int64] = np.array(tops, dtype=np.int64)
        self.bottom = tops[-1] + self.row_height if tops else 0

    def row_at(self, y: float) -> str | None:
        """Return the row at a height in pixels; between two limbs the nearest, outside None."""
        if not self.names or not 0 <= y < self.bottom:
            return None
        middles = self.tops + 0.5 * self.row_height
        return self.names[int(np.argmin(np.abs(middles - y)))]

    def rows_between(self, a: float, b: float) -> tuple[str, ...]:
        """Rows that the stretch between two heights touches."""
        low, high = min(a, b), max(a, b)
        touched = (self.tops < high) & (self.tops + self.row_height > low)
        return tuple(self.names[i] for i in np.flatnonzero(touched))

    def extent(self, group: Group) -> tuple[int, int]:
        """Upper and lower edge of a limb, pixels."""
        first, last = self.index[group.rows[0]], self.index[group.rows[-1]]
        return int(self.tops[first]), int(self.tops[last]) + self.row_height

    def group_at(self, y: float) -> Group | None:
        """Return the limb at a height in pixels, or None."""
        row = self.row_at(y)
        return next((group for group in self.groups if row in group.rows), None)

    def runs(self, names: frozenset[str] | tuple[str, ...]) -> list[tuple[int, int]]:
        """Upper and lower edges of the blocks that rows of one limb form when they adjoin."""
        wanted = set(names)
        result: list[tuple[int, int]] = []
        for group in self.groups:
            for name in group.rows:
                if name not in wanted:
                    continue
                top = int(self.tops[self.index[name]])
                if result and result[-1][1] == top:
                    result[-1] = (result[-1][0], top + self.row_height)
                else:
                    result.append((top, top + self.row_height))
        return result
