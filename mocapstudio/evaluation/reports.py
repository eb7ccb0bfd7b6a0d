"""The benchmark's results, put together: plain record, tables, page."""

from __future__ import annotations

import math
from collections.abc import Generator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from mocapstudio.cleaning.detection import detect
from mocapstudio.evaluation import detectors, page
from mocapstudio.evaluation.cases import Case, Conditions, ContextSize, cases
from mocapstudio.evaluation.corpora import available
from mocapstudio.evaluation.detection_benchmark import DetectionScores, evaluating
from mocapstudio.evaluation.experiments import Experiment, Section, detecting, split_record
from mocapstudio.evaluation.labels import (
    cleaned_case,
    departure_map,
    labelled_cases,
    read_labels,
)
from mocapstudio.evaluation.repair_benchmark import (
    Repairer,
    RepairScores,
    by_peer,
    medoid_given_truth,
    ours_as_detected,
    ours_given_truth,
    perfect,
    repairing,
    tuned_peers,
    untouched,
)
from mocapstudio.evaluation.search_speed import search_timing
from mocapstudio.evaluation.speed_benchmark import growth, timing
from mocapstudio.evaluation.tables import Table, detection_tables, repair_tables, speed_table
from mocapstudio.motion.progress import Progress, run

REPAIR_ERRORS_A_MINUTE = 12.0
"""More than in detection: repair is measured on erroneous frames only."""

Row = TypeVar("Row")


@dataclass(frozen=True)
class Report:
    """Results in three forms.

    Parameters
    ----------
    record
        Plain objects for JSON, without NaN.
    tables
        For the terminal.
    html
        A page of its own.
    """

    record: dict[str, Any]
    tables: tuple[Table, ...]
    html: str


def detection(
    data: Sequence[Path],
    contexts: Sequence[ContextSize],
    seed: int,
    limit: int,
    *,
    brief: bool = False,
) -> Generator[Progress, None, Report]:
    """Run the detection table; see `experiments.detecting`."""
    sections = yield from detecting(data, contexts=contexts, seed=seed, limit=limit, brief=brief)
    record = {
        "detection": [section.to_json() for section in sections],
        "split": split_record(data, seed),
    }
    return _report(
        "Detection", record, detection_tables(sections), [page.curves_html(sections)], seed
    )


def repair(
    data: Sequence[Path], context: ContextSize, seed: int, limit: int
) -> Generator[Progress, None, Report]:
    """Repair injected errors by every method, for each set of takes."""
    tables: list[Table] = []
    record: dict[str, Any] = {}
    sets = [s for s in available(tuple(data)) if s != "own rate"]
    for corpus in sets:
        yield Progress(0.0, f"{corpus}: tuning the peers")
        many = Conditions(errors_per_minute=REPAIR_ERRORS_A_MINUTE)
        size: ContextSize = "small" if context == "local" else context
        training = cases(tuple(data), corpus, size, seed, limit, "development", many)
        peers: dict[str, Repairer] = {k: by_peer(p) for k, p in tuned_peers(training).items()}
        tested = cases(tuple(data), corpus, context, seed, limit, "test", many)
        ours: dict[str, Repairer] = {
            "ours, true spans": ours_given_truth,
            "ours, own flags": ours_as_detected,
            "neighbours' medoid": medoid_given_truth,
        }
        methods = ours | peers | {"nothing done": untouched, "clean take": perfect}
        rows = yield from repairing(methods, tested, again=True)
        tables += repair_tables(f"Repair, {corpus}, {context}", rows)
        record[corpus] = [row.to_json() for row in rows]
    record = {"repair": record, "split": split_record(data, seed)}
    return _report("Repair", record, tables, [], seed)


def speed(
    data: Sequence[Path], seed: int, *, long: bool = True
) -> Generator[Progress, None, Report]:
    """Measure speed; see `speed_benchmark.timing` and `search_speed.search_timing`."""
    rows = yield from timing(data, seed=seed, long=long)
    rows += yield from search_timing(data, seed=seed, long=long)
    record = {"speed": [row.to_json() for row in rows], "growth": growth(rows)}
    return _report("Speed", record, [speed_table(rows)], [], seed)


def against_labels(
    data: Sequence[Path], labels: Path, context: ContextSize
) -> Generator[Progress, None, Report]:
    """Score detection against labels made by hand."""
    made = labelled_cases(data, read_labels(labels), context)
    return (yield from _detected(made, f"labels of {labels.name}", context))


def against_cleaned(
    data: Sequence[Path], cleaned: Path, context: ContextSize, *, repair: bool = False
) -> Generator[Progress, None, Report]:
    """Score the engine against a hand-cleaned version, with both maps one above the other."""
    case = cleaned_case(data, cleaned, context)
    title = f"{case.dirty.name} against {cleaned.name}"
    if repair:
        return (yield from _repaired([case], title))
    return (yield from _detected([case], title, context))


def _detected(
    made: Sequence[Case], title: str, context: ContextSize
) -> Generator[Progress, None, Report]:
    rows: list[DetectionScores] = []
    for name, detector in (("ours", detectors.ours()), ("literal", detectors.literal())):
        rows.append((yield from evaluating(detector, made, name)))
    experiment = Experiment(title, "labelled", context)
    names = tuple(case.dirty.name for case in made)
    errors = sum(len(case.truths) for case in made)
    section = Section(experiment, tuple(rows), errors, names)
    parts = [page.curves_html([section])]
    for case in made[:20]:
        analysis = run(detect(case.dirty, case.context))
        columns = [analysis.map.rows.index(r) for r in case.rows if r in analysis.map.rows]
        truth = case.mask().astype(float) if case.given is not None else departure_map(case)
        maps = [("ours", np.asarray(analysis.map.values[:, columns], dtype=np.float64))]
        maps.append(("labels" if case.given is not None else "from the cleaned version", truth))
        parts.append(page.maps_html(case.dirty.name, maps, "rows: " + ", ".join(case.rows)))
    record = {"detection": [section.to_json()]}
    return _report("Detection", record, detection_tables([section]), parts, None)


def _repaired(made: Sequence[Case], title: str) -> Generator[Progress, None, Report]:
    methods: dict[str, Repairer] = {
        "ours, true spans": ours_given_truth,
        "ours, own flags": ours_as_detected,
        "nothing done": untouched,
    }
    rows: list[RepairScores] = yield from repairing(methods, made, again=True)
    record = {"repair": {title: [row.to_json() for row in rows]}}
    return _report("Repair", record, repair_tables(title, rows), [], None)


def _report(
    title: str,
    record: dict[str, Any],
    tables: Sequence[Table],
    parts: Sequence[str],
    seed: int | None,
) -> Report:
    lead = (
        f"seed {seed}; errors injected into takes that tuning has not seen"
        if seed is not None
        else "scored against what was done by hand"
    )
    body = [*parts, *(page.table_html(table) for table in tables)]
    html = page.page(f"mocapstudio: {title.lower()}", lead, body, "mocapstudio evaluate")
    return Report(without_nan(record), tuple(tables), html)


def without_nan(value: Any) -> Any:
    """Put None in the place of every NaN of plain objects: JSON has none."""
    if isinstance(value, dict):
        return {key: without_nan(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [without_nan(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
