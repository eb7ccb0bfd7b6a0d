"""What lies between two flanks, by the covariance of a residual in time.

A Gaussian process whose mean is the prediction: the residual known on both sides of a span is led
across it, dies away from the seams as fast as such residuals do, and meets both ends smoothly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]
Mask = NDArray[np.bool_]

FLANK_SECONDS = 1.0
_NUGGET = 1e-4


@dataclass(frozen=True)
class Kernel:
    """Covariance of a residual over a lag in seconds (Matérn), with a long tail.

    Parameters
    ----------
    seconds
        Length scale of the quick part.
    smooth
        Whether the residual has a second derivative too, so that its turns are foreseen.
    slow
        Share of a part six times as slow.
    floor
        Variance of an offset that stays.
    """

    seconds: float
    smooth: bool = False
    slow: float = 0.4
    floor: float = 0.2

    def __call__(self, lag: F64) -> F64:
        """Covariance at each lag, 1 + floor at 0."""
        a = np.abs(lag) * (np.sqrt(5.0 if self.smooth else 3.0) / self.seconds)
        quick = (1.0 + a + (a * a / 3.0 if self.smooth else 0.0)) * np.exp(-a)
        return np.asarray((1.0 - self.slow) * quick + self.slow * np.exp(-a / 6.0) + self.floor)


OF_PREDICTED = (Kernel(0.1), Kernel(0.3, True, 0.0))
"""Of what a prediction from the other joints leaves: in general, and over moments."""
OF_MOTION = (Kernel(0.2), Kernel(0.4, True, 0.0))
"""Of the motion itself, where nothing predicts it."""


def weights(kernel: Kernel, known: F64, wanted: F64) -> F64:
    """(n, k) weights of residuals at `known` (k,) for those at `wanted` (n,), both in seconds."""
    among = kernel(known[:, None] - known) + _NUGGET * np.eye(len(known))
    across = kernel(wanted[:, None] - known)
    return np.asarray(np.linalg.solve(among, across.T).T)


def flanks(usable: Mask, start: int, end: int, rate: float) -> NDArray[np.int64]:
    """Usable frames (k,) within a second before and after [start, end); `usable` is (F,)."""
    reach = max(2, round(FLANK_SECONDS * rate))
    low, high = max(start - reach, 0), min(end + reach, len(usable))
    frames = np.arange(low, high)
    return frames[usable[low:high] & ((frames < start) | (frames >= end))]


def led_across(
    residuals: F64, usable: Mask, start: int, end: int, rate: float, kernel: Kernel
) -> F64:
    """(n, ...) residual inside [start, end), from the `usable` (F,) frames of both flanks.

    `residuals` are (F, ...), known where usable.
    """
    at = flanks(usable, start, end, rate)
    if not len(at):
        return np.zeros((end - start, *residuals.shape[1:]))
    inside = weights(kernel, at / rate, np.arange(start, end) / rate)
    return np.tensordot(inside, residuals[at], axes=1)
