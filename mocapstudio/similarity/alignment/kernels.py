"""Numba kernels of dynamic time warping (paper 4, algorithm 1): distances, recurrence, path.

Serial and `nogil` over blocks of rows, so that `similarity.parallel` can run several blocks at
once. Rows are reference frames, columns source frames. All arrays are contiguous float32.
"""

from __future__ import annotations

import numba as nb
import numpy as np
from numpy.typing import NDArray

F32 = NDArray[np.float32]
I32 = NDArray[np.int32]
U8 = NDArray[np.uint8]

DIAGONAL, UP, LEFT = 0, 1, 2
"""Steps of a path: from the pair before in both, in the reference alone, in the source alone."""

CHUNK = 256
"""Source frames that `distances` takes at a time."""
DIMENSIONS = 4
"""Dimensions that it takes at a time."""

_ROWS = 4
_ZERO = np.float32(0.0)
_INF = np.float32(np.inf)


@nb.njit(nogil=True, cache=True, fastmath=True)
def _squares(w: np.float32, x: np.float32, y: np.float32, z: np.float32) -> np.float32:
    return w * w + x * x + y * y + z * z


@nb.njit(nogil=True, cache=True, fastmath=True)
def distances(reference: F32, source: F32, out: F32) -> None:
    """Euclidean distances between poses, four reference frames at a time.

    Differences are squared as they are: ``|x|^2 + |y|^2 - 2 x.y`` does not give 0 for equal poses
    in float32. Loops over a whole chunk of source frames, of a length that is known beforehand,
    are what makes it fast.

    Parameters
    ----------
    reference
        (R, D); D a multiple of `DIMENSIONS`.
    source
        (chunks, D, CHUNK): source frames in chunks, the last filled up with anything.
    out
        (R, S), overwritten.
    """
    rows, frames, dims = reference.shape[0], out.shape[1], source.shape[1]
    total = np.empty((_ROWS, CHUNK), np.float32)
    for c in range(source.shape[0]):
        start, chunk = c * CHUNK, source[c]
        width = min(CHUNK, frames - start)
        for i in range(0, rows, _ROWS):
            i1, i2, i3 = min(i + 1, rows - 1), min(i + 2, rows - 1), min(i + 3, rows - 1)
            total[:] = _ZERO
            for d in range(0, dims, DIMENSIONS):
                w0, x0 = reference[i, d], reference[i, d + 1]
                y0, z0 = reference[i, d + 2], reference[i, d + 3]
                w1, x1 = reference[i1, d], reference[i1, d + 1]
                y1, z1 = reference[i1, d + 2], reference[i1, d + 3]
                w2, x2 = reference[i2, d], reference[i2, d + 1]
                y2, z2 = reference[i2, d + 2], reference[i2, d + 3]
                w3, x3 = reference[i3, d], reference[i3, d + 1]
                y3, z3 = reference[i3, d + 2], reference[i3, d + 3]
                for j in range(CHUNK):
                    p, q = chunk[d, j], chunk[d + 1, j]
                    r, s = chunk[d + 2, j], chunk[d + 3, j]
                    total[0, j] += _squares(w0 - p, x0 - q, y0 - r, z0 - s)
                    total[1, j] += _squares(w1 - p, x1 - q, y1 - r, z1 - s)
                    total[2, j] += _squares(w2 - p, x2 - q, y2 - r, z2 - s)
                    total[3, j] += _squares(w3 - p, x3 - q, y3 - r, z3 - s)
            for j in range(width):
                out[i, start + j] = np.sqrt(total[0, j])
                out[i1, start + j] = np.sqrt(total[1, j])
                out[i2, start + j] = np.sqrt(total[2, j])
                out[i3, start + j] = np.sqrt(total[3, j])


@nb.njit(nogil=True, cache=True, fastmath=True)
def distances_within(reference: F32, source: F32, low: I32, out: F32) -> None:
    """Euclidean distances between poses inside a band.

    Parameters
    ----------
    reference
        (R, D).
    source
        (D, S).
    low
        (R,) first source frame of each row of the band; may be negative.
    out
        (R, W), overwritten: columns are source frames from ``low`` on, infinite outside 0..S.
    """
    dims, frames = source.shape
    for i in range(reference.shape[0]):
        row, first = out[i], max(low[i], 0)
        row[:] = _INF
        width = min(frames, low[i] + row.shape[0]) - first
        if width <= 0:
            continue
        inside = row[first - low[i] :]
        inside[:width] = _ZERO
        for d in range(dims):
            a, y = reference[i, d], source[d, first:]
            for j in range(width):
                inside[j] += (a - y[j]) * (a - y[j])
        for j in range(width):
            inside[j] = np.sqrt(inside[j])


