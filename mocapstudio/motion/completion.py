"""Missing markers completed along bones: constant lengths, interpolated directions.

The data completion of the kata comparison (paper 4): the distance between two markers joined by a
bone stays the same, and the direction of the bone is interpolated over the gap.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.declared import Declared
from mocapstudio.motion.gap_fills import fill_rigid, fill_spline, fill_straight, straight
from mocapstudio.motion.gaps import Gap, completed, gaps
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.pose_fill import fill_from_poses
from mocapstudio.motion.rigidity import Distances, distances

Array = NDArray[np.float64]
Bones = Sequence[tuple[int, int]]

__all__ = [
    "complete",
    "fill_along_bones",
    "fill_from_poses",
    "fill_rigid",
    "fill_spline",
    "fill_straight",
]

# Bones of a marker that nobody drew: to so many of the markers most rigidly joined to it.
_NEIGHBOURS = 3


def fill_along_bones(
    take: MarkerTake, spans: Iterable[Declared] | None = None, bones: Bones | None = None
) -> MarkerTake:
    """Complete missing markers by constant bone lengths and interpolated directions (paper 4).

    At the edges of a gap length and direction of the bone are measured; between them it turns
    evenly, and what little the length differs is spread over the gap. At the take's ends, where
    one edge is absent, both are held. Several bones of a marker are averaged, the
    more rigid ones counting more. A neighbour that is missing too is completed first where its
    own neighbours allow it.

    Parameters
    ----------
    take
        The take.
    spans
        Markers and frames that may be filled; None for all.
    bones
        Pairs of marker indices; the take's by default. A marker without any is joined to those
        three that keep their distance to it best.

    Raises
    ------
    MocapError
        If a span names no marker of the take.
    """
    spans = None if spans is None else tuple(spans)
    measured = distances(take)
    joined = _joined(take, measured, take.bones if bones is None else bones)
    positions = take.positions.copy()
    waiting = gaps(take, spans)
    while waiting:
        still = [gap for gap in waiting if not _complete(positions, gap, joined, measured)]
        if len(still) == len(waiting):
            break
        waiting = still
    return completed(take, positions, spans)


def complete(take: MarkerTake, spans: Iterable[Declared] | None = None) -> MarkerTake:
    """Complete missing markers by what knows most about them.

    First from what other frames tell of such poses, then from the rigid body that a marker is
    fixed to, then along bones, at last by a spline: in the order of the errors that each leaves in
    gaps cut into whole takes. Markers that are never seen stay missing.

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
    for fill in (fill_from_poses, fill_rigid, fill_along_bones, fill_spline):
        if not gaps(take, spans):
            break
        take = fill(take, spans)
    return take


def _joined(take: MarkerTake, measured: Distances, bones: Bones) -> list[list[int]]:
    """Neighbours of each marker."""
    joined: list[list[int]] = [[] for _ in take.labels]
    for a, b in bones:
        joined[a].append(b)
        joined[b].append(a)
    return [
        known or [int(m) for m in measured.nearest(marker)[:_NEIGHBOURS]]
        for marker, known in enumerate(joined)
    ]


def _complete(positions: Array, gap: Gap, joined: list[list[int]], measured: Distances) -> bool:
    """Fill one gap in place; False where none of its neighbours is known throughout."""
    total, weights = np.zeros((gap.end - gap.start, 3)), 0.0
    if not gap.edges:
        return False
    frames = [*gap.edges, *range(gap.start, gap.end)]
    for other in joined[gap.marker]:
        spread = measured.spread[gap.marker, other]
        if np.isnan(positions[frames, other]).any() or not np.isfinite(spread):
            continue
        weight = 1.0 / (spread + 1e-3) ** 2
        total += weight * _along(positions, gap, other)
        weights += weight
    if weights == 0.0:
        return False
    positions[gap.span, gap.marker] = total / weights
    return True


def _along(positions: Array, gap: Gap, other: int) -> Array:
    """Places (end - start, 3) at the end of a bone that turns evenly between a gap's edges."""
    bone = positions[gap.edges, gap.marker] - positions[gap.edges, other]
    lengths = np.linalg.norm(bone, axis=1, keepdims=True)
    directions = bone / np.maximum(lengths, 1e-12)
    turned = straight(gap, lengths) * _turning(gap, directions)
    return np.asarray(positions[gap.span, other] + turned)


def _turning(gap: Gap, directions: Array) -> Array:
    """Unit vectors (end - start, 3) on the great circle between those at a gap's edges."""
    first, last = directions[0], directions[-1]
    angle = float(np.arccos(np.clip(first @ last, -1.0, 1.0)))
    along = (np.arange(gap.start, gap.end) - gap.start + 1)[:, None] / (gap.end - gap.start + 1)
    if angle < 1e-6:
        return np.repeat(first[None], gap.end - gap.start, axis=0)
    if np.pi - angle < 1e-6:
        # Opposite directions leave the circle open: any that is at right angles will do.
        aside = np.cross(first, np.eye(3)[int(np.argmin(np.abs(first)))])
        aside /= np.linalg.norm(aside)
        return np.asarray(np.cos(along * angle) * first + np.sin(along * angle) * aside)
    return np.asarray(
        (np.sin((1 - along) * angle) * first + np.sin(along * angle) * last) / np.sin(angle)
    )
