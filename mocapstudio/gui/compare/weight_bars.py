"""Weights on a figure: which of its joints are tinted how much, and bars that stand on them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mocapstudio.gui.compare.weight_rows import WeightRow
from mocapstudio.gui.stage.actors import Actor
from mocapstudio.gui.stage.scene import Bars
from mocapstudio.gui.viewport.palette import Colour
from mocapstudio.gui.viewport.world import Points

_HEIGHT = 0.11
_WIDTH = 0.016


class Weighting:
    """Where the weights of an actor's joints and bones are drawn.

    Parameters
    ----------
    actor
        Whom they are drawn on.
    rows
        The weights; those of nothing it has are left out.
    """

    def __init__(self, actor: Actor, rows: Sequence[WeightRow]) -> None:
        index = {name: i for i, name in enumerate(actor.names)}
        self._actor = actor
        ends, parts = [], []
        for row in rows:
            a, _, b = row.name.partition("-")
            if row.name in index:
                ends.append((index[row.name], index[row.name]))
            elif a in index and b in index:
                ends.append((index[a], index[b]))
            else:
                continue
            parts.append((row.pose, row.motion))
        self._ends = np.array(ends, dtype=np.int64).reshape(-1, 2)
        weights = np.array(parts, dtype=float).reshape(-1, 2)
        most = float(weights.sum(axis=1).max()) if len(weights) else 0.0
        self._parts = weights / (most or 1.0)

    def bars(self, points: Points, colours: tuple[Colour, Colour]) -> Bars:
        """Stand bars on joints, and in the middles of bones; `points` as they are drawn."""
        feet: Points = points[self._ends].mean(axis=1).astype(np.float32)
        size = self._actor.size
        return Bars(feet, self._parts * _HEIGHT * size, _WIDTH * size, colours)

    def tints(self, own: Colour, hot: Colour) -> NDArray[np.uint8]:
        """(P, 3) colour of each point: its own, or towards `hot` the more it counts than others."""
        share = np.zeros(len(self._actor.names))
        total = self._parts.sum(axis=1)
        if len(total) and total.max() > total.min():
            total = (total - total.min()) / (total.max() - total.min())
            for end in self._ends.T:
                np.maximum.at(share, end, total)
        at = share[self._actor.owners][:, None]
        mixed = np.array(own) + at * (np.array(hot, dtype=float) - np.array(own))
        rounded: NDArray[np.uint8] = np.round(mixed).astype(np.uint8)
        return rounded
