"""Learning the decision from a context, top to bottom.

1. Every take of the context is compared with the others: what residual is usual for a joint;
2. errors are put into its takes, again and again, half of the time with the nearest takes
left out, so that novelty is learnt as normal; 3. boosted trees learn to tell them apart, frame by
frame, each half of the takes for itself; nothing near an impossibly fast rotation counts as clean;
4. what they say is weighed against a judge who knows motion in general; 5. smaller trees judge
the spans that the two raise on what the first did not learn from.

A take that is alone is judged by trees learnt from every other three seconds of it, and what these
find in it as it came is taken for unknown, not for normal.
"""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import replace

import numpy as np

from mocapstudio.cleaning.decision.examples import (
    Example,
    Known,
    Made,
    TooLittleToLearnError,
    examples_of,
)
from mocapstudio.cleaning.decision.features import windows
from mocapstudio.cleaning.decision.forest import Forest
from mocapstudio.cleaning.decision.general import general_judge, share_of_general
from mocapstudio.cleaning.decision.growing import Rows, Size, grow
from mocapstudio.cleaning.decision.model import Bench, Decision, Judge, crossed, examine, halves
from mocapstudio.cleaning.decision.spans import candidates, judged, labels_of, span_features
from mocapstudio.cleaning.decision.spoiling import Anatomy
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.motion.progress import Progress, scaled
from mocapstudio.motion.runs import runs
from mocapstudio.motion.take import Take

_SUSPECT = 0.3
_DOUBTFUL = 0.5


_WHOLE, _HALF = Size(150, 31, 0.1, 40), Size(80, 31, 0.15, 40)
_ROOT, _SMALL = Size(60, 16, 0.12, 40), Size(80, 8, 0.08, 20)


def learn(
    context: Sequence[Take], joints: Sequence[str] | None = None, seed: int = 0
) -> Generator[Progress, None, Decision]:
    """Learn a decision from the takes of a context.

    Parameters
    ----------
    context
        Takes of one skeleton, presumably mostly clean. A single one is compared with itself.
    joints
        Names of the joints to compare, or None for those that all takes have.
    seed
        Of the errors and of the subsampling.

    Raises
    ------
    TooLittleToLearnError
        If no take is as long as a window, or nothing could be learnt.
    """
    rng = np.random.default_rng(seed)
    made = yield from scaled(examples_of(context, joints, rng), 0.0, 0.65)
    examples, takes = list(made.examples), made.takes
    yield Progress(0.65, "learning the decision")
    share = share_of_general(sum(len(one.texture) for one in takes))
    judges = yield from _judges(examples, rng, share, 0.65)
    alone = len(takes) == 1
    if alone:
        # Only here: among several takes this would unlearn what is rare but right.
        examples = _without_suspects(examples, takes, judges)
        judges = yield from _judges(examples, rng, share, 0.8)
    spans = grow(_span_examples(examples, judges, made.anatomy), rng, _SMALL)
    yield Progress(0.95, "learning the decision")
    if not alone:
        whole = Bench(_fitted(examples, rng, _WHOLE), general_judge(), share)
        return Decision(made.joints, made.usual, (whole,), spans, _doubts(made, judges, spans))
    return Decision(made.joints, made.usual, judges, spans)


def _doubts(
    made: Made, judges: tuple[Bench, Bench], spans: Forest
) -> dict[str, tuple[Declared, ...]]:
    """Spans of the context itself that those who did not learn from them call wrong."""
    found = {}
    rows = (*made.joints, *ROOT_ROWS)
    for i, (one, seen) in enumerate(zip(made.takes, made.seen, strict=True)):
        if seen is None:
            continue
        frame = one.texture.frame
        first = crossed(judges, seen, halves(len(seen.joints), i, len(made.takes)))
        probability = judged(first, seen.joints, made.anatomy.limb, spans)
        found[one.digest] = tuple(
            Declared(rows[row], round(frame(start)), round(frame(end - 1)) + 1)
            for row in range(probability.shape[1])
            for start, end in runs(probability[:, row] > _DOUBTFUL)
        )
    return found


def _judges(
    examples: Sequence[Example], rng: np.random.Generator, share: float, done: float
) -> Generator[Progress, None, tuple[Bench, Bench]]:
    """Learn from each half alone, so that either can judge the other."""
    first = _fitted(_half(examples, 0), rng, _HALF)
    yield Progress(done + 0.07, "learning the decision")
    second = _fitted(_half(examples, 1), rng, _HALF)
    yield Progress(done + 0.14, "learning the decision")
    return Bench(first, general_judge(), share), Bench(second, general_judge(), share)


def _half(examples: Sequence[Example], half: int) -> list[Example]:
    """One half's labels; of the root rows all, where the half has no error in them to show."""
    parts = [one.only(half) for one in examples]
    if any((one.labels[:, -2:] == 1).any() for one in parts):
        return parts
    whole = zip(parts, examples, strict=True)
    return [
        replace(part, labels=np.hstack([part.labels[:, :-2], one.labels[:, -2:]]))
        for part, one in whole
    ]


def _without_suspects(
    examples: Sequence[Example], takes: Sequence[Known], judges: tuple[Bench, Bench]
) -> list[Example]:
    """Take what looks wrong in the take itself for unknown: nobody said that it is clean."""
    seen = examine(takes[0].motion, takes[0].around)
    if seen is None:
        return list(examples)
    probability = crossed(judges, seen, halves(len(seen.joints), 0, 1))
    suspects = windows(probability, 2).max(axis=-1) > _SUSPECT
    return [one.doubting(suspects) for one in examples]


def _fitted(examples: Sequence[Example], rng: np.random.Generator, size: Size) -> Judge:
    """Learn the decisions on single frames: of joints, and of the root rows."""
    joints = Rows.of([(one.seen.joints, one.labels[:, :-2]) for one in examples])
    root = Rows.of([(one.seen.root, one.labels[:, -2:]) for one in examples])
    return Judge(grow(joints, rng, size), grow(root, rng, _ROOT))


def _span_examples(
    examples: Sequence[Example], judges: tuple[Bench, Bench], anatomy: Anatomy
) -> Rows:
    """Candidate spans that the decision of the other half raises."""
    parts = []
    for one in examples:
        probability = crossed(judges, one.seen, one.half)[:, : len(anatomy.limb)]
        found = candidates(probability)
        if found:
            rows = span_features(probability, one.seen.joints, anatomy.limb, found)
            parts.append((rows, labels_of(one.labels, found)))
    if not parts:
        raise TooLittleToLearnError("no error that was put into the context stands out")
    return Rows.of(parts)
