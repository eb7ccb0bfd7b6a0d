"""Comparing two performances of one kata (paper 4), from recordings to misalignment."""

from __future__ import annotations

from collections.abc import Generator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from math import ceil, floor

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison import timing
from mocapstudio.comparison.doubt import Doubt, doubt
from mocapstudio.comparison.joint_rows import performance_of_take
from mocapstudio.comparison.marker_rows import performance_of_markers
from mocapstudio.comparison.matching import Match, match
from mocapstudio.comparison.model import Comparison
from mocapstudio.comparison.normalisation import Poses, normalised
from mocapstudio.comparison.parameters import ComparisonParameters
from mocapstudio.comparison.performance import Performance, framed_alike
from mocapstudio.comparison.pose_alignment import align_poses
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.progress import Progress, scaled
from mocapstudio.motion.take import Take
from mocapstudio.similarity.alignment.dtw import Alignment, Path

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_MUCH = 0.1


def compare(
    reference: Take | MarkerTake,
    source: Take | MarkerTake,
    parameters: ComparisonParameters | None = None,
    *,
    reference_unreliable: Mask | None = None,
    source_unreliable: Mask | None = None,
    names: Mapping[str, str] | None = None,
) -> Generator[Progress, None, Comparison]:
    """Compare a source with a reference as paper 4 does, yielding progress.

    Parameters
    ----------
    reference, source
        Recordings of joints or of markers; their trimmed spans are compared.
    parameters
        The defaults where None.
    reference_unreliable, source_unreliable
        (frames, joints or markers of the recording): True where it is flagged or otherwise not to
        be trusted. Such samples count neither for the alignment nor as a difference.
    names
        Names of joints in the source and what they are called in the reference.

    Raises
    ------
    MocapError
        If too little of the two bodies can be matched, or nothing of one is ever seen.
    """
    chosen = parameters or ComparisonParameters()
    yield Progress(0.0, "reading poses")
    one, other = framed_alike(
        performance_of(reference, reference_unreliable), performance_of(source, source_unreliable)
    )
    matched = match(one, other, names)
    ours = normalised(one, matched.reference, chosen.features)
    theirs = normalised(other, matched.source, chosen.features)
    yield Progress(0.1, "resampling")
    frames = lengths(one, other, chosen)
    band = round(chosen.band * (frames[1] - 1) / _seconds(other)) if chosen.band > 0 else None
    poses = ours.resampled(one.span, frames[0]), theirs.resampled(other.span, frames[1])
    aligned = yield from scaled(align_poses(*poses, chosen, band), 0.2, 0.8)
    yield Progress(0.8, "weighing doubts")
    doubted = doubt(aligned, _seconds(one), _seconds(other), band)
    pair = _Pair(one, other, matched, ours, theirs)
    return _comparison(pair, aligned.alignment, frames, chosen, doubted)


def retimed(comparison: Comparison, chosen: ComparisonParameters) -> Comparison:
    """Classify a known misalignment anew, by another window and tolerance."""
    shown = comparison.misalignment if chosen.true_speed else comparison.misalignment_relative
    rate = float(comparison.source_rate)
    found = timing.slopes(shown, rate, chosen.window, chosen.tolerance)
    return replace(comparison, timing=found)


def performance_of(recording: Take | MarkerTake, unreliable: Mask | None = None) -> Performance:
    """Describe a recording of joints or of markers as a comparison needs it."""
    if isinstance(recording, MarkerTake):
        return performance_of_markers(recording, unreliable)
    return performance_of_take(recording, unreliable)


def lengths(one: Performance, other: Performance, chosen: ComparisonParameters) -> tuple[int, int]:
    """Frames to which both are resampled: equal, or at true speed of equal rate.

    The rate is the own one, or every second, third … frame of it, and at least the wanted one;
    equal lengths are those of the longer. With open ends nobody knows beforehand which parts
    answer to each other, so neither is stretched.
    """
    rates = [_reduced(p.rate, chosen.rate) for p in (one, other)]
    if chosen.true_speed or chosen.open:
        rate = max(rates)
        first, second = (max(2, ceil(_seconds(p) * rate - 1e-6) + 1) for p in (one, other))
        return first, second
    longest = max(round(_seconds(p) * r) + 1 for p, r in zip((one, other), rates, strict=True))
    return max(2, longest), max(2, longest)


