"""What an objective says: residuals of single frames, or differences between frames."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.ik.posed import Posed

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Rows:
    """Residuals of m different frames, linearised.

    Parameters
    ----------
    frames
        (m,) frames of the window, each at most once.
    residual
        (m, r).
    jacobian
        (m, r, n) derivative by the frame's unknowns.
    """

    frames: NDArray[np.int64]
    residual: Array
    jacobian: Array


class Objective(Protocol):
    """Something wanted of single frames."""

    def rows(self, posed: Posed) -> Rows:
        """Residuals and Jacobian in this pose."""
        ...


class TimeObjective(Protocol):
    """Something wanted of unknowns over time, linear in them and the same for all of them.

    The residual is ``difference @ (unknowns - reference)``, each column times its weight.
    """

    @property
    def difference(self) -> Array:
        """(k + 1, F + k) coefficients: row i weighs frame ``j - k + i`` in residual row j.

        Frames outside the window count as zero departure.
        """
        ...

    @property
    def weights(self) -> Array:
        """(n,) weight of each unknown."""
        ...

    @property
    def reference(self) -> Array | None:
        """(F, n) departure that is wanted, or None for none."""
        ...
