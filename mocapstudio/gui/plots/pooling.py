"""The digression map made small enough to draw, without losing a single frame's error. No Qt."""

from __future__ import annotations

from collections import OrderedDict

import numpy as np
from numpy.typing import NDArray

LEVELS = 256
_KEPT = 6


class PooledMap:
    """A map in 256 levels, and its largest values over blocks of frames.

    Blocks begin at multiples of their length, so that panning never makes the picture shimmer.

    Parameters
    ----------
    values
        (F, R), 0..1; NaN counts as 0.
    order
        (N,) which of the R rows to keep, in the order of drawing.
    """

    def __init__(self, values: NDArray[np.float32], order: NDArray[np.int64]) -> None:
        clean = np.nan_to_num(values[:, order], nan=0.0)
        scaled = np.clip(clean, 0.0, 1.0) * np.float32(LEVELS - 1) + np.float32(0.5)
        self._levels = np.ascontiguousarray(scaled.astype(np.uint8).T)
        self._pooled: OrderedDict[int, NDArray[np.uint8]] = OrderedDict()

    @property
    def frames(self) -> int:
        """F."""
        return int(self._levels.shape[1])

    def blocks(self, step: int) -> NDArray[np.uint8]:
        """(N, ceil(F / step)): the largest level of each row in each block of `step` frames."""
        if step <= 1:
            return self._levels
        if step not in self._pooled:
            starts = np.arange(0, self.frames, step)
            self._pooled[step] = np.maximum.reduceat(self._levels, starts, axis=1)
            if len(self._pooled) > _KEPT:
                self._pooled.popitem(last=False)
        self._pooled.move_to_end(step)
        return self._pooled[step]


def block_length(frames_per_pixel: float) -> int:
    """Frames a block must hold so that it is at least one pixel wide."""
    return max(1, int(np.ceil(frames_per_pixel - 1e-9)))
