"""Inverse kinematics by definition, frame by frame and joint by joint: an oracle for the solver."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from mocapstudio.cleaning.ik.freedom import Freedom
from mocapstudio.motion.take import Take


def turn(v: np.ndarray) -> np.ndarray:
    """Rotation matrix of a rotation vector (Rodrigues)."""
    angle = float(np.sqrt(v @ v))
    if angle < 1e-12:
        return np.eye(3)
    x, y, z = v / angle
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def place(
    take: Take, free: Freedom, unknowns: np.ndarray, frame: int, joint: int
) -> tuple[np.ndarray, np.ndarray]:
    """World position (3,) and rotation (3, 3) of one joint with departures applied."""
    skeleton = take.skeleton
    first = 3 if free.reach > 0 else 0
    local = Rotation.from_quat(take.rotations[frame, joint]).as_matrix()
    if joint in free.joints:
        i = free.joints.index(joint)
        along = unknowns[frame, first + 3 * i : first + 3 * i + 3]
        local = local @ turn(free.axes[i] @ along)
    if joint == 0:
        x = unknowns[frame, :3] if first else np.zeros(3)
        bend = np.sqrt(1 + x @ x / free.reach**2) if first else 1.0
        return take.translations[frame, 0] + x / bend, local
    position, world = place(take, free, unknowns, frame, int(skeleton.parents[joint]))
    return position + world @ skeleton.offsets[joint], world @ local


def point_residual(
    take: Take,
    free: Freedom,
    unknowns: np.ndarray,
    joint: int,
    offset: np.ndarray,
    targets: dict[int, np.ndarray],
    weight: float,
) -> np.ndarray:
    """Weighted distances of one point from its target at each frame that has one."""
    found = []
    for frame, target in targets.items():
        position, world = place(take, free, unknowns, frame, joint)
        found.append(weight * (position + world @ offset - target))
    return np.concatenate(found)


def orientation_residual(
    take: Take,
    free: Freedom,
    unknowns: np.ndarray,
    joint: int,
    targets: dict[int, np.ndarray],
    weight: float,
) -> np.ndarray:
    """Weighted rotation vectors of one joint from its target rotation matrix in the world."""
    found = []
    for frame, target in targets.items():
        _, world = place(take, free, unknowns, frame, joint)
        found.append(weight * Rotation.from_matrix(target.T @ world).as_rotvec())
    return np.concatenate(found)


def smoothness_residual(unknowns: np.ndarray, weights: np.ndarray, order: int) -> np.ndarray:
    """Differences over time of departures that are zero outside the window."""
    outside = np.zeros((order, unknowns.shape[1]))
    padded = np.vstack([outside, unknowns, outside])
    return (np.diff(padded, n=order, axis=0) * weights).ravel()
