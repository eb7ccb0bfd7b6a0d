"""Segments of a performance: suggested from its rests, and carried over along the path."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison.kata import performance_of
from mocapstudio.comparison.model import Comparison, Segment
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]

_SMOOTHING = 0.12
_SHORTEST = 0.5
_DEPTH = np.log(4.0)
_STILL = 0.02


@dataclass(frozen=True)
class CarriedSegment:
    """A segment of the reference and what answers to it in the source.

    Parameters
    ----------
    reference, source
        The segment in frames of each.
    delay
        Seconds that the source begins it later than the reference at true speed; negative where
        earlier.
    delay_relative
        The same at equal lengths.
    reference_duration, source_duration
        Seconds.
    pose_difference
        Mean distance of the poses within it.
    """

    reference: Segment
    source: Segment
    delay: float
    delay_relative: float
    reference_duration: float
    source_duration: float
    pose_difference: float


def carried(segments: Sequence[Segment], comparison: Comparison) -> tuple[CarriedSegment, ...]:
    """Carry segments of the reference over to the source along the path."""
    edges = np.array([[s.start, s.end] for s in segments], float).reshape(-1, 2)
    answers = np.round(source_frames(comparison, edges.ravel())).astype(int).reshape(-1, 2)
    rates = float(comparison.reference_rate), float(comparison.source_rate)
    last = len(comparison.warp) - 1
    found = []
    for segment, (start, end) in zip(segments, answers, strict=True):
        start = min(int(start), last)
        end = max(int(end), start + 1)
        found.append(
            CarriedSegment(
                segment,
                Segment(segment.name, start, end),
                -float(comparison.misalignment[start]),
                -float(comparison.misalignment_relative[start]),
                (segment.end - segment.start) / rates[0],
                (end - start) / rates[1],
                float(comparison.pose_difference[start:end].mean()),
            )
        )
    return tuple(found)


def source_frames(comparison: Comparison, reference_frames: Array) -> Array:
    """Fractional source frames that answer to boundaries in the reference: the inverse of F.

    Where the reference stays with one source frame, or the other way round, the middle of those
    that are matched; the end of the reference answers to the end of the source.
    """
    r, s = comparison.path.T.astype(float)
    frames, first = np.unique(r, return_index=True)
    last = np.append(first[1:], len(r)) - 1
    middle = (s[first] + s[last]) / 2
    ends = np.append(frames, frames[-1] + 1), np.append(middle, s[-1] + 1)
    return np.asarray(np.interp(reference_frames, *ends))


def suggested(recording: Take | MarkerTake) -> tuple[Segment, ...]:
    """Suggest segments: what lies between rests, the valleys of the body's kinetic energy.

    Valleys count where the energy falls to a quarter of what surrounds it; stretches that hardly
    move, such as the silence before the first technique, are no segments.
    """
    start, end = recording.span
    energy = kinetic_energy(recording)[start:end]
    if len(energy) < 3:
        return ()
    moving = energy > _STILL * np.quantile(energy, 0.95)
    if not moving.any():
        return ()
    inside = np.flatnonzero(moving)
    level = -np.log(np.maximum(energy, _STILL * np.quantile(energy, 0.95)))
    apart = max(1, round(_SHORTEST * float(recording.rate)))
    edges = {int(inside[0]), int(inside[-1]) + 1}
    for left, right in peaks(level, float(_DEPTH), apart):
        edges |= {left, right + 1} if right - left > apart else {(left + right + 1) // 2}
    cuts = sorted(edge for edge in edges if inside[0] <= edge <= inside[-1] + 1)
    pairs = [(a, b) for a, b in pairwise(cuts) if b - a >= apart / 2 and moving[a:b].mean() > 0.5]
    return tuple(Segment(f"part {n}", start + a, start + b) for n, (a, b) in enumerate(pairs, 1))


def peaks(level: Array, prominence: float, apart: int) -> list[tuple[int, int]]:
    """Find prominent maxima, as scipy.signal does, which takes a second to import.

    Parameters
    ----------
    level
        (F,) values.
    prominence
        How far the level must fall on both sides before it rises higher.
    apart
        Frames between two maxima at least; of nearer ones the higher stays.

    Returns
    -------
    First and last frame of each maximum, in order of time.
    """
    rises = np.flatnonzero(np.diff(level) != 0) + 1
    starts, ends = np.append(0, rises), np.append(rises, len(level)) - 1
    values, found = level[starts], []
    for i in range(1, len(values) - 1):
        if values[i] <= max(values[i - 1], values[i + 1]):
            continue
        higher = np.flatnonzero(values > values[i])
        before, after = higher[higher < i], higher[higher > i]
        left = values[before[-1] if len(before) else 0 : i].min()
        right = values[i + 1 : after[0] + 1 if len(after) else len(values)].min()
        if values[i] - max(left, right) >= prominence:
            found.append(i)
    kept: list[int] = []
    middle = (starts + ends) / 2
    for i in sorted(found, key=lambda i: -values[i]):
        if all(abs(middle[i] - middle[k]) >= apart for k in kept):
            kept.append(i)
    return [(int(starts[i]), int(ends[i])) for i in sorted(kept)]


def kinetic_energy(recording: Take | MarkerTake) -> Array:
    """(F,) mean squared speed of the rows, (m/s)^2, smoothed over a quarter of a second."""
    from scipy.ndimage import gaussian_filter1d

    performance = performance_of(recording)
    rate = float(recording.rate)
    places = gaussian_filter1d(performance.positions, _SMOOTHING * rate / 2, axis=0, mode="nearest")
    if len(places) < 2:
        return np.zeros(len(places))
    speed = np.gradient(places, axis=0) * rate
    weight = np.where(performance.unreliable, 0.0, 1.0)
    energy = np.sum(np.sum(speed**2, axis=2) * weight, axis=1) / np.maximum(weight.sum(axis=1), 1)
    return np.asarray(gaussian_filter1d(energy, _SMOOTHING * rate / 2, mode="nearest"))


def boundary_errors(
    found: Sequence[Segment], given: Sequence[Segment], rate: float
) -> NDArray[np.float64]:
    """Seconds from each given boundary to the nearest one found; infinite where none was."""
    edges = np.array(sorted({e for s in found for e in (s.start, s.end)}), float)
    wanted = np.array(sorted({e for s in given for e in (s.start, s.end)}), float)
    if not len(edges):
        return np.full(len(wanted), np.inf)
    return np.asarray(np.abs(wanted[:, None] - edges).min(axis=1) / rate)
