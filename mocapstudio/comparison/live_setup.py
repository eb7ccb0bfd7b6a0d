"""What makes a live alignment of a reference, with learnt weights or without."""

from __future__ import annotations

from fractions import Fraction

from mocapstudio.comparison.labels import Labels
from mocapstudio.comparison.live import LiveAlignment
from mocapstudio.comparison.online import OnlineAligner, Variant
from mocapstudio.comparison.online_features import Recording
from mocapstudio.comparison.online_reference import reference_of
from mocapstudio.comparison.weights import JointWeights


def live_alignment(
    take: Recording,
    streams: tuple[Recording, ...] = (),
    rate: Fraction | float | None = None,
    learnt: JointWeights | None = None,
    labels: Labels | None = None,
    *,
    wait: bool = False,
    paper: bool = False,
    path_frames: int = 0,
) -> LiveAlignment:
    """Make a live alignment with a take.

    Parameters
    ----------
    take
        The reference.
    streams
        Takes that are going to be aligned with it, where they are known.
    rate
        Frames a second of what arrives; the reference's own by default.
    learnt
        Weights, which also tell whether motion counts and how paths are accumulated.
    labels
        Segments of the reference.
    wait
        Whether to wait for the action to begin, and after its end for the next.
    paper
        Without `learnt`: as paper 3 does, poses alone and paths weighted by their length.
    path_frames
        See `OnlineAligner`.

    Raises
    ------
    SkeletonMismatchError
        If takes or weights do not belong to the reference.
    MocapError
        If the reference has fewer than three frames.
    """
    motion = learnt.motion if learnt is not None else not paper
    reference = reference_of(take, streams, rate, motion=motion)
    chosen = learnt.fitting(reference) if learnt is not None else None
    variant = Variant.PATH_LENGTH if paper else Variant.PLAIN
    if learnt is not None:
        variant = learnt.variant
    aligner = OnlineAligner(reference, chosen, variant, labels, path_frames)
    return LiveAlignment(aligner, wait=wait)
