"""Comparisons made in memory, whose warp is known, without the engine."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

import numpy as np

from mocapstudio.comparison.model import Comparison
from mocapstudio.motion.take import Take

ROWS = ("Hips", "Chest", "Head", "LeftArm", "LeftHand", "RightArm", "RightHand")
LIMBS = ("spine", "spine", "head", "left arm", "left arm", "right arm", "right arm")


def poses(frames: int, phase: np.ndarray | None = None) -> np.ndarray:
    """(frames, rows, 3) smooth colours, each row at a frequency of its own."""
    at = np.arange(frames, dtype=float) if phase is None else phase
    rows = np.arange(len(ROWS))
    waves = np.sin(at[:, None, None] * (0.02 + 0.01 * rows[:, None]) + np.arange(3))
    return (0.5 + 0.4 * waves).astype(np.float32)


def comparison(
    frames: tuple[int, int] = (300, 240),
    warp: Callable[[np.ndarray], np.ndarray] | None = None,
    rates: tuple[int, int] = (100, 100),
    names: tuple[str, str] = ("teacher", "pupil"),
    offset: float = 0.0,
) -> Comparison:
    """Make a source whose frame n matches frame `warp(n)` of the reference.

    By default the source runs evenly from the reference's first frame to its last.
    """
    reference, source = frames
    n = np.arange(source, dtype=float)
    matched = n * (reference - 1) / max(source - 1, 1) if warp is None else warp(n)
    matched = np.clip(np.maximum.accumulate(matched), 0, reference - 1)
    whole = np.rint(matched).astype(int)
    whole[0], whole[-1] = 0, reference - 1
    pairs = [(0, 0)]
    for k in range(1, source):
        middle = (whole[k - 1] + whole[k]) // 2
        between = range(whole[k - 1] + 1, whole[k])
        pairs += [(step, k - 1 if step <= middle else k) for step in between]
        pairs.append((whole[k], k))
    ours, theirs = poses(reference), poses(source, matched)
    theirs = theirs + np.float32(offset)
    low = np.floor(matched).astype(int)
    difference = np.linalg.norm(theirs - ours[low], axis=2)
    gap = matched / rates[0] - n / rates[1]
    tempo = (reference / rates[0]) / (source / rates[1])
    relative = matched / rates[0] - n / rates[1] * tempo
    slope = np.gradient(relative)
    return Comparison(
        reference=names[0],
        source=names[1],
        reference_rate=Fraction(rates[0]),
        source_rate=Fraction(rates[1]),
        rows=ROWS,
        limbs=LIMBS,
        reference_poses=ours,
        source_poses=theirs,
        path=np.array(pairs, dtype=np.int32),
        warp=matched,
        misalignment=gap,
        misalignment_relative=relative,
        timing=np.where(slope > 1e-3, 1, np.where(slope < -1e-3, -1, 0)).astype(np.int8),
        joint_difference=difference.astype(np.float32),
        pose_difference=np.linalg.norm(difference, axis=1).astype(np.float32),
        dissimilarity=float(difference.mean()),
    )


def shortened(take: Take, frames: int, name: str) -> Take:
    """The first frames of a take under another name."""
    return replace(
        take, name=name, rotations=take.rotations[:frames], translations=take.translations[:frames]
    )
