"""Numba kernels of the motion-word search (paper 1, equation 1 and appendix).

Serial and `nogil` over blocks of source rows, so that `similarity.parallel` can run several blocks
at once; vectorised over target frames, which lie contiguous in memory. All arrays are float32.
"""

from __future__ import annotations

import numba as nb
import numpy as np
from numpy.typing import NDArray

F32 = NDArray[np.float32]
I16 = NDArray[np.int16]
I64 = NDArray[np.int64]

_CHUNK = 128
_FAR = np.float32(1e30)

# acos(1 - u)^2 = u * (C0 + C1 u + ... + C6 u^6) on 0 <= u <= 1, to 1e-6: a Chebyshev fit, without
# the square root and the branch that keep acos from being vectorised.
_C0, _C1, _C2 = np.float32(2.0000005), np.float32(0.3332819), np.float32(0.0896723)
_C3, _C4, _C5 = np.float32(0.0241768), np.float32(0.0215540), np.float32(-0.0104543)
_C6 = np.float32(0.0091693)
_ZERO, _ONE, _TWO = np.float32(0.0), np.float32(1.0), np.float32(2.0)


@nb.njit(nogil=True, cache=True, fastmath=True, inline="always")
def _squared_log(dot: np.float32) -> np.float32:
    u = _ONE - min(abs(dot), _ONE)
    return u * (_C0 + u * (_C1 + u * (_C2 + u * (_C3 + u * (_C4 + u * (_C5 + u * _C6))))))


@nb.njit(nogil=True, cache=True, fastmath=True)
def pose_distances(source: F32, target: F32, trim: int, out: F32) -> None:
    """Squared geodesic distance between poses, the largest joints left out (equation 1).

    Parameters
    ----------
    source
        (S, m, 4) unit quaternions.
    target
        (m, 4, T) unit quaternions.
    trim
        How many of the m joints, those farthest apart, are left out of the sum.
    out
        (S, T), overwritten: sum over joints of ``||log(q_target^-1 q_source)||^2``, half angles,
        rad^2.
    """
    joints, frames = target.shape[0], target.shape[2]
    top = np.empty((max(trim, 1), _CHUNK), np.float32)
    total = np.empty(_CHUNK, np.float32)
    value = np.empty(_CHUNK, np.float32)
    for i in range(source.shape[0]):
        for start in range(0, frames, _CHUNK):
            width = min(_CHUNK, frames - start)
            total[:] = _ZERO
            top[:] = _ZERO
            for k in range(joints):
                x, y, z, w = source[i, k, 0], source[i, k, 1], source[i, k, 2], source[i, k, 3]
                tx, ty = target[k, 0, start:], target[k, 1, start:]
                tz, tw = target[k, 2, start:], target[k, 3, start:]
                for j in range(width):
                    a = _squared_log(x * tx[j] + y * ty[j] + z * tz[j] + w * tw[j])
                    total[j] += a
                    value[j] = a
                for r in range(trim):
                    best = top[r]
                    for j in range(width):
                        high = max(best[j], value[j])
                        value[j] = min(best[j], value[j])
                        best[j] = high
            for r in range(trim):
                best = top[r]
                for j in range(width):
                    total[j] -= best[j]
            row = out[i, start:]
            for j in range(width):
                row[j] = max(total[j], _ZERO)


