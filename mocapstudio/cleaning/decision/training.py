"""Learning the decision from a context, top to bottom.

1. Every take of the context is compared with the others: what residual is usual for a joint;
2. errors are put into its takes, again and again, half of the time with the nearest takes
left out, so that novelty is learnt as normal; 3. boosted trees learn to tell them apart, frame by
frame, each half of the takes for itself; nothing near an impossibly fast rotation counts as clean;
4. smaller trees judge the spans that these raise on what they did not learn from.

A take that is alone is judged by trees learnt from every other three seconds of it, and what these
find in it as it came is taken for unknown, not for normal.
"""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.decision import breaks
from mocapstudio.cleaning.decision.features import COLUMN, USUAL, Surroundings, windows
from mocapstudio.cleaning.decision.forest import Forest
from mocapstudio.cleaning.decision.matching import LEAST_FRAMES, nearest_takes
from mocapstudio.cleaning.decision.model import (
    Decision,
    Judge,
    Seen,
    crossed,
    examine,
    halves,
    pool,
)
from mocapstudio.cleaning.decision.spans import candidates, labels_of, span_features
from mocapstudio.cleaning.decision.spoiling import Anatomy, spoil
from mocapstudio.cleaning.decision.surroundings import anatomy_of, mean_pose, moments_of
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.take import Take
from mocapstudio.similarity.texture import (
    BodyMotion,
    MotionTexture,
    body_motion,
    comparable_joints,
    texture_of,
)

F32 = NDArray[np.float32]

_FRAMES_WANTED = 20_000
_VARIANTS = (2, 16)
_NEGATIVES = 60_000
_LEAST_USUAL = np.array([2.0, 2.0, 2.0, 0.1, 0.1], dtype=np.float32)
_MOST_DROPPED = 10
_SUSPECT = 0.3


@dataclass(frozen=True)
class _Size:
    """How much trees can learn: their number, leaves, step, and samples a leaf at least."""

    trees: int
    leaves: int
    rate: float
    least: int


_WHOLE, _HALF = _Size(150, 31, 0.1, 40), _Size(80, 31, 0.15, 40)
_ROOT, _SMALL = _Size(60, 16, 0.12, 40), _Size(80, 8, 0.08, 20)


class TooLittleToLearnError(MocapError):
    """A context from which no decision can be learnt."""


@dataclass(frozen=True, eq=False)
class _Known:
    """One take of the context and what it is compared with."""

    motion: BodyMotion
    texture: MotionTexture
    around: Surroundings


@dataclass(frozen=True, eq=False)
class _Example:
    """One spoilt take: what is seen of it, labels, and which half its frames belong to."""

    take: int
    seen: Seen
    labels: NDArray[np.int8]
    half: NDArray[np.int64]

    def doubting(self, doubtful: NDArray[np.bool_]) -> _Example:
        """Call nothing clean where it is doubtful, (S, m + 2)."""
        return replace(self, labels=np.where(doubtful & (self.labels == 0), -1, self.labels))

    def only(self, half: int) -> _Example:
        """Take the other half's labels away."""
        return replace(self, labels=np.where((self.half == half)[:, None], self.labels, -1))


