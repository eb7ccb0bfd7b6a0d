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

_CHUNK = 256
_ROWS = 4
_ZERO = np.float32(0.0)
_INF = np.float32(np.inf)


@nb.njit(nogil=True, cache=True, fastmath=True)
def distances(reference: F32, source: F32, out: F32) -> None:
    """Euclidean distances between poses.

    Differences are squared as they are: ``|x|^2 + |y|^2 - 2 x.y`` would be no faster here, and
    does not give 0 for equal poses in float32.

    Parameters
    ----------
    reference
        (R, D); D a multiple of 4.
    source
        (D, S).
    out
        (R, S), overwritten.
    """
    dims, frames = source.shape
    total = np.empty(_CHUNK, np.float32)
    for i in range(reference.shape[0]):
        for start in range(0, frames, _CHUNK):
            width = min(_CHUNK, frames - start)
            total[:] = _ZERO
            for d in range(0, dims, 4):
                a, b = reference[i, d], reference[i, d + 1]
                c, e = reference[i, d + 2], reference[i, d + 3]
                ya, yb = source[d, start:], source[d + 1, start:]
                yc, ye = source[d + 2, start:], source[d + 3, start:]
                for j in range(width):
                    da, db, dc, de = a - ya[j], b - yb[j], c - yc[j], e - ye[j]
                    total[j] += (da * da + db * db) + (dc * dc + de * de)
            row = out[i, start:]
            for j in range(width):
                row[j] = np.sqrt(total[j])


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
        e = e
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
def backtrack(m: F32, i: int, j: int, open_rows: bool, open_columns: bool, path: I32) -> int:
    """Walk the cheapest path back from cell (i, j); a diagonal step wins a tie.

    Parameters
    ----------
    m
        (R, S) accumulated distances.
    open_rows, open_columns
        Whether the path may begin at any row of the first column, or any column of the first row.
    path
        (at least R + S, 2), filled from its end backwards.

    Returns
    -------
    The index in `path` of the path's first pair.
    """
    at = path.shape[0] - 1
    path[at, 0], path[at, 1] = i, j
    while not ((i == 0 and (j == 0 or open_columns)) or (j == 0 and open_rows)):
        diagonal = m[i - 1, j - 1] if i > 0 and j > 0 else _INF
        up = m[i - 1, j] if i > 0 else _INF
        left = m[i, j - 1] if j > 0 else _INF
        if diagonal <= up and diagonal <= left:
            i, j = i - 1, j - 1
        elif up <= left:
            i -= 1
        else:
            j -= 1
        at -= 1
        path[at, 0], path[at, 1] = i, j
    return at
