"""Which joint carries each marker, and where on it the marker is expected."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.solving.segments import Segment, segments
from mocapstudio.motion.solving.sites import LEG, Site, site_of
from mocapstudio.motion.solving.template import Template

Array = NDArray[np.float64]

_UNKNOWN = 0.3
"""Metres: how far off a marker is whose place nobody knows."""


@dataclass(frozen=True, eq=False)
class Attachment:
    """M markers on joints.

    Attributes
    ----------
    markers
        (M,) indices of markers in the take.
    joints
        (M,) the joint that carries each.
    offsets
        (M, 3) metres in that joint's frame: where it is expected.
    spreads
        (M,) metres: how far from there it may well be.
    """

    markers: NDArray[np.int64]
    joints: NDArray[np.int64]
    offsets: Array
    spreads: Array

    def with_marker(self, marker: int, joint: int, offset: Array) -> Attachment:
        """Add a marker at `offset` (3,), a place on its joint that was measured, not known."""
        return Attachment(
            np.append(self.markers, marker),
            np.append(self.joints, joint),
            np.vstack([self.offsets, offset]),
            np.append(self.spreads, _UNKNOWN),
        )

    def scaled(self, factor: float) -> Attachment:
        """The same markers on a body `factor` times as large."""
        return replace(self, offsets=self.offsets * factor)


def attach_by_name(take: MarkerTake, template: Template, seen: Sequence[int]) -> Attachment:
    """Attach the markers whose names tell where they sit; the others are left out.

    Parameters
    ----------
    take
        The markers.
    template
        The body.
    seen
        Markers that have positions.
    """
    positions, world = template.standing_pose
    parts = segments(template.skeleton, positions, template.hinges)
    size = _leg(parts) / LEG
    rows = []
    for marker in seen:
        known = site_of(take.labels[marker])
        segment = _segment(parts, *known) if known else None
        if known is None or segment is None:
            continue
        place = _place(segment, known[1], known[0], size)
        joint = segment.joint_at(known[1].along)
        offset = world[joint].T @ (place - positions[joint])
        rows.append((marker, joint, offset, known[1].spread * size))
    return Attachment(
        np.array([row[0] for row in rows], dtype=np.int64),
        np.array([row[1] for row in rows], dtype=np.int64),
        np.array([row[2] for row in rows]).reshape(-1, 3),
        np.array([row[3] for row in rows]),
    )


def _segment(parts: dict[str, Segment], side: str, site: Site) -> Segment | None:
    return parts.get(f"{side} {site.segment}" if side else site.segment) or parts.get(site.segment)


def _place(segment: Segment, site: Site, side: str, size: float) -> Array:
    # Trunk segments have no side of their own: outwards is left of them.
    outer = site.outer
    if site.segment in {"pelvis", "chest", "head", "neck"} and side == "right":
        outer = -outer
    aside = outer * segment.outer + site.front * segment.front + site.up * segment.up
    return np.asarray(segment.start + site.along * segment.bone + size * aside)


def _leg(parts: dict[str, Segment]) -> float:
    lengths = [
        float(np.linalg.norm(parts[f"{side} thigh"].bone))
        + float(np.linalg.norm(parts[f"{side} shank"].bone))
        for side in ("left", "right")
        if f"{side} thigh" in parts and f"{side} shank" in parts
    ]
    return float(np.mean(lengths)) if lengths else LEG


def attach_by_rigidity(
    take: MarkerTake, others: Sequence[int], positions: Array, world: Array, frames: Array
) -> dict[int, tuple[int, Array, float]]:
    """For each of the markers `others` the joint in whose frame it moves least.

    Parameters
    ----------
    take
        The markers.
    others
        Markers to attach.
    positions, world
        (K, J, 3) and (K, J, 3, 3): solved joints.
    frames
        (K,) the frames they were solved at.

    Returns
    -------
    For each marker the joint, its offset (3,) there and its spread, metres.
    """
    found = {}
    for marker in others:
        seen = take.positions[frames.astype(int), marker]
        here = ~np.isnan(seen).any(axis=1)
        if here.sum() < 3:
            continue
        away = seen[here, None] - positions[here]
        local = np.einsum("kjba,kjb->kja", world[here], away)
        middle = np.median(local, axis=0)
        spread = np.sqrt(((local - middle) ** 2).sum(axis=2).mean(axis=0))
        # Of joints that do as well the nearest carries it.
        close = spread + 0.02 * np.linalg.norm(middle, axis=1)
        joint = int(np.argmin(close))
        found[marker] = (joint, middle[joint], float(spread[joint]))
    return found
