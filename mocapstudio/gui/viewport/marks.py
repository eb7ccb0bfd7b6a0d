"""Flat marks: shadow and heading on the floor, rings round joints, trails through the air.

All are triangles without light in one mesh. What is to face the camera is turned to it by hand,
which costs less than lines of several pixels' width do in software.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.gui.viewport.figure import Figure
from mocapstudio.gui.viewport.mesh import Mesh
from mocapstudio.gui.viewport.solids import Floats
from mocapstudio.gui.viewport.world import Points

Colour = tuple[int, int, int]

_DISC = 8
_RING = 28
_TURN = np.linspace(0, 2 * np.pi, _DISC, endpoint=False)
_RING_TURN = np.linspace(0, 2 * np.pi, _RING, endpoint=False)


class Marks:
    """Collects flat shapes for one frame, then shows them."""

    def __init__(self) -> None:
        self.mesh = Mesh(lit=False)
        self._corners: list[Floats] = []
        self._cells: list[NDArray[np.int64]] = []
        self._colours: list[NDArray[np.uint8]] = []
        self._count = 0
        self._shape: tuple[int, ...] = ()

    def _add(
        self, corners: NDArray[np.floating], cells: NDArray[np.int64], colour: NDArray[np.uint8]
    ) -> None:
        self._corners.append(corners.astype(np.float32))
        self._cells.append(cells + self._count)
        self._colours.append(np.broadcast_to(colour, corners.shape))
        self._count += len(corners)

    def shadow(self, figure: Figure, points: Points, level: float, colour: Colour) -> None:
        """Drop a figure's outline onto the floor at height `level`."""
        flat = figure.places(points)
        flat[:, 1] = level
        start, along = flat[figure.starts], flat[figure.ends] - flat[figure.starts]
        across = np.stack([along[:, 2], np.zeros(len(along)), -along[:, 0]], axis=1)
        across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-9)
        half = across * figure.rings.max(axis=1)[:, None] * 0.9
        quads = np.stack([start - half, start + half, start + along + half, start + along - half])
        tone = np.array(colour, np.uint8)
        self._add(quads.transpose(1, 0, 2).reshape(-1, 3), _fans(len(start), 4), tone)
        disc = np.stack([np.cos(_TURN), np.zeros(_DISC), np.sin(_TURN)], axis=1)
        discs = flat[figure.balls][:, None] + figure.ball_radius[:, None, None] * disc
        self._add(discs.reshape(-1, 3), _fans(len(figure.balls), _DISC), tone)

    def arrow(self, at: Points, heading: float, size: float, level: float, colour: Colour) -> None:
        """Draw a triangle on the floor in front of the hips, pointing where they face."""
        ahead = np.array([np.sin(heading), 0.0, np.cos(heading)])
        left = np.array([np.cos(heading), 0.0, -np.sin(heading)])
        base = np.array([at[0], level, at[2]]) + 0.24 * size * ahead
        wing, tip = 0.034 * size, 0.07 * size
        corners = np.stack([base + tip * ahead, base + wing * left, base - wing * left])
        self._add(corners, np.array([[0, 1, 2]]), np.array(colour, np.uint8))

    def ring(
        self, at: Points, radius: float, width: float, axes: NDArray[np.float64], colour: Colour
    ) -> None:
        """Draw a ring that faces the camera; `axes` are the camera's right, up and back."""
        circle = np.cos(_RING_TURN)[:, None] * axes[0] + np.sin(_RING_TURN)[:, None] * axes[1]
        middle = at + radius * axes[2]
        corners = np.concatenate([middle + radius * circle, middle + (radius + width) * circle])
        here = np.arange(_RING)
        there = (here + 1) % _RING
        cells = np.concatenate(
            [
                np.stack([here, there, here + _RING], axis=1),
                np.stack([there, there + _RING, here + _RING], axis=1),
            ]
        )
        self._add(corners, cells, np.array(colour, np.uint8))

    def trail(
        self,
        path: Points,
        width: NDArray[np.floating],
        eye: NDArray[np.float64],
        colours: NDArray[np.uint8],
    ) -> None:
        """Draw a ribbon along (N, 3) metres that faces the eye; widths and colours a point."""
        if len(path) < 2:
            return
        along = np.gradient(path, axis=0)
        across = np.cross(along, path - eye)
        across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-9)
        half = across * width[:, None] / 2
        here = np.arange(len(path) - 1)
        n = len(path)
        cells = np.concatenate(
            [
                np.stack([here, here + 1, here + n], axis=1),
                np.stack([here + 1, here + n + 1, here + n], axis=1),
            ]
        )
        self._add(np.concatenate([path - half, path + half]), cells, np.tile(colours, (2, 1)))

    def bars(
        self,
        feet: Points,
        heights: NDArray[np.floating],
        width: float,
        axes: NDArray[np.float64],
        colour: Colour,
    ) -> None:
        """Stand (N,) upright bars on (N, 3) feet; `axes` are the camera's right, up and back."""
        half = 0.5 * width * axes[0]
        rise = heights[:, None] * np.array([0.0, 1.0, 0.0])
        corners = np.stack([feet - half, feet + half, feet + half + rise, feet - half + rise])
        cells = _fans(len(feet), 4)
        self._add(corners.transpose(1, 0, 2).reshape(-1, 3), cells, np.array(colour, np.uint8))

    def show(self) -> None:
        """Put what was collected into the mesh and begin anew."""
        shape = tuple([len(one) for one in self._corners] + [len(one) for one in self._cells])
        # Marks of the same kinds have the same triangles: then only corners and colours move.
        if shape != self._shape:
            self._shape = shape
            empty = np.zeros((0, 3), dtype=np.int64)
            cells = np.concatenate(self._cells) if self._cells else empty
            self.mesh.reshape(self._count, cells)
        if self._corners:
            np.concatenate(self._corners, out=self.mesh.points)
            np.concatenate(self._colours, out=self.mesh.colours)
        self.mesh.changed()
        self._corners, self._cells, self._colours, self._count = [], [], [], 0


def _fans(count: int, corners: int) -> NDArray[np.int64]:
    """Triangles of `count` convex shapes of so many corners each."""
    inner = np.arange(1, corners - 1)
    fan = np.stack([np.zeros_like(inner), inner, inner + 1], axis=1)
    return (fan + corners * np.arange(count)[:, None, None]).reshape(-1, 3)


def fading(colour: Colour, towards: Colour, shares: NDArray[np.floating]) -> NDArray[np.uint8]:
    """(N, 3): from `colour` (share 0) `towards` another (share 1)."""
    share = shares[:, None]
    mixed = np.array(colour) * (1 - share) + np.array(towards) * share
    rounded: NDArray[np.uint8] = np.round(mixed).astype(np.uint8)
    return rounded
