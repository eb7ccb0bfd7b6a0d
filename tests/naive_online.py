"""Open-end time warping written from the equations of paper 3, cell by cell."""

from __future__ import annotations

from fractions import Fraction

import numpy as np


def pose_distance(a: np.ndarray, b: np.ndarray, weights: np.ndarray) -> float:
    """Equation 4 on two poses (D, 4) of unit quaternions."""
    return sum(
        float(w) * (1.0 - abs(float(np.dot(p, q)))) for w, p, q in zip(weights, a, b, strict=True)
    )


def matrices(costs: np.ndarray, variant: str) -> tuple[list, list, list]:
    """Accumulated costs, path lengths and traced-back predecessors of a whole matrix of costs.

    Rows are input frames, columns reference frames; exact numbers; `variant` is `plain`
    (equation 2), `diagonal` (the same, diagonal steps counting double) or `length` (equation 3).
    """
    rows, columns = costs.shape
    total = [[Fraction(0)] * columns for _ in range(rows)]
    length = [[0] * columns for _ in range(rows)]
    before = [[None] * columns for _ in range(rows)]
    for i in range(rows):
        for j in range(columns):
            cost = Fraction(float(costs[i, j]))
            options = []
            for k, m in ((i - 1, j - 1), (i - 1, j), (i, j - 1)):
                if k < 0 or m < 0:
                    continue
                factor = 2 if variant == "diagonal" and (k, m) == (i - 1, j - 1) else 1
                reached, steps = total[k][m] + factor * cost, length[k][m] + 1
                chosen_by = reached / steps if variant == "length" else reached
                mean = total[k][m] / length[k][m] if variant == "length" else chosen_by
                options.append((chosen_by, mean, reached, steps, (k, m)))
            if not options:
                total[i][j], length[i][j] = cost, 1
                continue
            chosen = min(options, key=lambda option: option[0])
            total[i][j], length[i][j] = chosen[2], chosen[3]
            before[i][j] = min(options, key=lambda option: option[1])[4]
    return total, length, before


def open_end(total: list) -> int:
    """The reference frame of the last row with the smallest accumulated cost."""
    row = total[-1]
    return row.index(min(row))


def path(before: list, end: int) -> list[tuple[int, int]]:
    """Pairs of reference and input frame, from the beginning to (last row, `end`)."""
    cell = (len(before) - 1, end)
    pairs = [cell]
    while before[cell[0]][cell[1]] is not None:
        cell = before[cell[0]][cell[1]]
        pairs.append(cell)
    return [(j, i) for i, j in reversed(pairs)]
