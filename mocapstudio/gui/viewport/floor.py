"""The floor: a grid of thin lines that fades out with distance."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mocapstudio.gui.viewport.mesh import Mesh

_PARTS = 4
_FAR = 7.0


def spacing(stature: float) -> float:
    """Metres between lines: one metre for a person, a power of ten for what is much smaller."""
    return float(10.0 ** round(math.log10(stature / 1.7)))


def extent(
    path: NDArray[np.float64], step: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """Lowest and highest corner (x, z) of the ground under (N, 2) places, and how far one sees.

    Corners lie on lines of the grid, so that an edit of the hips does not move the floor.

    Parameters
    ----------
    step
        Metres between lines.
    """
    low = np.floor(path.min(axis=0) / step) * step
    high = np.ceil(path.max(axis=0) / step) * step
    return low, high, float(np.linalg.norm(high - low)) + 10 * step


class Floor:
    """Grid lines in one unlit mesh, brightest near the performers."""

    def __init__(self) -> None:
        self.mesh = Mesh(lit=False)
        self._laid: object = None

    def lay(
        self,
        low: NDArray[np.float64],
        high: NDArray[np.float64],
        level: float,
        step: float,
        colour: tuple[int, int, int],
    ) -> None:
        """Lay the grid under the box from `low` to `high` (x, z in metres), and beyond.

        Parameters
        ----------
        low, high
            (2,) metres, x and z of what the performers cover.
        level
            Height of the floor in metres.
        step
            Metres between lines.
        colour
            Of the lines where they are brightest.
        """
        key = (low.tobytes(), high.tobytes(), level, step, colour)
        if key == self._laid:
            return
        self._laid = key
        margin = _FAR * step
        first = np.floor((low - margin) / step).astype(int)
        last = np.ceil((high + margin) / step).astype(int)
        along_z = _lines(np.arange(first[0], last[0] + 1), first[1], last[1])
        along_x = _lines(np.arange(first[1], last[1] + 1), first[0], last[0])[:, ::-1]
        flat = np.concatenate([along_z, along_x]) * step
        self.mesh.reshape(len(flat), np.arange(len(flat)).reshape(-1, 2), channels=4)
        self.mesh.points[:] = np.insert(flat, 1, level, axis=1)
        outside = np.linalg.norm(np.maximum(0, np.maximum(low - flat, flat - high)), axis=1)
        share = np.clip(1 - outside / margin, 0, 1) ** 1.5
        self.mesh.colours[:, :3] = colour
        self.mesh.colours[:, 3] = np.round(255 * share)
        self.mesh.changed()


def _lines(across: NDArray[np.int64], first: int, last: int) -> NDArray[np.float64]:
    """(2 N, 2) ends of short pieces, so that each can fade on its own."""
    cuts = np.linspace(first, last, (last - first) * _PARTS // 2 + 1)
    pieces = np.stack([cuts[:-1], cuts[1:]], axis=1).ravel()
    return np.stack([np.repeat(across, len(pieces)), np.tile(pieces, len(across))], axis=1)
