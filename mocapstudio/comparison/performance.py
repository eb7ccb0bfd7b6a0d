"""A performance: what a comparison needs of a recording, be it of joints or of markers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Row:
    """A joint or marker that can be compared.

    Parameters
    ----------
    name
        As in the file.
    limb
        Name of its limb, such as ``"left arm"``.
    role
        What it is in any body, such as ``"left elbow"``; "" where that is not known.
    """

    name: str
    limb: str
    role: str = ""


@dataclass(frozen=True, eq=False)
class BodyFrame:
    """A frame of reference that moves with the body.

    Parameters
    ----------
    origin
        (F, 3) metres in the world.
    axes
        (F, 3, 3): rows are the frame's axes in the world, right-handed and orthonormal.
    """

    origin: Array
    axes: Array

    def local(self, positions: Array) -> Array:
        """(F, N, 3) metres in this frame, of positions in the world."""
        away = positions - self.origin[:, None]
        return np.asarray(np.einsum("fij,fnj->fni", self.axes, away))


@dataclass(frozen=True, eq=False)
class Performance:
    """One recording, F frames at its own rate, N rows in order of limbs.

    Parameters
    ----------
    name
        Of the take.
    rate
        Frames a second.
    span
        Half-open span of frames that is compared: the take's trim.
    rows
        Joints or markers.
    positions
        (F, N, 3) metres in the world, complete.
    rotations
        (F, N, 4) local rotations of joints, of the hips without heading; None for markers.
    head, root
        The frames of neck and head, and of hips and heading.
    unreliable
        (F, N) True where a row should not count: missing, completed at a venture, or flagged.
    warnings
        What had to be assumed, as phrases.
    """

    name: str
    rate: Fraction
    span: tuple[int, int]
    rows: tuple[Row, ...]
    positions: Array
    rotations: Array | None
    head: BodyFrame
    root: BodyFrame
    unreliable: NDArray[np.bool_]
    warnings: tuple[str, ...] = ()

    @property
    def frames(self) -> int:
        """Number of frames."""
        return len(self.positions)

    def own(self, rows: Sequence[int]) -> list[str]:
        """Names of rows."""
        return [self.rows[i].name for i in rows]


def framed_alike(one: Performance, other: Performance) -> tuple[Performance, Performance]:
    """Give joints and markers the same frame of the head where they are compared with each other.

    Joints know how the chest is turned, markers do not: there neck, head and shoulders tell, in
    both. Performances of one kind, or without such rows, keep their frames.
    """
    if (one.rotations is None) == (other.rotations is None):
        return one, other
    frames = _frame_by_roles(one), _frame_by_roles(other)
    if frames[0] is None or frames[1] is None:
        return one, other
    return replace(one, head=frames[0]), replace(other, head=frames[1])


def _frame_by_roles(performance: Performance) -> BodyFrame | None:
    at = {row.role: i for i, row in enumerate(performance.rows)}
    wanted = ("neck", "head", "left shoulder", "right shoulder")
    if not all(role in at for role in wanted):
        return None
    neck, head, left, right = (performance.positions[:, at[role]] for role in wanted)
    return frame_along(neck, head - neck, -np.cross(left - right, head - neck))


def frame_along(origin: Array, z: Array, towards: Array) -> BodyFrame:
    """Build a frame with its z axis along `z` and `towards` in the yz plane (paper 4).

    Parameters
    ----------
    origin, z, towards
        (F, 3) metres. Where `towards` is parallel to `z` the plane of another frame is kept.
    """
    up = _unit(z)
    across = towards - np.sum(towards * up, axis=1, keepdims=True) * up
    forward = _unit(across)
    return BodyFrame(origin, np.stack([np.cross(forward, up), forward, up], axis=1))


def _unit(vectors: Array) -> Array:
    """Scale (F, 3) to unit length; a vector without length takes the nearest frame's."""
    length = np.linalg.norm(vectors, axis=1)
    known = np.flatnonzero(length > 1e-9)
    if not len(known):
        return np.tile([0.0, 0.0, 1.0], (len(vectors), 1))
    middles = (known[1:] + known[:-1]) / 2
    source = known[np.searchsorted(middles, np.arange(len(vectors)))]
    return np.asarray(vectors[source] / length[source, None])
