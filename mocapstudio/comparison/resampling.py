"""Lanczos resampling of sequences of poses (paper 4, 'Data reduction')."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_LOBES = 3
_CHUNK = 512


def lanczos(values: Array, frames: int) -> Array:
    """Resample (F, ...) to `frames` frames; first and last stay first and last.

    Where frames get fewer, the kernel is widened, so that what the lower rate cannot hold is
    filtered out. Beyond the ends the sequence is continued by point reflection, so that
    a line goes on as a line.
    """
    count = len(values)
    if frames == count or count == 1:
        return np.repeat(values, frames, axis=0) if count == 1 else values
    flat = np.asarray(values, np.float64).reshape(count, -1)
    step = (count - 1) / max(frames - 1, 1)
    width = _LOBES * max(step, 1.0)
    reach = int(np.ceil(width))
    padded = np.pad(flat, ((reach, reach), (0, 0)), mode="reflect", reflect_type="odd")
    taps = np.arange(-reach, reach + 1)
    result = np.empty((frames, flat.shape[1]))
    for start in range(0, frames, _CHUNK):
        at = np.arange(start, min(frames, start + _CHUNK)) * step
        near = np.round(at).astype(np.int64)[:, None] + taps
        apart = (near - at[:, None]) / max(step, 1.0)
        weight = np.where(np.abs(apart) < _LOBES, np.sinc(apart) * np.sinc(apart / _LOBES), 0.0)
        weight /= weight.sum(axis=1, keepdims=True)
        result[start : start + len(at)] = np.einsum("ft,ftd->fd", weight, padded[near + reach])
    return result.reshape(frames, *values.shape[1:])
