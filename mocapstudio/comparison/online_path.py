"""A whole take aligned online with a reference: every distance, every cost, and the path."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison.online import OnlineAligner, Variant
from mocapstudio.comparison.online_features import F32, Recording
from mocapstudio.comparison.online_reference import reference_of
from mocapstudio.comparison.weights import JointWeights
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.progress import Progress

_RATE = 30.0
_MOST = 1500
_REPORT = 128


@dataclass(frozen=True, eq=False)
class OnlinePath:
    """An online alignment seen from its end, A reference blocks and B stream frames.

    Parameters
    ----------
    distances
        (A, B) weighted pose distances (equation 4).
    accumulated
        (A, B) cost of the cheapest path to each pair (equation 2 or 3).
    path
        (P, 2) pairs of own frames, traced back from the last frame.
    answers
        (B, 2) own frames of reference and stream: where the performer seemed to be, told as each
        frame arrived.
    reference_at, source_at
        Own frame at which the first of the A and of the B lies, and how many each is long.
    frames
        Of both takes.
    rates
        Frames a second of both takes.
    """

    distances: F32
    accumulated: F32
    path: NDArray[np.int64]
    answers: NDArray[np.int64]
    reference_at: tuple[float, float]
    source_at: tuple[float, float]
    frames: tuple[int, int]
    rates: tuple[float, float]


def following(
    reference: Recording,
    source: Recording,
    variant: Variant = Variant.PLAIN,
    learnt: JointWeights | None = None,
) -> Generator[Progress, None, OnlinePath]:
    """Align a take with a reference as if its frames arrived one by one; yields progress.

    Long takes are thinned out: to 30 frames a second, and to 1500 frames at most.

    Parameters
    ----------
    reference, source
        What is aligned with, and what with it.
    variant
        How paths are accumulated without `learnt`.
    learnt
        Weights, which also tell whether motion counts and how paths are accumulated.

    Raises
    ------
    SkeletonMismatchError
        If the takes have too little in common, or one holds markers and the other joints, or the
        weights are not for the reference.
    MocapError
        If the reference is too short, or nothing of the source can be seen.
    """
    start, end = source.span
    seconds = max((one.span[1] - one.span[0]) / float(one.rate) for one in (reference, source))
    rate = min(_RATE, float(source.rate), float(reference.rate), _MOST / seconds)
    motion = learnt is None or learnt.motion
    prepared = reference_of(reference, (source,), rate, motion=motion)
    chosen = None if learnt is None else learnt.fitting(prepared)
    variant = variant if learnt is None else learnt.variant
    step = float(source.rate) / rate
    at = np.arange(int((end - start - 1) / step + 1e-6) + 1) * step
    poses = prepared.features.of(source)[np.rint(at).astype(np.int64)]
    aligner = OnlineAligner(prepared, chosen, variant, path_frames=len(poses))
    distances = np.zeros((len(poses), len(prepared)), np.float32)
    accumulated = np.zeros_like(distances)
    answers = np.zeros(len(poses), np.int64)
    for i, pose in enumerate(poses):
        if i % _REPORT == 0:
            yield Progress(i / len(poses), "following")
        found = aligner.feed(pose, i / rate)
        if found is None:
            # A frame that cannot be seen takes its time all the same.
            aligner.pass_over(1)
        distances[i] = aligner.pose_costs
        costs, lengths = aligner.accumulated()
        accumulated[i] = costs if variant is Variant.PLAIN else costs / np.maximum(lengths, 1.0)
        answers[i] = answers[i - 1] if found is None else found.at
    if aligner.frames == 0:
        raise MocapError(f"{source.name}: too little of it is seen to be followed")
    return _in_own_frames(aligner, (distances, accumulated), answers, (reference, source), rate)


def _in_own_frames(
    aligner: OnlineAligner,
    matrices: tuple[F32, F32],
    answers: NDArray[np.int64],
    recordings: tuple[Recording, Recording],
    rate: float,
) -> OnlinePath:
    reference, source = recordings
    late = len(answers) - aligner.frames
    each = float(reference.rate) / rate
    step = float(source.rate) / rate
    own = np.array([reference.span[0], source.span[0]]), np.array([each, step])
    pairs = (aligner.path() + np.array([0, late])) * own[1] + own[0]
    told = np.stack([answers, np.arange(len(answers))], axis=1) * own[1] + own[0]
    return OnlinePath(
        np.ascontiguousarray(matrices[0].T),
        np.ascontiguousarray(matrices[1].T),
        np.rint(pairs).astype(np.int64),
        np.rint(told).astype(np.int64),
        (float(own[0][0]), each),
        (float(own[0][1]), step),
        (reference.frames, source.frames),
        (float(reference.rate), float(source.rate)),
    )
