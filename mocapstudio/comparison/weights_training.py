"""Joint weights learnt by evolution from labelled performances (paper 3, section 4.2).

CMA-ES looks for the weights under which the open-end alignment puts most path cells into the right
segment, averaged over shares of the movement seen. Cross-validation leaves out one group of
performers at a time, so that what is reported holds for people whom the training has not seen.

Beyond the paper: with the tens of performances that people have, weights of forty rows learn the
performances by heart. So the evolution begins at the best of a few plain sets of weights and pays
for leaving it.
"""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass

import numpy as np
from threadpoolctl import threadpool_limits

from mocapstudio.comparison.online import Variant
from mocapstudio.comparison.online_features import F32, F64, I32
from mocapstudio.comparison.online_reference import MOTION_WEIGHT, ROOT_WEIGHT, Reference
from mocapstudio.comparison.weights import FoldQuality, JointWeights
from mocapstudio.comparison.weights_quality import SHARES, Example, Trials
from mocapstudio.comparison.weights_variance import variance_weights
from mocapstudio.motion.errors import MocapError, ParameterError
from mocapstudio.motion.progress import Progress


@dataclass(frozen=True)
class TrainingParameters:
    """How weights are learnt; see `PAPER` for those of paper 3.

    Parameters
    ----------
    iterations
        Of the evolution.
    step
        Initial step size; weights begin at 1.
    parents, offspring
        Of each iteration.
    folds
        Of the cross-validation, at most as many as there are performers; 0 for none.
    variants
        Ways of accumulating paths, among which one is chosen.
    shares
        Shares of the movement seen over which the quality is averaged.
    stiffness
        What the mean squared distance of the weights from where they began costs, in quality,
        divided by the number of examples: the fewer there are, the less is to be believed.
    root_starts, motion_starts
        Weights of the root and of motion rows, against 1 of other joints and of poses, among
        which the start is chosen; only looked at where the reference has such rows. The first of
        each are the plain ones, which others have to surpass.
    variance_start
        Whether weights by variance are among the starts too.
    seed
        Of the evolution and the folds.
    """

    iterations: int = 300
    step: float = 0.02
    parents: int = 6
    offspring: int = 12
    folds: int = 5
    variants: tuple[Variant, ...] = (Variant.PLAIN, Variant.PATH_LENGTH)
    shares: tuple[float, ...] = SHARES
    stiffness: float = 0.4
    root_starts: tuple[float, ...] = (ROOT_WEIGHT, 1.0)
    motion_starts: tuple[float, ...] = (MOTION_WEIGHT, 0.0, 1.0, 2 * MOTION_WEIGHT)
    variance_start: bool = True
    seed: int = 0

    def __post_init__(self) -> None:
        if self.iterations < 1 or self.folds < 0 or self.step <= 0:
            raise ParameterError("iterations, folds and step must be positive")
        if not 1 <= self.parents <= self.offspring or self.offspring < 2:
            raise ParameterError("there must be at least two offspring, and no more parents")


PAPER = TrainingParameters(
    stiffness=0.0,
    variants=(Variant.PATH_LENGTH,),
    root_starts=(1.0,),
    motion_starts=(1.0,),
    variance_start=False,
)
"""Paper 3 to the letter, for references without motion."""


@dataclass(frozen=True, eq=False)
class Learnt:
    """What the evolution came to.

    Parameters
    ----------
    weights
        (N,) with a mean of 1.
    variant
        How paths are to be accumulated with them.
    """

    weights: F32
    variant: Variant


@dataclass(frozen=True, eq=False)
class Fold:
    """What one fold of a cross-validation learnt, and how it does on those left out.

    Parameters
    ----------
    quality
        In numbers.
    tested
        Indices of the examples left out.
    learnt
        Without them.
    """

    quality: FoldQuality
    tested: tuple[int, ...]
    learnt: Learnt


@dataclass(frozen=True, eq=False)
class Training:
    """Result of a training.

    Parameters
    ----------
    weights
        Learnt from all examples, with the quality of every fold.
    folds
        Of the cross-validation.
    quality
        Mean quality of all examples under `weights`: they were learnt from these.
    """

    weights: JointWeights
    folds: tuple[Fold, ...]
    quality: float


def training(
    reference: Reference,
    segments: I32,
    examples: Sequence[Example],
    parameters: TrainingParameters = TrainingParameters(),
) -> Generator[Progress, None, Training]:
    """Learn weights from all examples, and say how well that does on other performers.

    Parameters
    ----------
    reference
        The performance that is aligned with.
    segments
        (R,) number of each reference frame's segment, see `weights_quality.segments_of`.
    examples
        Labelled performances, without the reference itself.

    Yields
    ------
    Progress.

    Raises
    ------
    MocapError
        If there is no example.
    """
    if not examples:
        raise MocapError("no labelled take to learn weights from")
    folds = []
    groups = folds_of(examples, parameters.folds, parameters.seed)
    size = 1 / (len(groups) + 1)
    for i, tested in enumerate(groups):
        kept = [examples[k] for k in range(len(examples)) if k not in tested]
        learning = evolved(reference, segments, kept, parameters)
        learnt = yield from as_part(learning, i * size, size, f"fold {i + 1}")
        left_out = [examples[k] for k in tested]
        quality = FoldQuality(
            tuple(dict.fromkeys(one.performer or one.name for one in left_out)),
            _quality(reference, segments, kept, learnt, parameters),
            _quality(reference, segments, left_out, learnt, parameters),
            _quality(reference, segments, left_out, _unlearnt(reference), parameters),
        )
        folds.append(Fold(quality, tested, learnt))
    learning = evolved(reference, segments, examples, parameters)
    learnt = yield from as_part(learning, 1 - size, size, "all takes")
    named = dict(zip(reference.names, map(float, learnt.weights), strict=True))
    found = tuple(fold.quality for fold in folds)
    weights = JointWeights(named, learnt.variant, reference.name, found)
    overall = _quality(reference, segments, examples, learnt, parameters)
    return Training(weights, tuple(folds), overall)


