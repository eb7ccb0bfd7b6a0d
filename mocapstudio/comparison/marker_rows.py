"""Performances of markers: rows, roles and body frames told by the labels (paper 4)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison import marker_names
from mocapstudio.comparison.performance import BodyFrame, Performance, Row, frame_along
from mocapstudio.motion.completion import complete
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.markers import MarkerTake

Array = NDArray[np.float64]

_NECK = (("nck",), ("clav",), ("neck",), ("lcla", "rcla"))
_BACK_OF_HEAD = (("bkhd",), ("lbhd", "rbhd"), ("lbhead", "rbhead"), ("head",), ("lfhd", "rfhd"))
_C7 = (("c7",), ("t1",), ("t2",), ("t10",))
_LEFT_HIP = (("lfhp", "lbhp"), ("lasi", "lpsi"), ("lfwt", "lbwt"), ("lasis", "lpsis"), ("lasi",))
_RIGHT_HIP = (("rfhp", "rbhp"), ("rasi", "rpsi"), ("rfwt", "rbwt"), ("rasis", "rpsis"), ("rasi",))
_LEFT_SHOULDER = (("lshd",), ("lsho",), ("lacr",), ("leftarm",), ("lshoulder",))
_RIGHT_SHOULDER = (("rshd",), ("rsho",), ("racr",), ("rightarm",), ("rshoulder",))
_LEFT_THIGH = (("lhip",), ("lhjc",), ("leftthigh",), ("leftupleg",), ("lthigh",))
_RIGHT_THIGH = (("rhip",), ("rhjc",), ("rightthigh",), ("rightupleg",), ("rthigh",))
_PAIRS = (
    (_LEFT_HIP, _RIGHT_HIP),
    (_LEFT_THIGH, _RIGHT_THIGH),
    (_LEFT_SHOULDER, _RIGHT_SHOULDER),
)

_TRUSTED_GAP = 0.5
"""Seconds: positions completed in longer gaps are not held against the performer."""


def performance_of_markers(
    take: MarkerTake, unreliable: NDArray[np.bool_] | None = None
) -> Performance:
    """Describe a take of markers; `unreliable` is (F, M), True where a marker should not count.

    Raises
    ------
    MocapError
        If no marker is ever seen.
    """
    seen = [i for i in range(len(take.labels)) if not take.missing[:, i].all()]
    if not seen:
        raise MocapError(f"{take.name}: no marker is ever seen")
    warnings = []
    if len(seen) < len(take.labels):
        never = [take.labels[i] for i in range(len(take.labels)) if i not in seen]
        warnings.append(f"never seen: {_listing(never)}")
    roles = marker_names.marker_roles(take.labels)
    limbs = [marker_names.limb_of(label) for label in take.labels]
    order = sorted(seen, key=lambda i: marker_names.LIMBS.index(limbs[i]))
    positions, doubtful = completed(take)
    if doubtful[:, order].any():
        share = float(doubtful[:, order].mean())
        warnings.append(f"{share:.1%} of the positions lie in long gaps and do not count")
    if unreliable is not None:
        doubtful = doubtful | unreliable
    there = [label if i in seen else "" for i, label in enumerate(take.labels)]
    root, said = _root_frame(there, positions, seen)
    head = _head_frame(there, positions)
    if head is None:
        said = (
            *said,
            "no markers of neck, head and C7 or shoulders: compared in the frame of the hips",
        )
    return Performance(
        name=take.name,
        rate=take.rate,
        span=take.span,
        rows=tuple(Row(take.labels[i], limbs[i], roles.get(i, "")) for i in order),
        positions=positions[:, order],
        rotations=None,
        head=head or root,
        root=root,
        unreliable=doubtful[:, order],
        warnings=(*warnings, *said),
    )


def completed(take: MarkerTake) -> tuple[Array, NDArray[np.bool_]]:
    """Complete what is missing, and tell which positions lie in gaps too long to be trusted.

    What nothing of the body tells, such as all markers missing at once, is interpolated.

    Returns
    -------
    positions
        (F, M, 3) metres; markers that are never seen stay NaN.
    doubtful
        (F, M).
    """
    doubtful = np.zeros(take.missing.shape, bool)
    if not take.missing.any():
        return take.positions, doubtful
    positions = complete(take).positions.copy()
    longest = _TRUSTED_GAP * float(take.rate)
    frames = np.arange(take.frames)
    for i in range(len(take.labels)):
        gone = take.missing[:, i]
        known = np.flatnonzero(~gone)
        if not gone.any() or not len(known):
            continue
        still = np.isnan(positions[:, i]).any(axis=1)
        for axis in range(3):
            positions[still, i, axis] = np.interp(
                frames[still], known, take.positions[known, i, axis]
            )
        edges = np.concatenate([[-1], known, [take.frames]])
        length = np.diff(edges)[np.searchsorted(edges, frames) - 1] - 1
        doubtful[:, i] = gone & (length > longest)
    return positions, doubtful


def _head_frame(labels: Sequence[str], positions: Array) -> BodyFrame | None:
    """NCK at the origin, NCK-BKHD along z, NCK-C7-BKHD in the yz plane (paper 4).

    Where C7 is not there, the shoulders tell which way the back is.
    """
    neck, back, c7, left, right = (
        marker_names.find(labels, *names)
        for names in (_NECK, _BACK_OF_HEAD, _C7, _LEFT_SHOULDER, _RIGHT_SHOULDER)
    )
    if not (neck and back and (c7 or (left and right))):
        return None
    origin = positions[:, neck].mean(axis=1)
    along = positions[:, back].mean(axis=1) - origin
    if c7:
        return frame_along(origin, along, positions[:, c7].mean(axis=1) - origin)
    across = positions[:, left].mean(axis=1) - positions[:, right].mean(axis=1)
    return frame_along(origin, along, -np.cross(across, along))


def _root_frame(
    labels: Sequence[str], positions: Array, seen: list[int]
) -> tuple[BodyFrame, tuple[str, ...]]:
    """Middle of the pelvis, world's up, and heading from right to left hip (or shoulder)."""
    for left_names, right_names in _PAIRS:
        left, right = (marker_names.find(labels, *names) for names in (left_names, right_names))
        if left and right:
            one, other = positions[:, left].mean(axis=1), positions[:, right].mean(axis=1)
            level = (one - other) * [1.0, 0.0, 1.0]
            up = np.broadcast_to([0.0, 1.0, 0.0], level.shape)
            frame = frame_along((one + other) / 2, up, np.cross(level, up))
            return _turned(frame), ()
    middle = positions[:, seen].mean(axis=1)
    still = BodyFrame(middle, np.broadcast_to(np.eye(3), (len(middle), 3, 3)))
    return still, ("no markers of hips or shoulders: the direction the body faces stays in",)


def _turned(frame: BodyFrame) -> BodyFrame:
    """Name the axes as the body frame does: x left, y up, z forward."""
    x, forward, up = np.moveaxis(frame.axes, 1, 0)
    return BodyFrame(frame.origin, np.stack([-x, up, forward], axis=1))


def _listing(names: list[str], most: int = 6) -> str:
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more
