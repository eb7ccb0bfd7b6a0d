"""The baselines of paper 1, Table 1: joint limits, derivative threshold, both.

Limits are learnt from clean takes; how far beyond them something is flagged is tuned on training
cases with injected errors.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from mocapstudio.evaluation.cases import Case
from mocapstudio.evaluation.detection_benchmark import Detector
from mocapstudio.evaluation.map_detector import detector_of, tuned
from mocapstudio.evaluation.truth import Array, analysed_rows
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION, hips_world, split_heading
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

MARGINS = (0.0, 2.0, 5.0, 10.0, 20.0, 40.0)
"""Tried: degrees (centimetres for the root's height) beyond the limits."""
FACTORS = (0.5, 0.7, 1.0, 1.4, 2.0, 3.0)
"""Tried: multiples of the fastest change in the clean takes."""
_FASTEST = 0.999


@dataclass(frozen=True, eq=False)
class Limits:
    """What clean takes never exceed.

    Parameters
    ----------
    rows
        R names.
    centre
        (R, 4) mean rotation of each joint; unused for the root rows.
    low, high
        (R, 3) bounds of the rotation vector from the mean, degrees; of the root's height in
        centimetres in the first column; infinite where there is no limit.
    fastest
        (R,) 99.9 % quantile of the speed: degrees, or centimetres, a second.
    margin
        How far beyond the bounds something is flagged.
    factor
        How many times `fastest` something must be to be flagged.
    """

    rows: tuple[str, ...]
    centre: Array
    low: Array
    high: Array
    fastest: Array
    margin: float = 5.0
    factor: float = 1.0

    def beyond_limits(self, take: Take, _: Sequence[Take] = ()) -> tuple[tuple[str, ...], Array]:
        """Baseline (a): rows and (F, R) map, 0.5 at the margin beyond the joint limits."""
        away = _vectors(take, self.rows, self.centre)
        excess = np.maximum(self.low - away, away - self.high).max(axis=-1)
        margin = max(self.margin, 1e-3)
        positive = np.maximum(excess, 0.0)
        return self.rows, positive / (positive + margin)

    def too_fast(self, take: Take, _: Sequence[Take] = ()) -> tuple[tuple[str, ...], Array]:
        """Baseline (b): rows and (F, R) map, 0.5 at `factor` times the fastest change."""
        ratio = _speeds(take, self.rows) / (self.factor * self.fastest)
        return self.rows, ratio / (1.0 + ratio)

    def either(self, take: Take, _: Sequence[Take] = ()) -> tuple[tuple[str, ...], Array]:
        """Baseline (c): rows and (F, R) map, the larger of both."""
        return self.rows, np.maximum(self.beyond_limits(take)[1], self.too_fast(take)[1])


def learn(takes: Sequence[Take]) -> Limits:
    """Learn limits and speeds from clean takes of one skeleton."""
    rows = analysed_rows(takes[0].skeleton)
    index = takes[0].skeleton.index
    centre = np.stack(
        [
            rot.mean(np.concatenate([_local(t)[::4, index[row]] for t in takes]))
            if row in index
            else rot.IDENTITY
            for row in rows
        ]
    )
    away = np.concatenate([_vectors(take, rows, centre) for take in takes])
    low, high = away.min(axis=0), away.max(axis=0)
    for row in (ROOT_POSITION, ROOT_HEADING):
        free = slice(1 if row == ROOT_POSITION else 0, None)
        low[rows.index(row), free], high[rows.index(row), free] = -np.inf, np.inf
    speeds = np.concatenate([_speeds(take, rows) for take in takes])
    fastest = np.maximum(np.quantile(speeds, _FASTEST, axis=0), 1e-3)
    return Limits(rows, centre, low, high, fastest)


def learnt_and_tuned(takes: Sequence[Take], training: Sequence[Case]) -> dict[str, Detector]:
    """Baselines (a), (b), (c), each with its best margin and factor on the training cases."""
    limits = learn(takes)
    margins = {m: replace(limits, margin=m).beyond_limits for m in MARGINS}
    factors = {f: replace(limits, factor=f).too_fast for f in FACTORS}
    pairs = {(m, f): replace(limits, margin=m, factor=f).either for m in MARGINS for f in FACTORS}
    return {
        "(a) joint limits": detector_of(margins[tuned(margins, training)]),
        "(b) derivative": detector_of(factors[tuned(factors, training)]),
        "(c) both": detector_of(pairs[tuned(pairs, training)]),
    }


def _local(take: Take) -> Array:
    """(F, J, 4) local rotations, of the hips only the tilt."""
    local = take.rotations.copy()
    local[:, topology(take.skeleton).hips] = split_heading(take)[1]
    return local


def _vectors(take: Take, rows: Sequence[str], centre: Array) -> Array:
    """(F, R, 3) rotation vectors from the mean, degrees; the root's height in centimetres."""
    local, result = _local(take), np.zeros((take.frames, len(rows), 3))
    for i, row in enumerate(rows):
        if row in take.skeleton.index:
            turn = rot.multiply(rot.conjugate(centre[i]), local[:, take.skeleton.index[row]])
            result[:, i] = np.degrees(rot.to_rotation_vector(turn))
        elif row == ROOT_POSITION:
            result[:, i, 0] = 100.0 * hips_world(take)[0][:, 1]
    return result


def _speeds(take: Take, rows: Sequence[str]) -> Array:
    """(F, R) change from the frame before or to the frame after, the larger, a second."""
    local, rate = _local(take), float(take.rate)
    steps = np.zeros((take.frames + 1, len(rows)))
    for i, row in enumerate(rows):
        if row in take.skeleton.index:
            q = local[:, take.skeleton.index[row]]
            steps[1:-1, i] = np.degrees(rot.angle(q[1:], q[:-1]))
        elif row == ROOT_POSITION:
            moved = np.diff(hips_world(take)[0], axis=0)
            steps[1:-1, i] = 100.0 * np.linalg.norm(moved, axis=-1)
        elif row == ROOT_HEADING:
            steps[1:-1, i] = np.degrees(np.abs(np.diff(split_heading(take)[0])))
    return rate * np.maximum(steps[1:], steps[:-1])