@dataclass(frozen=True, eq=False)
class _Rows:
    """Rows of features with sure labels."""

    rows: F32
    labels: NDArray[np.int8]

    @staticmethod
    def of(parts: Sequence[tuple[F32, NDArray[np.int8]]]) -> _Rows:
        rows = np.concatenate([f.reshape(-1, f.shape[-1]) for f, _ in parts])
        labels = np.concatenate([label.ravel() for _, label in parts])
        sure = labels >= 0
        return _Rows(rows[sure], labels[sure])


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
    yield Progress(0.0, "preparing the context")
    names = tuple(joints) if joints is not None else comparable_joints(context[0], context[1:])
    anatomy = anatomy_of(context[0].skeleton, names)
    motions = [body_motion(take, names) for take in context]
    motions = [one for one in motions if len(texture_of(one)) >= LEAST_FRAMES]
    if not motions:
        raise TooLittleToLearnError("no take of the context is long enough to learn from")
    takes = _each_without_itself(motions, anatomy)
    usual = yield from _usual(takes)
    takes = [replace(one, around=replace(one.around, usual=usual)) for one in takes]
    rng = np.random.default_rng(seed)
    examples = _without_breaks((yield from _spoilt_examples(takes, anatomy, rng)), takes)
    yield Progress(0.65, "learning the decision")
    judges = yield from _judges(examples, rng, 0.65)
    alone = len(takes) == 1
    if alone:
        # Only here: among several takes this would unlearn what is rare but right.
        examples = _without_suspects(examples, takes, judges)
        judges = yield from _judges(examples, rng, 0.8)
    spans = _fit(_span_examples(examples, judges, anatomy), rng, _SMALL)
    yield Progress(0.95, "learning the decision")
    return Decision(names, usual, judges if alone else (_fitted(examples, rng, _WHOLE),), spans)


def _judges(
    examples: Sequence[_Example], rng: np.random.Generator, done: float
) -> Generator[Progress, None, tuple[Judge, Judge]]:
    """Learn from each half alone, so that either can judge the other."""
    first = _fitted(_half(examples, 0), rng, _HALF)
    yield Progress(done + 0.07, "learning the decision")
    second = _fitted(_half(examples, 1), rng, _HALF)
    yield Progress(done + 0.14, "learning the decision")
    return first, second


def _half(examples: Sequence[_Example], half: int) -> list[_Example]:
    """One half's labels; of the root rows all, where the half has no error in them to show."""
    parts = [one.only(half) for one in examples]
    if any((one.labels[:, -2:] == 1).any() for one in parts):
        return parts
    whole = zip(parts, examples, strict=True)
    return [
        replace(part, labels=np.hstack([part.labels[:, :-2], one.labels[:, -2:]]))
        for part, one in whole
    ]


def _without_breaks(examples: Sequence[_Example], takes: Sequence[_Known]) -> list[_Example]:
    """Take what surrounds impossibly fast rotations of the context itself for unknown."""
    limit = breaks.limits([one.motion for one in takes])
    doubts = {i: breaks.doubtful(one.motion, one.texture, limit) for i, one in enumerate(takes)}
    return [one.doubting(doubts[one.take]) for one in examples]


def _without_suspects(
    examples: Sequence[_Example], takes: Sequence[_Known], judges: tuple[Judge, Judge]
) -> list[_Example]:
    """Take what looks wrong in the take itself for unknown: nobody said that it is clean."""
    seen = examine(takes[0].motion, takes[0].around)
    if seen is None:
        return list(examples)
    probability = crossed(judges, seen, halves(len(seen.joints), 0, 1))
    suspects = windows(probability, 2).max(axis=-1) > _SUSPECT
    return [one.doubting(suspects) for one in examples]


def _each_without_itself(motions: Sequence[BodyMotion], anatomy: Anatomy) -> list[_Known]:
    textures = [texture_of(one) for one in motions]
    centre = mean_pose(textures)
    moments = [moments_of(one, centre) for one in textures]
    total = moments[0]
    for one in moments[1:]:
        total = total + one
    takes = []
    for i, (motion, texture) in enumerate(zip(motions, textures, strict=True)):
        others = [other for k, other in enumerate(textures) if k != i]
        rest = total - moments[i] if others else total
        takes.append(_Known(motion, texture, Surroundings(others, rest, centre, anatomy.limb)))
    return takes


def _usual(takes: Sequence[_Known]) -> Generator[Progress, None, F32]:
    """(5, m) 98 % quantiles of clean takes' own residuals, every take without itself."""
    columns = [COLUMN[f"{name} usual"] for name in USUAL]
    found = []
    for i, one in enumerate(takes):
        yield Progress(0.05 + 0.1 * i / len(takes), "measuring what is usual")
        seen = examine(one.motion, one.around)
        if seen is not None:
            found.append(seen.joints[..., columns])
    quantiles = np.nanquantile(np.concatenate(found), 0.98, axis=0).T
    return np.asarray(np.maximum(np.nan_to_num(quantiles), _LEAST_USUAL[:, None]), dtype=np.float32)


