"""Targets, gaps and drag axes over the 3-D view, never hidden by a body."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocapstudio.gui.viewport.camera import Turntable
from mocapstudio.gui.viewport.marks import Marks
from mocapstudio.gui.viewport.palette import Colour

Array = NDArray[np.float64]

_NEARER = 0.3
"""Everything is drawn at this share of the way from the eye, so that nothing lies before it."""

_GAP = 0.004
_AXIS = 0.6
AXIS_COLOURS: tuple[Colour, Colour, Colour] = ((230, 90, 80), (110, 200, 90), (90, 150, 250))


@dataclass(frozen=True, eq=False)
class Mark:
    """One target as it is drawn.

    Parameters
    ----------
    place
        (3,) metres: the target.
    point
        (3,) metres: where the end effector is, or None.
    colour
        Of its kind.
    chosen
        Whether it stands out.
    """

    place: Array
    point: Array | None
    colour: Colour
    chosen: bool = False


class Overlay:
    """One actor of flat marks on top of the scene.

    Parameters
    ----------
    renderer
        Of VTK.
    """

    def __init__(self, renderer: Any) -> None:
        self._marks = Marks()
        renderer.AddActor(self._marks.mesh.actor)

    def draw(
        self,
        marks: Sequence[Mark],
        handles: Sequence[tuple[Array, Colour]],
        axes: tuple[Array, Sequence[int]] | None,
        camera: Turntable,
        height: int,
    ) -> None:
        """Draw what there is at this frame.

        Parameters
        ----------
        marks
            Targets.
        handles
            Places that can be dragged, with their colours.
        axes
            Where something is dragged, and along which of the axes x, y, z it may go; or None.
        camera
            From where the scene is seen, in a picture `height` pixels tall.
        """
        eye, basis = camera.position(), camera.basis()
        for mark in marks:
            pixel = _pixel(mark.place, camera, height)
            if mark.point is not None and np.linalg.norm(mark.point - mark.place) > _GAP:
                self._line(mark.point, mark.place, 1.6 * pixel, mark.colour, eye)
            radius = (8.0 if mark.chosen else 5.0) * pixel
            self._ring(mark.place, radius, 2.0 * pixel, basis, mark.colour, eye)
            if mark.chosen:
                self._ring(mark.place, 0.0, 3.5 * pixel, basis, mark.colour, eye)
        for place, colour in handles:
            pixel = _pixel(place, camera, height)
            self._ring(place, 4.0 * pixel, 1.5 * pixel, basis, colour, eye)
        if axes is not None:
            place, free = axes
            pixel = _pixel(place, camera, height)
            for axis in free:
                way = np.zeros(3)
                way[axis] = _AXIS
                self._line(place - way, place + way, 1.4 * pixel, AXIS_COLOURS[axis], eye)
        self._marks.show()

    def _ring(
        self, at: Array, radius: float, width: float, basis: Array, colour: Colour, eye: Array
    ) -> None:
        near = _before(at, eye).astype(np.float32)
        self._marks.ring(near, _NEARER * radius, _NEARER * width, basis, colour)

    def _line(self, a: Array, b: Array, width: float, colour: Colour, eye: Array) -> None:
        path = _before(np.linspace(a, b, 2), eye)
        tones = np.array([colour, colour], dtype=np.uint8)
        wide = np.full(2, _NEARER * width)
        self._marks.trail(path.astype(np.float32), wide, eye, tones)


def _before(places: Array, eye: Array) -> Array:
    return np.asarray(eye + _NEARER * (places - eye))


def _pixel(place: Array, camera: Turntable, height: int) -> float:
    """Metres a pixel at the depth of a place."""
    depth = float((camera.position() - place) @ camera.basis()[2])
    return camera.metres_per_pixel(height) * max(depth, 1e-3) / camera.distance
