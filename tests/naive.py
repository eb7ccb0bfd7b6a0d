"""Paper 1 word for word, slowly: oracles for the kernels, written from the equations alone.

Shapes follow the package: textures are (T, m, 4) quaternions, pose distances (N, T).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

STEPS = {"diagonal": (1, 1), "source": (1, 0), "target": (0, 1)}
MOST_IN_A_ROW = 2


def pose_distance(a: np.ndarray, b: np.ndarray, trim: int) -> float:
    """Equation 1 for two poses (m, 4), the `trim` largest joints left out: rad^2, half angles."""
    squares = []
    for qa, qb in zip(a.astype(float), b.astype(float), strict=True):
        half = np.arccos(min(1.0, abs(float(qa @ qb)) / np.linalg.norm(qa) / np.linalg.norm(qb)))
        squares.append(half**2)
    return sum(sorted(squares)[: len(squares) - trim])


def pose_distances(source: np.ndarray, target: np.ndarray, trim: int) -> np.ndarray:
    """(S, T) of textures (S, m, 4) and (T, m, 4)."""
    return np.array([[pose_distance(a, b, trim) for b in target] for a in source])


def paths(n: int, m: int) -> Iterator[list[tuple[int, int]]]:
    """Enumerate every admissible warping path of an n x m matrix (appendix of paper 1)."""

    def go_on(path: list[tuple[int, int]], last: str, run: int) -> Iterator[list[tuple[int, int]]]:
        i, j = path[-1]
        if i == n - 1 or j == m - 1:
            yield path
            return
        for name, (down, right) in STEPS.items():
            again = run + 1 if name == last else 1
            if name != "diagonal" and again > MOST_IN_A_ROW:
                continue
            yield from go_on([*path, (i + down, j + right)], name, again)

    yield from go_on([(0, 0)], "", 0)


class WarpingCosts:
    """Lowest cumulative cost of the admissible paths to every end, for many target words at once.

    Dynamic programming over (cell, last step and its run, length of the path); `cost[end]` is
    (L, W): of paths with so many pairs, for each of W target words.
    """

    def __init__(self, distances: np.ndarray, m: int) -> None:
        n, frames = distances.shape
        words = frames - m + 1
        longest = n + m
        states = [("diagonal", 0)]
        states += [(s, r) for s in ("source", "target") for r in range(1, MOST_IN_A_ROW + 1)]
        nowhere = np.full((longest + 1, words), np.inf)
        at: dict[tuple[int, int], dict[tuple[str, int], np.ndarray]] = {}
        first = nowhere.copy()
        first[1] = distances[0, :words]
        at[0, 0] = {("diagonal", 0): first}
        self.cost: dict[tuple[int, int], np.ndarray] = {}
        for i in range(n):
            for j in range(m):
                if (i, j) not in at:
                    continue
                if i == n - 1 or j == m - 1:
                    self.cost[i, j] = np.min(list(at[i, j].values()), axis=0)
                    continue
                for (last, run), cost in at[i, j].items():
                    for name, (down, right) in STEPS.items():
                        again = 0 if name == "diagonal" else run + 1 if name == last else 1
                        if again > MOST_IN_A_ROW:
                            continue
                        k, h = i + down, j + right
                        reached = nowhere.copy()
                        reached[1:] = cost[:-1] + distances[k, h : h + words]
                        cell = at.setdefault((k, h), {})
                        old = cell.get((name, again), nowhere)
                        cell[name, again] = np.minimum(old, reached)
        assert all(state in states for cell in at.values() for state in cell)

    def best(self) -> np.ndarray:
        """(W,) lowest cumulative cost of any path."""
        return np.min([cost.min(axis=0) for cost in self.cost.values()], axis=0)

    def means(self) -> tuple[np.ndarray, np.ndarray]:
        """(W,) mean cost a pair of the cheapest path; (2, W) source and target frames it covers.

        Where several paths are equally cheap, those of the shortest one.
        """
        words = self.best().shape[0]
        low, mean = np.full(words, np.inf), np.full(words, np.nan)
        ends = np.zeros((2, words), dtype=int)
        for (i, j), cost in self.cost.items():
            for length in range(1, len(cost)):
                better = cost[length] < low
                low = np.where(better, cost[length], low)
                mean = np.where(better, cost[length] / length, mean)
                ends = np.where(better, np.array([[i + 1], [j + 1]]), ends)
        return mean, ends


def minima(
    values: Sequence[float],
    breaks: Sequence[int],
    keep: int,
    barred: tuple[int, int],
    unusable: float = 1e29,
) -> list[int]:
    """The `keep` smallest local minima inside their segments, best first, earlier ones first.

    A flat bottom counts once, at its first frame; frames of `unusable` value bound it.
    """
    found = []
    edges = [*breaks, len(values)]
    for begin, end in pairwise(edges):
        for t in range(begin, end):
            here = values[t]
            if here >= unusable or barred[0] <= t < barred[1]:
                continue
            if t > begin and values[t - 1] <= here:
                continue
            after = t
            while after + 1 < end and values[after + 1] == here:
                after += 1
            if after + 1 < end and values[after + 1] < here:
                continue
            found.append(t)
    return sorted(found, key=lambda t: (values[t], t))[:keep]


def word_starts(frames: int, length: int, hop: int) -> list[int]:
    """First frames of the source words; the last one ends with the texture."""
    if frames < length:
        return []
    return sorted({*range(0, frames - length + 1, hop), frames - length})


def find_neighbours(
    source: np.ndarray,
    targets: Sequence[np.ndarray],
    keep: int,
    trim: int,
    lengths: tuple[int, int],
    word: int,
    own: bool,
) -> list[tuple[float, int, int, tuple[int, int]]]:
    """Neighbours of the word that starts at `word`: distance, target take, first frame, ends.

    `own` tells that the first target is the source itself: words whose centre is nearer than half
    a source word to the source word's centre are left out.
    """
    n, m = lengths
    found = []
    for which, target in enumerate(targets):
        if len(target) < m:
            continue
        costs = WarpingCosts(pose_distances(source[word : word + n], target, trim), m)
        mean, ends = costs.means()
        near = range(0)
        if own and which == 0:
            centre = word + n // 2 - m // 2
            near = range(centre - n // 2, centre + n // 2 + 1)
        found += [
            (float(mean[t]), which, t, (int(ends[0, t]), int(ends[1, t])))
            for t in minima(mean, [0], len(mean), (near.start, near.stop))
        ]
    return sorted(found)[:keep]


def resampled(values: np.ndarray, to: int) -> np.ndarray:
    """Resample (n, ...) to `to` samples, ends on ends, by a low-pass sinc of three lobes.

    The window is a squared cosine; beyond the ends the end values go on. When fewer samples are
    asked for than there are, the sinc widens in proportion, so that nothing folds over.
    """
    n = len(values)
    if n == 1:
        return np.repeat(values, to, axis=0)
    lobes = 3
    width = min(1.0, (to - 1) / (n - 1)) if to > 1 else 1.0
    pad = int(np.ceil(lobes / width)) + 2
    padded = np.concatenate([np.repeat(values[:1], pad, 0), values, np.repeat(values[-1:], pad, 0)])
    places = np.arange(-pad, n + pad)
    result = []
    for centre in np.linspace(0, n - 1, to):
        x = (places - centre) * width
        weight = np.where(np.abs(x) < lobes, np.sinc(x) * np.cos(np.pi * x / 2 / lobes) ** 2, 0.0)
        result.append(np.tensordot(weight / weight.sum(), padded, axes=1))
    return np.array(result)
