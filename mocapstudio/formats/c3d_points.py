"""The points of a C3D file: coordinates, residuals, and which samples are missing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.bvh_rows import LARGEST
from mocapstudio.formats.c3d_layout import Layout

Mask = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Points:
    """Every point of a file, in its own units and axes.

    Attributes
    ----------
    xyz
        (F, P, 3); whatever stands there where a sample is missing.
    invalid
        (F, P) True where the residual says that there is no sample.
    no_number
        (F, P) True where a coordinate is no number, or one that no capture holds.
    zero
        (F, P) True where all coordinates are exactly zero.
    measured
        (F, P) True where a camera or a residual tells that the sample was measured.
    """

    xyz: NDArray[np.float32]
    invalid: Mask
    no_number: Mask
    zero: Mask
    measured: Mask

    @property
    def missing(self) -> Mask:
        """(F, P) True where there is no sample."""
        return self.invalid | self.no_number | self.zero


def read_points(data: bytes, layout: Layout) -> Points:
    """Read all points of all frames; the samples lie within the data."""
    table = _table(data, layout)
    xyz = table[..., :3]
    with np.errstate(invalid="ignore"):
        no_number = ~(np.abs(xyz) <= LARGEST).all(axis=2)
        fourth = table[..., 3]
        words = np.where(np.abs(fourth) < 0x8000, fourth, np.where(fourth < 0, -1, 0))
        words = words.astype(np.int16)
    if not layout.real:
        xyz = xyz * np.float32(layout.scale)
    invalid = words < 0
    zero = (xyz == 0).all(axis=2) & ~invalid
    return Points(xyz, invalid, no_number & ~invalid, zero, words > 0)


def _table(data: bytes, layout: Layout) -> NDArray[np.float32]:
    """(F, P, 4) numbers as they stand; integers not yet scaled."""
    whole = memoryview(data)[layout.start : layout.start + layout.frames * layout.stride]
    # Without analogue samples between the frames nothing has to be cut out.
    if layout.analog:
        rows = np.frombuffer(whole, dtype=np.uint8).reshape(layout.frames, layout.stride)
        whole = memoryview(rows[:, : 4 * layout.points * layout.width].tobytes())
    numbers = layout.numbers
    flat = numbers.floats(whole) if layout.real else numbers.words(whole).astype(np.float32)
    return flat.reshape(layout.frames, layout.points, 4)
