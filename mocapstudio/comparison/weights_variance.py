"""Joint weights by how much a joint moves: what paper 3 compares its own with."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mocapstudio.comparison.online_features import F32, F64
from mocapstudio.motion import rotations as rot


def variance_weights(takes: Sequence[F32], directions: int = 0) -> F32:
    """Weights (D,) from the variance of roll, pitch and yaw over time (paper 3, section 4.2).

    Each variance is divided by the take's largest and averaged over takes; a joint's weight is the
    largest of its three. Of directions, the variance of the coordinates stands in.

    Parameters
    ----------
    takes
        (S, D, 4) rows of the training takes.
    directions
        How many of the rows, from the first, are directions and not rotations.
    """
    means = np.mean([_relative_variance(poses, directions) for poses in takes], axis=0)
    return np.asarray(means.max(axis=1), dtype=np.float32)


def _relative_variance(rows: F32, directions: int) -> F64:
    """(D, 3)."""
    rotations = np.asarray(rows[:, directions:], dtype=np.float64)
    angles = np.unwrap(rot.to_euler("ZXY", rotations), axis=0)
    straight = np.asarray(rows[:, :directions, :3], dtype=np.float64)
    variance = np.concatenate([straight.var(axis=0), angles.var(axis=0)])
    largest = variance.max()
    return np.asarray(variance / largest if largest > 0 else np.ones_like(variance))
