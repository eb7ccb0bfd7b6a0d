"""Gaps of markers filled from the marker itself, or from the body that it is fixed to."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.declared import Declared
from mocapstudio.motion.gaps import Gap, completed, gaps
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.rigidity import Distances, distances, fit_rigid

Array = NDArray[np.float64]

# Seconds on each side of a gap from which the velocity there is told.
_VELOCITY_FROM = 0.08
_FEWEST = 3
_COMPANIONS = 5
_BEGINNINGS = 6
# Of a distance, and metres: how far two markers of one body may move against each other.
_RIGID = (0.04, 0.012)
_TEMPLATE_FRAMES = 60


def fill_straight(take: MarkerTake, spans: Iterable[Declared] | None = None) -> MarkerTake:
    """Fill gaps by straight lines between the frames at their edges.

    Parameters
    ----------
    take
        The take.
    spans
        Markers and frames that may be filled; None for all. Gaps at the take's ends stay.

    Raises
    ------
    MocapError
        If a span names no marker of the take.
    """
    spans = None if spans is None else tuple(spans)
    positions = take.positions.copy()
    for gap in gaps(take, spans):
        if gap.inner:
            positions[gap.span, gap.marker] = straight(gap, take.positions[gap.edges, gap.marker])
    return completed(take, positions, spans)


def straight(gap: Gap, values: Array) -> Array:
    """Values (end - start, C) on the way between those at a gap's edges; held where there is one.

    Parameters
    ----------
    gap
        The gap.
    values
        (number of edges, C) at `gap.edges`.
    """
    if len(values) == 1:
        return np.repeat(values, gap.end - gap.start, axis=0)
    along = (np.arange(gap.start, gap.end) - gap.start + 1) / (gap.end - gap.start + 1)
    return np.asarray(values[0] + (values[1] - values[0]) * along[:, None])


def fill_spline(take: MarkerTake, spans: Iterable[Declared] | None = None) -> MarkerTake:
    """Fill gaps by cubics that keep place and velocity at both edges.

    The velocities come from parabolas through the last 0.08 s on each side, so that noise of one
    frame does not throw the curve off.

    Parameters
    ----------
    take, spans
        As in `fill_straight`.

    Raises
    ------
    MocapError
        If a span names no marker of the take.
    """
    spans = None if spans is None else tuple(spans)
    positions = take.positions.copy()
    window = max(_FEWEST, round(_VELOCITY_FROM * float(take.rate)))
    for gap in gaps(take, spans):
        if gap.inner:
            positions[gap.span, gap.marker] = _cubic(gap, take.positions[:, gap.marker], window)
    return completed(take, positions, spans)


def _cubic(gap: Gap, course: Array, window: int) -> Array:
    before, after = gap.start - 1, gap.end
    steps = after - before
    t = (np.arange(gap.start, gap.end) - before)[:, None] / steps
    leaving = _velocity(course, before, -1, window) * steps
    arriving = _velocity(course, after, 1, window) * steps
    return np.asarray(
        (2 * t**3 - 3 * t**2 + 1) * course[before]
        + (t**3 - 2 * t**2 + t) * leaving
        + (3 * t**2 - 2 * t**3) * course[after]
        + (t**3 - t**2) * arriving
    )


def _velocity(course: Array, at: int, step: int, window: int) -> Array:
    """Metres a frame at one side of a gap, from the frames before (-1) or after it (1)."""
    frames = [at]
    while len(frames) < window:
        further = frames[-1] + step
        if not 0 <= further < len(course) or np.isnan(course[further]).any():
            break
        frames.append(further)
    if len(frames) == 1:
        return np.zeros(3)
    times = np.array(frames, dtype=float) - at
    powers = np.stack([times, times**2][: min(2, len(frames) - 1)], axis=1)
    # The curve passes through the edge itself.
    slopes, *_ = np.linalg.lstsq(powers, course[frames] - course[at], rcond=None)
    return np.asarray(slopes[0])


def fill_rigid(take: MarkerTake, spans: Iterable[Declared] | None = None) -> MarkerTake:
    """Fill gaps from at least three markers on the same rigid body.

    The companions of a marker are those whose distances to it and to each other stay nearly the
    same. Their shape together with the marker is learnt from the frames around the gap, laid onto
    them in every frame of it, and shifted so that it meets the marker at the edges. Gaps of
    markers without three such companions stay, and so do frames in which fewer than three are
    seen.

    Parameters
    ----------
    take, spans
        As in `fill_straight`; gaps at the take's ends are filled too.

    Raises
    ------
    MocapError
        If a span names no marker of the take.
    """
    spans = None if spans is None else tuple(spans)
    measured = distances(take)
    positions = take.positions.copy()
    chosen: dict[int, list[int]] = {}
    for gap in gaps(take, spans):
        if gap.marker not in chosen:
            chosen[gap.marker] = companions(measured, gap.marker)
        others = chosen[gap.marker]
        if len(others) >= _FEWEST and gap.edges:
            placed = _placed(take, gap, others)
            if placed is not None:
                positions[gap.span, gap.marker] = placed
    return completed(take, positions, spans)


def companions(measured: Distances, marker: int) -> list[int]:
    """Up to five markers that keep their distance to a marker and to each other, best first."""
    near = [int(other) for other in measured.nearest(marker)]
    # The most rigid pair may be a bone between two bodies: others get to begin, too.
    groups = [_grown(measured, marker, first, near) for first in near[:_BEGINNINGS]]
    return max(groups, key=len, default=[])


def _grown(measured: Distances, marker: int, first: int, near: list[int]) -> list[int]:
    found: list[int] = []
    for other in [first, *(one for one in near if one != first)]:
        group = [marker, *found]
        allowed = np.minimum(_RIGID[0] * measured.length[other, group], _RIGID[1])
        if (measured.spread[other, group] <= allowed).all():
            found.append(other)
        if len(found) == _COMPANIONS:
            break
    return found


def _placed(take: MarkerTake, gap: Gap, others: list[int]) -> Array | None:
    """Where the body puts the marker in the gap (end - start, 3); NaN where it cannot tell."""
    body = [*others, gap.marker]
    whole = np.flatnonzero(~take.missing[:, body].any(axis=1))
    if not len(whole):
        return None
    middle = (gap.start + gap.end) / 2
    near = np.sort(whole[np.argsort(np.abs(whole - middle), kind="stable")[:_TEMPLATE_FRAMES]])
    shape = _shape(take.positions[near][:, body])
    frames = np.array([*gap.edges, *range(gap.start, gap.end)])
    rotations, shifts = fit_rigid(shape[:-1], take.positions[frames][:, others])
    placed: Array = np.einsum("fij,j->fi", rotations, shape[-1]) + shifts
    edges = len(gap.edges)
    off = take.positions[gap.edges, gap.marker] - placed[:edges]
    known = ~np.isnan(off).any(axis=1)
    if not known.any():
        return None
    off[~known] = off[known][0]
    return np.asarray(placed[edges:] + straight(gap, off))


def _shape(seen: Array) -> Array:
    """Mean shape (P, 3) of a body seen whole in several frames (F, P, 3)."""
    shape: Array = seen[0]
    for _ in range(2):
        rotations, shifts = fit_rigid(shape, seen)
        good = ~np.isnan(rotations).any(axis=(1, 2))
        if not good.any():
            return shape
        back = np.einsum("fji,fpj->fpi", rotations[good], seen[good] - shifts[good][:, None])
        shape = back.mean(axis=0)
    return shape
