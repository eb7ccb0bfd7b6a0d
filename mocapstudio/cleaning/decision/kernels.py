"""Numba kernels of the learnt decision: windows matched without one limb, and residuals to them.

Serial and `nogil`; target frames lie contiguous in memory; float32 throughout.
"""

from __future__ import annotations

import numba as nb
import numpy as np
from numpy.typing import NDArray

F32 = NDArray[np.float32]
I32 = NDArray[np.int32]
I64 = NDArray[np.int64]
U8 = NDArray[np.uint8]

HALF = 7
SATURATION = np.float32(np.deg2rad(25.0) ** 2)
_DEGREES = 180.0 / np.pi
_ONE, _TWO, _FOUR = np.float32(1.0), np.float32(2.0), np.float32(4.0)


@nb.njit(nogil=True, cache=True, fastmath=True)
def limb_row(pose: F32, planes: F32, limb: I64, out: F32) -> None:
    """Saturating distance of one pose to every target frame, limb by limb.

    Parameters
    ----------
    pose
        (m, 4) quaternions.
    planes
        (m, 4, T).
    limb
        (m,) which limb each joint belongs to.
    out
        (L, T), overwritten: sum over the limb's joints of ``a^2 / (a^2 + 25 deg^2)``, with the
        chord ``4 (1 - |dot|) * 2`` for ``a^2``: equal to it for small angles, bounded for large.
    """
    out[:] = np.float32(0.0)
    frames = planes.shape[2]
    for k in range(planes.shape[0]):
        x, y, z, w = pose[k, 0], pose[k, 1], pose[k, 2], pose[k, 3]
        tx, ty, tz, tw = planes[k, 0], planes[k, 1], planes[k, 2], planes[k, 3]
        row = out[limb[k]]
        for j in range(frames):
            dot = abs(x * tx[j] + y * ty[j] + z * tz[j] + w * tw[j])
            squared = _FOUR * _TWO * max(_ONE - dot, np.float32(0.0))
            row[j] += squared / (squared + SATURATION)


@nb.njit(nogil=True, cache=True)
def _select(cost: F32, usable: U8, found: I32, distance: F32) -> None:
    """Keep the smallest local minima among usable targets, best first; -1 where there are fewer."""
    keep = found.shape[0]
    count = 0
    found[:] = -1
    distance[:] = np.nan
    for j in range(1, cost.shape[0] - 1):
        here = cost[j]
        if usable[j] == 0 or (count == keep and here >= distance[keep - 1]):
            continue
        if usable[j - 1] != 0 and cost[j - 1] <= here:
            continue
        if usable[j + 1] != 0 and cost[j + 1] < here:
            continue
        at = min(count, keep - 1)
        while at > 0 and distance[at - 1] > here:
            found[at], distance[at] = found[at - 1], distance[at - 1]
            at -= 1
        found[at], distance[at] = j, here
        count = min(count + 1, keep)


@nb.njit(nogil=True, cache=True, fastmath=True)
def _first_windows(source: F32, first: int, planes: F32, limb: I64, ring: F32, window: F32) -> None:
    """Fill the ring with the rows of one window and sum them along the diagonals."""
    frames = planes.shape[2]
    for n in range(2 * HALF + 1):
        limb_row(source[first - HALF + n], planes, limb, ring[n])
        shift = n - HALF
        for part in range(window.shape[0]):
            row, total = ring[n, part], window[part]
            for j in range(max(0, -shift), min(frames, frames - shift)):
                total[j] += row[j + shift]


@nb.njit(nogil=True, cache=True, fastmath=True)
def _advance(ring: F32, newest: int, window: F32) -> None:
    """Move all windows on by one frame of source and target: sums along the diagonal.

    Frames beyond the ends of the corpus count 0; windows there are never usable.
    """
    length, frames = ring.shape[0] - 1, window.shape[1]
    entering, leaving = ring[newest % (length + 1)], ring[(newest + 1) % (length + 1)]
    for part in range(window.shape[0]):
        row, new, old = window[part], entering[part], leaving[part]
        for j in range(frames - 1, 0, -1):
            value = row[j - 1]
            if j + HALF < frames:
                value += new[j + HALF]
            if j - 1 - HALF >= 0:
                value -= old[j - 1 - HALF]
            row[j] = value
        row[0] = np.float32(0.0)
        for n in range(HALF + 1):
            row[0] += ring[(newest - HALF + n) % (length + 1), part, n]


@nb.njit(nogil=True, cache=True, fastmath=True)
def _cost_without(window: F32, without: int, scale: np.float32, cost: F32) -> None:
    cost[:] = np.float32(0.0)
    for part in range(window.shape[0]):
        if part != without:
            row = window[part]
            for j in range(cost.shape[0]):
                cost[j] += row[j]
    for j in range(cost.shape[0]):
        cost[j] *= scale


