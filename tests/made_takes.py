"""Skeletons and takes made in memory, whose every property is known, for tests of any package."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take

Bone = tuple[str, str, tuple[float, float, float]]

# A person who faces +Z, the left at +X; name, parent, offset in metres.
_TRUNK: list[Bone] = [
    ("Hips", "", (0, 0, 0)),
    ("Spine", "Hips", (0, 0.15, 0)),
    ("Chest", "Spine", (0, 0.25, 0)),
    ("Neck", "Chest", (0, 0.2, 0)),
    ("Head", "Neck", (0, 0.1, 0)),
]
_ARM: list[Bone] = [
    ("Shoulder", "Chest", (0.05, 0.15, 0)),
    ("Arm", "Shoulder", (0.15, 0, 0)),
    ("ForeArm", "Arm", (0.3, 0, 0)),
    ("Hand", "ForeArm", (0.25, 0, 0)),
]
_LEG: list[Bone] = [
    ("UpLeg", "Hips", (0.1, -0.05, 0)),
    ("Leg", "UpLeg", (0, -0.43, 0)),
    ("Foot", "Leg", (0, -0.43, 0)),
]
_HAND: list[Bone] = [
    (f"Hand{finger}{n}", f"Hand{finger}{n - 1}" if n > 1 else "Hand", (0.04, 0, z))
    for finger, z in (("Thumb", 0.03), ("Index", 0.02), ("Pinky", -0.02))
    for n in (1, 2)
]
_EYES: list[Bone] = [("LeftEye", "Head", (0.03, 0.1, 0.1)), ("RightEye", "Head", (-0.03, 0.1, 0.1))]
_HORSE: list[Bone] = [
    ("Pelvis", "", (0, 0, 0)),
    ("Loin", "Pelvis", (0, 0, 0.4)),
    ("Withers", "Loin", (0, 0.05, 0.4)),
    ("Neck", "Withers", (0, 0.3, 0.3)),
    ("Skull", "Neck", (0, 0.3, 0.2)),
    ("Tail1", "Pelvis", (0, 0, -0.2)),
    ("Tail2", "Tail1", (0, -0.2, -0.1)),
]
_FORE: list[Bone] = [
    ("FrontUpper", "Withers", (0.15, -0.2, 0)),
    ("FrontLower", "FrontUpper", (0, -0.4, 0)),
    ("FrontHoof", "FrontLower", (0, -0.4, 0)),
]
_HIND: list[Bone] = [
    ("HindUpper", "Pelvis", (0.15, -0.2, 0)),
    ("HindLower", "HindUpper", (0, -0.4, -0.05)),
    ("HindHoof", "HindLower", (0, -0.4, 0.05)),
]


def build(bones: Sequence[Bone]) -> Skeleton:
    """Lay bones out as a skeleton; every leaf gets a tip that goes on by half its bone."""
    names = tuple(name for name, _, _ in bones)
    parents = np.array([names.index(parent) if parent else -1 for _, parent, _ in bones])
    offsets = np.array([offset for _, _, offset in bones], dtype=float)
    leaves = np.array([j for j in range(len(names)) if j not in parents])
    return Skeleton(names, parents, offsets, leaves, 0.5 * offsets[leaves])


def _sides(bones: Sequence[Bone], trunk: Sequence[Bone]) -> list[Bone]:
    """Make both sides of a limb."""
    fixed = {name for name, _, _ in trunk}
    return [
        (side + name, parent if parent in fixed else side + parent, (sign * x, y, z))
        for side, sign in (("Left", 1.0), ("Right", -1.0))
        for name, parent, (x, y, z) in bones
    ]


def person(fingers: bool = False) -> Skeleton:
    """Build nineteen joints of a person who faces +Z; with fingers and eyes on demand."""
    arms, legs = _sides(_ARM, _TRUNK), _sides(_LEG, _TRUNK)
    hands = [*_sides(_HAND, _TRUNK), *_EYES] if fingers else []
    return build([*_TRUNK, *arms, *legs, *hands])


def horse() -> Skeleton:
    """Build a quadruped with a tail; it faces +Z."""
    return build([*_HORSE, *_sides(_FORE, _HORSE), *_sides(_HIND, _HORSE)])


def chain(joints: int = 5) -> Skeleton:
    """Build one chain without branches."""
    return build([(f"c{i}", f"c{i - 1}" if i else "", (0, 0.1, 0)) for i in range(joints)])


def nameless(skeleton: Skeleton) -> Skeleton:
    """Return the same skeleton with names that tell nothing."""
    return replace(skeleton, names=tuple(f"node{i}" for i in range(len(skeleton))))


# Swing of each joint in a walk: degrees, share of the cycle, axis of rotation.
_SWINGS: dict[str, tuple[float, float, int]] = {
    "LeftUpLeg": (28, 0.0, 0), "RightUpLeg": (28, 0.5, 0),
    "LeftLeg": (30, 0.25, 0), "RightLeg": (30, 0.75, 0),
    "LeftFoot": (15, 0.4, 0), "RightFoot": (15, 0.9, 0),
    "LeftArm": (24, 0.5, 1), "RightArm": (24, 0.0, 1),
    "LeftForeArm": (18, 0.6, 1), "RightForeArm": (18, 0.1, 1),
    "LeftHand": (8, 0.7, 2), "RightHand": (8, 0.2, 2),
    "LeftShoulder": (5, 0.5, 1), "RightShoulder": (5, 0.0, 1),
    "Spine": (6, 0.0, 1), "Chest": (6, 0.5, 1), "Neck": (4, 0.3, 1), "Head": (5, 0.2, 0),
    "Hips": (5, 0.1, 2),
}  # fmt: skip


def walking(
    seconds: float = 10.0,
    rate: int = 30,
    seed: int = 0,
    variation: float = 0.06,
    name: str | None = None,
) -> Take:
    """Somebody walks on a wide arc, a cycle a second, no two cycles quite alike.

    The motion is a smooth function of time: another rate samples the same motion.
    """
    rng = np.random.default_rng(seed)
    skeleton = person()
    time = np.arange(round(seconds * rate)) / rate

    def drifting(size: float) -> np.ndarray:
        parts = [
            rng.normal() * np.sin(2 * np.pi * (f * time + rng.random())) for f in (0.11, 0.23, 0.37)
        ]
        return size * np.sum(parts, axis=0)

    phase = time + drifting(variation) + rng.random()
    rotations = np.empty((len(time), len(skeleton), 4))
    for j, joint in enumerate(skeleton.names):
        degrees, share, axis = _SWINGS[joint]
        wave = np.sin(2 * np.pi * (phase + share)) + 0.2 * np.sin(4 * np.pi * (phase + share))
        angle = np.deg2rad(degrees) * (1.0 + drifting(variation)) * wave
        rotations[:, j] = rot.about_axis(axis, angle)
    heading = 0.15 * time + drifting(0.1)
    rotations[:, 0] = rot.multiply(rot.about_axis(1, heading), rotations[:, 0])
    step = 1.2 / rate * np.stack([np.sin(heading), np.zeros_like(time), np.cos(heading)], axis=-1)
    place = np.cumsum(step, axis=0)
    place[:, 1] = 0.9 + 0.02 * np.sin(4 * np.pi * phase)
    return Take(
        name or f"walk {seed}",
        skeleton,
        rot.continuous(rotations),
        place[:, None],
        Fraction(rate),
    )


def turned(
    take: Take,
    joint: str,
    start: int,
    end: int,
    degrees: float,
    axis: Sequence[float] = (0.6, 0.0, 0.8),
) -> Take:
    """Turn one joint by a fixed angle over a half-open span: an offset, or a pop of one frame."""
    rotations = take.rotations.copy()
    column = take.skeleton.index[joint]
    turn = rot.from_rotation_vector(np.deg2rad(degrees) * np.asarray(axis, dtype=float))
    rotations[start:end, column] = rot.multiply(rotations[start:end, column], turn)
    return take.with_motion(rotations)


def moved(take: Take, start: int, end: int, metres: Sequence[float]) -> Take:
    """Shift the root over a half-open span."""
    translations = take.translations.copy()
    translations[start:end, 0] += metres
    return take.with_motion(translations=translations)


def faced(take: Take, start: int, end: int, degrees: float) -> Take:
    """Turn the whole body about the vertical through its hips over a half-open span."""
    rotations = take.rotations.copy()
    turn = rot.about_axis(1, np.deg2rad(degrees))
    rotations[start:end, 0] = rot.multiply(turn, rotations[start:end, 0])
    return take.with_motion(rotations)


def elsewhere(take: Take, degrees: float, metres: Sequence[float]) -> Take:
    """Turn the whole take about the world's vertical, then move it."""
    turn = rot.about_axis(1, np.deg2rad(degrees))
    rotations, translations = take.rotations.copy(), take.translations.copy()
    rotations[:, 0] = rot.multiply(turn, rotations[:, 0])
    translations[:, 0] = rot.rotate(turn, translations[:, 0]) + metres
    return take.with_motion(rotations, translations)


