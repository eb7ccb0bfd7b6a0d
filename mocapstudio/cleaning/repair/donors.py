"""Motion of one neighbour in the place of what is flagged (paper 1, section 4).

The donor follows the warping path to the flagged span, is shifted to meet both flanks, and
smoothed at the seams by a quadratic Savitzky-Golay filter.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.model import Neighbour
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import split_heading
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

F64 = NDArray[np.float64]

_SAMPLES = 12
_STEP_SECONDS = 1 / 24


def medoid(analysis: Analysis, near: Sequence[Neighbour], joints: Sequence[str]) -> Neighbour:
    """Return the neighbour whose motion of the joints is closest to all others': a real motion."""
    if len(near) < 3:
        return near[0]
    motions = np.stack(
        [
            sample_rotations(
                take_of(analysis, one), joints, np.linspace(one.start, one.end - 1, _SAMPLES)
            )
            for one in near
        ]
    )
    apart = rot.angle(motions[:, None], motions[None]).mean(axis=(2, 3))
    return near[int(np.argmin(apart.sum(axis=1)))]


def take_of(analysis: Analysis, neighbour: Neighbour) -> Take:
    """Return the take that a neighbour lies in."""
    return analysis.take if neighbour.index == 0 else analysis.context[neighbour.index - 1]


def sample_rotations(take: Take, joints: Sequence[str], at: F64) -> F64:
    """(n, m, 4) local rotations at fractional frames, held at the take's ends.

    Of the hips without their heading, as in the motion-texture.
    """
    q = take.rotations[:, [take.skeleton.index[name] for name in joints]]
    hips = take.skeleton.names[topology(take.skeleton).hips]
    if hips in joints:
        q = q.copy()
        q[:, list(joints).index(hips)] = split_heading(take)[1]
    at = np.clip(at, 0, len(q) - 1)
    low = np.minimum(at.astype(np.int64), max(len(q) - 2, 0))
    high = np.minimum(low + 1, len(q) - 1)
    return rot.slerp(q[low], q[high], (at - low)[:, None])


def aligned(
    analysis: Analysis, donor: Neighbour, flagged: tuple[int, int], wrong: set[str]
) -> tuple[F64, F64]:
    """Frames of the donor that match frames of the take, along the warping path.

    Parameters
    ----------
    donor
        The neighbour.
    flagged
        The span it is a neighbour of.
    wrong
        Joints that are not compared.

    Returns
    -------
    frames, matched
        (n,) increasing frames of the take, and (n,) the donor's frames there, both with fractions.
    """
    take, other = analysis.take, take_of(analysis, donor)
    right = [name for name in analysis.texture.joints if name not in wrong]
    n = max(2, round((flagged[1] - flagged[0]) / float(take.rate) / _STEP_SECONDS) + 1)
    m = max(2, round((donor.end - donor.start) / float(other.rate) / _STEP_SECONDS) + 1)
    frames = np.linspace(flagged[0], flagged[1] - 1, n)
    there = np.linspace(donor.start, donor.end - 1, m)
    straight = np.interp(np.arange(n), [0, n - 1], [donor.start, donor.end - 1])
    if not right or n < 4 or m < 4:
        return frames, straight
    a, b = sample_rotations(take, right, frames), sample_rotations(other, right, there)
    apart = np.sum(rot.angle(a[:, None], b[None]) ** 2, axis=-1)
    matched = _path(apart)
    # The path's stairs, a frame high, would be jerks: they are smoothed over a quarter second.
    half = min(3, (n - 1) // 2)
    padded = np.concatenate(
        [
            2 * matched[0] - matched[half:0:-1],
            matched,
            2 * matched[-1] - matched[-2 : -half - 2 : -1],
        ]
    )
    smooth = np.convolve(padded, np.ones(2 * half + 1) / (2 * half + 1), mode="valid")
    return frames, np.interp(smooth, np.arange(m), there)


def _path(apart: F64) -> F64:
    """(n,) mean matched column of every row on the cheapest path from corner to corner."""
    n, m = apart.shape
    cost = np.full((n + 1, m + 1), np.inf)
    cost[0, 0] = 0.0
    for i in range(n):
        for j in range(m):
            before = min(cost[i, j], cost[i, j + 1], cost[i + 1, j])
            cost[i + 1, j + 1] = apart[i, j] + before
    total, count = np.zeros(n), np.zeros(n)
    i, j = n - 1, m - 1
    while i >= 0 and j >= 0:
        total[i] += j
        count[i] += 1
        step = int(np.argmin([cost[i, j], cost[i, j + 1], cost[i + 1, j]]))
        i, j = i - (step != 2), j - (step != 1)
    return np.asarray(total / np.maximum(count, 1))
