"""Markers × frames as a picture: measured, filled, missing. No Qt but its colours."""

from __future__ import annotations

from enum import IntEnum

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QColor

from mocapstudio.gui import theme as themes
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.rows import Group
from mocapstudio.motion.marker_labels import bare, split_side
from mocapstudio.motion.markers import MarkerTake


class Cell(IntEnum):
    """What is known of a marker in a frame; of several frames in one pixel the highest counts."""

    MEASURED = 0
    FILLED = 1
    MISSING = 2


_SIDES = {"left": "left", "right": "right", "": "middle"}


def cells(take: MarkerTake) -> NDArray[np.uint8]:
    """(F, M) `Cell` of each sample."""
    found = np.where(take.missing, Cell.MISSING, Cell.MEASURED).astype(np.uint8)
    if take.filled is not None:
        found[take.filled & ~take.missing] = Cell.FILLED
    return found


def side_groups(labels: tuple[str, ...]) -> tuple[Group, ...]:
    """Sort markers by the side that their labels name, in the order of the file otherwise."""
    sides: dict[str, list[str]] = {"left": [], "right": [], "middle": []}
    for label in labels:
        sides[_SIDES[split_side(bare(label))[0]]].append(label)
    if not sides["left"] or not sides["right"]:
        return (Group("", labels),)
    return tuple(Group(name, tuple(found)) for name, found in sides.items() if found)


def pooled(found: NDArray[np.uint8], start: float, length: float, pixels: int) -> NDArray[np.uint8]:
    """(pixels, M): the worst cell of each column of pixels.

    Parameters
    ----------
    found
        (F, M).
    start, length
        The visible frames; frame n covers n - 0.5 to n + 0.5.
    """
    frames = len(found)
    edges = np.floor(start + 0.5 + np.arange(pixels + 1) * length / pixels).astype(np.int64)
    edges = np.clip(edges, 0, frames - 1)
    last = min(int(edges[-1]) + 1, frames)
    return np.maximum.reduceat(found[:last], edges[:-1], axis=0)


def cell_colour(look: themes.Theme, cell: Cell) -> QColor:
    """Colour of a cell; the three are apart in lightness too."""
    if cell is Cell.MISSING:
        return QColor(look.rejected)
    if cell is Cell.FILLED:
        return QColor(look.result)
    return colours.mixed(look.field, look.body, 0.26)
