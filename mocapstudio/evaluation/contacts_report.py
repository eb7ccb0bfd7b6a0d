"""The tables of contacts: how well they are found, and how well foot skate is removed."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mocapstudio.cleaning.contacts.detection import detect_contacts
from mocapstudio.evaluation import page
from mocapstudio.evaluation.contacts_cases import MADE_SECONDS, ContactCase, made, marked
from mocapstudio.evaluation.contacts_hands import marked_hands, score_hands
from mocapstudio.evaluation.contacts_peers import tuned
from mocapstudio.evaluation.contacts_scoring import ContactScores, Tally, score_contacts
from mocapstudio.evaluation.contacts_slide import SlideRow, measure
from mocapstudio.evaluation.corpora import OWN, entries
from mocapstudio.evaluation.reports import Report
from mocapstudio.evaluation.tables import Table, number
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.progress import Progress

_POINTS = ("heel", "ball", "toe", "palm")
_MOST_JERK, _NO_MORE = 1.2, 1.02
"""Times the take's own 99th percentile; times what there was before."""
_NOTE = "frames in contact; within 1/30 s of a true edge nothing is scored, but for 'strict'"
_CHOSEN = "; the thresholds of the peers are chosen on other takes"


def contacts(
    data: Sequence[Path], labels: Path | None, seed: int, limit: int
) -> Generator[Progress, None, Report]:
    """Measure contact detection and foot-skate clean-up.

    Parameters
    ----------
    data
        Takes or folders.
    labels
        Contacts marked by eye, a file or a folder of them; see `contacts_cases.marked`.
    seed
        Of made takes.
    limit
        How many takes of each folder are cleaned.

    Raises
    ------
    MocapError
        If there is no take to clean.
    """
    sections: list[tuple[str, str, list[ContactScores]]] = []
    sets = {"made with planted feet": (made("development", seed), made("test", seed))}
    if labels is not None:
        by_eye = marked(data, labels)
        halves = [[c for c in by_eye if c.part == part] for part in ("development", "test")]
        sets = {"marked by eye": (halves[0], halves[1]), **sets}
    for name, (training, test) in sets.items():
        yield Progress(0.02, f"contacts {name}")
        if training and test:
            sections.append((f"Contacts {name}", _takes(test), _scored(training, test)))
    held = [] if labels is None else marked_hands(data, labels)
    if held:
        takes = ", ".join(f"{case.take.name} with {case.partner.name}" for case in held)
        sections.append(("Hands that hold each other", takes, [score_hands("ours", held)]))
    rows: dict[str, list[SlideRow]] = {}
    chosen = _chosen(data, limit)
    for i, (folder, path) in enumerate(chosen):
        yield Progress(0.1 + 0.9 * i / len(chosen), f"foot skate: {path.stem}")
        rows.setdefault(folder, []).extend(_measured(path))
    tables = [_detection_table(*section) for section in sections]
    tables += [_slide_table(folder, found) for folder, found in rows.items() if found]
    record = {
        "detection": {title: [_to_json(one) for one in scores] for title, _, scores in sections},
        "slide": {folder: [row.to_json() for row in found] for folder, found in rows.items()},
    }
    return _report(record, tables)


def _scored(training: Sequence[ContactCase], test: Sequence[ContactCase]) -> list[ContactScores]:
    detectors = {"ours": detect_contacts, **tuned(training)}
    return [score_contacts(name, detector, test) for name, detector in detectors.items()]


def _takes(cases: Sequence[ContactCase]) -> str:
    return ", ".join(case.take.name for case in cases)


