"""What is offered instead of a flagged span (paper 1, section 4).

The flagged joints take the motion of the neighbours' medoid, time-warped to the span, shifted to
meet what stays at both ends, and smoothed at the seams by a quadratic Savitzky-Golay filter.
Spans too short to hold a motion of their own are interpolated.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.blending import join_rotations, smooth_seams
from mocapstudio.cleaning.model import Flag, Neighbour, Proposal
from mocapstudio.cleaning.reasons import neighbours
from mocapstudio.cleaning.root_proposals import propose_heading, propose_position
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import ParameterError
from mocapstudio.motion.facing import (
    ROOT_HEADING,
    ROOT_POSITION,
    ROOT_ROWS,
    carrier,
    hips_rotation,
    split_heading,
)
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]

_SHORT_SECONDS = 0.2
_PAD_SECONDS = 0.04
_SEAM_SECONDS = 0.06


def propose(
    analysis: Analysis, flag: Flag, choice: int | None = None, onto: Take | None = None
) -> Proposal:
    """Make the replacement motion for one flag.

    Parameters
    ----------
    analysis
        The analysis that raised the flag.
    flag
        What to replace: its own row, over its span.
    choice
        Which of `reasons.neighbours` to take as donor, counted from 0; None for the engine's own
        choice.
    onto
        The take as it is by now, where repairs of other flags share the joints: the replacement
        joins these, and keeps the heading or the tilt that they gave the hips.

    Raises
    ------
    ParameterError
        If there is no such neighbour.
    """
    near = () if flag.joint in ROOT_ROWS else neighbours(analysis, flag)
    if onto is not None:
        analysis = replace(analysis, take=onto)
    if flag.joint == ROOT_POSITION:
        return _measured(analysis.take, propose_position(analysis, flag))
    if flag.joint == ROOT_HEADING:
        return _measured(analysis.take, propose_heading(analysis, flag))
    if choice is not None and not 0 <= choice < len(near):
        raise ParameterError(f"there is no neighbour {choice + 1} for this flag")
    joints = (flag.joint,)
    start, end = _padded(analysis.take, flag)
    short = (flag.end - flag.start) / float(analysis.take.rate) <= _SHORT_SECONDS
    if choice is None and (short or not near):
        inside = _interpolated(analysis.take, joints, start, end)
        proposal = Proposal(joints, start, end, inside, None, "interpolation")
    else:
        donor = near[choice] if choice is not None else medoid(analysis, near, joints)
        inside = _from_donor(analysis, flag, donor, joints, start, end)
        proposal = Proposal(joints, start, end, inside, None, "neighbours", donor)
    return _measured(analysis.take, proposal)


def apply(take: Take, proposal: Proposal) -> Take:
    """Return the take with the proposal's samples in place of its own."""
    rotations, translations = take.rotations, take.translations
    if proposal.joints:
        rotations = rotations.copy()
        columns = [take.skeleton.index[name] for name in proposal.joints]
        rotations[proposal.start : proposal.end, columns] = proposal.rotations
    if proposal.translations is not None:
        translations = translations.copy()
        translations[proposal.start : proposal.end, carrier(take)] = proposal.translations
    return take.with_motion(rotations, translations)


def medoid(analysis: Analysis, near: Sequence[Neighbour], joints: Sequence[str]) -> Neighbour:
    """Return the neighbour whose motion of the joints is closest to all others': a real motion."""
    if len(near) < 3:
        return near[0]
    motions = np.stack([_sampled(_take_of(analysis, one), one, joints, 12) for one in near])
    apart = rot.angle(motions[:, None], motions[None]).mean(axis=(2, 3))
    return near[int(np.argmin(apart.sum(axis=1)))]


def _padded(take: Take, flag: Flag) -> tuple[int, int]:
    pad = max(1, round(_PAD_SECONDS * float(take.rate)))
    first, last = take.span
    return max(flag.start - pad, first), min(flag.end + pad, last)


def _take_of(analysis: Analysis, neighbour: Neighbour) -> Take:
    return analysis.take if neighbour.index == 0 else analysis.context[neighbour.index - 1]


def _sampled(take: Take, span: Neighbour, joints: Sequence[str], count: int) -> Array:
    return sample_rotations(take, joints, np.linspace(span.start, span.end - 1, count))


def sample_rotations(take: Take, joints: Sequence[str], at: Array) -> Array:
    """(n, m, 4) local rotations at fractional frames, held at the take's ends."""
    return _sampled_rotations(take.rotations[:, [take.skeleton.index[n] for n in joints]], at)


