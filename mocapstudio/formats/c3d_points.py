"""The points of a C3D file: coordinates, residuals, and which samples are missing."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.bvh_rows import LARGEST
from mocapstudio.formats.c3d_layout import Layout
from mocapstudio.motion import rotations as rot

Mask = NDArray[np.bool_]
Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_AT_ONCE = 1 << 12
"""Points read at a time, so that the numbers of a file are never held a second time as a whole."""


@dataclass(frozen=True, eq=False)
class Points:
    """Every point of a file, in its own units and axes.

    Attributes
    ----------
    data, layout
        The file and where the samples stand in it: coordinates are read when they are asked for.
    invalid
        (F, P) True where the residual says that there is no sample.
    no_number
        (F, P) True where a coordinate is no number, or one that no capture holds.
    zero
        (F, P) True where all coordinates are exactly zero.
    measured
        (F, P) True where a camera or a residual tells that the sample was measured.
    """

    data: bytes
    layout: Layout
    invalid: Mask
    no_number: Mask
    zero: Mask
    measured: Mask

    @property
    def missing(self) -> Mask:
        """(F, P) True where there is no sample."""
        return self.invalid | self.no_number | self.zero

    def filled(self, points: Indices) -> Mask | None:
        """(F, N) True where samples of some points were computed, or None where none was.

        They have neither camera nor residual, while most samples of that point have, or some of
        that point and most of all.
        """
        there = ~self.missing[:, points]
        measured = self.measured[:, points] & there
        own = measured.sum(axis=0)
        mostly = measured.sum() * 2 > there.sum()
        found = there & ~measured & ((own * 2 > there.sum(axis=0)) | (mostly & (own > 0)))
        return found if found.any() else None

    def coordinates(self, frames: slice | Indices, points: Indices) -> NDArray[np.float32]:
        """(K, N, 3) of some frames and points, NaN where missing."""
        xyz, _ = _samples(self.data, self.layout, frames, points)
        missing = (mask[frames][:, points] for mask in (self.invalid, self.no_number, self.zero))
        for mask in missing:
            xyz[mask] = np.nan
        return xyz

    def positions(self, points: Indices, units: Array, to_inside: Array) -> Array:
        """Metres, Y up, of some points; NaN where missing.

        Parameters
        ----------
        points
            (N,) indices.
        units
            (N,) metres per unit.
        to_inside
            Quaternion from the file's axes to ours.

        Returns
        -------
        (F, N, 3).
        """
        axes = rot.to_matrix(to_inside).T
        result = np.empty((self.layout.frames, len(points), 3))
        for frames in _spans(self.layout):
            np.matmul(self.coordinates(frames, points) * units[:, None], axes, out=result[frames])
        return result


def read_points(data: bytes, layout: Layout) -> Points:
    """Tell samples from gaps in all frames; the samples lie within the data."""
    shape = (layout.frames, layout.points)
    invalid, no_number, zero, measured = (np.empty(shape, dtype=bool) for _ in range(4))
    every = np.arange(layout.points)
    for frames in _spans(layout):
        xyz, fourth = _samples(data, layout, frames, every)
        with np.errstate(invalid="ignore"):
            words = np.where(np.abs(fourth) < 0x8000, fourth, np.where(fourth < 0, -1, 0))
            words = words.astype(np.int16)
            invalid[frames] = words < 0
            no_number[frames] = ~(np.abs(xyz) <= LARGEST).all(axis=2) & ~invalid[frames]
        zero[frames] = (xyz == 0).all(axis=2) & ~invalid[frames]
        measured[frames] = words > 0
    return Points(data, layout, invalid, no_number, zero, measured)


def _spans(layout: Layout) -> Iterator[slice]:
    step = max(1, _AT_ONCE // max(1, layout.points))
    return (slice(at, at + step) for at in range(0, layout.frames, step))


def _samples(
    data: bytes, layout: Layout, frames: slice | Indices, points: Indices
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Coordinates (K, N, 3), and what stands beside them: (K, N) residual and cameras."""
    whole = memoryview(data)[layout.start : layout.start + layout.frames * layout.stride]
    rows = np.frombuffer(whole, dtype=np.uint8).reshape(layout.frames, layout.stride)
    # Analogue samples between the frames are cut out.
    own = rows[frames, : 4 * layout.points * layout.width]
    each = own.reshape(len(own), layout.points, 4 * layout.width)[:, points]
    numbers = layout.numbers
    if layout.real:
        table = numbers.floats(each.tobytes()).reshape(len(own), len(points), 4)
        return table[..., :3], table[..., 3]
    table = numbers.words(each.tobytes()).astype(np.float32).reshape(len(own), len(points), 4)
    return table[..., :3] * np.float32(layout.scale), table[..., 3]
