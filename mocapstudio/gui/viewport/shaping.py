"""Which bones and balls a skeleton gets, and how thick they are, sized to the performer."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.gui.viewport.figure import Figure
from mocapstudio.gui.viewport.solids import BONE, SKULL, Detail, Floats, Indices, triangles
from mocapstudio.gui.viewport.world import Points
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.topology import topology

# Shares of the body's height.
_THICKEST, _THINNEST, _FINGER, _HEAD = 0.017, 0.0065, 0.0038, 0.043
_ZERO = 1e-4
# A head is at least this many times as long as it is wide to one side.
_LONG = 2.5


@dataclass(frozen=True)
class _Bones:
    """Bones to draw; `skull` is one of them, and may begin where its bone ends (`beyond`)."""

    middles: Indices
    starts: Indices
    ends: Indices
    skull: int | None = None
    beyond: bool = False


def build_figure(skeleton: Skeleton, points: Points, detail: Detail) -> Figure:
    """Shape a figure for a skeleton.

    Parameters
    ----------
    skeleton
        J joints and E tips.
    points
        (J + E, 3) metres in any pose of the take: bone lengths are read off it, since joints
        with translations of their own may have none in the rest pose.
    detail
        How finely to cut.
    """
    height = stature(skeleton, points)
    own = _bones(skeleton, points, height)
    places = np.concatenate([points, points[own.middles].mean(axis=1)])
    length = np.linalg.norm(places[own.ends] - places[own.starts], axis=1)
    radius = _bone_radii(skeleton, own, length, height)
    rings = radius[:, None] * BONE[:, 1]
    place = np.broadcast_to(BONE[:, 0], rings.shape).copy()
    if own.skull is not None:
        one = own.skull
        rings[one] = _HEAD * height * SKULL[:, 1]
        reach = max(float(length[one]), _LONG * _HEAD * height / float(np.ptp(SKULL[:, 0])))
        place[one] = float(own.beyond) + SKULL[:, 0] * reach / length[one]
    balls = _balls(skeleton, points, own, height)
    return Figure(
        joints=len(skeleton),
        middles=own.middles,
        owners=skeleton.parents[own.middles[:, 0]],
        starts=own.starts,
        ends=own.ends,
        balls=balls,
        ball_radius=_ball_radii(balls, own, radius, len(places), height),
        rings=rings.astype(np.float32),
        ring_place=place.astype(np.float32),
        triangles=triangles(len(balls), len(own.starts), detail),
        detail=detail,
    )


def stature(skeleton: Skeleton, points: NDArray[np.floating]) -> float:
    """Metres: about a person's height, whatever the pose, read off the bones' lengths.

    It is four fifths of the longest way along bones from one tip to another, which in a person
    leads from a hand to a foot.
    """
    parents = np.concatenate([skeleton.parents, skeleton.end_parents])
    below = np.zeros(len(parents))
    longest = 0.0
    for point in range(len(parents) - 1, 0, -1):
        parent = int(parents[point])
        reach = below[point] + float(np.linalg.norm(points[point] - points[parent]))
        longest = max(longest, below[parent] + reach)
        below[parent] = max(below[parent], reach)
    return max(0.8 * longest, 1e-3)


def _bones(skeleton: Skeleton, points: Points, height: float) -> _Bones:
    above = list(topology(skeleton).above_hips)
    starts = np.concatenate([skeleton.parents[1:], skeleton.end_parents]).astype(np.int64)
    ends = np.arange(1, len(points))
    long = np.linalg.norm(points[ends] - points[starts], axis=1) > _ZERO * height
    # What only carries the body through the world is none of its bones.
    kept = long & ~np.isin(starts, above)
    bones = _Bones(np.zeros((0, 2), dtype=np.int64), starts[kept], ends[kept])
    return _with_head(skeleton, points, bones)


def _with_head(skeleton: Skeleton, points: Points, bones: _Bones) -> _Bones:
    """Say which bone is the skull, or add one, for the last joint of the head."""
    parts = topology(skeleton)
    head = next((limb.joints for limb in parts.limbs if limb.name == "head"), ())
    solid = [j for j in head if j not in parts.details]
    if not solid:
        return bones
    top, starts, ends = solid[-1], bones.starts, bones.ends
    tips = np.flatnonzero((starts == top) & (ends >= len(skeleton)))
    if len(tips):
        length = np.linalg.norm(points[ends[tips]] - points[top], axis=1)
        return replace(bones, skull=int(tips[np.argmax(length)]))
    eyes = [c for c in skeleton.children[top] if c in parts.details][:2]
    if len(eyes) == 2:
        # One bone to between the eyes instead of one to each.
        kept = ~np.isin(ends, eyes)
        starts, ends = np.append(starts[kept], top), np.append(ends[kept], len(points))
        return _Bones(np.array([eyes]), starts, ends, len(starts) - 1)
    neck = np.flatnonzero(ends == top)
    if not len(neck):
        return bones
    starts, ends = np.append(starts, starts[neck[0]]), np.append(ends, top)
    return _Bones(bones.middles, starts, ends, len(starts) - 1, beyond=True)


def _bone_radii(skeleton: Skeleton, bones: _Bones, length: Floats, height: float) -> Floats:
    details = list(topology(skeleton).details)
    fine = np.isin(bones.starts, details) | np.isin(bones.ends, details)
    radius = np.clip(0.1 * length, _THINNEST * height, _THICKEST * height)
    return np.where(fine, _FINGER * height, radius).astype(np.float32)


def _balls(skeleton: Skeleton, points: Points, bones: _Bones, height: float) -> Indices:
    parents = np.concatenate([skeleton.parents, skeleton.end_parents])
    apart = np.linalg.norm(points - points[parents], axis=1) > _ZERO * height
    # A joint at its parent's place would only flicker through the parent's sphere.
    apart[0] = True
    apart[list(topology(skeleton).above_hips)] = False
    apart[topology(skeleton).hips] = True
    if bones.skull is not None and bones.ends[bones.skull] < len(points) and not bones.beyond:
        apart[bones.ends[bones.skull]] = False
    return np.flatnonzero(apart)


def _ball_radii(balls: Indices, bones: _Bones, radius: Floats, count: int, height: float) -> Floats:
    # The widest bone that meets the point decides; a skull is no measure for the neck.
    usual = radius.copy()
    if bones.skull is not None:
        usual[bones.skull] = _THINNEST * height
    widest = np.zeros(count, np.float32)
    np.maximum.at(widest, bones.starts, usual * 0.95)
    np.maximum.at(widest, bones.ends, usual * 0.8)
    widest[widest == 0] = _THINNEST * height
    return widest[balls]
