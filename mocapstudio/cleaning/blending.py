"""Joining a replacement to what stays: nothing outside the span is touched."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot

Array = NDArray[np.float64]


@lru_cache(maxsize=32)
def savitzky_golay(half: int) -> Array:
    """Weights (2 half + 1,) of the quadratic Savitzky-Golay smoother."""
    t = np.arange(-half, half + 1, dtype=float)
    basis = np.stack([np.ones_like(t), t, t * t], axis=1)
    return np.asarray(np.linalg.pinv(basis)[0])


def smooth_seams(inside: Array, before: Array | None, after: Array | None, half: int) -> Array:
    """Smooth the first and last `half` frames of a replacement with a quadratic filter.

    Frames outside are read, never changed.

    Parameters
    ----------
    inside
        (n, 4) quaternions of the replacement.
    before, after
        (b, 4) and (a, 4) frames around it, at least `half` of them where the take has them; None
        at the take's ends.
    half
        Half the width of the filter, frames.

    Returns
    -------
    (n, 4) quaternions, sign-continuous.
    """
    n = len(inside)
    parts = [part for part in (before, inside, after) if part is not None and len(part)]
    q = rot.continuous(np.concatenate(parts))
    lead = len(before) if before is not None else 0
    weights = savitzky_golay(half)
    result = q[lead : lead + n].copy()
    seams = {*range(min(half, n)), *range(max(n - half, 0), n)}
    for i in seams:
        at = lead + i
        if at - half < 0 or at + half >= len(q):
            continue
        result[i] = rot.normalize(np.tensordot(weights, q[at - half : at + half + 1], axes=1))
    return result
