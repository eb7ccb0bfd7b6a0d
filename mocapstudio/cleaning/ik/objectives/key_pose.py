"""A frame that was posed by hand stays as it was posed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.ik.objectives.rows import Rows
from mocapstudio.cleaning.ik.posed import Posed

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class KeyPose:
    """One frame keeps its departure.

    The residual is ``weight * (unknowns - wanted)``.

    Parameters
    ----------
    frame
        Frame of the window.
    wanted
        (n,) its unknowns.
    weight
        Per unit of each.
    """

    frame: int
    wanted: Array
    weight: float

    def rows(self, posed: Posed) -> Rows:
        """Differences (1, n) from what is wanted."""
        away = posed.unknowns[self.frame] - self.wanted
        jacobian = self.weight * np.eye(len(self.wanted))
        return Rows(np.array([self.frame]), self.weight * away[None], jacobian[None])
