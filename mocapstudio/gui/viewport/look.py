"""What is drawn of the scene at one frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Look:
    """What is drawn of the roles at one frame.

    Parameters
    ----------
    frame
        Of the active take.
    values
        (J,) digression of the active performer's joints at the frame, NaN where not analysed, or
        None while there is no map.
    threshold
        From which a joint counts as flagged.
    selected
        Indices of the selected joints.
    trails
        Whether they leave trails.
    pixel
        Size of a pixel in metres, where the camera looks.
    """

    frame: int
    values: NDArray[np.floating] | None
    threshold: float
    selected: tuple[int, ...]
    trails: bool
    pixel: float
