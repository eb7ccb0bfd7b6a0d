"""A stage's scene in VTK: figures side by side or over one another, marks and floor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocapstudio.gui.viewport import floor, marks, scene3d
from mocapstudio.gui.viewport.bodies import Bodies
from mocapstudio.gui.viewport.camera import Turntable
from mocapstudio.gui.viewport.figure import Figure
from mocapstudio.gui.viewport.palette import Colour, Palette
from mocapstudio.gui.viewport.solids import Floats
from mocapstudio.gui.viewport.world import Points

_BEFORE = 0.07


@dataclass(frozen=True, eq=False)
class Bars:
    """Upright bars of two parts that face the camera.

    Parameters
    ----------
    feet
        (N, 3) metres.
    parts
        (N, 2) metres: heights of the lower and the upper part.
    width
        Metres.
    colours
        Of lower and upper parts.
    """

    feet: Points
    parts: NDArray[np.float64]
    width: float
    colours: tuple[Colour, Colour]


@dataclass(frozen=True, eq=False)
class Pose:
    """One figure as it is drawn now.

    Parameters
    ----------
    points
        (P, 3) metres.
    colours
        (P, 3) bytes.
    girth
        Thickness as a share of the figure's own.
    swell
        See `Figure.pose`.
    ring
        The point that is marked, or None.
    trail
        (N, 3) metres that the marked point travels through, the present in the middle, or None.
    size
        About the performer's height, metres.
    bars
        Bars that stand on joints, or None.
    """

    points: Points
    colours: NDArray[np.uint8]
    girth: float = 1.0
    swell: Floats | None = None
    ring: int | None = None
    trail: Points | None = None
    size: float = 1.7
    bars: Bars | None = None


class StageScene:
    """Everything one viewport draws; three actors, whoever is on stage.

    Parameters
    ----------
    renderer
        Of VTK.
    """

    def __init__(self, renderer: Any) -> None:
        self._renderer = renderer
        self._bodies, self._marks, self._floor = Bodies(), marks.Marks(), floor.Floor()
        for mesh in (self._floor.mesh, self._marks.mesh, self._bodies.mesh):
            renderer.AddActor(mesh.actor)
        self._floor.mesh.actor.ForceTranslucentOn()
        scene3d.set_up(renderer)
        self._figures: Sequence[Figure] = ()
        self._palette: Palette | None = None
        self._level, self._radius = 0.0, 10.0
        self.step = 1.0

    def cast(self, figures: Sequence[Figure], palette: Palette) -> None:
        """Put other figures on stage, or colour the ground otherwise."""
        self._figures, self._palette = figures, palette
        self._bodies.cast(figures)
        scene3d.colour_ground(self._renderer, palette)
        self._floor.mesh.actor.SetVisibility(bool(figures))
        if not figures:
            self._marks.show()

    def lay_floor(
        self, path: NDArray[np.floating], level: float, size: float, palette: Palette
    ) -> None:
        """Lay the floor under (N, 3) places of performers of about `size` metres."""
        self.step = floor.spacing(size)
        flat = path[:, [0, 2]].astype(np.float64)
        low, high, self._radius = floor.extent(flat, self.step)
        self._level = level
        self._floor.lay(low, high, level, self.step, palette.floor)

    def show(self, poses: Sequence[Pose], camera: Turntable, pixel: float) -> None:
        """Pose all figures; `pixel` is the size of a pixel in metres, where the camera looks."""
        if self._palette is None:
            return
        for number, pose in enumerate(poses):
            self._bodies.pose(number, pose.points, pose.colours, pose.girth, pose.swell)
            level = self._level - 0.004 * self.step
            self._marks.shadow(self._figures[number], pose.points, level, self._palette.shadow)
            self._mark(pose, camera, pixel)
        self._bodies.changed()
        self._marks.show()

    def aim(self, camera: Turntable) -> None:
        """Show the scene from where the camera is."""
        scene3d.aim(self._renderer, camera, self._radius)

    def _mark(self, pose: Pose, camera: Turntable, pixel: float) -> None:
        assert self._palette is not None
        if pose.bars is not None:
            self._stand(pose.bars, pose.size, camera)
        if pose.ring is None:
            return
        radius = max(0.0225 * pose.size, 7 * pixel)
        width = max(0.0028 * pose.size, 1.8 * pixel)
        at = pose.points[pose.ring]
        self._marks.ring(at, radius, width, camera.basis(), self._palette.accent)
        if pose.trail is not None:
            self._trail(pose.trail, pose.size, camera)

    def _stand(self, bars: Bars, size: float, camera: Turntable) -> None:
        axes = camera.basis()
        # In front of the body, not within it.
        feet = bars.feet + _BEFORE * size * axes[2]
        lower, upper = bars.parts.T
        self._marks.bars(feet, lower, bars.width, axes, bars.colours[0])
        above = feet + lower[:, None] * np.array([0.0, 1.0, 0.0])
        self._marks.bars(above, upper, bars.width, axes, bars.colours[1])

    def _trail(self, path: Points, size: float, camera: Turntable) -> None:
        assert self._palette is not None
        steps = np.linspace(-1.0, 1.0, len(path))
        past = marks.fading(self._palette.accent, self._palette.bottom, 0.25 + 0.7 * np.abs(steps))
        coming = marks.fading(self._palette.faint, self._palette.bottom, 0.7 * np.abs(steps))
        colours = np.where((steps <= 0)[:, None], past, coming)
        width = 0.006 * size * (1 - 0.75 * np.abs(steps))
        self._marks.trail(path, width, camera.position(), colours)
