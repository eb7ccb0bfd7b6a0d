"""Gaps of markers filled from frames of like poses: where the marker was then, it is now."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.declared import Declared
from mocapstudio.motion.gap_fills import straight
from mocapstudio.motion.gaps import Gap, completed, gaps
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.rigidity import Distances, distances, fit_rigid

Array = NDArray[np.float64]

# The markers around one whose places tell its own, in the order of how rigidly they are joined.
_PREDICTORS = 8
_FEWEST_FRAMES = 40
_MOST_FRAMES = 1500
# Metres: noise that the regression does not follow.
_NOISE = 0.004


def fill_from_poses(take: MarkerTake, spans: Iterable[Declared] | None = None) -> MarkerTake:
    """Fill gaps by what other frames of the take say of the marker in such a pose.

    The markers most rigidly joined to it, seen throughout the gap, are laid onto each other over
    all frames in which the marker is seen; a ridge regression from their places to its own tells
    where it is in the gap. The result is shifted to meet the marker at the edges. It is akin to
    the gap filling by principal components of Federolf 2013, on the nearest markers instead of
    with weights by distance.

    Parameters
    ----------
    take
        The take.
    spans
        Markers and frames that may be filled; None for all.

    Raises
    ------
    MocapError
        If a span names no marker of the take.
    """
    spans = None if spans is None else tuple(spans)
    measured = distances(take)
    positions = take.positions.copy()
    for gap in gaps(take, spans):
        placed = _predicted(take, gap, measured) if gap.edges else None
        if placed is not None:
            positions[gap.span, gap.marker] = placed
    return completed(take, positions, spans)


def _predicted(take: MarkerTake, gap: Gap, measured: Distances) -> Array | None:
    """Places in the gap (end - start, 3), or None where too little is known."""
    asked = np.array([*gap.edges, *range(gap.start, gap.end)])
    seen = ~take.missing[asked].any(axis=0)
    others = [int(m) for m in measured.nearest(gap.marker) if seen[m]][:_PREDICTORS]
    if len(others) < 3:
        return None
    known = np.flatnonzero(~take.missing[:, [*others, gap.marker]].any(axis=1))
    if len(known) < _FEWEST_FRAMES:
        return None
    if len(known) > _MOST_FRAMES:
        known = known[np.linspace(0, len(known) - 1, _MOST_FRAMES).astype(int)]
    template = take.positions[known[np.argmin(np.abs(known - gap.start))]][others]
    learnt, asking = take.positions[known], take.positions[asked]
    turn, shift = fit_rigid(template, learnt[:, others])
    turn_asked, shift_asked = fit_rigid(template, asking[:, others])
    if np.isnan(turn_asked).any():
        return None
    good = ~np.isnan(turn).any(axis=(1, 2))
    inputs = _within(learnt[good][:, others], turn[good], shift[good])
    target = _within(learnt[good][:, [gap.marker]], turn[good], shift[good])
    local = _regressed(inputs, target, _within(asking[:, others], turn_asked, shift_asked))
    placed = np.einsum("fij,fj->fi", turn_asked, local) + shift_asked
    edges = len(gap.edges)
    off = take.positions[gap.edges, gap.marker] - placed[:edges]
    return np.asarray(placed[edges:] + straight(gap, off))


def _within(points: Array, turn: Array, shift: Array) -> Array:
    """Points (F, P, 3) as seen from a body; flat, (F, 3 P)."""
    local: Array = np.einsum("fji,fpj->fpi", turn, points - shift[:, None])
    return local.reshape(len(points), -1)


def _regressed(inputs: Array, target: Array, asked: Array) -> Array:
    """Predict targets (A, 3) from asked inputs (A, C) by ridge regression on (F, C) and (F, 3)."""
    middle, level = inputs.mean(axis=0), target.mean(axis=0)
    centred = inputs - middle
    gram = centred.T @ centred + len(centred) * _NOISE**2 * np.eye(centred.shape[1])
    return np.asarray(
        level + (asked - middle) @ np.linalg.solve(gram, centred.T @ (target - level))
    )