def _spoilt_examples(
    takes: Sequence[_Known], anatomy: Anatomy, rng: np.random.Generator
) -> Generator[Progress, None, list[_Example]]:
    frames = sum(len(one.texture) for one in takes)
    variants = int(np.clip(round(_FRAMES_WANTED / frames), *_VARIANTS))
    examples = []
    for n in range(variants * len(takes)):
        yield Progress(0.15 + 0.5 * n / (variants * len(takes)), "making examples of errors")
        one, variant = takes[n % len(takes)], n // len(takes)
        motion, label = spoil(one.motion, anatomy, rng)
        seen = examine(motion, one.around)
        if seen is None:
            continue
        if variant % 2 and len(one.around.textures) > 2:
            seen = _without_nearest(motion, one, seen, rng)
        take, labels = n % len(takes), _pooled_labels(label, one.texture)
        examples.append(_Example(take, seen, labels, halves(len(labels), take, len(takes))))
    return examples


def _without_nearest(motion: BodyMotion, one: _Known, seen: Seen, rng: np.random.Generator) -> Seen:
    most = min(_MOST_DROPPED, len(one.around.textures) - 1)
    barred = nearest_takes(seen.matches)[: int(rng.integers(1, most + 1))]
    again = examine(motion, one.around, barred.tolist())
    return again if again is not None else seen


def _pooled_labels(label: NDArray[np.int8], texture: MotionTexture) -> NDArray[np.int8]:
    wrong = pool((label == 1).astype(np.float32), texture)
    unsure = pool((label != 0).astype(np.float32), texture)
    return np.where(wrong > 0, 1, np.where(unsure > 0, -1, 0)).astype(np.int8)


def _fitted(examples: Sequence[_Example], rng: np.random.Generator, size: _Size) -> Judge:
    """Learn the decisions on single frames: of joints, and of the root rows."""
    joints = _Rows.of([(one.seen.joints, one.labels[:, :-2]) for one in examples])
    root = _Rows.of([(one.seen.root, one.labels[:, -2:]) for one in examples])
    return Judge(_fit(joints, rng, size), _fit(root, rng, _ROOT))


def _span_examples(
    examples: Sequence[_Example], judges: tuple[Judge, Judge], anatomy: Anatomy
) -> _Rows:
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
    return _Rows.of(parts)


def _fit(examples: _Rows, rng: np.random.Generator, size: _Size) -> Forest:
    # Imported here: scikit-learn takes a second, and only learning needs it.
    from sklearn.ensemble import HistGradientBoostingClassifier
    from threadpoolctl import threadpool_limits

    right, wrong = (np.flatnonzero(examples.labels == value) for value in (0, 1))
    if not len(wrong) or not len(right):
        raise TooLittleToLearnError("the context is too short to learn from")
    kept = rng.choice(right, min(len(right), _NEGATIVES), replace=False)
    rows = np.concatenate([wrong, kept])
    model = HistGradientBoostingClassifier(
        max_iter=size.trees,
        learning_rate=size.rate,
        max_leaf_nodes=size.leaves,
        min_samples_leaf=size.least,
        l2_regularization=1.0,
        early_stopping=False,
        random_state=0,
    )
    # Waiting OpenMP threads spin: on a busy machine one thread is faster than two.
    with threadpool_limits(1):
        # What does not exist in this context, such as other takes, is no column to learn from.
        there = np.flatnonzero(np.isfinite(examples.rows[rows]).any(axis=0))
        model.fit(examples.rows[np.ix_(rows, there)], examples.labels[rows])
    forest = Forest.of(model, there)
    # What was left out of the right rows is put back into the odds: weights would do the same,
    # but make scikit-learn's binning several times slower.
    return replace(forest, base=forest.base - float(np.log(len(right) / len(kept))))
