"""The skeleton rendered off screen by VTK, which is imported only when a picture is made."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocapstudio.pictures.stick import Stick
from mocapstudio.pictures.style import Palette

_BONE, _JOINT, _TIP = 0.013, 0.019, 0.010
_ANGLE = 28.0


@dataclass(frozen=True, eq=False)
class Figure3D:
    """A body to draw: its pose, the colour of what is marked, and how solid it is."""

    stick: Stick
    accent: str
    opacity: float = 1.0


@dataclass(frozen=True, eq=False)
class View:
    """Where the camera looks, what extent (metres) it shows, and from which heading (radians)."""

    centre: NDArray[np.float64]
    extent: float
    heading: float

    @property
    def toward(self) -> NDArray[np.float64]:
        """(3,) unit vector from the centre to the camera: from the front, to one side, above."""
        yaw, pitch = self.heading + np.deg2rad(38.0), np.deg2rad(14.0)
        flat = np.cos(pitch)
        return np.array([flat * np.sin(yaw), np.sin(pitch), flat * np.cos(yaw)])


def view_of(sticks: list[Stick]) -> View:
    """Choose a view that holds all bodies."""
    points = np.concatenate([one.points for one in sticks])
    low, high = points.min(axis=0), points.max(axis=0)
    return View((low + high) / 2, float(np.linalg.norm(high - low)), sticks[-1].heading)


def render(
    figures: list[Figure3D], view: View, size: tuple[int, int], palette: Palette
) -> NDArray[np.uint8]:
    """Render bodies on a floor; (height, width, 3) bytes.

    Needs OpenGL: ask `pictures.opengl` first.
    """
    import pyvista
    from vtkmodules.vtkCommonCore import vtkObject

    # A machine without an X server is no trouble here, and no reason for warnings of VTK's own.
    warns = vtkObject.GetGlobalWarningDisplay()
    vtkObject.GlobalWarningDisplayOff()
    try:
        plotter: Any = pyvista.Plotter(
            off_screen=True, window_size=list(size), lighting="three lights"
        )
        plotter.set_background(palette.field)
        plotter.enable_anti_aliasing("msaa", multi_samples=8)
        _floor(plotter, figures, view, palette)
        for figure in figures:
            _body(plotter, figure, palette, view.extent)
        distance = 0.5 * view.extent / np.tan(np.deg2rad(_ANGLE) / 2)
        plotter.camera.focal_point = view.centre
        plotter.camera.position = view.centre + distance * view.toward
        plotter.camera.up = (0.0, 1.0, 0.0)
        plotter.camera.view_angle = _ANGLE
        plotter.camera.clipping_range = (0.05 * distance, 8.0 * distance)
        image: NDArray[np.uint8] = plotter.screenshot(return_img=True)
        plotter.close()
    finally:
        vtkObject.SetGlobalWarningDisplay(warns)
    return image


def _body(plotter: Any, figure: Figure3D, palette: Palette, extent: float) -> None:
    import pyvista

    stick = figure.stick
    joints = len(stick.points) - _tips(stick)
    for marked, colour in ((False, palette.body), (True, figure.accent)):
        bones = stick.bones[stick.marked_bones == marked]
        wider = 1.35 if marked else 1.0
        size = wider * extent / 2
        parts = []
        if len(bones):
            cells = np.column_stack([np.full(len(bones), 2), bones]).ravel()
            lines = pyvista.PolyData(stick.points, lines=cells)
            parts.append(lines.tube(radius=_BONE * size, n_sides=16))
        index = np.arange(len(stick.points))
        for chosen, radius in ((index < joints, _JOINT), (index >= joints, _TIP)):
            places = stick.points[chosen & (stick.marked_points == marked)]
            if len(places):
                ball = pyvista.Sphere(radius=radius * size, theta_resolution=20, phi_resolution=20)
                parts.append(pyvista.PolyData(places).glyph(geom=ball, scale=False, orient=False))
        for part in parts:
            plotter.add_mesh(
                part,
                color=colour,
                opacity=figure.opacity,
                smooth_shading=True,
                specular=0.15,
                ambient=0.15,
                diffuse=0.8,
            )


def _tips(stick: Stick) -> int:
    """Count the points that no bone starts from."""
    return len(set(range(len(stick.points))) - {int(b) for b in stick.bones[:, 0]})


def _floor(plotter: Any, figures: list[Figure3D], view: View, palette: Palette) -> None:
    import pyvista

    step = 0.25 * max(1.0, round(view.extent / 2))
    reach = step * np.ceil(0.9 * view.extent / step)
    x, z = (np.round(view.centre[axis] / step) * step for axis in (0, 2))
    ticks = np.arange(-reach, reach + step / 2, step)
    height = min(0.0, *(figure.stick.points[:, 1].min() for figure in figures))
    ends = [
        end
        for tick in ticks
        for end in (
            (x + tick, height, z - reach),
            (x + tick, height, z + reach),
            (x - reach, height, z + tick),
            (x + reach, height, z + tick),
        )
    ]
    lines = pyvista.line_segments_from_points(np.array(ends))
    plotter.add_mesh(lines, color=palette.floor, line_width=1, lighting=False)
