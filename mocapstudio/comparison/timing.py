"""When the source does what the reference does: warping function, misalignment, slopes (paper 4).

Everything here counts in frames at the takes' own rates, 0-based.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Path = NDArray[np.int32]


def at_own_rates(path: Path, reference: Array, source: Array) -> Path:
    """Spread a path over other frames.

    Parameters
    ----------
    path
        (P, 2) pairs of frames as they were aligned.
    reference, source
        Where those frames lie among the takes' own, fractional and ascending.

    Returns
    -------
    (Q, 2) pairs of own frames, in steps of (1, 1), (1, 0) and (0, 1).
    """
    corners = np.stack([reference[path[:, 0]], source[path[:, 1]]], axis=1)
    steps = np.maximum(np.ceil(np.abs(np.diff(corners, axis=0)).max(axis=1) - 1e-9), 1).astype(int)
    legs = np.repeat(np.arange(len(steps)), steps)
    share = (np.arange(len(legs)) - np.repeat(np.cumsum(steps) - steps, steps)) / steps[legs]
    line = corners[legs] + share[:, None] * (corners[legs + 1] - corners[legs])
    pairs = np.round(np.vstack([line, corners[-1:]]) - 1e-9).astype(np.int32)
    moves = np.any(np.diff(pairs, axis=0), axis=1)
    return np.asarray(pairs[np.concatenate([[True], moves])])


def warping_function(path: Path, frames: int, *, rounded: bool = False) -> Array:
    """F: (frames,) mean of the reference frames matched with each source frame (equation 1).

    NaN for source frames that the path leaves out.
    """
    count = np.bincount(path[:, 1], minlength=frames)
    total = np.bincount(path[:, 1], weights=path[:, 0], minlength=frames)
    mean = np.where(count > 0, total / np.maximum(count, 1), np.nan)
    return np.floor(mean + 0.5) if rounded else mean


def misalignment(
    warp: Array, rates: tuple[float, float], tempo: float = 1.0, begin: tuple[float, float] = (0, 0)
) -> Array:
    """G in seconds: how far the source is ahead of the reference (equation 2).

    Parameters
    ----------
    warp
        (S,) F, NaN outside the path: there G goes on as at the nearest matched frame.
    rates
        Frames a second of reference and source.
    tempo
        Seconds of the reference that correspond to one second of the source; 1 for true speed.
    begin
        Frames of reference and source from which time counts.
    """
    own = (np.arange(len(warp)) - begin[1]) / rates[1] * tempo
    gap = (warp - begin[0]) / rates[0] - own
    known = np.flatnonzero(~np.isnan(gap))
    return np.asarray(gap[known[_nearest(known, len(gap))]])


def warp_of(
    gap: Array, rates: tuple[float, float], begin: tuple[float, float], frames: int
) -> Array:
    """F for every source frame from G at true speed, kept within the reference's frames."""
    seconds = (np.arange(len(gap)) - begin[1]) / rates[1] + gap
    return np.clip(seconds * rates[0] + begin[0], 0, frames - 1)


def slopes(gap: Array, rate: float, window: float, tolerance: float) -> NDArray[np.int8]:
    """Classify each frame as hastened (1), delayed (-1) or on time (0).

    Parameters
    ----------
    gap
        (S,) misalignment in seconds.
    rate
        Frames a second.
    window
        Seconds, centred on the frame, over which gain or loss counts; shorter at the ends.
    tolerance
        Seconds that may be gained or lost within it.
    """
    half = max(1, round(window * rate / 2))
    at = np.arange(len(gap))
    gain = gap[np.minimum(at + half, len(gap) - 1)] - gap[np.maximum(at - half, 0)]
    return np.where(np.abs(gain) > tolerance, np.sign(gain), 0).astype(np.int8)


def _nearest(known: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    middles = (known[1:] + known[:-1]) / 2
    return np.searchsorted(middles, np.arange(count), side="left")
