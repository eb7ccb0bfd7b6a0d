"""How close a repaired take is to the clean one (paper 1, Table 2), and how it looks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mocapstudio.cleaning.model import Kind
from mocapstudio.evaluation.cases import Case
from mocapstudio.evaluation.truth import Array, Mask, Truth, departure
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION, carrier
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

_CONTACT_HEIGHT = 0.03
_CONTACT_SPEED = 0.15


@dataclass(frozen=True)
class EventError:
    """What is left of one error after repair, over its erroneous frames.

    Parameters
    ----------
    kind, seconds
        What the error was, and the length of its span.
    body_mean, body_max
        ``sum_k ||log(p_k^-1 q_k)||^2`` over all joints (half angles, rad²): mean and maximum over
        frames.
    joint_mean, joint_max
        The same of single erroneous joints; NaN where only the root was wrong.
    degrees_mean, degrees_max
        Angles of erroneous joints or heading; NaN where only the root's place was wrong.
    centimetres
        Mean distance of the root's place, NaN where it was right.
    frames
        Number of erroneous frames.
    """

    kind: Kind
    seconds: float
    body_mean: float
    body_max: float
    joint_mean: float
    joint_max: float
    degrees_mean: float
    degrees_max: float
    centimetres: float
    frames: int


@dataclass(frozen=True)
class Looks:
    """Quality that squared error does not follow.

    Parameters
    ----------
    jerk
        Mean jerk of all joints in the world, m/s³.
    slide
        Mean horizontal speed of feet while the clean take has them on the ground, m/s; NaN where
        it never has.
    stretch
        Largest change of a bone's length against the clean take, mm.
    changed
        Samples that differ from the dirty take outside what was declared.
    """

    jerk: float
    slide: float
    stretch: float
    changed: int


def event_errors(case: Case, repaired: Take) -> list[EventError]:
    """Measure what is left of each error that has erroneous frames to be scored."""
    rows, mask = case.rows, case.mask()
    if case.ignore is not None:
        mask &= ~case.ignore[:, None]
    away = departure(case.clean, repaired, rows)
    angular = np.array([row != ROOT_POSITION for row in rows])
    joints = np.array([row not in (ROOT_POSITION, ROOT_HEADING) for row in rows])
    squared = np.where(joints, (0.5 * np.radians(away)) ** 2, 0.0)
    found = [_event_error(case, t, rows, mask, away, squared, angular, joints) for t in case.truths]
    return [one for one in found if one is not None]


def _event_error(
    case: Case,
    truth: Truth,
    rows: Sequence[str],
    mask: Mask,
    away: Array,
    squared: Array,
    angular: Mask,
    joints: Mask,
) -> EventError | None:
    here = np.zeros_like(mask)
    columns = [rows.index(row) for row in truth.joints if row in rows]
    here[truth.start : truth.end, columns] = mask[truth.start : truth.end, columns]
    frames = here.any(axis=1)
    if not frames.any():
        return None
    whole = squared[frames].sum(axis=1)
    own, degrees = squared[here & joints], away[here & angular]
    place = away[:, rows.index(ROOT_POSITION)][here[:, rows.index(ROOT_POSITION)]]
    return EventError(
        kind=truth.kind,
        seconds=(truth.end - truth.start) / float(case.clean.rate),
        body_mean=float(whole.mean()),
        body_max=float(whole.max()),
        joint_mean=_mean(own),
        joint_max=float(own.max()) if len(own) else math.nan,
        degrees_mean=_mean(degrees),
        degrees_max=float(degrees.max()) if len(degrees) else math.nan,
        centimetres=_mean(place),
        frames=int(frames.sum()),
    )


def looks(case: Case, repaired: Take, declared: Sequence[Declared]) -> Looks:
    """Jerk, foot slide, bone lengths, and change outside what was declared."""
    clean, _ = take_pose(case.clean)
    positions, _ = take_pose(repaired)
    bones = _bones(case.clean, clean)
    return Looks(
        jerk=jerk(positions, float(repaired.rate)),
        slide=_slide(case.clean, clean, positions),
        stretch=1000.0 * float(np.abs(_bones(repaired, positions) - bones).max()),
        changed=changed_outside(case.dirty, repaired, declared),
    )


def jerk(positions: Array, rate: float) -> float:
    """Mean length of the third derivative of (F, J, 3) positions, m/s³."""
    if len(positions) < 4:
        return math.nan
    return float(np.linalg.norm(np.diff(positions, n=3, axis=0), axis=-1).mean() * rate**3)


def changed_outside(before: Take, after: Take, declared: Sequence[Declared]) -> int:
    """Count samples (joint rotations, translations) that differ outside the declared rows × spans.

    Root heading declares the rotation of the hips, root position the translation that carries the
    body. A rotation and its negative are the same.
    """
    index, hips = before.skeleton.index, topology(before.skeleton).hips
    same = np.abs(np.sum(before.rotations * after.rotations, axis=-1)) > 1 - 1e-12
    still = (before.translations == after.translations).all(axis=-1)
    for one in declared:
        span = slice(one.start, one.end)
        if one.row == ROOT_POSITION:
            still[span, carrier(before)] = True
        else:
            same[span, hips if one.row == ROOT_HEADING else index[one.row]] = True
    return int((~same).sum() + (~still).sum())


def _bones(take: Take, positions: Array) -> Array:
    children = np.flatnonzero(take.skeleton.parents >= 0)
    parents = take.skeleton.parents[children]
    # The joint that carries the body floats free of its parent.
    fixed = children != take.translated[carrier(take)]
    children, parents = children[fixed], parents[fixed]
    return np.asarray(np.linalg.norm(positions[:, children] - positions[:, parents], axis=-1))


def _slide(take: Take, clean: Array, repaired: Array) -> float:
    """Mean horizontal speed of ankles and toes where the clean take has them at rest, low down."""
    legs = [limb for limb in topology(take.skeleton).limbs if limb.name.endswith("leg")]
    feet = [joint for limb in legs for joint in limb.joints[-2:]]
    rate = float(take.rate)
    if not feet or take.frames < 2:
        return math.nan
    speed = np.linalg.norm(np.diff(clean[:, feet], axis=0), axis=-1) * rate
    height = clean[1:, feet, 1]
    down = (speed < _CONTACT_SPEED) & (height < np.quantile(height, 0.05, axis=0) + _CONTACT_HEIGHT)
    slid = np.linalg.norm(np.diff(repaired[:, feet][..., [0, 2]], axis=0), axis=-1) * rate
    return _mean(slid[down])


def _mean(values: Array) -> float:
    return float(values.mean()) if len(values) else math.nan