@nb.njit(nogil=True, cache=True, fastmath=True)
def match_windows(
    source: F32,
    centres: I64,
    planes: F32,
    limb: I64,
    limbs: int,
    usable: U8,
    own: I64,
    found: I32,
    distance: F32,
    own_found: I32,
    own_distance: F32,
) -> None:
    """Match windows of 2 HALF + 1 frames rigidly, every time without one limb.

    Parameters
    ----------
    source
        (S, m, 4) quaternions.
    centres
        (C,) ascending source frames, all at least HALF from both ends.
    planes, limb, limbs
        As in `limb_row`; limbs may exceed the largest of `limb`, to leave out nothing.
    usable
        (T,) 1 where a window centred there lies inside one take that may be used.
    own
        (3,) half-open span of the corpus that is the source itself, and how many frames from the
        source's own place a window of it must keep.
    found, distance, own_found, own_distance
        (C, L, K), overwritten: frames of the rest of the corpus, and of the source itself, and
        their distance a joint and frame, without limb l.
    """
    frames, joints, length = planes.shape[2], planes.shape[0], 2 * HALF + 1
    ring = np.zeros((length + 1, limbs, frames), np.float32)
    window = np.zeros((limbs, frames), np.float32)
    outside, inside = usable.copy(), np.zeros_like(usable)
    outside[own[0] : own[1]] = 0
    counts = np.zeros(limbs, np.float32)
    for k in range(joints):
        counts[limb[k]] += _ONE
    cost = np.empty(frames, np.float32)
    newest, at = length - 1, centres[0]
    _first_windows(source, at, planes, limb, ring, window)
    span = slice(own[0], own[1])
    for c in range(centres.shape[0]):
        while at < centres[c]:
            at += 1
            newest += 1
            limb_row(source[at + HALF], planes, limb, ring[newest % (length + 1)])
            _advance(ring, newest, window)
        inside[span] = usable[span]
        inside[max(own[0], own[0] + at - own[2]) : min(own[1], own[0] + at + own[2] + 1)] = 0
        for part in range(limbs):
            rest = max(np.float32(joints) - counts[part], _ONE)
            _cost_without(window, part, _ONE / (np.float32(length) * rest), cost)
            _select(cost, outside, found[c, part], distance[c, part])
            _select(cost[span], inside[span], own_found[c, part], own_distance[c, part])
            for n in range(own_found.shape[2]):
                if own_found[c, part, n] >= 0:
                    own_found[c, part, n] += own[0]


RESIDUALS = 9
"""Columns of `residuals`: see there."""


@nb.njit(nogil=True, cache=True)
def _between(a: F32, b: F32) -> float:
    """Geodesic angle between two quaternions, degrees."""
    dot = abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3])
    return float(2.0 * np.arccos(min(dot, np.float32(1.0))) * _DEGREES)


@nb.njit(nogil=True, cache=True)
def _velocity(a: F32, b: F32, out: NDArray[np.float64]) -> float:
    """Rotation a frame from `a` to `b`, two frames apart, degrees; returns its size."""
    sign = 1.0 if a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] >= 0 else -1.0
    sign *= _DEGREES
    out[0] = sign * (a[3] * b[0] - a[0] * b[3] - a[1] * b[2] + a[2] * b[1])
    out[1] = sign * (a[3] * b[1] + a[0] * b[2] - a[1] * b[3] - a[2] * b[0])
    out[2] = sign * (a[3] * b[2] - a[0] * b[1] + a[1] * b[0] - a[2] * b[3])
    return float(np.sqrt(out[0] ** 2 + out[1] ** 2 + out[2] ** 2))


@nb.njit(nogil=True, cache=True)
def _mean_of(poses: F32, count: int, like: F32, out: F32) -> None:
    """Chordal mean of quaternions, signs aligned to `like`."""
    out[:] = np.float32(0.0)
    for n in range(count):
        p = poses[n]
        same = like[0] * p[0] + like[1] * p[1] + like[2] * p[2] + like[3] * p[3] >= 0
        for i in range(4):
            out[i] += p[i] if same else -p[i]
    out /= np.sqrt(out[0] ** 2 + out[1] ** 2 + out[2] ** 2 + out[3] ** 2)


@nb.njit(nogil=True, cache=True)
def _gather(
    pose: F32,
    plane: F32,
    found: I32,
    shift: int,
    poses: F32,
    angles: NDArray[np.float64],
    total: NDArray[np.float64],
) -> tuple[int, float]:
    """Poses of one joint's neighbours, angles to them and their summed velocity; count, speeds."""
    last = plane.shape[1] - 1
    count, speed = 0, 0.0
    velocity = np.empty(3)
    total[:] = 0.0
    for j in found:
        if j < 0:
            continue
        at = j + shift
        poses[count] = plane[:, at]
        angles[count] = _between(pose, poses[count])
        speed += _velocity(plane[:, max(at - 1, 0)], plane[:, min(at + 1, last)], velocity)
        total += velocity
        count += 1
    return count, speed


