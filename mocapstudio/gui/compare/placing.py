"""Putting one performer beside another: turned about the vertical and moved. No Qt."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_FEWEST = 2


@dataclass(frozen=True)
class Placing:
    """A turn about +Y and a shift.

    Parameters
    ----------
    cosine, sine
        Of the turn: +Z towards +X where the sine is positive.
    shift
        Metres, x, y and z, after the turn.
    """

    cosine: float = 1.0
    sine: float = 0.0
    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __call__(self, points: NDArray[np.floating]) -> NDArray[np.float32]:
        """Place (..., 3) points."""
        c, s = self.cosine, self.sine
        turn = np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]], dtype=points.dtype)
        placed = points @ turn + np.array(self.shift, dtype=points.dtype)
        result: NDArray[np.float32] = placed.astype(np.float32)
        return result


IN_PLACE = Placing()


def fit(points: NDArray[np.floating], onto: NDArray[np.floating], rise: float = 0.0) -> Placing:
    """Return the turn and shift over the floor that brings points nearest to others.

    Least squares over x and z alone, so that both stay upright and on their floor.

    Parameters
    ----------
    points, onto
        (N, 3) metres, row by row the same part of the body; rows that are not finite are left out.
    rise
        Metres by which points are lifted.
    """
    known = np.isfinite(points).all(axis=1) & np.isfinite(onto).all(axis=1)
    if not known.any():
        return Placing(shift=(0.0, rise, 0.0))
    p, q = points[known].astype(np.float64), onto[known].astype(np.float64)
    middle, wanted = p.mean(axis=0), q.mean(axis=0)
    a, b = (p - middle)[:, [0, 2]], (q - wanted)[:, [0, 2]]
    cosine, sine = 1.0, 0.0
    if known.sum() >= _FEWEST:
        along = float((a * b).sum())
        across = float((a[:, 1] * b[:, 0] - a[:, 0] * b[:, 1]).sum())
        length = float(np.hypot(along, across))
        if length > 1e-12:
            cosine, sine = along / length, across / length
    turned = Placing(cosine, sine)(middle)
    return Placing(cosine, sine, (wanted[0] - turned[0], rise, wanted[2] - turned[2]))
