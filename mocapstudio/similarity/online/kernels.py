"""Numba kernels of open-end time warping (paper 3, equations 1 to 4).

Serial and `nogil`. Poses and weights are float32; accumulated costs are float64, because a stream
has no end and sums must not lose the costs of single frames.
"""

from __future__ import annotations

import numba as nb
import numpy as np
from numpy.typing import NDArray

F32 = NDArray[np.float32]
F64 = NDArray[np.float64]
I64 = NDArray[np.int64]
U8 = NDArray[np.uint8]

DIAGONAL, STAY, SKIP = 0, 1, 2
"""Steps of a path: to both next frames, to the next input frame, to the next reference frame."""

_HALF = np.float32(0.5)
_ONE = np.float32(1.0)


@nb.njit(nogil=True, cache=True, fastmath=True)
def pose_costs(pose: F32, reference: F32, weights: F32, directions: bool, out: F32) -> None:
    """Weighted distance of one pose from every reference frame (equations 1 and 4).

    Parameters
    ----------
    pose
        (D, 4): unit quaternions, or unit directions with a fourth component of 0.
    reference
        (D, 4, R), time last.
    weights
        (D,).
    directions
        False: ``sum_d w_d (1 - |q_d . p_d|)``; True: ``sum_d w_d (1 - q_d . p_d) / 2``.
    out
        (R,), overwritten.
    """
    frames = reference.shape[2]
    out[:] = np.float32(0.0)
    for d in range(reference.shape[0]):
        x, y, z, w = pose[d, 0], pose[d, 1], pose[d, 2], pose[d, 3]
        weight = weights[d]
        px, py, pz, pw = reference[d, 0], reference[d, 1], reference[d, 2], reference[d, 3]
        if directions:
            for j in range(frames):
                dot = x * px[j] + y * py[j] + z * pz[j]
                out[j] += weight * _HALF * (_ONE - dot)
        else:
            for j in range(frames):
                dot = x * px[j] + y * py[j] + z * pz[j] + w * pw[j]
                out[j] += weight * (_ONE - abs(dot))


@nb.njit(nogil=True, cache=True)
def next_row(
    costs: F32,
    first: bool,
    by_length: bool,
    diagonal: float,
    before: F64,
    lengths_before: F64,
    now: F64,
    lengths: F64,
    steps: U8,
) -> int:
    """Add one input frame to the accumulated costs (equations 2 and 3).

    Parameters
    ----------
    costs
        (R,) distance M of the input frame from every reference frame.
    first
        True for the first input frame; `before` is not looked at then.
    by_length
        True: of the three predecessors, that with the smallest ``(D + M) / (L + 1)`` (equation 3),
        traced back by the smallest ``D / L``. False: that with the smallest D (equation 2).
    diagonal
        What M counts on a diagonal step; 1 for the paper's own variants, 2 for the penalty.
    before, lengths_before
        (R,) accumulated costs D and path lengths L of the input frame before.
    now, lengths
        (R,), overwritten with those of this frame.
    steps
        (ceil(R / 4),), overwritten: the step that a path traced back takes out of each cell, two
        bits each.

    Returns
    -------
    The open end: the reference frame with the smallest D.
    """
    frames = costs.shape[0]
    steps[:] = 0
    end = 0
    for j in range(frames):
        cost = np.float64(costs[j])
        total, length, step, traced = np.inf, 1.0, DIAGONAL, DIAGONAL
        least, least_length = np.inf, 1.0
        if first and j == 0:
            total, length = cost, 1.0
        if not first and j > 0:
            total, length = before[j - 1] + diagonal * cost, lengths_before[j - 1] + 1.0
            least, least_length = before[j - 1], lengths_before[j - 1]
        if not first:
            other, more = before[j] + cost, lengths_before[j] + 1.0
            if _less(other, more, total, length, by_length):
                total, length, step = other, more, STAY
            if before[j] * least_length < least * lengths_before[j]:
                least, least_length, traced = before[j], lengths_before[j], STAY
        if j > 0:
            other, more = now[j - 1] + cost, lengths[j - 1] + 1.0
            if _less(other, more, total, length, by_length):
                total, length, step = other, more, SKIP
            if now[j - 1] * least_length < least * lengths[j - 1]:
                traced = SKIP
        now[j], lengths[j] = total, length
        steps[j >> 2] |= np.uint8((traced if by_length else step) << (2 * (j & 3)))
        if total < now[end]:
            end = j
    return end


@nb.njit(nogil=True, cache=True, inline="always")
def _less(a: float, a_length: float, b: float, b_length: float, by_length: bool) -> bool:
    # Cross-multiplied, since a division a cell would cost more than all the rest.
    return a * b_length < b * a_length if by_length else a < b


@nb.njit(nogil=True, cache=True)
def trace_back(steps: U8, newest: int, frame: int, end: int, path: I64) -> int:
    """Follow the stored steps from the open end to the first frame that is still stored.

    Parameters
    ----------
    steps
        (N, ceil(R / 4)) ring of what `next_row` wrote for the last N input frames.
    newest
        Row of the latest input frame.
    frame
        Its number, counted from the first input frame.
    end
        Its reference frame.
    path
        (N + R, 2), overwritten from its end: pairs of reference and input frame, ascending.

    Returns
    -------
    Where in `path` the pairs begin.
    """
    at = path.shape[0] - 1
    path[at, 0], path[at, 1] = end, frame
    left = min(steps.shape[0], frame + 1)
    row = newest
    while end > 0 or frame > 0:
        step = (steps[row, end >> 2] >> np.uint8(2 * (end & 3))) & 3
        if step != SKIP:
            left -= 1
            if left == 0:
                break
            frame -= 1
            row = row - 1 if row > 0 else steps.shape[0] - 1
        if step != STAY:
            end -= 1
        at -= 1
        path[at, 0], path[at, 1] = end, frame
    return int(at)