@dataclass(frozen=True, eq=False)
class _Pair:
    """Two performances and their poses at their own rates."""

    one: Performance
    other: Performance
    matched: Match
    ours: Poses
    theirs: Poses


def _comparison(
    pair: _Pair,
    alignment: Alignment,
    frames: tuple[int, int],
    chosen: ComparisonParameters,
    doubted: Doubt,
) -> Comparison:
    one, other, ours, theirs = pair.one, pair.other, pair.ours, pair.theirs
    path = timing.at_own_rates(
        alignment.path,
        np.linspace(one.span[0], one.span[1] - 1, frames[0]),
        np.linspace(other.span[0], other.span[1] - 1, frames[1]),
    )
    rates = float(one.rate), float(other.rate)
    begins = float(one.span[0]), float(other.span[0])
    matched = timing.warping_function(path, other.frames, rounded=chosen.rounded)
    gap = timing.misalignment(matched, rates, 1.0, begins)
    tempo, first = (
        _tempo(path, one, other) if chosen.open else (_seconds(one) / _seconds(other), begins)
    )
    relative = timing.misalignment(matched, rates, tempo, first)
    warp = timing.warp_of(gap, rates, begins, one.frames)
    difference, total, weight = _differences(ours, theirs, warp)
    shown = gap if chosen.true_speed else relative
    rows = [one.rows[i] for i in pair.matched.reference]
    return Comparison(
        reference=one.name,
        source=other.name,
        reference_rate=one.rate,
        source_rate=other.rate,
        rows=tuple(row.name for row in rows),
        limbs=tuple(row.limb for row in rows),
        reference_poses=ours.shown.astype(np.float32),
        source_poses=theirs.shown.astype(np.float32),
        path=path,
        warp=warp,
        misalignment=gap,
        misalignment_relative=relative,
        timing=timing.slopes(shown, rates[1], chosen.window, chosen.tolerance),
        joint_difference=difference,
        pose_difference=total,
        dissimilarity=alignment.mean_cost,
        warnings=(
            *one.warnings,
            *other.warnings,
            *pair.matched.warnings,
            *_left_out(weight),
            *doubted.warnings,
        ),
        doubt=doubted.disorder,
        unreliable=None if (weight > 0).all() else weight == 0,
        features=chosen.features,
        true_speed=chosen.true_speed,
        source_rows=tuple(other.rows[j].name for j in pair.matched.source),
    )


def _differences(
    ours: Poses, theirs: Poses, warp: Array
) -> tuple[NDArray[np.float32], NDArray[np.float32], Array]:
    """Distance of each row (S, N) and of whole poses (S,) from the matched one; weights (S, N)."""
    points, weight = ours.at(warp)
    weight = weight * theirs.weight
    rows = np.linalg.norm(theirs.points - points, axis=2) * weight
    known = weight.sum(axis=1)
    scale = np.where(known > 0, weight.shape[1] / np.maximum(known, 1.0), 0.0)
    total = np.sqrt(np.sum(rows**2, axis=1) * scale)
    return rows.astype(np.float32), total.astype(np.float32), weight


def _left_out(weight: Array) -> list[str]:
    """Say how much did not count, where it was much."""
    share = 1.0 - float(weight.mean())
    return [f"{share:.0%} of all joints and frames are left out"] if share > _MUCH else []


def _tempo(path: Path, one: Performance, other: Performance) -> tuple[float, tuple[float, float]]:
    """Seconds of the reference a second of the source, and where both begin, on a path."""
    (first, begin), (last, end) = path[0].tolist(), path[-1].tolist()
    seconds = max(last - first, 1) / float(one.rate), max(end - begin, 1) / float(other.rate)
    return seconds[0] / seconds[1], (float(first), float(begin))


def _reduced(rate: Fraction, least: float) -> float:
    return float(rate / max(1, floor(float(rate) / least + 1e-6)))


def _seconds(performance: Performance) -> float:
    start, end = performance.span
    return max(end - start - 1, 1) / float(performance.rate)
