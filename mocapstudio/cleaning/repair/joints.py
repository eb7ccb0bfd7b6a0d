"""Replacement motion for flagged joints: an estimate, a donor's motion, or sides exchanged."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.blending import smooth_seams
from mocapstudio.cleaning.model import Flag, Neighbour, Proposal
from mocapstudio.cleaning.repair import kriging
from mocapstudio.cleaning.repair.donors import aligned, sample_rotations, take_of
from mocapstudio.cleaning.repair.estimate import Estimate, Span, estimate
from mocapstudio.cleaning.repair.group import together
from mocapstudio.cleaning.repair.kriging import OF_PREDICTED
from mocapstudio.cleaning.repair.material import Material, is_repaired, material
from mocapstudio.cleaning.repair.ranges import joint_ranges, within
from mocapstudio.cleaning.repair.swap import MANNERS, exchanged, has_two_sides
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import hips_rotation
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

F64 = NDArray[np.float64]

PAD_SECONDS = 0.04
_SEAM_SECONDS = 0.06
_CLEARLY = 0.5
_LEAST_GAIN = np.deg2rad(5.0)

PREDICTION = "prediction"
NEIGHBOURS = "neighbours"
INTERPOLATION = "interpolation"
SWAP = "swap"


def padded(take: Take, flag: Flag) -> Span:
    """Widen a flag's span by 40 ms on both sides, within the trimmed span."""
    pad = max(1, round(PAD_SECONDS * float(take.rate)))
    first, last = take.span
    return max(flag.start - pad, first), min(flag.end + pad, last)


def propose_joints(analysis: Analysis, flag: Flag, take: Take, donor: Neighbour | None) -> Proposal:
    """Replace the joints of a flag, and of those that belong to one repair with it.

    Parameters
    ----------
    analysis
        The analysis that raised the flag.
    flag
        A flag on a joint.
    take
        The take as it is by now.
    donor
        The neighbour whose motion to take; None for what is best: sides exchanged once more where
        they were, else an estimate from the other joints and both flanks.
    """
    if donor is None and is_repaired(analysis.take, take, flag):
        start, end = padded(take, flag)
        kept = take.rotations[start:end, [take.skeleton.index[flag.joint]]].copy()
        return Proposal((flag.joint,), start, end, kept, None, PREDICTION)
    known = material(analysis, flag, take)
    flags = together(analysis, flag, take)
    spans = _spans(take, flags)
    if donor is not None:
        found = [_of_donor(analysis, flag, known, donor, joint, spans) for joint in spans]
        return _proposal(analysis, known, spans, found, NEIGHBOURS, donor)
    wider = together(analysis, flag, take, both_sides=True)
    if has_two_sides(take.skeleton, [take.skeleton.index[one.joint] for one in wider]):
        sides = _spans(take, wider)
        back = _exchanged_back(known, sides, [one.rotations for one in _guessed(known, sides)])
        if back is not None:
            return _proposal(analysis, known, sides, back, SWAP, None)
    guesses = _guessed(known, spans)
    method = PREDICTION if max(one.share for one in guesses) > 0.0 else INTERPOLATION
    return _proposal(analysis, known, spans, [one.rotations for one in guesses], method, None)


def _guessed(known: Material, spans: dict[str, Span]) -> list[Estimate]:
    """Estimates of all joints, each over its span in frames of the take."""
    first = known.motion.start
    columns = [known.joints.index(joint) for joint in spans]
    inner = [(start - first, end - first) for start, end in spans.values()]
    pad = max(1, round(PAD_SECONDS * known.motion.rate))
    return estimate(known, columns, inner, pad)


def _spans(take: Take, flags: Sequence[Flag]) -> dict[str, Span]:
    """Joints in the skeleton's order, each with the span that its flags cover."""
    spans: dict[str, Span] = {}
    for one in flags:
        start, end = padded(take, one)
        if one.joint in spans:
            start, end = min(start, spans[one.joint][0]), max(end, spans[one.joint][1])
        spans[one.joint] = (start, end)
    return dict(sorted(spans.items(), key=lambda item: take.skeleton.index[item[0]]))


