"""The motion-texture as a picture: rotations of the joints as colours. No Qt."""

from __future__ import annotations

from collections import OrderedDict
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot

if TYPE_CHECKING:
    from mocapstudio.similarity.texture import MotionTexture

F32 = NDArray[np.float32]

SOFT = 40.0
"""Degrees about an axis that take its colour three quarters of the way."""

_KEPT = 6


def turned(texture: MotionTexture) -> F32:
    """(T, m, 3) degrees: rotation vector of each joint from its own mean rotation."""
    turns = texture.quaternions.astype(np.float64)
    away = rot.multiply(rot.conjugate(rot.mean(turns))[None], turns)
    return np.asarray(np.rad2deg(rot.to_rotation_vector(away)), dtype=np.float32)


def rgb(degrees: F32) -> F32:
    """Colours 0..1 of rotation vectors (..., 3): x red, y green, z blue; no turn is grey."""
    return np.asarray(0.5 + 0.5 * np.tanh(degrees / np.float32(SOFT)), dtype=np.float32)


class TexturePicture:
    """The colours of a texture, and their means over blocks of its frames.

    Blocks begin at multiples of their length, so that panning never makes the picture shimmer.

    Parameters
    ----------
    degrees
        (T, m, 3), see `turned`.
    order
        (N,) which of the m joints to keep, in the order of drawing.
    """

    def __init__(self, degrees: F32, order: NDArray[np.int64]) -> None:
        self.degrees = degrees
        self._colours = rgb(degrees[:, order]).transpose(1, 0, 2)
        self._blocks: OrderedDict[int, NDArray[np.uint32]] = OrderedDict()

    @property
    def frames(self) -> int:
        """T."""
        return int(self._colours.shape[1])

    def blocks(self, step: int) -> NDArray[np.uint32]:
        """(N, ceil(T / step)) colours as 0xffRRGGBB, the mean of each block of `step` frames."""
        if step not in self._blocks:
            starts = np.arange(0, self.frames, step)
            lengths = np.diff(starts, append=self.frames)[None, :, None]
            mean = np.add.reduceat(self._colours, starts, axis=1) / lengths
            part = np.round(255 * mean).astype(np.uint32)
            packed = 0xFF000000 | part[..., 0] << 16 | part[..., 1] << 8 | part[..., 2]
            self._blocks[step] = np.ascontiguousarray(packed, dtype=np.uint32)
            if len(self._blocks) > _KEPT:
                self._blocks.popitem(last=False)
        self._blocks.move_to_end(step)
        return self._blocks[step]
