"""Performers beside each other: one's take frame by frame on the clock of another's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mocapstudio.motion.take import Take


def on_clock(take: Take, offset: float, other: Take, other_offset: float) -> Take:
    """Return another performer's take frame by frame as it is beside `take`.

    Before it begins and after it ends it stands still.

    Parameters
    ----------
    offset, other_offset
        Seconds by which each starts after the scene's zero.
    """
    if take.frames == other.frames and take.rate == other.rate and offset == other_offset:
        return other
    shift = (offset - other_offset) * float(other.rate)
    steps = np.arange(take.frames) * float(other.rate / take.rate)
    at = np.clip(np.floor(shift + steps + 0.5).astype(int), 0, other.frames - 1)
    return replace(
        other,
        rotations=np.ascontiguousarray(other.rotations[at]),
        translations=np.ascontiguousarray(other.translations[at]),
        rate=take.rate,
        trim=None,
    )
