"""The likely cause of a flagged span, told from the shape of the motion in it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.model import DigressionMap, Kind
from mocapstudio.cleaning.own_rate import OwnRate
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION
from mocapstudio.motion.take import Take

_FLIP_DEGREES = 85.0


def likely_kind(
    take: Take, digression: DigressionMap, own_rate: OwnRate, column: int, start: int, end: int
) -> Kind:
    """Name the cause that fits the span of one row best."""
    row = digression.rows[column]
    rate = float(take.rate)
    seconds = (end - start) / rate
    popping = bool(own_rate.pops[start:end, column].max(initial=0.0) >= 1.0)
    if row == ROOT_POSITION:
        return Kind.ROOT_POP if seconds < 0.3 else Kind.HEIGHT_DRIFT
    if row == ROOT_HEADING:
        return Kind.HEADING_FLIP
    residual = digression.residuals[start:end, column]
    if seconds <= 0.06 and popping:
        return Kind.POP
    if seconds > 0.1 and _still(take, row, start, end):
        return Kind.FREEZE
    if seconds > 0.1 and _straight(take, row, start, end):
        return Kind.GAP
    if residual.max(initial=0.0) > _FLIP_DEGREES:
        return Kind.FLIP
    if own_rate.jitter[start:end, column].max(initial=0.0) >= 1.0 and residual.max() < 12.0:
        return Kind.JITTER
    if seconds < 0.25:
        return Kind.SPIKE
    if _turns(residual) > 6.0 * seconds + 3.0:
        return Kind.NOISE
    late = residual[len(residual) // 2 :].mean() > 1.6 * residual[: len(residual) // 2].mean() + 1.0
    return Kind.DRIFT if late and seconds > 0.8 else Kind.OFFSET


def _angular_velocity(take: Take, row: str, start: int, end: int) -> NDArray[np.float64]:
    """(n, 3) rotation from frame to frame, radians, over the middle of a span."""
    margin = (end - start) // 5
    q = take.rotations[start + margin : end - margin, take.skeleton.index[row]]
    return rot.to_rotation_vector(rot.multiply(rot.conjugate(q[:-1]), q[1:]))


def _still(take: Take, row: str, start: int, end: int) -> bool:
    steps = np.linalg.norm(_angular_velocity(take, row, start, end), axis=-1)
    return len(steps) > 2 and bool(np.rad2deg(np.median(steps)) * float(take.rate) < 0.6)


def _straight(take: Take, row: str, start: int, end: int) -> bool:
    steps = _angular_velocity(take, row, start, end)
    if len(steps) < 4:
        return False
    mean = steps.mean(axis=0)
    return bool(np.median(np.linalg.norm(steps - mean, axis=-1)) < 0.02 * np.linalg.norm(mean))


def _turns(residual: NDArray[np.float32]) -> int:
    """How often a curve changes direction by more than a fifth of its range."""
    smallest = 0.2 * float(np.ptp(residual))
    count, direction, extreme = 0, 0, float(residual[0])
    for value in residual[1:]:
        if direction >= 0 and value < extreme - smallest:
            count, direction, extreme = count + 1, -1, float(value)
        elif direction <= 0 and value > extreme + smallest:
            count, direction, extreme = count + 1, 1, float(value)
        elif (value - extreme) * direction > 0 or direction == 0:
            extreme = max(extreme, float(value)) if direction >= 0 else min(extreme, float(value))
    return count
