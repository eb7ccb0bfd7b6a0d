"""Forward kinematics: from local rotations to places in the world."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]


def global_pose(
    skeleton: Skeleton,
    rotations: Array,
    translations: Array,
    translated: tuple[int, ...] = (0,),
) -> tuple[Array, Array]:
    """Place every joint in the world.

    Parameters
    ----------
    skeleton
        J joints.
    rotations
        (F, J, 4) local rotations.
    translations
        (F, T, 3) metres, local translations of the joints `translated`.

    Returns
    -------
    positions
        (F, J, 3) metres.
    world_rotations
        (F, J, 4).
    """
    frames = len(rotations)
    local = np.broadcast_to(skeleton.offsets, (frames, len(skeleton), 3)).copy()
    local[:, list(translated)] = translations
    positions = np.empty_like(local)
    world = np.empty((frames, len(skeleton), 4))
    positions[:, 0], world[:, 0] = local[:, 0], rotations[:, 0]
    for joints, parents in _levels(skeleton):
        positions[:, joints] = positions[:, parents] + rot.rotate(
            world[:, parents], local[:, joints]
        )
        world[:, joints] = rot.multiply(world[:, parents], rotations[:, joints])
    return positions, world


def _levels(skeleton: Skeleton) -> list[tuple[list[int], list[int]]]:
    depth = np.zeros(len(skeleton), dtype=int)
    for joint in range(1, len(skeleton)):
        depth[joint] = depth[skeleton.parents[joint]] + 1
    return [
        ([int(j) for j in joints], [int(skeleton.parents[j]) for j in joints])
        for level in range(1, int(depth.max(initial=0)) + 1)
        for joints in [np.flatnonzero(depth == level)]
    ]


def take_pose(take: Take, start: int = 0, end: int | None = None) -> tuple[Array, Array]:
    """Positions (F, J, 3) and world rotations (F, J, 4) of a take's frames [start, end)."""
    frames = slice(start, end)
    return global_pose(
        take.skeleton, take.rotations[frames], take.translations[frames], take.translated
    )


def end_positions(skeleton: Skeleton, positions: Array, world_rotations: Array) -> Array:
    """(F, E, 3) metres: the tips, from what `global_pose` returned."""
    parents = skeleton.end_parents
    return positions[:, parents] + rot.rotate(world_rotations[:, parents], skeleton.end_offsets)
