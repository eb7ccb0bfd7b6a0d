"""Which markers move as if on one body: pairs whose distance stays as it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.markers import MarkerTake

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_LOOKED_AT = 400
_FEWEST_TOGETHER = 10


@dataclass(frozen=True, eq=False)
class Distances:
    """Distances between the markers of a take.

    Attributes
    ----------
    length
        (M, M) metres, median; NaN where two are hardly ever seen together.
    spread
        (M, M) metres, standard deviation over time; infinite there.
    """

    length: Array
    spread: Array

    def nearest(self, marker: int) -> NDArray[np.int64]:
        """Indices of other markers with a finite spread, the most rigidly joined first."""
        order = np.argsort(self.spread[marker], kind="stable")
        known = np.isfinite(self.spread[marker][order]) & (order != marker)
        return np.asarray(order[known])


def distances(take: MarkerTake) -> Distances:
    """Measure the distances between all markers, on evenly spread frames."""
    some = np.unique(np.linspace(0, take.frames - 1, _LOOKED_AT).astype(int))
    positions = take.positions[some]
    markers = positions.shape[1]
    length = np.full((markers, markers), np.nan)
    spread = np.full((markers, markers), np.inf)
    few = min(_FEWEST_TOGETHER, len(some))
    for m in range(markers):
        apart = np.linalg.norm(positions - positions[:, m : m + 1], axis=2)
        enough = np.flatnonzero((~np.isnan(apart)).sum(axis=0) >= few)
        if len(enough):
            length[m, enough] = np.nanmedian(apart[:, enough], axis=0)
            spread[m, enough] = np.nanstd(apart[:, enough], axis=0)
    return Distances(length, spread)


def fit_rigid(template: Array, seen: Array) -> tuple[Array, Array]:
    """Rotation and shift that bring a template onto each frame's points, in least squares.

    Arun, Huang and Blostein 1987, with the sign of Umeyama 1991 so that nothing is mirrored.

    Parameters
    ----------
    template
        (P, 3) points of a rigid body.
    seen
        (F, P, 3) where they are; NaN where one is missing.

    Returns
    -------
    rotations
        (F, 3, 3); NaN where fewer than three points are seen, or all on a line.
    shifts
        (F, 3): ``seen = rotation @ template + shift``.
    """
    present: Mask = np.asarray(~np.isnan(seen).any(axis=2))
    weights = present[..., None].astype(float)
    count = np.maximum(weights.sum(axis=1), 1.0)
    known = np.where(present[..., None], seen, 0.0)
    middle = (known * weights).sum(axis=1) / count
    centre = (template * weights).sum(axis=1) / count
    from_there = (template - centre[:, None]) * weights
    to_here = (known - middle[:, None]) * weights
    u, sizes, vt = np.linalg.svd(np.einsum("fpi,fpj->fij", to_here, from_there))
    sign = np.sign(np.linalg.det(u @ vt))
    u[:, :, 2] *= np.where(sign == 0, 1.0, sign)[:, None]
    rotations = u @ vt
    flat = sizes[:, 1] < 1e-4 * np.maximum(sizes[:, 0], 1e-12)
    rotations[(present.sum(axis=1) < 3) | flat] = np.nan
    return rotations, middle - np.einsum("fij,fj->fi", rotations, centre)
