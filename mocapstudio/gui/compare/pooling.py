"""Poses and curves made small enough to draw. No Qt."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_KEPT = 8


class PooledPoses:
    """Poses as colours, and their means over blocks of frames.

    Blocks begin at multiples of their length, so that panning never makes the picture shimmer.

    Parameters
    ----------
    poses
        (F, N, 3) features; NaN where there is none.
    low, high
        (3,) values that are drawn darkest and brightest, for each of the three features.
    """

    def __init__(
        self, poses: NDArray[np.float32], low: NDArray[np.float32], high: NDArray[np.float32]
    ) -> None:
        self._known: NDArray[np.bool_] = np.asarray(np.isfinite(poses).all(axis=2))
        scaled = (poses - low) / np.maximum(high - low, 1e-6)
        self._poses = np.where(self._known[..., None], scaled, 0.0).astype(np.float32)
        self._pooled: OrderedDict[int, NDArray[np.uint32]] = OrderedDict()

    @property
    def frames(self) -> int:
        """F."""
        return len(self._poses)

    def blocks(self, step: int) -> NDArray[np.uint32]:
        """(N, ceil(F / step)): mean colour of each row in each block, as 0xAARRGGBB.

        Alpha is 0 where a row has no pose in the whole block.
        """
        step = max(step, 1)
        if step not in self._pooled:
            self._pooled[step] = self._pool(step)
            if len(self._pooled) > _KEPT:
                self._pooled.popitem(last=False)
        self._pooled.move_to_end(step)
        return self._pooled[step]

    def _pool(self, step: int) -> NDArray[np.uint32]:
        starts = np.arange(0, self.frames, step)
        if step == 1:
            poses, count = self._poses, self._known.astype(np.float32)
        else:
            poses = np.add.reduceat(self._poses, starts, axis=0)
            count = np.add.reduceat(self._known, starts, axis=0, dtype=np.float32)
        mean = poses / np.maximum(count, 1.0)[..., None]
        rgb = (np.clip(mean, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint32)
        alpha = np.where(count > 0, np.uint32(0xFF000000), np.uint32(0))
        packed = alpha | rgb[..., 0] << 16 | rgb[..., 1] << 8 | rgb[..., 2]
        return np.ascontiguousarray(np.where(count > 0, packed, 0).T.astype(np.uint32))


def contrast(
    one: NDArray[np.float32], other: NDArray[np.float32]
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """(3,) lowest and highest value of each feature in two performances, outliers left out.

    Both are drawn by the same scale, so that equal colours are equal poses.
    """
    every = max(1, max(len(one), len(other)) // 400)
    both = np.concatenate([one[::every].reshape(-1, 3), other[::every].reshape(-1, 3)])
    both = both[np.isfinite(both).all(axis=1)]
    if not len(both):
        return np.zeros(3, np.float32), np.ones(3, np.float32)
    low, high = np.percentile(both, (1, 99), axis=0)
    return low.astype(np.float32), high.astype(np.float32)


@dataclass(frozen=True)
class Columns:
    """A curve pooled into columns of pixels.

    Parameters
    ----------
    first
        First frame of each column.
    frames
        Frames a column holds.
    low, high
        Lowest and highest value in it; NaN where all are.
    timing
        What the column is coloured with: the commonest of early and late, else 0.
    """

    first: NDArray[np.int64]
    frames: int
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    timing: NDArray[np.int8]


def columns(
    values: NDArray[np.floating],
    timing: NDArray[np.int8],
    start: float,
    end: float,
    step: int,
) -> Columns:
    """Pool the values of the frames from `start` to `end` into blocks of `step` frames.

    Parameters
    ----------
    values
        (F,) a curve.
    timing
        (F,) -1, 0 or 1 a frame.
    """
    frames = len(values)
    first = max(int(np.floor(start)) // step * step, 0)
    last = min(int(np.ceil(end)) + step + 1, frames)
    starts = np.arange(first, max(last, first + 1), step)
    starts = starts[starts < frames]
    if not len(starts):
        empty = np.zeros(0)
        return Columns(starts, step, empty, empty, empty.astype(np.int8))
    part = values[first : starts[-1] + step].astype(np.float64)
    offsets = starts - first
    known = np.isfinite(part)
    low = np.minimum.reduceat(np.where(known, part, np.inf), offsets)
    high = np.maximum.reduceat(np.where(known, part, -np.inf), offsets)
    low[~np.isfinite(low)] = np.nan
    high[~np.isfinite(high)] = np.nan
    kinds = timing[first : starts[-1] + step]
    early = np.add.reduceat((kinds > 0).astype(int), offsets)
    late = np.add.reduceat((kinds < 0).astype(int), offsets)
    count = np.add.reduceat(np.ones(len(kinds), dtype=int), offsets)
    shown = np.where(early >= late, 1, -1) * (2 * np.maximum(early, late) >= count)
    return Columns(starts, step, low, high, shown.astype(np.int8))