def evolved(
    reference: Reference,
    segments: I32,
    examples: Sequence[Example],
    parameters: TrainingParameters = TrainingParameters(),
) -> Generator[Progress, None, Learnt]:
    """Learn weights from examples, without cross-validation."""
    import cma

    trials = Trials(reference, segments, examples, parameters.shares)
    price = parameters.stiffness / len(examples)
    # The threads of the pool already fill the cores.
    with threadpool_limits(1, "blas"):
        starts = _starts(reference, examples, parameters)
        tried = [trials.qualities(starts, one).mean(axis=2) for one in parameters.variants]
        best, at = surest(np.array(tried))
        variant, start = parameters.variants[best], starts[at]
        strategy = cma.CMAEvolutionStrategy(start, parameters.step, _options(parameters))
        while not strategy.stop():
            yield Progress(strategy.countiter / parameters.iterations, "evolving")
            asked = np.array(strategy.ask())
            weights = np.maximum(asked, 0.0)
            quality = _mean_qualities(trials, weights, variant)
            paid = price * np.mean((weights - start) ** 2, axis=1)
            strategy.tell(list(asked), list(1.0 - quality + paid))
    return Learnt(_used(strategy.result.xfavorite), variant)


def _options(parameters: TrainingParameters) -> dict[str, float]:
    return {
        "popsize": parameters.offspring,
        "CMA_mu": parameters.parents,
        "maxiter": parameters.iterations,
        "seed": parameters.seed + 1,
        "verbose": -9,
        # Quality is a staircase: to stand on a step for long is no reason to stop.
        "tolfun": 0,
        "tolfunhist": 0,
        "tolflatfitness": parameters.iterations + 1,
        "tolstagnation": parameters.iterations + 1,
    }


def folds_of(examples: Sequence[Example], folds: int, seed: int) -> list[tuple[int, ...]]:
    """Deal the performers out to folds; each fold's examples are all of its performers'.

    With one performer or none known, each take counts as a performer of its own; consecutive takes,
    which are most alike, stay in one fold then.
    """
    performers = [example.performer for example in examples]
    several = len(set(performers)) > 1
    if not several:
        performers = [str(i) for i in range(len(examples))]
    different = list(dict.fromkeys(performers))
    count = min(folds, len(different))
    if count < 2:
        return []
    order = np.arange(len(different))
    if several:
        order = np.random.default_rng(seed).permutation(order)
    fold = {different[k]: i * count // len(order) for i, k in enumerate(order)}
    return [
        tuple(k for k, performer in enumerate(performers) if fold[performer] == i)
        for i in range(count)
    ]


def surest(qualities: F64) -> tuple[int, int]:
    """Choose by qualities (V, N, S) of N examples one of V variants and one of S sets of weights.

    The first of both, unless others are better by more than their lead's standard error: with few
    examples the best of many is so by chance.
    """
    lead = qualities - qualities[:1, :, :1]
    examples = lead.shape[1]
    error = lead.std(axis=1, ddof=1) / np.sqrt(examples) if examples > 1 else np.inf
    sure = np.where(np.any(lead != 0, axis=1), lead.mean(axis=1) - error, 0.0)
    variant, weights = np.unravel_index(int(np.argmax(sure)), sure.shape)
    return int(variant), int(weights)


def _starts(
    reference: Reference, examples: Sequence[Example], parameters: TrainingParameters
) -> F32:
    """(n, N) sets of weights where the evolution may begin, each with a mean of 1."""
    has_root = reference.features.root is not None
    roots = parameters.root_starts if has_root else (1.0,)
    motions = parameters.motion_starts if reference.motion else (1.0,)
    sets = [reference.weights(root, motion) for root in roots for motion in motions]
    if parameters.variance_start:
        rows = [example.rows for example in examples]
        by_variance = variance_weights(rows, reference.directions)
        sets += [by_variance * reference.weights(1.0, motion) for motion in motions]
    return np.array([_used(one) for one in sets])


def _used(weights: F64 | F32) -> F32:
    """Weights at least 0 with a mean of 1: neither sign nor scale means anything to a path."""
    positive = np.maximum(np.asarray(weights), 0.0)
    mean = positive.mean()
    return np.asarray(positive / mean if mean > 0 else np.ones_like(positive), dtype=np.float32)


def _mean_qualities(trials: Trials, weights: F64 | F32, variant: Variant) -> F64:
    """(P,) mean over examples and shares of P sets of weights."""
    found = trials.qualities(np.asarray(weights, dtype=np.float32), variant)
    return np.asarray(found.mean(axis=(0, 2)))


def _quality(
    reference: Reference,
    segments: I32,
    examples: Sequence[Example],
    learnt: Learnt,
    parameters: TrainingParameters,
) -> float:
    trials = Trials(reference, segments, examples, parameters.shares)
    return float(_mean_qualities(trials, learnt.weights[None], learnt.variant)[0])


def _unlearnt(reference: Reference) -> Learnt:
    return Learnt(reference.plain_weights, Variant.PLAIN)


def as_part(
    work: Generator[Progress, None, Learnt], low: float, size: float, what: str
) -> Generator[Progress, None, Learnt]:
    """Pass the progress of a part of the work on as progress of the whole, named `what`."""
    while True:
        try:
            progress = next(work)
        except StopIteration as stop:
            result: Learnt = stop.value
            return result
        yield Progress(low + size * progress.done, what)