@nb.njit(nogil=True, cache=True, fastmath=True)
def pair_distances(reference: F32, source: F32, path: I32, out: F32) -> None:
    """Euclidean distances (P,) between the poses, (R, D) and (S, D), of a path's pairs (P, 2)."""
    for k in range(path.shape[0]):
        x, y = reference[path[k, 0]], source[path[k, 1]]
        total = _ZERO
        for d in range(x.shape[0]):
            total += (x[d] - y[d]) * (x[d] - y[d])
        out[k] = np.sqrt(total)


@nb.njit(nogil=True, cache=True)
def _one_row(now: F32, above: F32, corner: np.float32, edge: np.float32) -> None:
    left, diagonal = edge, corner
    for j in range(now.shape[0]):
        up = above[j]
        left = now[j] + min(left, min(diagonal, up))
        now[j] = left
        diagonal = up


@nb.njit(nogil=True, cache=True)
def _four_rows(m: F32, i: int, above: F32, corner: np.float32, edge: np.float32) -> None:
    """Fill rows i to i+3 side by side, each one column behind the one above.

    A cell waits for its left neighbour; four rows at once hide that.
    """
    n = m.shape[1]
    r0, r1, r2, r3 = m[i], m[i + 1], m[i + 2], m[i + 3]
    a = b = c = e = edge
    a1 = b1 = c1 = edge
    d0 = corner
    for s in range(3):
        if s >= 2:
            new = r2[s - 2] + min(c, min(b1, b))
            c1, c = c, new
            r2[s - 2] = new
        if s >= 1:
            new = r1[s - 1] + min(b, min(a1, a))
            b1, b = b, new
            r1[s - 1] = new
        up = above[s]
        new = r0[s] + min(a, min(d0, up))
        a1, a, d0 = a, new, up
        r0[s] = new
    for s in range(3, n):
        up = above[s]
        e = r3[s - 3] + min(e, min(c1, c))
        c1 = c
        c = r2[s - 2] + min(c, min(b1, b))
        b1 = b
        b = r1[s - 1] + min(b, min(a1, a))
        a1 = a
        a = r0[s] + min(a, min(d0, up))
        d0 = up
        r3[s - 3], r2[s - 2], r1[s - 1], r0[s] = e, c, b, a
    for s in range(n, n + 3):
        e = r3[s - 3] + min(e, min(c1, c))
        r3[s - 3] = e
        if s - 2 < n:
            c1 = c
            c = r2[s - 2] + min(c, min(b1, b))
            r2[s - 2] = c
        else:
            c1 = c
        if s - 1 < n:
            b1 = b
            b = r1[s - 1] + min(b, min(a1, a))
            r1[s - 1] = b
        else:
            b1 = b
        a1 = a


@nb.njit(nogil=True, cache=True)
def accumulate(m: F32, above: F32, corner: float, edge: float) -> None:
    """Turn distances into accumulated distances, in place (algorithm 1).

    Parameters
    ----------
    m
        (n, S) distances of a block of rows; overwritten with the accumulated ones.
    above
        (S,) accumulated distances of the row before the block.
    corner, edge
        What stands in the column before the first: in the row before the block, and in the
        block's own rows.
    """
    first, rows = np.float32(corner), m.shape[0]
    side = np.float32(edge)
    i = 0
    while i < rows:
        if rows - i >= _ROWS and m.shape[1] >= _ROWS:
            _four_rows(m, i, above, first, side)
            i += _ROWS
        else:
            _one_row(m[i], above, first, side)
            i += 1
        above, first = m[i - 1], side


@nb.njit(nogil=True, cache=True)
def _row_steps(
    now: F32, above: F32, corner: np.float32, edge: np.float32, shift: int, out: U8
) -> None:
    diagonal, up, left = np.uint8(DIAGONAL), np.uint8(UP << shift), np.uint8(LEFT << shift)
    first = left if above[0] > edge else up
    out[0] |= diagonal if corner <= min(above[0], edge) else first
    for j in range(1, now.shape[0]):
        a, b, c = above[j - 1], above[j], now[j - 1]
        straight = left if b > c else up
        out[j] |= diagonal if a <= min(b, c) else straight


