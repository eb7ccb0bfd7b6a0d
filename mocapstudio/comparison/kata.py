"""Comparing two performances of one kata (paper 4), from recordings to misalignment."""

from __future__ import annotations

from collections.abc import Generator
from fractions import Fraction
from math import ceil, floor

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison import timing
from mocapstudio.comparison.joint_rows import performance_of_take
from mocapstudio.comparison.model import Comparison
from mocapstudio.comparison.parameters import ROOT, ROTATIONS, ComparisonParameters
from mocapstudio.comparison.performance import Performance
from mocapstudio.comparison.resampling import lanczos
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.take import Take
from mocapstudio.similarity.alignment.dtw import Ends, aligning

Array = NDArray[np.float64]


def compare(
    reference: Take | MarkerTake,
    source: Take | MarkerTake,
    parameters: ComparisonParameters | None = None,
) -> Generator[Progress, None, Comparison]:
    """Compare a source with a reference, yielding progress."""
    chosen = parameters or ComparisonParameters()
    yield Progress(0.0, "reading poses")
    one, other = performance_of_take(_take(reference)), performance_of_take(_take(source))
    rows = [row for row in one.rows if any(row.name == r.name for r in other.rows)]
    if not rows:
        raise MocapError("no joint of the source is one of the reference's")
    ours = _normalised(one, [one.rows.index(row) for row in rows], chosen)
    names = [row.name for row in other.rows]
    theirs = _normalised(other, [names.index(row.name) for row in rows], chosen)
    frames = _lengths(one, other, chosen)
    begin, end = (None if e == "closed" else e for e in (chosen.begin, chosen.end))
    alignment = yield from aligning(
        _flat(lanczos(ours[slice(*one.span)], frames[0])),
        _flat(lanczos(theirs[slice(*other.span)], frames[1])),
        Ends(begin, end),  # type: ignore[arg-type]
    )
    at = [
        np.linspace(p.span[0], p.span[1] - 1, n) for p, n in zip((one, other), frames, strict=True)
    ]
    path = timing.at_own_rates(alignment.path, *at)
    warp = timing.warping_function(path, other.frames, rounded=chosen.rounded)
    rates = float(one.rate), float(other.rate)
    begins = float(one.span[0]), float(other.span[0])
    gap = timing.misalignment(warp, rates, 1.0, begins)
    tempo = _seconds(one) / _seconds(other)
    relative = timing.misalignment(warp, rates, tempo, begins)
    shown = gap if chosen.true_speed else relative
    full = np.clip(
        (gap + (np.arange(other.frames) - begins[1]) / rates[1]) * rates[0] + begins[0],
        0,
        one.frames - 1,
    )
    matched = _sampled(ours, full)
    difference = np.linalg.norm(theirs - matched, axis=2)
    return Comparison(
        reference=one.name,
        source=other.name,
        reference_rate=one.rate,
        source_rate=other.rate,
        rows=tuple(row.name for row in rows),
        limbs=tuple(row.limb for row in rows),
        reference_poses=ours.astype(np.float32),
        source_poses=theirs.astype(np.float32),
        path=path,
        warp=full,
        misalignment=gap,
        misalignment_relative=relative,
        timing=timing.slopes(shown, rates[1], chosen.window, chosen.tolerance),
        joint_difference=difference.astype(np.float32),
        pose_difference=np.linalg.norm(difference, axis=1).astype(np.float32),
        dissimilarity=alignment.mean_cost,
        warnings=one.warnings,
    )


def _take(recording: Take | MarkerTake) -> Take:
    if not isinstance(recording, Take):
        raise MocapError("markers cannot be compared yet")
    return recording


def _normalised(performance: Performance, rows: list[int], chosen: ComparisonParameters) -> Array:
    if chosen.features == ROTATIONS:
        assert performance.rotations is not None
        return rot.to_rotation_vector(performance.rotations[:, rows]) / (2 * np.pi) + 0.5
    frame = performance.root if chosen.features == ROOT else performance.head
    local = frame.local(performance.positions[:, rows])
    start, end = performance.span
    return local * (0.5 / np.abs(local[start:end]).max()) + 0.5


def _lengths(one: Performance, other: Performance, chosen: ComparisonParameters) -> tuple[int, int]:
    """Frames at which both are aligned: own frames, or every second, third … of them."""
    rates = [_reduced(p.rate, chosen.rate) for p in (one, other)]
    if chosen.true_speed:
        return tuple(max(2, ceil(_seconds(p) * rates[0]) + 1) for p in (one, other))  # type: ignore
    longest = max(
        max(2, round(_seconds(p) * r) + 1) for p, r in zip((one, other), rates, strict=True)
    )
    return longest, longest


def _reduced(rate: Fraction, least: float) -> float:
    return float(rate / max(1, floor(float(rate) / least + 1e-6)))


def _seconds(performance: Performance) -> float:
    start, end = performance.span
    return max(end - start - 1, 1) / float(performance.rate)


def _flat(poses: Array) -> NDArray[np.float32]:
    return poses.reshape(len(poses), -1).astype(np.float32)


def _sampled(poses: Array, at: Array) -> Array:
    low = np.minimum(at.astype(np.int64), max(len(poses) - 2, 0))
    high = np.minimum(low + 1, len(poses) - 1)
    part = (at - low)[:, None, None]
    return poses[low] * (1 - part) + poses[high] * part
