"""Labelled takes as examples for joint weights."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from mocapstudio.comparison.labels import Labels
from mocapstudio.comparison.online_features import I32, Features, Recording, features_of
from mocapstudio.comparison.online_reference import Reference, reference_of
from mocapstudio.comparison.weights_quality import Example, example_of, segments_of

TRAINING_RATE = Fraction(30)
"""Frames a second at most: what paper 3's times are for, and enough for segments."""


@dataclass(frozen=True, eq=False)
class LabelledTake:
    """A performance and its segments.

    Parameters
    ----------
    take
        Its trimmed span is the action.
    labels
        In frames of the take.
    performer
        Who it is; empty where nobody knows.
    """

    take: Recording
    labels: Labels
    performer: str = ""


@dataclass(frozen=True, eq=False)
class ExampleSet:
    """A reference and the performances that are aligned with it.

    Parameters
    ----------
    reference
        R frames.
    segments
        (R,) number of each one's segment.
    examples
        The performances.
    """

    reference: Reference
    segments: I32
    examples: tuple[Example, ...]


def repetitions(labelled: LabelledTake) -> list[LabelledTake]:
    """Cut a take in which an action is repeated before each return of its first segment.

    A take without a return stays as it is.
    """
    segments = labelled.labels.segments
    first = segments[0].name if segments else ""
    begins = [i for i, segment in enumerate(segments) if segment.name == first]
    if len(begins) < 2:
        return [labelled]
    cut = []
    for number, (a, b) in enumerate(zip(begins, [*begins[1:], len(segments)], strict=True), 1):
        span = (segments[a].start, segments[b - 1].end)
        take = replace(labelled.take, name=f"{labelled.take.name} {number}", trim=span)
        cut.append(LabelledTake(take, labelled.labels, labelled.performer))
    return cut


def example_set(
    reference: LabelledTake,
    others: Sequence[LabelledTake],
    *,
    motion: bool = True,
    features: Features | None = None,
) -> ExampleSet:
    """Prepare a reference and performances for training and for scoring.

    Parameters
    ----------
    motion
        Whether how joints move counts beside their poses.
    features
        What is compared, in place of what all the takes have in common.

    Raises
    ------
    SkeletonMismatchError
        If the takes have too little in common.
    MocapError
        If a take is too short, or none of its frames lies in a segment.
    """
    takes = tuple(one.take for one in others)
    features = features or features_of(reference.take, takes)
    rate = min(reference.take.rate, TRAINING_RATE)
    names = tuple(dict.fromkeys(name for one in (reference, *others) for name in one.labels.names))
    prepared = reference_of(reference.take, rate=rate, motion=motion, features=features)
    segments = segments_of(prepared, reference.labels, names)
    examples = tuple(
        example_of(
            reference_of(one.take, rate=rate, motion=motion, features=features),
            one.labels,
            names,
            one.performer,
        )
        for one in others
    )
    return ExampleSet(prepared, segments, examples)
