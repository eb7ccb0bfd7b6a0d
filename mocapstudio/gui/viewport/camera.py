"""A turntable camera: it orbits a point, keeps the horizon level and never rolls."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

VIEW_ANGLE = math.radians(30.0)
"""Vertical opening angle: narrow, so that limbs towards the camera are not drawn large."""

_LOWEST, _HIGHEST = math.radians(-25.0), math.radians(90.0)
_NEAREST, _FARTHEST = 0.02, 500.0

# How far each preset stands round the performer, and how high, in degrees.
PRESETS = {
    "front": (0.0, 6.0),
    "side": (90.0, 6.0),
    "top": (0.0, 90.0),
    "three-quarter": (38.0, 16.0),
}


@dataclass
class Turntable:
    """Where the camera is, in metres and radians, Y up.

    Parameters
    ----------
    focal
        (3,) the point it looks at and turns about.
    azimuth
        Angle about +Y from +Z towards +X at which the camera stands.
    elevation
        Angle above the horizon, at most a right angle.
    distance
        Metres from the focal point.
    """

    focal: Array = field(default_factory=lambda: np.array([0.0, 0.9, 0.0]))
    azimuth: float = math.radians(38.0)
    elevation: float = math.radians(16.0)
    distance: float = 5.0

    def basis(self) -> Array:
        """(3, 3) rows: right, up and back (towards the camera), in the world."""
        sa, ca = math.sin(self.azimuth), math.cos(self.azimuth)
        se, ce = math.sin(self.elevation), math.cos(self.elevation)
        return np.array([[ca, 0.0, -sa], [-sa * se, ce, -ca * se], [sa * ce, se, ca * ce]])

    def position(self) -> Array:
        """(3,) the eye."""
        eye: Array = self.focal + self.distance * self.basis()[2]
        return eye

    def orbit(self, right: float, up: float) -> None:
        """Turn about the focal point by radians; positive `right` moves the scene to the right."""
        self.azimuth = math.remainder(self.azimuth - right, math.tau)
        self.elevation = min(max(self.elevation - up, _LOWEST), _HIGHEST)

    def pan(self, right: float, up: float, height: int) -> None:
        """Shift the scene by pixels of a picture `height` pixels tall."""
        metres = self.metres_per_pixel(height)
        axes = self.basis()
        self.focal = self.focal - metres * (right * axes[0] + up * axes[1])

    def zoom(self, factor: float, at: tuple[float, float], size: tuple[int, int]) -> None:
        """Come nearer by `factor` (below 1), towards the pixel `at` of a picture of `size`.

        What lies under that pixel at the focal point's depth stays under it.
        """
        wanted = min(max(self.distance * factor, _NEAREST), _FARTHEST)
        factor = wanted / self.distance
        metres = self.metres_per_pixel(size[1])
        axes = self.basis()
        towards = (at[0] - size[0] / 2) * axes[0] + (size[1] / 2 - at[1]) * axes[1]
        self.focal = self.focal + (1.0 - factor) * metres * towards
        self.distance = wanted

    def frame(self, points: Array, aspect: float, margin: float = 1.25) -> None:
        """Look at the middle of (N, 3) points from a distance at which all of them show."""
        low, high = points.min(axis=0), points.max(axis=0)
        self.focal = (low + high) / 2
        axes = self.basis()
        seen = (points - self.focal) @ axes.T
        tangent = math.tan(VIEW_ANGLE / 2)
        needed = np.maximum(np.abs(seen[:, 1]), np.abs(seen[:, 0]) / max(aspect, 1e-3)) / tangent
        self.distance = float(np.clip((margin * needed + seen[:, 2]).max(), _NEAREST, _FARTHEST))

    def look(self, view: str, heading: float) -> None:
        """Stand where a preset says, round a performer who faces `heading` (radians about +Y).

        Raises
        ------
        KeyError
            If there is no preset of that name.
        """
        round_about, high = PRESETS[view]
        self.azimuth = math.remainder(heading + math.radians(round_about), math.tau)
        self.elevation = math.radians(high)

    def metres_per_pixel(self, height: int) -> float:
        """Size of a pixel at the focal point's depth, in a picture `height` pixels tall."""
        return 2.0 * self.distance * math.tan(VIEW_ANGLE / 2) / max(height, 1)

    def project(self, points: NDArray[np.floating], size: tuple[int, int]) -> tuple[Array, Array]:
        """Project (N, 3) points of the world to the picture.

        Parameters
        ----------
        points
            Metres, in the world.
        size
            Width and height of the picture in pixels.

        Returns
        -------
        pixels
            (N, 2) from the picture's top left; NaN for points behind the camera.
        depth
            (N,) metres in front of the eye.
        """
        seen = (points - self.position()) @ self.basis().T
        depth = -seen[:, 2]
        ahead = np.where(depth > _NEAREST / 2, depth, np.nan)
        scale = size[1] / 2 / math.tan(VIEW_ANGLE / 2) / ahead
        x, y = size[0] / 2 + seen[:, 0] * scale, size[1] / 2 - seen[:, 1] * scale
        return np.stack([x, y], axis=1), depth

    def clipping(self, radius: float) -> tuple[float, float]:
        """Nearest and farthest metres to draw in a scene that reaches `radius` from the focus."""
        far = self.distance + 2.0 * radius
        return max(0.02 * self.distance, 1e-3 * far), far
