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
I32 = NDArray[np.int32]
I64 = NDArray[np.int64]
U8 = NDArray[np.uint8]

DIAGONAL, STAY, SKIP = 0, 1, 2
"""Steps of a path: to both next frames, to the next input frame, to the next reference frame."""

_HALF = np.float32(0.5)
_ONE = np.float32(1.0)
_ZERO = np.float32(0.0)


@nb.njit(nogil=True, cache=True, fastmath=True)
def pose_costs(pose: F32, reference: F32, weights: F32, directions: int, out: F32) -> None:
    """Weighted distance of one pose from every reference frame (equations 1 and 4).

    Parameters
    ----------
    pose
        (D, 4): unit directions with a fourth component of 0, then unit quaternions.
    reference
        (D, 4, R), time last.
    weights
        (D,).
    directions
        How many of the rows are directions; they count ``w_d (1 - q_d . p_d) / 2``, the others
        ``w_d (1 - |q_d . p_d|)``.
    out
        (R,), overwritten.
    """
    frames = reference.shape[2]
    out[:] = _ZERO
    for d in range(reference.shape[0]):
        x, y, z, w = pose[d, 0], pose[d, 1], pose[d, 2], pose[d, 3]
        weight = weights[d]
        px, py, pz, pw = reference[d, 0], reference[d, 1], reference[d, 2], reference[d, 3]
        if d < directions:
            for j in range(frames):
                dot = x * px[j] + y * py[j] + z * pz[j]
                out[j] += weight * _HALF * max(_ONE - dot, _ZERO)
        else:
            for j in range(frames):
                dot = x * px[j] + y * py[j] + z * pz[j] + w * pw[j]
                out[j] += weight * max(_ONE - abs(dot), _ZERO)


@nb.njit(nogil=True, cache=True)
def displacements(before: F32, now: F32, directions: bool, out: F32) -> None:
    """Rotation of every row from an earlier pose to a later one.

    Parameters
    ----------
    before, now
        (D, 4) quaternions, or directions with a fourth component of 0.
    directions
        Which of the two; of directions the shortest rotation from one to the other.
    out
        (D, 4) quaternions, overwritten.
    """
    for d in range(before.shape[0]):
        ax, ay, az, aw = before[d, 0], before[d, 1], before[d, 2], before[d, 3]
        bx, by, bz, bw = now[d, 0], now[d, 1], now[d, 2], now[d, 3]
        if directions:
            x, y, z = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
            w = _ONE + ax * bx + ay * by + az * bz
        else:
            x = aw * bx - ax * bw - ay * bz + az * by
            y = aw * by + ax * bz - ay * bw - az * bx
            z = aw * bz - ax * by + ay * bx - az * bw
            w = aw * bw + ax * bx + ay * by + az * bz
        length = np.sqrt(x * x + y * y + z * z + w * w)
        if length < np.float32(1e-6):
            x, w, length = _ONE, np.float32(0.0), _ONE
        out[d, 0], out[d, 1], out[d, 2], out[d, 3] = x / length, y / length, z / length, w / length


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
    steps[:] = 0
    if first:
        return _first_row(costs, now, lengths, steps)
    now[0], lengths[0] = before[0] + np.float64(costs[0]), lengths_before[0] + 1.0
    steps[0] = STAY
    end = 0
    for j in range(1, costs.shape[0]):
        cost = np.float64(costs[j])
        total, length, step = before[j - 1] + diagonal * cost, lengths_before[j - 1] + 1.0, DIAGONAL
        least, least_length, traced = before[j - 1], lengths_before[j - 1], DIAGONAL
        other, more = before[j] + cost, lengths_before[j] + 1.0
        if _less(other, more, total, length, by_length):
            total, length, step = other, more, STAY
        if before[j] * least_length < least * lengths_before[j]:
            least, least_length, traced = before[j], lengths_before[j], STAY
        other, more = now[j - 1] + cost, lengths[j - 1] + 1.0
        if _less(other, more, total, length, by_length):
            total, length, step = other, more, SKIP
        if now[j - 1] * least_length < least * lengths[j - 1]:
            traced = SKIP
        now[j], lengths[j] = total, length
        steps[j >> 2] |= np.uint8((traced if by_length else step) << (2 * (j & 3)))
        end = j if total < now[end] else end
    return end


@nb.njit(nogil=True, cache=True)
def _first_row(costs: F32, now: F64, lengths: F64, steps: U8) -> int:
    """The first input frame: nothing but reference frames has been left behind."""
    end = 0
    for j in range(costs.shape[0]):
        now[j], lengths[j] = np.float64(costs[j]), 1.0
        if j > 0:
            now[j] += now[j - 1]
            lengths[j] += lengths[j - 1]
            steps[j >> 2] |= np.uint8(SKIP << (2 * (j & 3)))
        if now[j] < now[end]:
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


@nb.njit(nogil=True, cache=True, fastmath=True)
def row_distances(poses: F32, reference: F32, directions: int, out: F32) -> None:
    """Distance of every pose from every reference frame, row by row and unweighted.

    Parameters
    ----------
    poses
        (S, D, 4).
    reference
        (D, 4, R).
    directions
        As in `pose_costs`.
    out
        (D, S, R), overwritten.
    """
    for d in range(reference.shape[0]):
        px, py, pz, pw = reference[d, 0], reference[d, 1], reference[d, 2], reference[d, 3]
        for i in range(poses.shape[0]):
            x, y, z, w = poses[i, d, 0], poses[i, d, 1], poses[i, d, 2], poses[i, d, 3]
            row = out[d, i]
            if d < directions:
                for j in range(px.shape[0]):
                    dot = x * px[j] + y * py[j] + z * pz[j]
                    row[j] = _HALF * max(_ONE - dot, _ZERO)
            else:
                for j in range(px.shape[0]):
                    dot = x * px[j] + y * py[j] + z * pz[j] + w * pw[j]
                    row[j] = max(_ONE - abs(dot), _ZERO)