def _sampled_rotations(q: Array, at: Array) -> Array:
    at = np.clip(at, 0, len(q) - 1)
    low = np.minimum(at.astype(np.int64), max(len(q) - 2, 0))
    high = np.minimum(low + 1, len(q) - 1)
    return rot.slerp(q[low], q[high], (at - low)[:, None])


def _from_donor(
    analysis: Analysis, flag: Flag, donor: Neighbour, joints: tuple[str, ...], start: int, end: int
) -> Array:
    take, other = analysis.take, _take_of(analysis, donor)
    pace = (donor.end - donor.start) / (flag.end - flag.start)
    at = donor.start + np.arange(start - flag.start, end - flag.start, dtype=np.float64) * pace
    inside = sample_rotations(other, joints, at)
    hips = take.skeleton.names[topology(take.skeleton).hips]
    if hips in joints:
        tilt = _sampled_rotations(split_heading(other)[1][:, None], at)[:, 0]
        inside[:, joints.index(hips)] = hips_rotation(take, tilt, start, end)
    return _joined(take, joints, inside, start, end)


def _interpolated(take: Take, joints: Sequence[str], start: int, end: int) -> Array:
    """Hermite interpolation on the rotations' logarithms, with the speeds outside the span."""
    columns = [take.skeleton.index[name] for name in joints]
    q = take.rotations[:, columns]
    n = end - start
    if start < 1 or end >= take.frames:
        edge = q[end] if end < take.frames else q[max(start - 1, 0)]
        return np.broadcast_to(edge, (n, *edge.shape)).copy()
    a, b = q[start - 1], q[end]
    reach = n + 1.0
    to_local = rot.conjugate(a)
    whole = rot.to_rotation_vector(rot.multiply(to_local, b))
    speed_a = speed_b = whole
    if start > 1:
        speed_a = rot.to_rotation_vector(rot.multiply(rot.conjugate(q[start - 2]), a)) * reach
    if end < take.frames - 1:
        speed_b = rot.to_rotation_vector(rot.multiply(rot.conjugate(b), q[end + 1])) * reach
    limit = 2.0 * np.linalg.norm(whole, axis=-1, keepdims=True) + 0.1
    speed_a, speed_b = _limited(speed_a, limit), _limited(speed_b, limit)
    t = ((np.arange(n) + 1.0) / reach)[:, None, None]
    curve = (
        (t**3 - 2 * t**2 + t) * speed_a + (3 * t**2 - 2 * t**3) * whole + (t**3 - t**2) * speed_b
    )
    return rot.multiply(a, rot.from_rotation_vector(curve))


def _limited(vector: Array, limit: Array) -> Array:
    norm = np.linalg.norm(vector, axis=-1, keepdims=True)
    return np.asarray(vector * np.minimum(1.0, limit / np.maximum(norm, 1e-12)))


def _joined(take: Take, joints: Sequence[str], inside: Array, start: int, end: int) -> Array:
    columns = [take.skeleton.index[name] for name in joints]
    half = max(2, round(_SEAM_SECONDS * float(take.rate)))
    before = take.rotations[max(start - half, 0) : start, columns]
    after = take.rotations[end : end + half, columns]
    joined = join_rotations(
        inside,
        before[[-min(len(before), 2), -1]] if len(before) else None,
        after[[0, min(len(after), 2) - 1]] if len(after) else None,
    )
    return smooth_seams(joined, before, after, min(half, max(2, len(inside) // 2)))


def _measured(take: Take, proposal: Proposal) -> Proposal:
    """Add how far hands, feet and head outside the joints move."""
    skeleton = take.skeleton
    changed = {skeleton.index[name] for name in proposal.joints}
    inner = topology(skeleton).details
    ends = [
        limb.joints[-1] if not set(limb.joints) & inner else _last_outside(limb.joints, inner)
        for limb in topology(skeleton).limbs
        if limb.name != "spine"
    ]
    span = slice(proposal.start, proposal.end)
    before, _ = take_pose(take, span.start, span.stop)
    short = replace(
        take, rotations=take.rotations[span], translations=take.translations[span], trim=None
    )
    moved = apply(short, replace(proposal, start=0, end=span.stop - span.start))
    after, _ = take_pose(moved)
    far = np.linalg.norm(after - before, axis=-1).max(axis=0)
    return replace(
        proposal,
        displacement={
            skeleton.names[j]: float(far[j]) for j in ends if j not in changed and far[j] > 1e-6
        },
    )


def _last_outside(joints: tuple[int, ...], inner: frozenset[int]) -> int:
    return [j for j in joints if j not in inner][-1]
