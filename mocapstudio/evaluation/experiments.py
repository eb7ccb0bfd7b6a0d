"""The rows of the detection table: which takes, which errors, which context, which methods."""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mocapstudio.cleaning.model import Kind
from mocapstudio.evaluation import baselines, detectors
from mocapstudio.evaluation.alternatives import tuned_alternatives
from mocapstudio.evaluation.cases import CONTEXT_TAKES, USUAL, Conditions, ContextSize, cases
from mocapstudio.evaluation.corpora import NAMED, available, entries, split
from mocapstudio.evaluation.detection_benchmark import DetectionScores, Detector, evaluating
from mocapstudio.evaluation.injection import KINDS
from mocapstudio.evaluation.shapes import JITTER_HERTZ
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.progress import Progress

OURS = "ours"
LITERAL = "literal"
BASELINES = "baselines"
ALTERNATIVES = "alternatives"
METHODS = (OURS, LITERAL, BASELINES, ALTERNATIVES)

PAPER: dict[tuple[str, str], tuple[float, float]] = {
    ("locomotion", "local"): (0.985, 0.875),
    ("locomotion", "small"): (0.985, 0.919),
    ("locomotion", "large"): (0.988, 0.936),
    ("varied", "local"): (0.947, 0.785),
    ("varied", "small"): (0.952, 0.832),
    ("varied", "large"): (0.968, 0.896),
}
"""Recall and precision that paper 1, Table 1, reports; its dances stand beside varied actions."""

REACH: dict[tuple[str, str], tuple[float, float]] = {
    ("locomotion", "local"): (0.985, 0.940),
    ("locomotion", "small"): (0.990, 0.980),
    ("locomotion", "large"): (0.997, 0.985),
    ("varied", "local"): (0.950, 0.850),
    ("varied", "small"): (0.955, 0.880),
    ("varied", "large"): (0.970, 0.940),
}
"""Recall and precision to be reached."""

SHARP = (Kind.POP, Kind.JITTER, Kind.ROOT_POP, Kind.HEIGHT_DRIFT, Kind.HEADING_FLIP)
"""What a detector at 24 fps misses."""
ALONE_A_MINUTE = 12.0
"""Errors a minute where a kind is measured by itself."""


@dataclass(frozen=True)
class Experiment:
    """One set of cases and what is run on it.

    Parameters
    ----------
    title
        For people.
    corpus, context
        See `cases.cases`.
    conditions
        What is wrong with the takes and with their context.
    methods
        Of `METHODS`.
    """

    title: str
    corpus: str
    context: ContextSize
    conditions: Conditions = USUAL
    methods: tuple[str, ...] = (OURS,)

    @property
    def is_main(self) -> bool:
        """Whether it is a row of the main table, which the paper has too."""
        return self.conditions == USUAL

    @property
    def is_of_one_kind(self) -> bool:
        """Whether one kind of error is measured by itself."""
        return len(self.conditions.kinds) == 1


@dataclass(frozen=True)
class Section:
    """The results of one experiment.

    Parameters
    ----------
    experiment
        What was done.
    rows
        One a method.
    errors, takes
        How many errors were injected, and the names of the analysed takes.
    """

    experiment: Experiment
    rows: tuple[DetectionScores, ...]
    errors: int
    takes: tuple[str, ...]

    def to_json(self) -> dict[str, Any]:
        """Plain objects for JSON."""
        key = (self.experiment.corpus, self.experiment.context)
        return {
            "title": self.experiment.title,
            "corpus": self.experiment.corpus,
            "context": self.experiment.context,
            "errors": self.errors,
            "takes": list(self.takes),
            "paper": PAPER.get(key) if self.experiment.is_main else None,
            "reach": REACH.get(key) if self.experiment.is_main else None,
            "rows": [row.to_json() for row in self.rows],
        }


def experiments(
    sets: Sequence[str], contexts: Sequence[ContextSize], *, brief: bool = False
) -> list[Experiment]:
    """Every row that the sets of takes allow; `brief` leaves out all but the main table."""
    main = [s for s in sets if s != "own rate"]
    plan = [
        Experiment(f"{corpus}, {context}", corpus, context, USUAL, METHODS)
        for corpus in main
        for context in contexts
    ]
    if brief:
        return plan
    widest = max(contexts, key=lambda c: CONTEXT_TAKES[c])
    for corpus in main:
        plan += _further(corpus, widest, sets)
    if "own rate" in sets:
        title = f"pops, jitter (above {JITTER_HERTZ:g} Hz) and root errors at 120 fps"
        plan.append(Experiment(title, "own rate", widest, Conditions(kinds=SHARP)))
    return plan