def _proposal(
    analysis: Analysis,
    known: Material,
    spans: dict[str, Span],
    found: Sequence[F64],
    method: str,
    donor: Neighbour | None,
) -> Proposal:
    """Lay each joint's samples, kept in its ranges, into one block.

    Outside its own span a joint stays as it is.
    """
    take = known.take
    start = min(one[0] for one in spans.values())
    end = max(one[1] for one in spans.values())
    block = take.rotations[start:end, [take.skeleton.index[name] for name in spans]].copy()
    hips = take.skeleton.names[topology(take.skeleton).hips]
    for i, ((name, (low, high)), one) in enumerate(zip(spans.items(), found, strict=True)):
        column = known.joints.index(name)
        ranges = joint_ranges(known, analysis.context, column, analysis.doubts)
        rotations = within(known, column, one, ranges)
        local = hips_rotation(take, rotations, low, high) if name == hips else rotations
        block[low - start : high - start, i] = local
    return Proposal(tuple(spans), start, end, block, None, method, donor)


def _of_donor(
    analysis: Analysis,
    flag: Flag,
    known: Material,
    donor: Neighbour,
    joint: str,
    spans: dict[str, Span],
) -> F64:
    """(n, 4) the donor's motion of one joint, warped, led into both flanks and smoothed there."""
    frames, matched = aligned(analysis, donor, (flag.start, flag.end), set(spans))
    start, end = (at - known.motion.start for at in spans[joint])
    rate, total = known.motion.rate, len(known.motion)
    half = max(2, round(_SEAM_SECONDS * rate))
    low, high = max(start - half, 0), min(end + half, total)
    wanted = np.arange(low, high) + known.motion.start
    pace = (matched[-1] - matched[0]) / max(frames[-1] - frames[0], 1.0)
    at = np.interp(wanted, frames, matched)
    at += pace * (np.minimum(wanted - frames[0], 0) + np.maximum(wanted - frames[-1], 0))
    expected = sample_rotations(take_of(analysis, donor), (joint,), at)[:, 0]
    column = known.joints.index(joint)
    actual = known.motion.rotations[low:high, column]
    away = rot.to_rotation_vector(rot.multiply(rot.conjugate(expected), actual))
    usable = ~known.wrong[low:high, column]
    usable[start - low : end - low] = False
    span = start - low, end - low
    led = kriging.led_across(away, usable, *span, rate, OF_PREDICTED[0])
    inside = rot.multiply(expected[slice(*span)], rot.from_rotation_vector(led))
    before, after = actual[: start - low][:, None], actual[end - low :][:, None]
    seam = min(half, max(2, len(inside) // 2))
    return smooth_seams(inside[:, None], before, after, seam)[:, 0]


def _exchanged_back(
    known: Material, spans: dict[str, Span], guesses: Sequence[F64]
) -> list[F64] | None:
    """Exchange the sides once more, where that comes much nearer to the guesses than what is there.

    Frames at which what is there is nearer stay, as they lay outside the exchange; joints without
    a mirror image are guessed.
    """
    take = known.take
    mirror = topology(take.skeleton).mirror
    names = [
        name for name in spans if mirror[take.skeleton.index[name]] != take.skeleton.index[name]
    ]
    columns = [take.skeleton.index[name] for name in names]
    if not has_two_sides(take.skeleton, columns):
        return None
    start = min(spans[name][0] for name in names)
    end = max(spans[name][1] for name in names)
    wanted = dict(zip(spans, guesses, strict=True))
    there = [take.rotations[slice(*spans[name]), c] for name, c in zip(names, columns, strict=True)]
    was = [rot.angle(one, wanted[name]) for one, name in zip(there, names, strict=True)]
    best: tuple[list[F64], list[F64]] | None = None
    least = _CLEARLY * _middle(was)
    for manner in MANNERS:
        whole = exchanged(take, columns, start, end, manner)
        back = [
            whole[spans[name][0] - start : spans[name][1] - start, i]
            for i, name in enumerate(names)
        ]
        now = [rot.angle(one, wanted[name]) for one, name in zip(back, names, strict=True)]
        if _middle(was) - _middle(now) > _LEAST_GAIN and _middle(now) < least:
            best, least = (back, now), _middle(now)
    if best is None:
        return None
    for name, one, stays, new, old in zip(names, best[0], there, best[1], was, strict=True):
        wanted[name] = np.where((new < old)[:, None], one, stays)
    return list(wanted.values())


def _middle(away: Sequence[F64]) -> float:
    """Mean over joints of the mean over the middle half of each span."""
    return float(np.mean([one[len(one) // 4 : len(one) - len(one) // 4].mean() for one in away]))