@nb.njit(nogil=True, cache=True)
def path_qualities(
    costs: F32,
    source: I32,
    reference: I32,
    seen: I64,
    by_length: bool,
    diagonal: float,
    closed: bool,
    out: F64,
) -> None:
    """Share of path cells whose segments agree, for P sets of weights at once.

    The accumulation is that of `next_row`; the P costs of a cell lie side by side, so that they
    are worked on together, fastest for multiples of 16.

    Parameters
    ----------
    costs
        (S, R, P) distance of source from reference frames.
    source, reference
        (S,) and (R,) segment of each frame; source frames of -1 do not count.
    seen
        (K,) numbers of source frames after which a path is traced back, ascending.
    by_length, diagonal
        As in `next_row`.
    closed
        True: every path ends in the last reference frame (offline time warping).
    out
        (P, K), overwritten; 1 where no cell counts.
    """
    frames, size, sets = costs.shape
    # P accumulated costs, then P path lengths; column 0 lies before the first reference frame.
    cells = np.full((2, size + 1, 2 * sets), np.inf)
    cells[:, :, sets:] = 1.0
    cells[1, 0] = 0.0
    scratch = np.empty(2 * sets)
    steps = np.empty((frames, size, sets), np.uint8)
    at = 0
    for i in range(frames):
        before, now = cells[1 - i % 2], cells[i % 2]
        factor = diagonal if i > 0 else 1.0
        for j in range(size):
            a, b, c, cost = before[j], before[j + 1], now[j], costs[i, j]
            if by_length:
                _two_by_length(a, b, cost, scratch)
                _third_by_length(scratch, c, cost, now[j + 1])
                _traced_by_length(a, b, c, steps[i, j])
            else:
                _three_by_sum(a, b, c, cost, factor, now[j + 1], steps[i, j])
        if i == 0:
            cells[1, 0, :sets] = np.inf
            cells[1, 0, sets:] = 1.0
        while at < seen.shape[0] and seen[at] == i + 1:
            for p in range(sets):
                end = size - 1 if closed else int(np.argmin(now[1:, p]))
                out[p, at] = _agreement(steps[:, :, p], i, end, source, reference)
            at += 1


# Four small loops of few arrays each: only such are vectorised by the compiler.


@nb.njit(nogil=True, cache=True)
def _two_by_length(a: F64, b: F64, cost: F32, out: F64) -> None:
    """The better of the diagonal and the staying step (equation 3)."""
    sets = cost.shape[0]
    for p in range(sets):
        x, x_length = a[p] + cost[p], a[sets + p] + 1.0
        y, y_length = b[p] + cost[p], b[sets + p] + 1.0
        better = y * x_length < x * y_length
        out[p] = y if better else x
        out[sets + p] = y_length if better else x_length


@nb.njit(nogil=True, cache=True)
def _third_by_length(two: F64, c: F64, cost: F32, out: F64) -> None:
    """The better of those and the skipping step."""
    sets = cost.shape[0]
    for p in range(sets):
        z, z_length = c[p] + cost[p], c[sets + p] + 1.0
        better = z * two[sets + p] < two[p] * z_length
        out[p] = z if better else two[p]
        out[sets + p] = z_length if better else two[sets + p]


@nb.njit(nogil=True, cache=True)
def _traced_by_length(a: F64, b: F64, c: F64, steps: U8) -> None:
    """The step out of a cell to the smallest ``D / L``."""
    sets = steps.shape[0]
    for p in range(sets):
        stays = b[p] * a[sets + p] < a[p] * b[sets + p]
        x = b[p] if stays else a[p]
        x_length = b[sets + p] if stays else a[sets + p]
        skips = c[p] * x_length < x * c[sets + p]
        steps[p] = SKIP if skips else (STAY if stays else DIAGONAL)


@nb.njit(nogil=True, cache=True)
def _three_by_sum(a: F64, b: F64, c: F64, cost: F32, diagonal: float, out: F64, steps: U8) -> None:
    """The step of the smallest sum (equation 2)."""
    for p in range(steps.shape[0]):
        x, y, z = a[p] + diagonal * cost[p], b[p] + cost[p], c[p] + cost[p]
        stays = y < x
        x = y if stays else x
        skips = z < x
        out[p] = z if skips else x
        steps[p] = SKIP if skips else (STAY if stays else DIAGONAL)


@nb.njit(nogil=True, cache=True)
def _agreement(steps: U8, frame: int, end: int, source: I32, reference: I32) -> float:
    agree, count = 0, 0
    while True:
        if source[frame] >= 0:
            count += 1
            if source[frame] == reference[end]:
                agree += 1
        if frame == 0 and end == 0:
            break
        step = steps[frame, end]
        if frame == 0:
            step = SKIP
        elif end == 0:
            step = STAY
        if step != SKIP:
            frame -= 1
        if step != STAY:
            end -= 1
    return agree / count if count else 1.0
