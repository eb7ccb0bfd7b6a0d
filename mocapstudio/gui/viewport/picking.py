"""Which joint lies under the mouse."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.gui.viewport.camera import Turntable

REACH = 12.0
"""Pixels from a joint within which the mouse still means it."""


def joint_at(
    camera: Turntable,
    joints: NDArray[np.floating],
    mouse: tuple[float, float],
    size: tuple[int, int],
    reach: float = REACH,
) -> int | None:
    """Return the index of the joint nearest to the mouse in the picture, or None.

    Parameters
    ----------
    camera
        Through which the picture is seen.
    joints
        (J, 3) metres, in the world. Of joints at the same place the first is meant.
    mouse
        Pixels from the picture's top left.
    size
        Width and height of the picture, in the same pixels.
    reach
        Farthest distance in pixels that still counts.
    """
    pixels, _ = camera.project(joints, size)
    apart = np.linalg.norm(pixels - np.asarray(mouse), axis=1)
    apart = np.where(np.isnan(apart), np.inf, np.round(apart, 3))
    nearest = int(np.argmin(apart))
    return nearest if apart[nearest] <= reach else None
