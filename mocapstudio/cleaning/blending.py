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


def join_rotations(inside: Array, before: Array | None, after: Array | None) -> Array:
    """Shift a replacement so that it meets what stays at both ends.

    The mismatch at each end is spread over the span as a rotation that fades linearly to the
    other end; the middle keeps the donor's own motion.

    Parameters
    ----------
    inside
        (n, m, 4) replacement.
    before, after
        (2, m, 4): the two frames just before, and just after, the span in the order of time; None
        at the take's own ends.
    """
    n = len(inside)
    at = (np.arange(n) + 1.0) / (n + 1.0)
    result = inside
    if before is not None:
        start = rot.multiply(inside[:1], rot.conjugate(_forecast(before[1], before[0])[None]))
        gap = -rot.log(start)[0]
        fade = (1.0 - at) if after is not None else np.ones(n)
        result = rot.multiply(rot.exp(fade[:, None, None] * gap), result)
    if after is not None:
        end = rot.multiply(inside[-1:], rot.conjugate(_forecast(after[0], after[1])[None]))
        gap = -rot.log(end)[0]
        fade = at if before is not None else np.ones(n)
        result = rot.multiply(rot.exp(fade[:, None, None] * gap), result)
    return result


def _forecast(near: Array, far: Array) -> Array:
    """Go on by the last step: what the frame next to `near` would be at constant speed."""
    return rot.multiply(rot.multiply(near, rot.conjugate(far)), near)


def smooth_seams(inside: Array, before: Array | None, after: Array | None, half: int) -> Array:
    """Smooth the first and last `half` frames of a replacement with a quadratic filter.

    Frames outside are read, never changed; `before` and `after` hold at least `half` frames where
    the take has them.
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
