"""Aligning two sequences of poses, with what differs all the time left out of it."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison.normalisation import Poses
from mocapstudio.comparison.parameters import ComparisonParameters
from mocapstudio.motion.progress import Progress, scaled
from mocapstudio.similarity.alignment.costs import Costs, PoseDistances, ReliableDistances
from mocapstudio.similarity.alignment.dtw import (
    Alignment,
    Ends,
    Path,
    align_in_band,
    aligning,
)
from mocapstudio.similarity.alignment.frugal import aligning_frugally

Array = NDArray[np.float64]

_MOST_CELLS = 1_000_000_000
"""Pairs of frames whose steps are kept at once: 250 MB."""


@dataclass(frozen=True, eq=False)
class PoseAlignment:
    """Two sequences aligned.

    Parameters
    ----------
    alignment
        The path with the distances of its pairs of poses as they are.
    costs
        What it was found by: the distances without the constant difference.
    """

    alignment: Alignment
    costs: Costs


def align_poses(
    ours: Poses, theirs: Poses, chosen: ComparisonParameters, band: int | None = None
) -> Generator[Progress, None, PoseAlignment]:
    """Align poses of a source with those of a reference.

    A difference that lasts, such as a bent head or another stance, is no matter of timing, yet it
    drowns those that are: distances hardly vary, and the path keeps to the diagonal. So the
    alignment is first made between what departs from each take's mean pose, then once more with
    the median difference of the poses so matched taken out.

    Parameters
    ----------
    band
        Source frames that the path may be off the straight line, None for any.
    """
    plain = costs_of(ours, theirs)
    if not chosen.ignore_style:
        alignment = yield from _aligning(plain, chosen, band)
        return PoseAlignment(alignment, plain)
    offset = _mean(ours) - _mean(theirs)
    first = yield from scaled(
        _aligning(costs_of(ours, _moved(theirs, offset)), chosen, band), 0.0, 0.5
    )
    costs = costs_of(ours, _moved(theirs, _lasting(ours, theirs, first.path)))
    second = yield from scaled(_aligning(costs, chosen, band), 0.5, 1.0)
    return PoseAlignment(Alignment(second.path, plain.pairs(second.path)), costs)


def costs_of(ours: Poses, theirs: Poses) -> Costs:
    """Return what pairs of frames cost, by the rows that are reliable."""
    one, other = ours.points.astype(np.float32), theirs.points.astype(np.float32)
    if ours.reliable and theirs.reliable:
        return PoseDistances(one.reshape(len(one), -1), other.reshape(len(other), -1))
    return ReliableDistances(one, other, ours.weight, theirs.weight)


def _aligning(
    costs: Costs, chosen: ComparisonParameters, band: int | None
) -> Generator[Progress, None, Alignment]:
    if band is not None:
        yield Progress(0.0, "aligning")
        return align_in_band(costs, band)
    ends = Ends(chosen.open_begin, chosen.open_end)
    if costs.shape[0] * costs.shape[1] > _MOST_CELLS:
        return (yield from aligning_frugally(costs, ends))
    return (yield from aligning(costs, ends))


def _moved(poses: Poses, offset: Array) -> Poses:
    return replace(poses, points=poses.points + offset)


def _mean(poses: Poses) -> Array:
    """(N, C) mean of what is reliable."""
    weight = poses.weight[..., None]
    return np.asarray(np.sum(poses.points * weight, axis=0) / np.maximum(weight.sum(axis=0), 1e-9))


def _lasting(ours: Poses, theirs: Poses, path: Path) -> Array:
    """(N, C) median difference of matched poses, where both are reliable."""
    i, j = path.T
    away = ours.points[i] - theirs.points[j]
    known = (ours.weight[i] > 0) & (theirs.weight[j] > 0)
    if known.all():
        return np.asarray(np.median(away, axis=0))
    median = np.zeros(away.shape[1:])
    for row in np.flatnonzero(known.any(axis=0)):
        median[row] = np.median(away[known[:, row], row], axis=0)
    return median
