"""Inverse kinematics by definition, frame by frame and joint by joint: an oracle for the solver."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from mocapstudio.cleaning.ik.freedom import Freedom
from mocapstudio.motion.take import Take


def place(take: Take, free: Freedom, unknowns: np.ndarray) -> tuple[np.ndarray, list]:
    """World positions (F, J, 3) and rotations (F lists of J) with departures applied."""
    skeleton = take.skeleton
    positions = np.zeros((take.frames, len(skeleton), 3))
    rotations = []
    first = 3 if free.reach > 0 else 0
    for f in range(take.frames):
        world: list[Rotation] = []
        for j in range(len(skeleton)):
            local = Rotation.from_quat(take.rotations[f, j])
            if j in free.joints:
                i = free.joints.index(j)
                along = unknowns[f, first + 3 * i : first + 3 * i + 3]
                local = local * Rotation.from_rotvec(free.axes[i] @ along)
            if j == 0:
                x = unknowns[f, :3] if first else np.zeros(3)
                bend = np.sqrt(1 + x @ x / free.reach**2) if first else 1.0
                positions[f, 0] = take.translations[f, 0] + x / bend
                world.append(local)
            else:
                parent = int(skeleton.parents[j])
                positions[f, j] = positions[f, parent] + world[parent].apply(skeleton.offsets[j])
                world.append(world[parent] * local)
        rotations.append(world)
    return positions, rotations


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
    positions, rotations = place(take, free, unknowns)
    return np.concatenate(
        [
            weight * (positions[f, joint] + rotations[f][joint].apply(offset) - target)
            for f, target in targets.items()
        ]
    )


def orientation_residual(
    take: Take,
    free: Freedom,
    unknowns: np.ndarray,
    joint: int,
    targets: dict[int, np.ndarray],
    weight: float,
) -> np.ndarray:
    """Weighted rotation vectors of one joint from its target rotation matrix in the world."""
    _, rotations = place(take, free, unknowns)
    return np.concatenate(
        [
            weight * (Rotation.from_matrix(target).inv() * rotations[f][joint]).as_rotvec()
            for f, target in targets.items()
        ]
    )


def smoothness_residual(unknowns: np.ndarray, weights: np.ndarray, order: int) -> np.ndarray:
    """Differences over time of departures that are zero outside the window."""
    padded = np.vstack([np.zeros((order, unknowns.shape[1]))] * 1 + [unknowns])
    padded = np.vstack([padded, np.zeros((order, unknowns.shape[1]))])
    return (np.diff(padded, n=order, axis=0) * weights).ravel()
