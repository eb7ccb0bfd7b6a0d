"""A body at one frame, as points and bones to draw."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.facing import ROOT_ROWS, split_heading
from mocapstudio.motion.kinematics import end_positions, take_pose
from mocapstudio.motion.take import Take


@dataclass(frozen=True, eq=False)
class Stick:
    """Joints and tips at one frame.

    Parameters
    ----------
    points
        (P, 3) metres, world: the joints, then the tips.
    bones
        (B, 2) indices of points, from parent to child.
    marked_points, marked_bones
        (P,) and (B,) bool: what belongs to the joints that the picture is about.
    heading
        Radians about +Y: where the body faces.
    """

    points: NDArray[np.float64]
    bones: NDArray[np.int64]
    marked_points: NDArray[np.bool_]
    marked_bones: NDArray[np.bool_]
    heading: float


def stick(take: Take, frame: int, joints: Collection[str] = ()) -> Stick:
    """Pose a take's skeleton at a frame.

    Parameters
    ----------
    joints
        Rows to mark. A joint marks the bones that it turns; a root row marks the whole body.
    """
    skeleton = take.skeleton
    positions, world = take_pose(take, frame, frame + 1)
    tips = end_positions(skeleton, positions, world)
    points = np.concatenate([positions[0], tips[0]])
    count = len(skeleton)
    upper = np.concatenate([skeleton.parents[1:], skeleton.end_parents])
    lower = np.concatenate([np.arange(1, count), count + np.arange(len(skeleton.end_parents))])
    # What lies above the hips is no part of the body, and its bones would hide it.
    solid = np.linalg.norm(points[upper] - points[lower], axis=1) > 1e-6
    everything = any(row in ROOT_ROWS for row in joints)
    wanted = {skeleton.index[row] for row in joints if row in skeleton.index}
    marked = np.array(
        [everything or j in wanted for j in range(count)] + [everything] * len(tips[0])
    )
    bones = np.stack([upper, lower], axis=1)[solid].astype(np.int64)
    heading, _ = split_heading(take, frame, frame + 1)
    return Stick(points, bones, marked, marked[bones[:, 0]], float(heading[0]))


def frame_of_change(before: Take, after: Take, start: int, end: int) -> int:
    """Frame of [start, end) at which two versions of a take lie farthest apart."""
    there, here = (take_pose(take, start, end) for take in (before, after))
    apart = np.linalg.norm(there[0] - here[0], axis=-1)
    # A turned joint moves only what hangs on it, so tips count too.
    skeleton = before.skeleton
    tips = [end_positions(skeleton, *pose) for pose in (there, here)]
    apart = np.concatenate([apart, np.linalg.norm(tips[0] - tips[1], axis=-1)], axis=1)
    return start + int(apart.max(axis=1).argmax())
