"""The literal digression map of paper 1, section 3, written from its equations alone.

For takes at 24 fps whose rest pose stands upright and faces +Z, so that sampling and body frame
are no part of it. Slow: for a few seconds of motion.
"""

from __future__ import annotations

from collections.abc import Sequence

import naive
import numpy as np
from scipy.spatial.transform import Rotation

from mocapstudio.motion.take import Take

SOURCE, HOP, TARGET, K = 15, 5, 20, 5


def texture(take: Take) -> np.ndarray:
    """(T, m, 4): local rotations, of the hips without the turn about the vertical."""
    assert take.rate == 24
    q = take.rotations.copy()
    heading = 2.0 * np.arctan2(q[:, 0, 1], q[:, 0, 3])
    turn = Rotation.from_rotvec(-heading[:, None] * np.array([[0.0, 1.0, 0.0]]))
    q[:, 0] = (turn * Rotation.from_quat(q[:, 0])).as_quat()
    for t in range(1, len(q)):
        for joint in range(q.shape[1]):
            if q[t, joint] @ q[t - 1, joint] < 0:
                q[t, joint] *= -1.0
    return q


def rotation_mean(q: np.ndarray) -> np.ndarray:
    """Chordal mean of (n, 4), signs aligned to the first."""
    total = sum(one if one @ q[0] >= 0 else -one for one in q)
    return total / np.linalg.norm(total)


def mean_texture(source: np.ndarray, targets: Sequence[np.ndarray]) -> np.ndarray:
    """(T, m, 4): the mean of all mean-words that cover a frame."""
    frames, joints = source.shape[:2]
    trim = -(-joints // 8)
    covering: list[list[np.ndarray]] = [[] for _ in range(frames)]
    for word in naive.word_starts(frames, SOURCE, HOP):
        near = naive.find_neighbours(source, targets, K, trim, (SOURCE, TARGET), word, own=True)
        warped = []
        for _, which, start, (_, covered) in near:
            resampled = naive.resampled(targets[which][start : start + covered], SOURCE)
            warped.append(resampled / np.linalg.norm(resampled, axis=-1, keepdims=True))
        for n in range(SOURCE):
            poses = [rotation_mean(np.array([w[n, k] for w in warped])) for k in range(joints)]
            covering[word + n].append(np.array(poses))
    return np.array(
        [
            [rotation_mean(np.array([pose[k] for pose in poses])) for k in range(joints)]
            for poses in covering
        ]
    )


def departures(take: Take, context: Sequence[Take]) -> np.ndarray:
    """(T, m) radians between texture and mean texture."""
    source = texture(take)
    mean = mean_texture(source, [source, *(texture(one) for one in context)])
    flat = Rotation.from_quat(source.reshape(-1, 4)).inv() * Rotation.from_quat(mean.reshape(-1, 4))
    return flat.magnitude().reshape(source.shape[:2])


def literal_map(away: np.ndarray) -> np.ndarray:
    """(T, m) in 0..1 from departures: rows scaled by their own means, then the kernel function."""
    scaled = away / away.mean(axis=0)
    return 1.0 - np.exp(-(scaled**2))
