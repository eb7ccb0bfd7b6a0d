"""From probabilities to spans: none too short, none over drawn ones, none that travels."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.runs import runs

Array = NDArray[np.float64]

_SHORTEST = 0.05
"""Seconds: shorter contacts are none, shorter gaps are bridged."""
_WIDE = 0.075
"""Share of the leg: a point that gets farther from its middle has been set down twice."""
_SLIDING = 0.25
"""Share of the leg a second at which a point in contact travels."""
_PIECE = 0.07
"""Seconds that a part of a contact lasts at least."""


def contact_spans(
    probability: Array,
    rate: float,
    within: tuple[int, int],
    taken: Sequence[tuple[int, int]] = (),
) -> list[tuple[int, int]]:
    """Half-open spans in which a point is in contact rather than not.

    Parameters
    ----------
    probability
        (F,) of contact.
    rate
        Frames a second.
    within
        Half-open span outside which nothing is in contact.
    taken
        Spans that are spoken for.
    """
    fewest = max(1, round(_SHORTEST * rate))
    contact = probability > 0.5
    low, high = within
    for start, end in runs(~contact):
        if end - start < fewest and start > low and end < high:
            contact[start:end] = True
    contact[:low] = contact[high:] = False
    for start, end in taken:
        contact[start:end] = False
    return [(a, b) for a, b in runs(contact) if b - a >= fewest]


def set_down(
    span: tuple[int, int], place: Array, speed: Array, rate: float, leg: float
) -> list[tuple[int, int]]:
    """Part a contact where its point slides or hops from one place to another.

    Parameters
    ----------
    span
        Half-open.
    place
        (F, 3) metres.
    speed
        (F,) legs a second.
    rate, leg
        Frames a second; metres.

    Returns
    -------
    list of spans
        `span` itself where the point stays in one place, or creeps.
    """
    start, end = span
    piece = max(1, round(_PIECE * rate))
    own = place[start:end]
    away = np.linalg.norm(own - np.median(own, axis=0), axis=1)
    if away.max() <= _WIDE * leg or end - start < 3 * piece:
        return [span]
    inside = speed[start + piece : end - piece]
    peak = start + piece + int(inside.argmax())
    if speed[peak] < _SLIDING:
        return [span]
    fast = speed[start:end] > max(_SLIDING, speed[peak] / 2)
    left, right = next((a, b) for a, b in runs(fast) if start + a <= peak < start + b)
    return [
        found
        for part in ((start, start + left), (start + right, end))
        if part[1] - part[0] >= piece
        for found in set_down(part, place, speed, rate, leg)
    ]