@nb.njit(nogil=True, cache=True, fastmath=True)
def _arrive(
    distances: F32,
    at: tuple[int, int],
    i: int,
    j: int,
    cost: F32,
    length: F32,
    far: F32,
    width: int,
) -> None:
    """Cheapest arrival in cell (i, j) by a diagonal step, for one chunk of targets.

    `at` is where the chunk starts in a row, and how far apart two target frames lie there.

    What lies between two diagonal steps is nothing, or one or two steps along one of the words:
    a turn from one word to the other is never cheaper than the diagonal step that cuts it short.
    """
    now, steps = cost[i % 4, j], length[i % 4, j]
    one, one_length = cost[(i - 1) % 4], length[(i - 1) % 4]
    a0, l0 = one[j - 1], one_length[j - 1]
    a1, l1 = (one[j - 2], one_length[j - 2]) if j > 1 else (far, far)
    a2, l2 = (one[j - 3], one_length[j - 3]) if j > 2 else (far, far)
    a3, l3 = (cost[(i - 2) % 4, j - 1], length[(i - 2) % 4, j - 1]) if i > 1 else (far, far)
    a4, l4 = (cost[(i - 3) % 4, j - 1], length[(i - 3) % 4, j - 1]) if i > 2 else (far, far)
    start, step = at
    here = distances[i, start + j * step :]
    back = distances[i - 1, start + (j - 1) * step :]
    left = distances[i - 1, start + max(j - 2, 0) * step :]
    down = distances[max(i - 2, 0), start + (j - 1) * step :]
    for t in range(width):
        b = back[t]
        best, count = a0[t], l0[t]
        other = a1[t] + b
        count = l1[t] + _ONE if other < best else count
        best = min(other, best)
        other = a2[t] + b + left[t]
        count = l2[t] + _TWO if other < best else count
        best = min(other, best)
        other = a3[t] + b
        count = l3[t] + _ONE if other < best else count
        best = min(other, best)
        other = a4[t] + b + down[t]
        count = l4[t] + _TWO if other < best else count
        best = min(other, best)
        now[t] = best + here[t]
        steps[t] = count + _ONE


@nb.njit(nogil=True, cache=True, fastmath=True)
def _close(
    cost: F32,
    length: F32,
    extra: F32,
    more: F32,
    steps: int,
    end: tuple[int, int],
    best: F32,
    mean: F32,
    ends: I16,
    width: int,
) -> None:
    """End paths after a last diagonal step and `steps` (0 to 2) further ones, where cheapest."""
    source_end, target_end = ends[0], ends[1]
    i, j = np.int16(end[0] + 1), np.int16(end[1] + 1)
    weights = np.float32(steps > 0), np.float32(steps > 1)
    for t in range(width):
        total = cost[t] + weights[0] * extra[t] + weights[1] * more[t]
        better = total < best[t]
        mean[t] = total / (length[t] + np.float32(steps)) if better else mean[t]
        source_end[t] = i if better else source_end[t]
        target_end[t] = j if better else target_end[t]
        best[t] = min(total, best[t])


@nb.njit(nogil=True, cache=True, fastmath=True)
def _dtw_chunk(
    distances: F32, at: tuple[int, int], width: int, work: F32, best: F32, mean: F32, ends: I16
) -> None:
    """Fill the cost matrix of one chunk of targets and close every path that reaches an end."""
    cost, length, far = work[0], work[1], work[2, 0, 0]
    last, offsets = distances.shape[0] - 1, cost.shape[1]
    start, step = at
    cost[:] = _FAR
    cost[0, 0, :width] = distances[0, start : start + width]
    length[0, 0] = _ONE
    for i in range(last + 1):
        if i > 0:
            cost[i % 4, 0] = _FAR
        for j in range(1, offsets if i > 0 else 0):
            _arrive(distances, at, i, j, cost, length, far, width)
            here, steps = cost[i % 4, j], length[i % 4, j]
            if i == last or j == offsets - 1:
                _close(here, steps, here, here, 0, (i, j), best, mean, ends, width)
            elif j >= offsets - 3:
                more, end = offsets - 1 - j, (i, offsets - 1)
                one = distances[i, start + (j + 1) * step :]
                two = distances[i, start + (offsets - 1) * step :]
                _close(here, steps, one, two, more, end, best, mean, ends, width)
            if last > i >= last - 2:
                one, two = distances[i + 1, start + j * step :], distances[last, start + j * step :]
                _close(here, steps, one, two, last - i, (last, j), best, mean, ends, width)


