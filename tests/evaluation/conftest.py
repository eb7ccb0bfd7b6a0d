"""Generated takes for the tests of the benchmark."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take

# name, parent, offset: a plain figure that faces +Z, its left at +X.
_BONES = [
    ("Hips", -1, (0, 0, 0)),
    ("Spine", 0, (0, 0.2, 0)),
    ("Chest", 1, (0, 0.2, 0)),
    ("Neck", 2, (0, 0.2, 0)),
    ("Head", 3, (0, 0.1, 0)),
    ("LeftArm", 2, (0.2, 0.15, 0)),
    ("LeftForeArm", 5, (0.3, 0, 0)),
    ("LeftHand", 6, (0.25, 0, 0)),
    ("RightArm", 2, (-0.2, 0.15, 0)),
    ("RightForeArm", 8, (-0.3, 0, 0)),
    ("RightHand", 9, (-0.25, 0, 0)),
    ("LeftUpLeg", 0, (0.1, 0, 0)),
    ("LeftLeg", 11, (0, -0.45, 0)),
    ("LeftFoot", 12, (0, -0.45, 0)),
    ("RightUpLeg", 0, (-0.1, 0, 0)),
    ("RightLeg", 14, (0, -0.45, 0)),
    ("RightFoot", 15, (0, -0.45, 0)),
]
_TIPS = {
    "Head": (0, 0.15, 0),
    "LeftHand": (0.1, 0, 0),
    "RightHand": (-0.1, 0, 0),
    "LeftFoot": (0, 0, 0.15),
    "RightFoot": (0, 0, 0.15),
}


def figure() -> Skeleton:
    names = tuple(name for name, _, _ in _BONES)
    return Skeleton(
        names,
        np.array([parent for _, parent, _ in _BONES]),
        np.array([offset for _, _, offset in _BONES], dtype=float),
        np.array([names.index(name) for name in _TIPS]),
        np.array(list(_TIPS.values()), dtype=float),
    )


def swinging(seconds: float = 12.0, rate: int = 30, seed: int = 0, still: bool = False) -> Take:
    """Every joint swings about an axis of its own; the hips travel and turn slowly."""
    rng = np.random.default_rng(seed)
    skeleton = figure()
    frames = round(seconds * rate)
    time = np.arange(frames) / rate
    rotations = np.empty((frames, len(skeleton), 4))
    for joint in range(len(skeleton)):
        axis = rng.standard_normal(3)
        axis /= np.linalg.norm(axis)
        swing = rng.uniform(0.3, 0.7) * np.sin(2 * np.pi * 0.8 * time + rng.uniform(0, 6))
        rotations[:, joint] = rot.from_rotation_vector(axis * (0 if still else 1) * swing[:, None])
    rotations[:, 0] = rot.multiply(rot.about_axis(1, 0.2 * time), rotations[:, 0])
    travel = np.stack([0.5 * time, 0.9 + 0.02 * np.sin(10 * time), 0.3 * time], axis=1)
    return Take(
        f"swinging {seed}", skeleton, rot.continuous(rotations), travel[:, None], Fraction(rate)
    )


@pytest.fixture(scope="session")
def make_take() -> Callable[..., Take]:
    return swinging


@pytest.fixture(scope="session")
def take() -> Take:
    return swinging()
