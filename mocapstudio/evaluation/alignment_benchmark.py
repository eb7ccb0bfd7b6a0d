"""Quality of online alignment over the share of the movement seen (paper 3, figures 2, 4 and 5)."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from mocapstudio.comparison.online import Variant
from mocapstudio.comparison.online_features import F64
from mocapstudio.comparison.weights_examples import ExampleSet, example_set
from mocapstudio.comparison.weights_quality import SHARES, Trials
from mocapstudio.comparison.weights_training import (
    PAPER,
    Learnt,
    TrainingParameters,
    as_part,
    evolved,
    folds_of,
)
from mocapstudio.comparison.weights_variance import variance_weights
from mocapstudio.evaluation.alignment_cases import Action
from mocapstudio.motion.progress import Progress

OFFLINE = "offline"
PLAIN = "plain open-end"
DIAGONAL = "diagonal penalty"
PATH_LENGTH = "path length"
VARIANCE = "variance-based weights"
PAPER_WEIGHTS = "evolved weights (paper)"
MOTION = "with motion, not learnt"
OURS = "with motion, evolved"
METHODS = (OFFLINE, PLAIN, DIAGONAL, PATH_LENGTH, VARIANCE, PAPER_WEIGHTS, MOTION, OURS)

FROM_SHARE = 0.4
"""From which share of the movement on the online alignment is to keep up with the offline one."""


@dataclass(frozen=True, eq=False)
class ActionScores:
    """How well each method aligns one action, on performances it was not trained on.

    Parameters
    ----------
    action
        Its name.
    references, performances
        How many of each.
    curves
        (K,) mean quality after each of the shares, by method.
    """

    action: str
    references: int
    performances: int
    curves: dict[str, F64]

    @property
    def behind_offline(self) -> float:
        """Largest lead of the offline alignment over ours from `FROM_SHARE` on."""
        late = np.array(SHARES) >= FROM_SHARE - 1e-9
        return float((self.curves[OFFLINE] - self.curves[OURS])[late].max())

    @property
    def above_plain(self) -> tuple[float, float]:
        """Smallest and mean lead of ours over the plain open end."""
        lead = self.curves[OURS] - self.curves[PLAIN]
        return float(lead.min()), float(lead.mean())

    def to_json(self) -> dict[str, Any]:
        """Plain objects for JSON."""
        low, mean = self.above_plain
        return {
            "action": self.action,
            "references": self.references,
            "performances": self.performances,
            "shares": list(SHARES),
            "quality": {name: curve.tolist() for name, curve in self.curves.items()},
            "behind_offline": self.behind_offline,
            "above_plain": {"least": low, "mean": mean},
        }


def scoring(
    action: Action, references: int, folds: int, iterations: int, seed: int
) -> Generator[Progress, None, ActionScores]:
    """Align an action's performances with some of them as reference, cross-validated.

    Parameters
    ----------
    references
        How many performances serve as reference in their turn.
    folds, iterations
        Of the training.
    """
    collected: dict[str, list[F64]] = {name: [] for name in METHODS}
    chosen = action.references(references, seed)
    steps = 2 * len(chosen)
    for i, number in enumerate(chosen):
        others = [one for k, one in enumerate(action.performances) if k != number]
        own = action.performances[number]
        poses = example_set(own, others, motion=False)
        paper = replace(PAPER, folds=folds, iterations=iterations, seed=seed)
        for name, values in _without_training(poses).items():
            collected[name].append(values)
        collected[VARIANCE].append(_by_variance(poses, paper))
        at = 2 * i / steps
        what = f"{action.name}, reference {i + 1}, the paper's weights"
        collected[PAPER_WEIGHTS].append((yield from _trained(poses, paper, at, 1 / steps, what)))
        moving = example_set(own, others, motion=True)
        trials = Trials(moving.reference, moving.segments, moving.examples)
        collected[MOTION].append(trials.qualities(moving.reference.plain_weights[None])[:, 0])
        ours = TrainingParameters(folds=folds, iterations=iterations, seed=seed)
        what = f"{action.name}, reference {i + 1}, our weights"
        collected[OURS].append((yield from _trained(moving, ours, at + 1 / steps, 1 / steps, what)))
    curves = {name: np.concatenate(values).mean(axis=0) for name, values in collected.items()}
    return ActionScores(action.name, len(chosen), len(action.performances), curves)


def mean_scores(scores: Sequence[ActionScores]) -> ActionScores:
    """Mean over actions, each counting the same."""
    curves = {
        name: np.asarray(np.mean([one.curves[name] for one in scores], axis=0)) for name in METHODS
    }
    references, performances = (
        sum(getattr(one, field) for one in scores) for field in ("references", "performances")
    )
    return ActionScores("mean of actions", references, performances, curves)


def _without_training(made: ExampleSet) -> dict[str, F64]:
    """(N, K) qualities of the methods that learn nothing."""
    trials = Trials(made.reference, made.segments, made.examples)
    ones = np.ones((1, len(made.reference.names)), np.float32)
    whole = trials.qualities(ones, Variant.PLAIN, closed=True)[:, 0, -1:]
    return {
        OFFLINE: np.repeat(whole, len(SHARES), axis=1),
        PLAIN: trials.qualities(ones, Variant.PLAIN)[:, 0],
        DIAGONAL: trials.qualities(ones, Variant.DIAGONAL)[:, 0],
        PATH_LENGTH: trials.qualities(ones, Variant.PATH_LENGTH)[:, 0],
    }


def _by_variance(made: ExampleSet, parameters: TrainingParameters) -> F64:
    """(N, K) qualities under weights by variance, each fold's from the other folds."""
    out = _untrained(made, parameters)
    for tested in _groups(made, parameters):
        kept = [one.rows for k, one in enumerate(made.examples) if k not in tested]
        weights = variance_weights(kept, made.reference.directions)
        _test(made, tested, Learnt(weights, Variant.PATH_LENGTH), out)
    return out


def _trained(
    made: ExampleSet, parameters: TrainingParameters, at: float, size: float, what: str
) -> Generator[Progress, None, F64]:
    """(N, K) qualities under evolved weights, each fold's from the other folds."""
    out = _untrained(made, parameters)
    groups = _groups(made, parameters)
    for i, tested in enumerate(groups):
        kept = [one for k, one in enumerate(made.examples) if k not in tested]
        learning = evolved(made.reference, made.segments, kept, parameters)
        part = size / len(groups)
        learnt = yield from as_part(learning, at + i * part, part, what)
        _test(made, tested, learnt, out)
    return out


def _untrained(made: ExampleSet, parameters: TrainingParameters) -> F64:
    """(N, K) qualities where there is nothing to learn from."""
    out = np.empty((len(made.examples), len(SHARES)))
    learnt = Learnt(made.reference.plain_weights, parameters.variants[0])
    _test(made, range(len(made.examples)), learnt, out)
    return out


def _groups(made: ExampleSet, parameters: TrainingParameters) -> list[tuple[int, ...]]:
    return folds_of(made.examples, parameters.folds, parameters.seed)


def _test(made: ExampleSet, tested: Sequence[int], learnt: Learnt, out: F64) -> None:
    trials = Trials(made.reference, made.segments, [made.examples[k] for k in tested])
    out[list(tested)] = trials.qualities(learnt.weights[None], learnt.variant)[:, 0]
