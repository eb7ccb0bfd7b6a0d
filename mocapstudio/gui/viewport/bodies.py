"""All figures of the scene in one mesh: an actor each would cost more than all their triangles."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mocapstudio.gui.viewport.figure import Figure
from mocapstudio.gui.viewport.mesh import Mesh
from mocapstudio.gui.viewport.solids import Floats
from mocapstudio.gui.viewport.world import Points


class Bodies:
    """Figures side by side in one lit mesh."""

    def __init__(self) -> None:
        self.mesh = Mesh(lit=True)
        self._figures: tuple[Figure, ...] = ()
        self._parts: list[slice] = []
        self._painted: list[NDArray[np.uint8] | None] = []

    def cast(self, figures: Sequence[Figure]) -> None:
        """Say which figures there are; the mesh is rebuilt only where they are others."""
        if len(figures) == len(self._figures) and all(map(_same, figures, self._figures)):
            return
        self._figures = tuple(figures)
        self._parts, triangles, corners = [], [], 0
        for figure in figures:
            self._parts.append(slice(corners, corners + figure.corners))
            triangles.append(figure.triangles + corners)
            corners += figure.corners
        self._painted = [None] * len(figures)
        empty = np.zeros((0, 3), dtype=np.int64)
        self.mesh.reshape(corners, np.concatenate(triangles) if triangles else empty)

    def pose(
        self,
        number: int,
        points: Points,
        colours: NDArray[np.uint8],
        girth: float = 1.0,
        swell: Floats | None = None,
    ) -> None:
        """Put one figure into a pose, with a colour a point; `changed` must follow.

        The very array of colours that it was last painted with costs nothing.
        """
        part, figure = self._parts[number], self._figures[number]
        self.mesh.points[part], self.mesh.normals[part] = figure.pose(points, girth, swell)
        if self._painted[number] is not colours:
            self._painted[number] = colours
            self.mesh.colours[part] = figure.colour(colours)

    def hide(self, number: int) -> None:
        """Shrink a figure to nothing; `changed` must follow."""
        self.mesh.points[self._parts[number]] = 0.0

    def changed(self) -> None:
        """Show what was posed."""
        self.mesh.changed()


def _same(one: Figure, other: Figure) -> bool:
    return one is other
