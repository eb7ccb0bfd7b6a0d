"""Replacements for the two root rows: where the body is, and where it faces."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.model import Flag, Proposal
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import above_hips, carrier, split_heading
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]

_PAD_SECONDS = 0.04


def propose_position(analysis: Analysis, flag: Flag) -> Proposal:
    """Lead the body smoothly from before the span to after it (cubic, speeds kept)."""
    take = analysis.take
    start, end = _padded(take, flag)
    track = take.translations[:, carrier(take)]
    inside = _hermite(track, start, end, float(take.rate))
    return Proposal((), start, end, np.empty((end - start, 0, 4)), inside, "interpolation")


def propose_heading(analysis: Analysis, flag: Flag) -> Proposal:
    """Turn the hips so that the heading leads smoothly over the span; their tilt stays."""
    take = analysis.take
    start, end = _padded(take, flag)
    hips = topology(take.skeleton).hips
    heading, _ = split_heading(take)
    heading = _continued(heading, start, end)
    led = _hermite(heading[:, None], start, end, float(take.rate))[:, 0]
    turn = rot.about_axis(1, led - heading[start:end])
    # The hips turn about the world's vertical; what is above them in the chain is undone first.
    above = above_hips(take, start, end)
    local = rot.multiply(rot.multiply(rot.conjugate(above), turn), above)
    rotations = rot.multiply(local, take.rotations[start:end, hips])[:, None]
    name = take.skeleton.names[hips]
    return Proposal((name,), start, end, rotations, None, "interpolation")


def _padded(take: Take, flag: Flag) -> tuple[int, int]:
    pad = max(1, round(_PAD_SECONDS * float(take.rate)))
    first, last = take.span
    return max(flag.start - pad, first), min(flag.end + pad, last)


def _continued(heading: Array, start: int, end: int) -> Array:
    """Undo whole turns that a flip inside the span has added after it."""
    if start == 0 or end >= len(heading):
        return heading
    turns = np.round((heading[end] - heading[start - 1]) / (2 * np.pi))
    result = heading.copy()
    result[end:] -= 2 * np.pi * turns
    return result


def _hermite(track: Array, start: int, end: int, rate: float) -> Array:
    """(n, d) cubic from the frame before the span to the frame after, with the speeds outside."""
    n = end - start
    if start < 1 or end >= len(track):
        edge = track[end] if start < 1 and end < len(track) else track[max(start - 1, 0)]
        return np.broadcast_to(edge, (n, track.shape[1])).copy()
    reach = n + 1.0
    window = max(1, round(_PAD_SECONDS * rate))
    a, b = track[start - 1], track[end]
    first, last = max(start - 1 - window, 0), min(end + window, len(track) - 1)
    speed_a = (a - track[first]) / max(start - 1 - first, 1) * reach
    speed_b = (track[last] - b) / max(last - end, 1) * reach
    t = ((np.arange(n) + 1.0) / reach)[:, None]
    return np.asarray(
        (2 * t**3 - 3 * t**2 + 1) * a
        + (t**3 - 2 * t**2 + t) * speed_a
        + (3 * t**2 - 2 * t**3) * b
        + (t**3 - t**2) * speed_b
    )