def _chosen(data: Sequence[Path], limit: int) -> list[tuple[str, Path]]:
    """At most `limit` takes of each folder, spread over the whole of it."""
    folders: dict[str, list[Path]] = {}
    for entry in entries(tuple(data), OWN):
        folders.setdefault(entry.path.resolve().parent.name, []).append(entry.path)
    return [
        (folder, paths[i * len(paths) // min(limit, len(paths))])
        for folder, paths in folders.items()
        for i in range(min(limit, len(paths)))
    ]


def _measured(path: Path) -> list[SlideRow]:
    from mocapstudio.evaluation.corpora import read_take

    try:
        return measure(read_take(path))
    except MocapError:
        # Marker takes and takes that are too short are none to clean.
        return []


def _detection_table(title: str, takes: str, scores: Sequence[ContactScores]) -> Table:
    points = [point for point in _POINTS if any(point in one.points for one in scores)]
    head = ("method", "F1", "recall", "precision", "strict F1", *points, "worst take")
    rows = tuple(
        (
            one.name,
            number(one.tolerant.f1, 3),
            number(one.tolerant.recall, 3),
            number(one.tolerant.precision, 3),
            number(one.strict.f1, 3),
            *(number(one.points.get(point, Tally()).f1, 3) for point in points),
            f"{number(one.worst[0], 3)} {one.worst[1]}",
        )
        for one in scores
    )
    chosen = _CHOSEN if len(scores) > 1 else ""
    return Table(title, head, rows, f"{_NOTE}{chosen}; measured on {takes}")


def _slide_table(folder: str, rows: Sequence[SlideRow]) -> Table:
    head = (
        "method",
        "slide mm/frame",
        "worst take",
        "worst frame",
        "gap mm",
        "edge jerk",
        "worst take",
        "jerk rises in",
        "legs turned °",
        "others °",
        "bones mm",
        "root mm",
        "s per s",
    )
    methods = dict.fromkeys(row.method for row in rows)
    made_rows = []
    for method in methods:
        own = [row for row in rows if row.method == method]
        slides = [row.slide for row in own]
        # Who stands throughout has no edges.
        jerks = [row.jerk for row in own if np.isfinite(row.jerk)] or [float("nan")]
        made_rows.append(
            (
                method,
                number(float(np.mean(slides)), 4),
                number(max(slides), 4),
                number(max(row.worst_step for row in own), 2),
                number(max(row.gap for row in own), 2),
                number(float(np.mean(jerks)), 2),
                number(max(jerks), 2),
                ", ".join(row.take for row in own if _jerks(row)) or "–",
                number(float(np.mean([row.turned for row in own])), 2),
                number(float(np.mean([row.others for row in own])), 2),
                number(max(row.bones for row in own), 4),
                number(max(row.moved for row in own), 0),
                number(sum(row.seconds for row in own) / sum(row.duration for row in own), 2),
            )
        )
    takes, count = len(rows) // len(methods), sum(row.contacts for row in rows) // len(methods)
    note = (
        f"{takes} takes, {count} contacts as detected; slide in contact a frame at 120 fps; edge"
        " jerk against the take's own 99th percentile, and takes where it rises above"
        f" {_MOST_JERK} and what it was"
    )
    return Table(f"Foot skate, {folder}", head, tuple(made_rows), note)


def _jerks(row: SlideRow) -> bool:
    """Whether edges jerk more than they may: 1.2 times the take's own, or as much as before."""
    return row.jerk > max(_MOST_JERK, _NO_MORE * row.jerk_before)


def _to_json(one: ContactScores) -> dict[str, Any]:
    return {
        "name": one.name,
        "f1": one.tolerant.f1,
        "recall": one.tolerant.recall,
        "precision": one.tolerant.precision,
        "strict_f1": one.strict.f1,
        "points": {point: tally.f1 for point, tally in one.points.items()},
        "worst": {"take": one.worst[1], "f1": one.worst[0]},
    }


def _report(record: dict[str, Any], tables: Sequence[Table]) -> Report:
    lead = f"takes marked by eye, and takes of {MADE_SECONDS:.0f} s made with planted feet"
    body = [page.table_html(table) for table in tables]
    html = page.page("mocapstudio: contacts", lead, body, "mocapstudio evaluate contacts")
    return Report(_plain(record), tuple(tables), html)


def _plain(value: Any) -> Any:
    """Leave NaN out: JSON has none."""
    if isinstance(value, dict):
        return {key: _plain(one) for key, one in value.items()}
    if isinstance(value, list):
        return [_plain(one) for one in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value
