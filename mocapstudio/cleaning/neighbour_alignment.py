"""How a neighbour answers to the flagged span, frame by frame: the path behind its distance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.distance_profile import DistanceProfile, pose_distances
from mocapstudio.cleaning.model import Flag
from mocapstudio.motion.errors import MocapError

F32 = NDArray[np.float32]
Cell = tuple[int, int]

_WAYS: tuple[tuple[int, int, tuple[Cell, ...]], ...] = (
    (1, 1, ()),
    (1, 2, ((0, 0),)),
    (1, 3, ((0, 0), (0, -1))),
    (2, 1, ((0, 0),)),
    (3, 1, ((0, 0), (-1, 0))),
)
"""How far back the last diagonal step arrived before one into a cell, and the straight cells that
lie between, as seen from the cell that the step leaves."""


@dataclass(frozen=True, eq=False)
class NeighbourAlignment:
    """The flagged span with its margins against one neighbour, N by M frames at 24 fps.

    Parameters
    ----------
    distances
        (N, M) root mean square joint angle, degrees, over the joints that were compared.
    accumulated
        (N, M) cheapest sum of distances up to a pair, as the constrained paths of the paper allow;
        infinite where none leads.
    path
        (P, 2) pairs of the path, ascending.
    flagged
        Half-open span of the N frames that is flagged.
    own, theirs
        Frames of the take and of the neighbour's take at which the first of the N and of the M
        lies, and how many of those each is long.
    take
        Name of the neighbour's take.
    rates
        Frames a second of the take and of the neighbour's.
    """

    distances: F32
    accumulated: F32
    path: NDArray[np.int32]
    flagged: tuple[int, int]
    own: tuple[float, float]
    theirs: tuple[float, float]
    take: str
    rates: tuple[float, float]


def neighbour_alignment(
    analysis: Analysis, flag: Flag, profile: DistanceProfile, which: int
) -> NeighbourAlignment:
    """Align a flag's neighbour with the flagged span as its distance was measured.

    Parameters
    ----------
    profile
        Of that flag.
    which
        Position of the neighbour among the profile's minima.

    Raises
    ------
    MocapError
        If there is no such neighbour.
    """
    if not 0 <= which < len(profile.minima):
        raise MocapError(f"the flag has no neighbour {which + 1}")
    at, window = int(profile.minima[which]), profile.window
    squared = pose_distances(analysis, flag, window, at, at + window.longest)
    accumulated = arrivals(squared)
    rows, columns = (int(count) for count in profile.ends[:, at])
    path = traced(squared, accumulated, (rows - 1, columns - 1))
    index, first = analysis.corpus.locate(at)
    mine, other = analysis.texture, analysis.corpus.textures[index]
    take = analysis.take if index == 0 else analysis.context[index - 1]
    compared = max(1, len(mine.joints) - len(flag.joints))
    return NeighbourAlignment(
        np.rad2deg(2.0 * np.sqrt(squared / compared)).astype(np.float32),
        accumulated,
        path,
        (window.start - window.low, window.end - window.low),
        (mine.frame(window.low), mine.frames_each),
        (other.frame(first), other.frames_each),
        take.name,
        (float(analysis.take.rate), float(take.rate)),
    )


def arrivals(distances: F32) -> F32:
    """(N, M) cheapest way from the first pair to each that arrives by a diagonal step (appendix).

    Between two diagonal steps lie at most two steps along one of the words.
    """
    rows, columns = distances.shape
    cost = np.full(distances.shape, np.inf, np.float32)
    cost[0, 0] = distances[0, 0]
    # Straight cells are passed before the diagonal step into (i, j): their costs, shifted.
    for i in range(1, rows):
        best = np.full(columns, np.inf, np.float32)
        for up, left, between in _WAYS:
            if up > i or left >= columns:
                continue
            way = cost[i - up, : columns - left].copy()
            for down, right in between:
                row = distances[i - 1 + down]
                way += row[left - 1 + right : columns - 1 + right]
            best[left:] = np.minimum(best[left:], way)
        cost[i] = best + distances[i]
    return cost


def traced(distances: F32, arrived: F32, end: Cell) -> NDArray[np.int32]:
    """(P, 2) the cheapest path from the first pair to `end`.

    Parameters
    ----------
    arrived
        As `arrivals` gives it.
    """
    found = _last_steps(distances, arrived, end)
    i, j = found[-1]
    while (i, j) != (0, 0):
        options = []
        for up, left, between in _WAYS:
            if up <= i and left <= j:
                cells = [(i - 1 + down, j - 1 + right) for down, right in between]
                cost = arrived[i - up, j - left] + sum(float(distances[c]) for c in cells)
                options.append((float(cost), [*cells, (i - up, j - left)]))
        # Nothing leads to a cell that no path of the constrained kind can reach.
        cells = min(options, key=lambda one: one[0])[1] if options else [(0, 0)]
        found += cells
        i, j = found[-1]
    return np.array(found[::-1], dtype=np.int32)


def _last_steps(distances: F32, arrived: F32, end: Cell) -> list[Cell]:
    """Cells from `end` back to the last diagonal step, at most two along one of the words."""
    best, cells = float(arrived[end]), [end]
    for down, right in ((0, 1), (1, 0)):
        # A path that came along an edge would have ended there.
        if (end[0] == len(distances) - 1 and right) or (end[1] == distances.shape[1] - 1 and down):
            continue
        way, cost = [end], 0.0
        for steps in (1, 2):
            cell = end[0] - steps * down, end[1] - steps * right
            if min(cell) < 0:
                break
            cost += float(distances[way[-1]])
            way = [*way, cell]
            if float(arrived[cell]) + cost < best:
                best, cells = float(arrived[cell]) + cost, way
    return cells