@nb.njit(nogil=True, cache=True)
def residuals(
    source: F32,
    planes: F32,
    limb: I64,
    centre_of: I64,
    centres: I64,
    found: I32,
    distance: F32,
    out: F32,
) -> None:
    """Residuals of every joint and frame to its neighbours.

    Parameters
    ----------
    source, planes, limb, centre_of, centres, found, distance
        As in `match_windows`; `centre_of` (S,) tells which centre each source frame goes by.
    out
        (S, m, RESIDUALS), overwritten, degrees: 0 smallest and 1 median angle to a neighbour, 2
        angle to their mean, 3 mean angle of the neighbours to their mean, 4 and 5 distance of the
        nearest and of the farthest neighbour, 6 difference of velocity to the neighbours' mean
        velocity and 7 own speed less theirs (degrees a frame), 8 how many neighbours.
    """
    keep, frames = found.shape[2], source.shape[0]
    poses, mean = np.empty((keep, 4), np.float32), np.empty(4, np.float32)
    angles, step, total = np.empty(keep), np.empty(3), np.empty(3)
    for t in range(frames):
        c = centre_of[t]
        shift = t - centres[c]
        for k in range(source.shape[1]):
            part, row = limb[k], out[t, k]
            count, speed = _gather(
                source[t, k], planes[k], found[c, part], shift, poses, angles, total
            )
            if count == 0:
                row[:] = np.nan
                row[8] = 0.0
                continue
            _mean_of(poses, count, source[t, k], mean)
            spread = 0.0
            for n in range(count):
                spread += _between(mean, poses[n])
            mine = _velocity(source[max(t - 1, 0), k], source[min(t + 1, frames - 1), k], step)
            step -= total / count
            ranked = np.sort(angles[:count])
            row[0], row[1] = ranked[0], ranked[count // 2]
            row[2], row[3] = _between(source[t, k], mean), spread / count
            row[4], row[5] = distance[c, part, 0], distance[c, part, count - 1]
            row[6] = np.sqrt(step[0] ** 2 + step[1] ** 2 + step[2] ** 2)
            row[7] = mine - speed / count
            row[8] = count


@nb.njit(nogil=True, cache=True, fastmath=True)
def nearest_rotations(source: F32, planes: F32, mate: I64, span: I64, out: F32) -> None:
    """Angle to the nearest rotation of a span of the corpus, joint by joint.

    Parameters
    ----------
    source
        (S, m, 4) quaternions.
    planes
        (m, 4, T).
    mate
        (m,) the joint that is looked at together with each.
    span
        (3,) half-open span of the corpus, and how many frames from the source's own place in it
        a frame must keep; negative where the source is not in it.
    out
        (S, m, 2), overwritten, degrees: the joint alone, and the root of the summed squares of
        joint and mate (by the chord); NaN where no frame is left.
    """
    begin, end, apart = span[0], span[1], span[2]
    for k in range(source.shape[1]):
        g = mate[k]
        tx, ty, tz, tw = planes[k, 0], planes[k, 1], planes[k, 2], planes[k, 3]
        ux, uy, uz, uw = planes[g, 0], planes[g, 1], planes[g, 2], planes[g, 3]
        for t in range(source.shape[0]):
            x, y, z, w = source[t, k, 0], source[t, k, 1], source[t, k, 2], source[t, k, 3]
            a, b, c, d = source[t, g, 0], source[t, g, 1], source[t, g, 2], source[t, g, 3]
            alone, pair = _FOUR, _FOUR
            for j in range(begin, end):
                if apart >= 0 and abs(j - begin - t) <= apart:
                    continue
                one = _ONE - abs(x * tx[j] + y * ty[j] + z * tz[j] + w * tw[j])
                other = _ONE - abs(a * ux[j] + b * uy[j] + c * uz[j] + d * uw[j])
                alone = min(alone, one)
                pair = min(pair, one + other)
            if alone == _FOUR:
                out[t, k, :] = np.nan
                continue
            out[t, k, 0] = 2.0 * np.arccos(min(_ONE - alone, _ONE)) * _DEGREES
            out[t, k, 1] = np.sqrt(_FOUR * _TWO * max(pair, np.float32(0.0))) * _DEGREES


@nb.njit(nogil=True, cache=True)
def add_trees(
    rows: F32,
    roots: I32,
    feature: I32,
    threshold: F32,
    left: I32,
    right: I32,
    missing_left: U8,
    value: F32,
    odds: F32,
) -> None:
    """Add the leaf values of all trees to `odds` (n,), for rows (n, f); see `forest.Forest`."""
    for r in range(rows.shape[0]):
        row = rows[r]
        total = np.float32(0.0)
        for root in roots:
            node = root
            while feature[node] >= 0:
                x = row[feature[node]]
                goes_left = missing_left[node] != 0 if np.isnan(x) else x <= threshold[node]
                node = left[node] if goes_left else right[node]
            total += value[node]
        odds[r] += total
