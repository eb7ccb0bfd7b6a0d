"""Poses without place, direction and size of the body (paper 4, section 3.2)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison.parameters import BOX, ROTATIONS
from mocapstudio.comparison.performance import Performance
from mocapstudio.comparison.resampling import lanczos
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError

Array = NDArray[np.float64]

_CENTRE = 0.5


@dataclass(frozen=True, eq=False)
class Poses:
    """Poses of F frames and N rows as they are compared.

    Parameters
    ----------
    points
        (F, N, C) what distances are measured between.
    shown
        (F, N, 3) what the heat map shows, 0..1.
    weight
        (F, N) 1 where a row counts, 0 where it is unreliable.
    """

    points: Array
    shown: Array
    weight: Array

    @property
    def reliable(self) -> bool:
        """Whether every row counts in every frame."""
        return bool(np.all(self.weight == 1.0))

    def resampled(self, span: tuple[int, int], frames: int) -> Poses:
        """Return a span stretched or shrunk to `frames` frames by Lanczos resampling."""
        start, end = span
        at = np.round(np.linspace(start, end - 1, frames)).astype(np.int64)
        points = lanczos(self.points[start:end], frames)
        return Poses(points, self.shown[at], self.weight[at])

    def at(self, frames: Array) -> tuple[Array, Array]:
        """Points (n, N, C) and weights (n, N) at fractional frames (n,)."""
        low = np.clip(frames.astype(np.int64), 0, max(len(self.points) - 2, 0))
        high = np.minimum(low + 1, len(self.points) - 1)
        part = np.clip(frames - low, 0.0, 1.0)[:, None]
        weight = np.minimum(self.weight[low], self.weight[high])
        part = part[..., None]
        return self.points[low] * (1 - part) + self.points[high] * part, weight


def normalised(performance: Performance, rows: Sequence[int], features: str) -> Poses:
    """Take place, direction and size out of the poses of some rows.

    Parameters
    ----------
    features
        ``"box"``: positions in the frame of neck and head, scaled by one number a take so that
        they fit into the unit box with the neck at its centre; ``"root"``: the same in the frame
        of hips and heading; ``"rotations"``: rotation matrices over the square root of 2, so that
        the distance of two rotations by a small angle is that angle in radians.

    Raises
    ------
    MocapError
        If rotations are asked of markers, or the body has no extent.
    """
    weight = np.where(performance.unreliable[:, rows], 0.0, 1.0)
    if features == ROTATIONS:
        if performance.rotations is None:
            raise MocapError(f"{performance.name}: markers have no rotations to be compared")
        turns = performance.rotations[:, rows]
        matrices = rot.to_matrix(turns).reshape(*turns.shape[:2], 9) / np.sqrt(2.0)
        shown = rot.to_rotation_vector(turns) / (2 * np.pi) + _CENTRE
        return Poses(matrices, shown, weight)
    frame = performance.head if features == BOX else performance.root
    local = frame.local(performance.positions[:, rows])
    start, end = performance.span
    reach = np.abs(local[start:end]).max(axis=2)
    counted = reach[weight[start:end] > 0]
    size = float(counted.max() if len(counted) else reach.max())
    if size < 1e-6:
        raise MocapError(f"{performance.name}: all joints lie in one point")
    points = local * (_CENTRE / size) + _CENTRE
    return Poses(points, np.clip(points, 0.0, 1.0), weight)
