"""Replacements for the two root rows: where the body is, and where it faces.

What the body does tells how the hips travel (see `repair.walk`); the expected path is led into
what stays at both ends. What of the recorded path is right stays, and a heading that jumps away
and back is turned back.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.model import Flag, Proposal
from mocapstudio.cleaning.repair.material import is_repaired, wrong_rows
from mocapstudio.cleaning.repair.walk import Walk, expected_walk
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import above_hips, carrier, hips_world, split_heading
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]

_PAD_SECONDS = 0.04
_SHORT_SECONDS = 0.2
_STRAY_METRES = 0.03
_STRAY_TIMES = 3.0
_FITS_METRES = 0.01
_KNOT_SECONDS = 0.03
_FLIP = np.deg2rad(20.0)
_EVEN = np.deg2rad(15.0)


def propose_position(analysis: Analysis, flag: Flag, take: Take) -> Proposal:
    """Lead the hips along the path that the body's motion lets expect, both ends met.

    Short spans are led over smoothly (cubic, speeds kept). In longer ones the height and the
    horizontal path are replaced each only where it strays from what is expected.
    """
    start, end = _padded(take, flag)
    place, _ = hips_world(take)
    rate = float(take.rate)
    short = (flag.end - flag.start) / rate <= _SHORT_SECONDS
    walk = None if short else _walk(analysis, flag, take)
    led, method = _led_over(place, start, end, rate, short=short), "interpolation"
    if walk is not None and start > take.span[0] and end < take.span[1]:
        first, last = take.span
        path = _expected(walk, place[first:last], rate)
        span = start - first, end - first
        led, method = _along(path, place[first:last], span, rate), "prediction"
        ground = np.linalg.norm((place[start:end] - led)[:, [0, 2]], axis=1).max()
        if ground < _usual_stray(path, place[first:last], span, rate):
            led[:, [0, 2]] = place[start:end][:, [0, 2]]
    moved = led - place[start:end]
    at = carrier(take)
    turned = _above(take, take.translated[at], start, end)
    inside = take.translations[start:end, at] + rot.rotate(rot.conjugate(turned), moved)
    return Proposal((), start, end, np.empty((end - start, 0, 4)), inside, method)


def propose_heading(analysis: Analysis, flag: Flag, take: Take) -> Proposal:
    """Turn the hips so that the heading leads over the span; their tilt stays.

    A heading that jumps at both ends by the same angle is turned back by it and keeps its own
    motion; any other is led across as the body's motion lets expect.
    """
    start, end = _padded(take, flag)
    heading, _ = split_heading(take)
    led, method = _turned_back(heading, flag, start, end), "turned back"
    if led is None:
        led, method = _led_heading(analysis, flag, take, heading, start, end)
    turn = rot.about_axis(1, led - heading[start:end])
    hips = topology(take.skeleton).hips
    # The hips turn about the world's vertical; what is above them in the chain is undone first.
    above = above_hips(take, start, end)
    local = rot.multiply(rot.multiply(rot.conjugate(above), turn), above)
    rotations = rot.multiply(local, take.rotations[start:end, hips])[:, None]
    name = take.skeleton.names[hips]
    return Proposal((name,), start, end, rotations, None, method)


def _walk(analysis: Analysis, flag: Flag, take: Take) -> Walk | None:
    joints = analysis.texture.joints
    open_ = [f for f in analysis.flags if not is_repaired(analysis.take, take, f)]
    first, last = take.span
    wrong = wrong_rows(joints, last - first, first, [*open_, flag])
    near = np.any(wrong[max(flag.start - first, 0) : flag.end - first], axis=0)
    columns = [i for i in range(len(joints)) if not near[i]]
    names = tuple(joints[i] for i in columns)
    if not names:
        return None
    return expected_walk(take, analysis.context, names, np.any(wrong, axis=1))


def _expected(walk: Walk, place: Array, rate: float) -> Array:
    """(F', 3) the path that a walk describes, from any place."""
    path = place.copy()
    path[:, [0, 2]] = np.cumsum(walk.velocity[:, [0, 2]], axis=0) / rate
    path[:, 1] = walk.height
    return path


def _along(path: Array, place: Array, span: tuple[int, int], rate: float) -> Array:
    """(n, 3) an expected path over a span, led into both ends by a smooth offset."""
    return np.asarray(path[slice(*span)] + _hermite(place - path, *span, rate))


def _usual_stray(path: Array, place: Array, span: tuple[int, int], rate: float) -> float:
    """Metres by which the expected path may stray on the ground where nothing is wrong."""
    n = span[1] - span[0]
    away = [0.0]
    for start in np.linspace(1, max(len(place) - n - 1, 1), 12).astype(int).tolist():
        if (start < span[1] and span[0] < start + n) or start + n >= len(place):
            continue
        one = (start, start + n)
        led = _along(path, place, one, rate)
        away.append(np.linalg.norm((place[slice(*one)] - led)[:, [0, 2]], axis=1).max())
    return max(_STRAY_METRES, _STRAY_TIMES * float(np.median(away)))


def _led_over(place: Array, start: int, end: int, rate: float, *, short: bool) -> Array:
    """(n, d) a smooth lead over a span; frames at the ends of a short one stay where they fit."""
    if not short or start < 1 or end >= len(place):
        return _hermite(place, start, end, rate)
    led = _cubic(place, start, end, rate)
    pad = max(1, round(_PAD_SECONDS * rate))
    fits = np.linalg.norm(led - place[start:end], axis=1) < _FITS_METRES
    low = next((k for k in range(pad) if not fits[k]), pad)
    high = next((k for k in range(pad) if not fits[-1 - k]), pad)
    inner = start + low, end - high
    led = place[start:end].copy()
    led[low : len(led) - high] = _cubic(place, *inner, rate)
    return led


def _cubic(track: Array, start: int, end: int, rate: float) -> Array:
    """(n, d) the cubic through two frames on either side, three hundredths of a second apart."""
    step = max(1, round(_KNOT_SECONDS * rate))
    knots = np.array([start - 1 - step, start - 1, end, end + step])
    knots = np.clip(knots, 0, len(track) - 1)
    if len(set(knots.tolist())) < 4:
        return _hermite(track, start, end, rate)
    at = np.arange(start, end)[:, None] - start
    basis = np.ones((end - start, 4))
    for i in range(4):
        for j in range(4):
            if i != j:
                basis[:, i] *= (at[:, 0] + start - knots[j]) / (knots[i] - knots[j])
    return np.asarray(basis @ track[knots])


def _led_heading(
    analysis: Analysis, flag: Flag, take: Take, heading: Array, start: int, end: int
) -> tuple[Array, str]:
    heading = _continued(heading, start, end)
    rate = float(take.rate)
    first, last = take.span
    walk = None
    if (flag.end - flag.start) / rate > _SHORT_SECONDS:
        walk = _walk(analysis, flag, take)
    if walk is None or start <= first or end >= last:
        return _hermite(heading[:, None], start, end, rate)[:, 0], "interpolation"
    expected = np.zeros_like(heading)
    expected[first:last] = np.cumsum(walk.turning) / rate
    expected[last:] = expected[last - 1]
    offset = _hermite((heading - expected)[:, None], start, end, rate)[:, 0]
    return expected[start:end] + offset, "prediction"


def _turned_back(heading: Array, flag: Flag, start: int, end: int) -> Array | None:
    """(n,) the heading less the angle by which it jumps near both ends; None where it does not."""
    if start < 2 or end > len(heading) - 2:
        return None
    steps = np.diff(heading)
    usual = np.median(steps[max(start - 10, 0) : end + 10])
    reach = 2 * (flag.start - start) + 1
    # Step k leads from frame k to frame k + 1.
    leave = start - 1 + int(np.argmax(np.abs(steps[start - 1 : start - 1 + reach] - usual)))
    low = max(end - reach, leave + 1)
    back = low + int(np.argmax(np.abs(steps[low:end] - usual)))
    if back - leave < 3:
        # Too short a stay to tell how fast the heading turns meanwhile.
        meanwhile = steps[leave - 1], steps[min(back + 1, len(steps) - 1)]
    else:
        after = steps[min(back + 1, len(steps) - 1)]
        meanwhile = (
            0.5 * (steps[leave - 1] + steps[leave + 1]),
            0.5 * (steps[back - 1] + after),
        )
    away, home = steps[leave] - meanwhile[0], steps[back] - meanwhile[1]
    apart = float(np.angle(np.exp(1j * (away + home))))
    if min(abs(away), abs(home)) < _FLIP or abs(apart) > _EVEN:
        return None
    led = heading[start:end].copy()
    n = back - leave
    led[leave + 1 - start : back + 1 - start] -= away - apart * (np.arange(n) + 0.5) / n
    led[back + 1 - start :] -= away + home - apart
    return led


def _above(take: Take, joint: int, start: int, end: int) -> Array:
    """World rotations (n, 4) of a joint's parent."""
    above = np.broadcast_to(rot.IDENTITY, (end - start, 4))
    for one in reversed(take.skeleton.ancestors(joint)):
        above = rot.multiply(above, take.rotations[start:end, one])
    return above


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