@nb.njit(nogil=True, cache=True)
def steps(m: F32, above: F32, corner: float, edge: float, out: U8) -> None:
    """Tell by which step the cheapest path comes to each cell; a diagonal step wins a tie.

    Parameters
    ----------
    m
        (n, S) accumulated distances of a block of rows.
    above, corner, edge
        As in `accumulate`.
    out
        (ceil(n / 4), S) zeros; the steps are written into it, four rows to a byte.
    """
    before, side = np.float32(corner), np.float32(edge)
    for i in range(m.shape[0]):
        _row_steps(m[i], above, before, side, 2 * (i & 3), out[i >> 2])
        above, before = m[i], side


@nb.njit(nogil=True, cache=True)
def trace(steps: U8, i: int, j: int, open_rows: bool, open_columns: bool, path: I32) -> int:
    """Walk the cheapest path back from cell (i, j) along the steps that lead to it.

    Parameters
    ----------
    steps
        (ceil(R / 4), S) as `steps` writes them.
    open_rows, open_columns, path
        As in `backtrack`.

    Returns
    -------
    The index in `path` of the path's first pair.
    """
    at = len(path) - 1
    path[at, 0], path[at, 1] = i, j
    while not ((i == 0 and (j == 0 or open_columns)) or (j == 0 and open_rows)):
        step = (steps[i >> 2, j] >> np.uint8(2 * (i & 3))) & 3
        # At the borders there is but one way, whatever the costs.
        step = LEFT if i == 0 else (UP if j == 0 else step)
        i -= step != LEFT
        j -= step != UP
        at -= 1
        path[at, 0], path[at, 1] = i, j
    return at


@nb.njit(nogil=True, cache=True)
def accumulate_within(m: F32, low: I32, open_rows: bool, open_columns: bool) -> None:
    """Turn the distances of a band into accumulated distances, in place.

    Parameters
    ----------
    m
        (R, W) as `distances_within` fills it.
    low
        (R,) ascending.
    open_rows, open_columns
        Whether the path may begin at any row of the first column, or any column of the first row.
    """
    rows, width = m.shape
    for i in range(rows):
        shift = low[i] - low[i - 1] if i > 0 else 0
        left = _INF
        for k in range(width):
            j = low[i] + k
            best = left
            if i > 0:
                if k + shift < width:
                    best = min(best, m[i - 1, k + shift])
                if 0 < k + shift <= width:
                    best = min(best, m[i - 1, k + shift - 1])
            if (i == 0 and (j == 0 or open_columns)) or (j == 0 and open_rows):
                best = _ZERO
            left = m[i, k] + best
            m[i, k] = left


@nb.njit(nogil=True, cache=True)
def backtrack(
    m: F32, low: I32, i: int, j: int, open_rows: bool, open_columns: bool, path: I32
) -> int:
    """Walk the cheapest path back from cell (i, j); a diagonal step wins a tie.

    Parameters
    ----------
    m
        (R, W) accumulated distances.
    low
        (R,) source frame at which each row of `m` begins; 0 where it is no band.
    open_rows, open_columns
        Whether the path may begin at any row of the first column, or any column of the first row.
    path
        (at least R + S, 2), filled from its end backwards.

    Returns
    -------
    The index in `path` of the path's first pair.
    """
    width, at = m.shape[1], len(path) - 1
    path[at, 0], path[at, 1] = i, j
    while not ((i == 0 and (j == 0 or open_columns)) or (j == 0 and open_rows)):
        diagonal, up, left = _INF, _INF, _INF
        if i > 0:
            k = j - low[i - 1]
            up = m[i - 1, k] if 0 <= k < width else _INF
            diagonal = m[i - 1, k - 1] if 0 < k <= width and j > 0 else _INF
        if j > 0 and j > low[i]:
            left = m[i, j - 1 - low[i]]
        if diagonal <= up and diagonal <= left:
            i, j = i - 1, j - 1
        elif up <= left:
            i -= 1
        else:
            j -= 1
        at -= 1
        path[at, 0], path[at, 1] = i, j
    return at
