"""Markers made from a take of joints, for tests: where they sit and how they move is known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take

# Joint that carries it, and metres from there in the rest pose, of a person in T-pose who faces
# +Z: on the skin of the person of `made_takes`. For the right side x is mirrored.
_MIDDLE = {
    "C7": ("Chest", (0, 0.22, -0.05)),
    "T10": ("Chest", (0, 0.02, -0.10)),
    "CLAV": ("Chest", (0, 0.15, 0.08)),
    "STRN": ("Chest", (0, -0.01, 0.12)),
}
_SIDED = {
    "FHD": ("Head", (0.075, 0.12, 0.09)),
    "BHD": ("Head", (0.06, 0.09, -0.04)),
    "ASI": ("Hips", (0.125, 0.03, 0.06)),
    "PSI": ("Hips", (0.045, 0.04, -0.12)),
    "SHO": ("Shoulder", (0.13, 0.045, 0)),
    "UPA": ("Arm", (0.16, 0.05, 0)),
    "ELB": ("Arm", (0.3, 0.045, 0)),
    "FRM": ("ForeArm", (0.13, 0.03, 0)),
    "WRA": ("ForeArm", (0.25, 0.03, 0.05)),
    "WRB": ("ForeArm", (0.25, 0.03, -0.055)),
    "FIN": ("Hand", (0.08, 0.028, 0)),
    "THI": ("UpLeg", (0.085, -0.24, 0)),
    "KNE": ("UpLeg", (0.06, -0.43, 0)),
    "TIB": ("Leg", (0.07, -0.2, 0)),
    "ANK": ("Leg", (0.045, -0.43, 0)),
    "HEE": ("Foot", (0, -0.035, -0.045)),
    "TOE": ("Foot", (0.01, -0.04, 0.16)),
    "MT5": ("Foot", (0.065, -0.04, 0.11)),
}


@dataclass(frozen=True)
class Made:
    """Markers and the joint that carries each."""

    take: MarkerTake
    carriers: tuple[str, ...]


def markers_on(take: Take, seed: int = 0, noise: float = 1e-3, misplaced: float = 0.01) -> Made:
    """Put markers on a take of `made_takes.person`.

    Parameters
    ----------
    take
        Where the joints are.
    seed
        Of noise and misplacement.
    noise, misplaced
        Metres, standard deviations: of every sample, and of where a marker was stuck on.
    """
    rng = np.random.default_rng(seed)
    rows = [(label, joint, np.array(at, float)) for label, (joint, at) in _MIDDLE.items()]
    for side, letter, sign in (("Left", "L", 1.0), ("Right", "R", -1.0)):
        for label, (joint, at) in _SIDED.items():
            name = joint if joint in {"Head", "Hips"} else f"{side}{joint}"
            rows.append((letter + label, name, np.array(at) * [sign, 1, 1]))
    positions, world = take_pose(take)
    places = []
    for _, joint, at in rows:
        j = take.skeleton.index[joint]
        offset = at + misplaced * rng.standard_normal(3)
        turned = rot.rotate(world[:, j], np.broadcast_to(offset, (take.frames, 3)))
        places.append(positions[:, j] + turned)
    samples = np.stack(places, axis=1)
    samples += noise * rng.standard_normal(samples.shape)
    labels = tuple(f"Anna:{label}" for label, _, _ in rows)
    return Made(
        MarkerTake("made", labels, samples, take.rate), tuple(joint for _, joint, _ in rows)
    )
