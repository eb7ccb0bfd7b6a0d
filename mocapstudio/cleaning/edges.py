"""Edges of flags at the take's own rate: the 24 fps map only tells them to some frames."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.similarity.texture import TEXTURE_RATE

_SEARCH = 4
_WIDEN = 1
_SHARE = 0.25
_DEGREES = (4.0, 10.0)
_LEAST_PEAK = 12.0


def refined(
    fine: NDArray[np.float32], start: int, end: int, rate: float, limits: tuple[int, int]
) -> tuple[int, int]:
    """Move the edges of a span to where the departure really rises and falls.

    Parameters
    ----------
    fine
        (F,) degrees at the take's own rate, of the flagged row.
    start, end
        Half-open span as the map has it.
    rate
        Frames a second.
    limits
        Half-open span that may not be left: the trim, or the gap to the next flag of the row.

    Returns
    -------
    Half-open span. Each edge moves inward by four 24 fps frames at most, outward by one; where
    nothing stands out, the span stays as it is.
    """
    each = rate / TEXTURE_RATE
    inward, outward = round(_SEARCH * each), round(_WIDEN * each)
    low, high = max(start - outward, limits[0]), min(end + outward, limits[1])
    around = np.concatenate(
        [
            fine[max(low - 2 * inward, limits[0]) : low],
            fine[high : min(high + 2 * inward, limits[1])],
        ]
    )
    usual = float(np.median(around)) if len(around) else 0.0
    peak = float(fine[start:end].max()) - usual
    if peak < _LEAST_PEAK:
        return start, end
    cut = usual + float(np.clip(_SHARE * peak, *_DEGREES))
    above = np.flatnonzero(fine[low:high] > cut) + low
    first = int(np.clip(above[0], low, start + inward))
    last = int(np.clip(above[-1] + 1, end - inward, high))
    return (first, last) if first < last else (start, end)
