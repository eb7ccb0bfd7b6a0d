"""Matching and residuals of the decision, slowly and by definition."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from scipy.spatial.transform import Rotation

HALF = 7
SATURATION = np.deg2rad(25.0) ** 2


def saturating(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """`c^2 / (c^2 + 25 deg^2)` of the chord c between (..., 4) and (..., 4), full angles."""
    chord = 8.0 * (1.0 - np.minimum(np.abs(np.sum(a * b, axis=-1)), 1.0))
    return chord / (chord + SATURATION)


def window_costs(
    source: np.ndarray, corpus: np.ndarray, centre: int, keep: np.ndarray
) -> np.ndarray:
    """(T,) mean saturating distance of 15 frames around `centre` over the joints `keep`."""
    costs = np.full(len(corpus), np.nan)
    mine = source[centre - HALF : centre + HALF + 1][:, keep]
    for at in range(HALF, len(corpus) - HALF):
        theirs = corpus[at - HALF : at + HALF + 1][:, keep]
        costs[at] = saturating(mine, theirs).mean()
    return costs


def smallest(costs: np.ndarray, usable: np.ndarray, count: int) -> list[int]:
    """Frames of the smallest local minima among usable ones, best first."""
    found = []
    for at in np.flatnonzero(usable):
        before = at > 0 and usable[at - 1] and costs[at - 1] <= costs[at]
        after = at + 1 < len(costs) and usable[at + 1] and costs[at + 1] < costs[at]
        if not before and not after:
            found.append(int(at))
    return sorted(found, key=lambda at: costs[at])[:count]


def match(
    source: np.ndarray,
    corpus: np.ndarray,
    centre: int,
    without: Iterable[int],
    usable: np.ndarray,
    own: tuple[int, int],
    apart: int,
    count: tuple[int, int],
) -> tuple[list[int], list[int], np.ndarray]:
    """Neighbours in the rest of the corpus and in the source itself, and the costs."""
    keep = np.setdiff1d(np.arange(source.shape[1]), list(without))
    costs = window_costs(source, corpus, centre, keep)
    inside = np.zeros(len(corpus), dtype=bool)
    inside[own[0] : own[1]] = True
    near = np.abs(np.arange(len(corpus)) - (own[0] + centre)) <= apart
    others = smallest(costs, usable & ~inside, count[0])
    itself = smallest(costs, usable & inside & ~near, count[1])
    return others, itself, costs


def angle(a: np.ndarray, b: np.ndarray) -> float:
    """Degrees between two rotations."""
    return float(np.rad2deg((Rotation.from_quat(a).inv() * Rotation.from_quat(b)).magnitude()))


def velocity(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """(3,) degrees a frame between two frames that lie two apart: sine for the small half angle."""
    vector = (Rotation.from_quat(before).inv() * Rotation.from_quat(after)).as_quat(canonical=True)
    return np.rad2deg(vector[:3])


def residual(
    source: np.ndarray, corpus: np.ndarray, t: int, k: int, places: list[int], shift: int
) -> list[float]:
    """Return columns 0 to 3, 6 and 7 of `kernels.residuals` for one frame and joint."""
    poses = np.array([corpus[j + shift, k] for j in places])
    last = len(corpus) - 1
    theirs = np.array(
        [
            velocity(corpus[max(j + shift - 1, 0), k], corpus[min(j + shift + 1, last), k])
            for j in places
        ]
    )
    mine = velocity(source[max(t - 1, 0), k], source[min(t + 1, len(source) - 1), k])
    angles = sorted(angle(source[t, k], pose) for pose in poses)
    signs = np.where(poses @ source[t, k] < 0, -1.0, 1.0)
    mean = np.sum(poses * signs[:, None], axis=0)
    mean /= np.linalg.norm(mean)
    return [
        angles[0],
        angles[len(angles) // 2],
        angle(source[t, k], mean),
        float(np.mean([angle(mean, pose) for pose in poses])),
        float(np.linalg.norm(mine - theirs.mean(axis=0))),
        float(np.linalg.norm(mine) - np.linalg.norm(theirs, axis=1).mean()),
    ]