@nb.njit(nogil=True, cache=True, fastmath=True)
def dtw_word(distances: F32, offsets: int, out: F32, ends: I16) -> None:
    """Constrained open-end DTW of one source word against every target word (appendix).

    A path starts at the first frame of both words, takes at most two consecutive steps along one
    of them, and ends when either word ends; the path of lowest cumulative cost counts.

    Parameters
    ----------
    distances
        (N, T) pose distances of the word's N frames; N at least 4.
    offsets
        M, length of a target word; word ``t`` covers target frames ``[t, t + M)``.
    out
        (T - M + 1,), overwritten: mean pose distance a matched pair along the path.
    ends
        (2, T - M + 1), overwritten: how many source and target frames the path covers.
    """
    words = out.shape[0]
    work = np.full((3, 4, offsets, _CHUNK), _FAR, np.float32)
    best, mean = np.empty(_CHUNK, np.float32), np.empty(_CHUNK, np.float32)
    end = np.empty((2, _CHUNK), np.int16)
    for start in range(0, words, _CHUNK):
        width = min(_CHUNK, words - start)
        best[:] = _FAR
        _dtw_chunk(distances, (start, 1), width, work, best, mean, end)
        out[start : start + width] = mean[:width]
        ends[:, start : start + width] = end[:, :width]


@nb.njit(nogil=True, cache=True, fastmath=True)
def dtw_listed(distances: F32, offsets: int, starts: I64, out: F32, ends: I16) -> None:
    """Do what `dtw_word` does, for listed target words only.

    Parameters
    ----------
    distances
        (N, T) pose distances of the word's N frames; N at least 4.
    offsets
        M, length of a target word.
    starts
        (C,) columns in which the target words start, at most T - M.
    out, ends
        (C,) and (2, C), overwritten: as in `dtw_word`.
    """
    rows = distances.shape[0]
    work = np.full((3, 4, offsets, _CHUNK), _FAR, np.float32)
    block = np.zeros((rows, offsets * _CHUNK), np.float32)
    best, mean = np.empty(_CHUNK, np.float32), np.empty(_CHUNK, np.float32)
    end = np.empty((2, _CHUNK), np.int16)
    for first in range(0, starts.shape[0], _CHUNK):
        width = min(_CHUNK, starts.shape[0] - first)
        for i in range(rows):
            for t in range(width):
                start = starts[first + t]
                for j in range(offsets):
                    block[i, j * _CHUNK + t] = distances[i, start + j]
        best[:] = _FAR
        _dtw_chunk(block, (0, _CHUNK), width, work, best, mean, end)
        out[first : first + width] = mean[:width]
        ends[:, first : first + width] = end[:, :width]


@nb.njit(nogil=True, cache=True)
def smallest_minima(distances: F32, breaks: I64, keep: int, barred: I64, found: I64) -> int:
    """Starts of the `keep` smallest local minima of a distance over target words, best first.

    Parameters
    ----------
    distances
        (T',) one value a target word; words not to be used hold values of 1e29 or more.
    breaks
        (B,) ascending: first word of every take; a minimum never looks across one. A flat bottom
        is one minimum, at its first word.
    barred
        (2,) half-open span of words too close to the source, skipped.
    found
        (keep,), overwritten.

    Returns
    -------
    How many were found.
    """
    count, segment = 0, 0
    for t in range(distances.shape[0]):
        while segment + 1 < breaks.shape[0] and breaks[segment + 1] <= t:
            segment += 1
        here = distances[t]
        if here >= np.float32(1e29) or barred[0] <= t < barred[1]:
            continue
        last = distances.shape[0]
        if segment + 1 < breaks.shape[0]:
            last = breaks[segment + 1]
        if t > breaks[segment] and distances[t - 1] <= here:
            continue
        after = t + 1
        while after < last and distances[after] == here:
            after += 1
        if after < last and distances[after] < here:
            continue
        if count == keep and here >= distances[found[count - 1]]:
            continue
        at = min(count, keep - 1)
        while at > 0 and distances[found[at - 1]] > here:
            found[at] = found[at - 1]
            at -= 1
        found[at] = t
        count = min(count + 1, keep)
    return count


@nb.njit(nogil=True, cache=True)
def gather(poses: F32, runs: I64, planes: F32) -> None:
    """Lay spans of poses end to end, time last.

    Parameters
    ----------
    poses
        (T, m, 4).
    runs
        (R, 2) half-open spans of frames.
    planes
        (m, 4, G), overwritten; G frames in all spans together.
    """
    at = 0
    for r in range(runs.shape[0]):
        for t in range(runs[r, 0], runs[r, 1]):
            for k in range(poses.shape[1]):
                for c in range(4):
                    planes[k, c, at] = poses[t, k, c]
            at += 1
