"""The demo performer: twenty joints, 1.75 m tall, T-pose, facing +Z with the left at +X.

Segment lengths follow the anthropometric ratios of Drillis and Contini as Winter tabulates them
(Biomechanics and Motor Control of Human Movement, fig. 4.1), rounded to 5 mm.
"""

from __future__ import annotations

import numpy as np

from mocapstudio.motion.skeleton import Skeleton

SIDES = (("Left", 1.0), ("Right", -1.0))
"""Name and sign of X of either side."""

THIGH, SHANK = 0.430, 0.430
UPPER_ARM, FOREARM = 0.300, 0.260
ANKLE_HEIGHT = 0.070
"""Metres: ankle above the sole of a flat foot."""
HEEL = np.array([0.0, -ANKLE_HEIGHT, -0.055])
"""Metres: where the heel touches the floor, in the foot's frame."""
BALL = np.array([0.0, -0.055, 0.135])
"""Metres: the toe joint, in the foot's frame."""
HIP = np.array([0.087, -0.040, 0.0])
"""Metres: the left hip joint, in the pelvis's frame."""
STANDING_HEIGHT = ANKLE_HEIGHT + SHANK + THIGH - HIP[1]
"""Metres: the pelvis above the floor with straight legs."""

_TRUNK: tuple[tuple[str, str, tuple[float, float, float]], ...] = (
    ("Hips", "", (0.0, 0.0, 0.0)),
    ("Spine", "Hips", (0.0, 0.090, 0.0)),
    ("Chest", "Spine", (0.0, 0.200, 0.0)),
    ("Head", "Chest", (0.0, 0.285, 0.0)),
)
_ARM = (
    ("Shoulder", "Chest", (0.030, 0.200, 0.0)),
    ("Arm", "Shoulder", (0.155, -0.015, 0.0)),
    ("ForeArm", "Arm", (UPPER_ARM, 0.0, 0.0)),
    ("Hand", "ForeArm", (FOREARM, 0.0, 0.0)),
)
_LEG = (
    ("UpLeg", "Hips", tuple(HIP)),
    ("Leg", "UpLeg", (0.0, -THIGH, 0.0)),
    ("Foot", "Leg", (0.0, -SHANK, 0.0)),
    ("Toe", "Foot", tuple(BALL)),
)
_TIPS = {
    "Head": (0.0, 0.205, 0.020),
    "LeftHand": (0.170, 0.0, 0.0),
    "RightHand": (-0.170, 0.0, 0.0),
    "LeftToe": (0.0, -0.005, 0.065),
    "RightToe": (0.0, -0.005, 0.065),
}


def demo_skeleton() -> Skeleton:
    """Build the skeleton of the demo take: trunk, arms, legs; tips at head, fingers and toes."""
    names, parents, offsets = [], [], []
    for name, parent, offset in _TRUNK:
        names.append(name)
        parents.append(names.index(parent) if parent else -1)
        offsets.append(offset)
    for chain in (_ARM, _LEG):
        for side, sign in SIDES:
            for part, parent, offset in chain:
                above = parent if parent in names else side + parent
                names.append(side + part)
                parents.append(names.index(above))
                offsets.append((sign * offset[0], offset[1], offset[2]))
    return Skeleton(
        names=tuple(names),
        parents=np.array(parents, dtype=np.int64),
        offsets=np.array(offsets, dtype=np.float64),
        end_parents=np.array([names.index(tip) for tip in _TIPS], dtype=np.int64),
        end_offsets=np.array(list(_TIPS.values()), dtype=np.float64),
    )