def _further(corpus: str, context: ContextSize, sets: Sequence[str]) -> list[Experiment]:
    under = {
        "untouched takes": Conditions(errors_per_minute=0.0),
        "other shapes": Conditions(family="held-out"),
        "recurring errors": Conditions(recurring=3),
    }
    if context != "local":
        under["dirty context"] = Conditions(dirty_context=True)
        other = next((s for s in ("varied", "locomotion") if s in sets and s != corpus), None)
        if other and corpus in ("varied", "locomotion"):
            under[f"context {other}"] = Conditions(foreign=other)
    for kind in KINDS:
        under[f"{kind.value} alone"] = Conditions((kind,), ALONE_A_MINUTE)
    return [Experiment(f"{corpus}, {name}", corpus, context, what) for name, what in under.items()]


def detecting(
    data: Sequence[Path],
    *,
    contexts: Sequence[ContextSize] = ("local", "small", "large"),
    seed: int = 0,
    limit: int = 12,
    brief: bool = False,
) -> Generator[Progress, None, list[Section]]:
    """Run all experiments that the data allow, on the test half.

    Parameters
    ----------
    data
        Folders or files; the known sets among them, else all takes as one set.
    contexts
        Sizes of context.
    seed
        Of split, choice and errors.
    limit
        Cases an experiment.
    brief
        Only the main table.
    """
    plan = experiments(available(tuple(data)), contexts, brief=brief)
    learnt: dict[str, dict[str, dict[str, Detector]]] = {}
    sections = []
    for i, experiment in enumerate(plan):
        yield Progress(i / len(plan), f"{experiment.title}: reading")
        corpus = experiment.corpus
        if len(experiment.methods) > 1 and corpus not in learnt:
            learnt[corpus] = _learn(data, corpus, seed, limit)
        chosen: dict[str, Detector] = {}
        for method in experiment.methods:
            chosen |= _detectors(method, learnt.get(corpus, {}))
        section = yield from _run(data, experiment, chosen, seed, limit, (i, len(plan)))
        if section is not None:
            sections.append(section)
    return sections


def _run(
    data: Sequence[Path],
    experiment: Experiment,
    chosen: Mapping[str, Detector],
    seed: int,
    limit: int,
    place: tuple[int, int],
) -> Generator[Progress, None, Section | None]:
    try:
        made = cases(
            tuple(data),
            experiment.corpus,
            experiment.context,
            seed,
            limit,
            "test",
            experiment.conditions,
        )
    except MocapError as cause:
        yield Progress(place[0] / place[1], f"{experiment.title}: left out, {cause}")
        return None
    rows = []
    for name, detector in chosen.items():
        work = evaluating(detector, made, name)
        try:
            while True:
                inner = next(work)
                done = (place[0] + inner.done / len(chosen)) / place[1]
                yield Progress(done, f"{experiment.title}: {inner.what}")
        except StopIteration as stop:
            rows.append(stop.value)
    errors = sum(len(case.truths) for case in made)
    return Section(experiment, tuple(rows), errors, tuple(case.clean.name for case in made))


def _learn(
    data: Sequence[Path], corpus: str, seed: int, limit: int
) -> dict[str, dict[str, Detector]]:
    """Learn and tune what needs it, on the development half."""
    training = cases(tuple(data), corpus, "large", seed, max(2 * limit, 16), "development")
    clean = training[0].context
    return {
        BASELINES: baselines.learnt_and_tuned(clean, training),
        ALTERNATIVES: tuned_alternatives(training),
    }


def _detectors(method: str, learnt: Mapping[str, dict[str, Detector]]) -> dict[str, Detector]:
    if method == OURS:
        return {"ours": detectors.ours()}
    if method == LITERAL:
        return {"literal mode": detectors.literal()}
    return learnt.get(method, {})


def split_record(data: Sequence[Path], seed: int) -> dict[str, dict[str, list[str]]]:
    """Which files are in which half, by set: kept with the results so that they can be repeated."""
    sets = [s for s in available(tuple(data)) if s in NAMED or s == "own"]
    return {
        corpus: {
            part: [e.path.name for e in split(entries(tuple(data), corpus), part, seed)]
            for part in ("development", "test")
        }
        for corpus in sets
    }
