"""Dynamic time warping written from its definition, over full matrices; slow on purpose."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np


def distances(reference: np.ndarray, source: np.ndarray) -> np.ndarray:
    """(R, S) Euclidean distances in double precision."""
    gaps = reference[:, None].astype(float) - source[None].astype(float)
    return np.sqrt((gaps**2).sum(axis=2))


def accumulated(
    costs: np.ndarray,
    open_rows: bool = False,
    open_columns: bool = False,
    allowed: np.ndarray | None = None,
) -> np.ndarray:
    """Algorithm 1 of paper 4, with free beginnings and forbidden cells."""
    rows, columns = costs.shape
    m = np.full((rows, columns), np.inf)
    for i in range(rows):
        for j in range(columns):
            if allowed is not None and not allowed[i, j]:
                continue
            before = [
                m[a, b] for a, b in ((i - 1, j - 1), (i - 1, j), (i, j - 1)) if a >= 0 and b >= 0
            ]
            begins = (i == 0 and j == 0) or (open_rows and j == 0) or (open_columns and i == 0)
            m[i, j] = costs[i, j] + (0.0 if begins else min(before))
    return m


def cheapest(
    costs: np.ndarray,
    begin: str | None = None,
    end: str | None = None,
    allowed: np.ndarray | None = None,
) -> float:
    """Cost of the cheapest path."""
    m = accumulated(costs, begin == "reference", begin == "source", allowed)
    if end == "reference":
        return float(m[:, -1].min())
    return float(m[-1].min() if end == "source" else m[-1, -1])


def path(costs: np.ndarray, begin: str | None = None, end: str | None = None) -> list[list[int]]:
    """Return the cheapest path; a diagonal step wins a tie, then one in the reference."""
    m = accumulated(costs, begin == "reference", begin == "source")
    i, j = costs.shape[0] - 1, costs.shape[1] - 1
    if end == "reference":
        i = int(np.argmin(m[:, -1]))
    elif end == "source":
        j = int(np.argmin(m[-1]))
    found = [[i, j]]
    while not ((i == 0 and (j == 0 or begin == "source")) or (j == 0 and begin == "reference")):
        steps = [(i - 1, j - 1), (i - 1, j), (i, j - 1)]
        i, j = min((s for s in steps if min(s) >= 0), key=lambda step: m[step])
        found.append([i, j])
    return found[::-1]


def paths(rows: int, columns: int) -> Iterator[list[tuple[int, int]]]:
    """Every path from the first cell to the last, in steps of (1, 1), (1, 0) and (0, 1)."""

    def go_on(path: list[tuple[int, int]]) -> Iterator[list[tuple[int, int]]]:
        i, j = path[-1]
        if (i, j) == (rows - 1, columns - 1):
            yield path
            return
        for a, b in ((i + 1, j + 1), (i + 1, j), (i, j + 1)):
            if a < rows and b < columns:
                yield from go_on([*path, (a, b)])

    yield from go_on([(0, 0)])