def below_a_reference(take: Take, turn: np.ndarray) -> Take:
    """Hang the same motion below a joint that stands at the world's origin, turned by `turn`."""
    old = take.skeleton
    skeleton = Skeleton(
        ("Reference", *old.names),
        np.concatenate([[-1], old.parents + 1]),
        np.vstack([np.zeros(3), old.offsets]),
        old.end_parents + 1,
        old.end_offsets,
    )
    rotations = np.concatenate(
        [np.broadcast_to(turn, (take.frames, 1, 4)), take.rotations], axis=1
    ).copy()
    rotations[:, 1] = rot.multiply(rot.conjugate(turn), take.rotations[:, 0])
    place = rot.rotate(rot.conjugate(turn), take.translations[:, 0])
    translations = np.stack([np.zeros_like(place), place], axis=1)
    return replace(
        take, skeleton=skeleton, rotations=rotations, translations=translations, translated=(0, 1)
    )


def paced(take: Take, pace: np.ndarray) -> Take:
    """Play a take at a pace of its own, one value a frame: more than 1 is faster."""
    at = np.cumsum(pace)
    at = at[at < take.frames - 1]
    low = at.astype(int)
    part = (at - low)[:, None]
    rotations = rot.slerp(take.rotations[low], take.rotations[low + 1], part)
    before, after = take.translations[low], take.translations[low + 1]
    place = before * (1 - part[..., None]) + after * part[..., None]
    return take.with_motion(rot.continuous(rotations), place)


def reaching(still: int, reach: int, after: int, rate: int = 30) -> Take:
    """Stand, raise both arms and lower them again, stand; frames of each."""
    skeleton = person()
    course = np.concatenate([np.zeros(still), np.hanning(reach), np.zeros(after)])
    rotations = np.tile(rot.IDENTITY, (len(course), len(skeleton), 1))
    for name, sign in (("LeftArm", 1.0), ("RightArm", -1.0)):
        rotations[:, skeleton.index[name]] = rot.about_axis(2, sign * 1.4 * course)
    for name in ("LeftForeArm", "RightForeArm"):
        rotations[:, skeleton.index[name]] = rot.about_axis(0, -0.8 * course**2)
    places = np.tile([0.0, 0.95, 0.0], (len(course), 1, 1))
    return Take("reach", skeleton, rotations, places, Fraction(rate))
