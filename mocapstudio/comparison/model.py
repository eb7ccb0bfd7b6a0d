"""The result of comparing one performance with another."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Segment:
    """A named part of a performance, such as a technique.

    Parameters
    ----------
    name
        What is done.
    start, end
        Half-open span of the take's own frames.
    """

    name: str
    start: int
    end: int


@dataclass(frozen=True, eq=False)
class Comparison:
    """A source aligned with a reference: R and S frames at their own rates, N rows (paper 4).

    Parameters
    ----------
    reference, source
        Names of the two takes.
    reference_rate, source_rate
        Frames a second.
    rows
        Joints or markers compared, in order of limbs.
    limbs
        (N,) name of the limb of each row.
    reference_poses, source_poses
        (R, N, 3) and (S, N, 3): normalised features, 0..1 in each axis for the unit box; what the
        RGB heat maps show.
    path
        (P, 2) warping path: pairs of reference and source frames, ascending.
    warp
        (S,) F: the reference frame, fractional, that matches each source frame.
    misalignment
        (S,) G in seconds: positive where the source is ahead of the reference (its movement comes
        earlier), negative where it lags.
    misalignment_relative
        (S,) the same relative to the overall tempo: what is left at equal lengths.
    timing
        (S,) int8: 1 where the source gains (hastened), -1 where it loses (delayed), 0 on time.
    joint_difference
        (S, N) Euclidean distance of each row from its matched reference row.
    pose_difference
        (S,) Euclidean distance of whole poses, all rows as one point.
    dissimilarity
        Mean cost of a step of the path.
    warnings
        What makes the alignment doubtful, as phrases; empty where nothing does.
    doubt
        Cost of the path over its cost with the source's parts in wrong orders: near 0 where only
        the right order fits, 1 where any does.
    unreliable
        (S, N) True where a row was left out of the difference (which is 0 there), in the source
        or in the matched reference frame; None where none was.
    features
        What was compared: ``"box"``, ``"root"`` or ``"rotations"``.
    true_speed
        Whether `timing` classifies `misalignment`, or `misalignment_relative`.
    source_rows
        (N,) the rows as the source names them; empty where nobody said.
    """

    reference: str
    source: str
    reference_rate: Fraction
    source_rate: Fraction
    rows: tuple[str, ...]
    limbs: tuple[str, ...]
    reference_poses: NDArray[np.float32]
    source_poses: NDArray[np.float32]
    path: NDArray[np.int32]
    warp: NDArray[np.float64]
    misalignment: NDArray[np.float64]
    misalignment_relative: NDArray[np.float64]
    timing: NDArray[np.int8]
    joint_difference: NDArray[np.float32]
    pose_difference: NDArray[np.float32]
    dissimilarity: float
    warnings: tuple[str, ...] = ()
    doubt: float = 0.0
    unreliable: NDArray[np.bool_] | None = None
    features: str = "box"
    true_speed: bool = False
    source_rows: tuple[str, ...] = ()
