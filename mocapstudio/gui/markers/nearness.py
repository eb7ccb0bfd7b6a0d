"""Which markers another one could be taken for. No Qt."""

from __future__ import annotations

import numpy as np

from mocapstudio.motion.markers import MarkerTake


def nearest_markers(take: MarkerTake, marker: str, frame: int) -> list[tuple[str, str]]:
    """Other markers with their distance at a frame in words, the nearest first.

    Where the marker is missing there, it is looked for at the nearest frame in which it is seen.
    """
    at = take.index[marker]
    seen = np.flatnonzero(~take.missing[:, at])
    here = take.positions[frame, at]
    if len(seen):
        here = take.positions[int(seen[np.argmin(np.abs(seen - frame))]), at]
    apart = np.linalg.norm(take.positions[frame] - here, axis=1)
    order = np.argsort(np.where(np.isnan(apart), np.inf, apart), kind="stable")
    return [
        (take.labels[int(i)], "missing here" if np.isnan(apart[i]) else f"{100 * apart[i]:.1f} cm")
        for i in order
        if i != at
    ]
