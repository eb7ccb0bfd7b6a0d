"""The benchmark's tables, for the terminal and the page: heads, and rows of texts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from mocapstudio.evaluation.detection_benchmark import DetectionScores
from mocapstudio.evaluation.experiments import PAPER, REACH, Section
from mocapstudio.evaluation.repair_benchmark import LONG_SECONDS, RepairScores
from mocapstudio.evaluation.speed_benchmark import SpeedRow, growth


@dataclass(frozen=True)
class Table:
    """A table of texts; the first column names the row.

    Parameters
    ----------
    title, note
        Above it, and below it in small print.
    head
        Titles of the columns.
    rows
        As many texts each.
    """

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""


_DETECTION_HEAD = (
    "method",
    "recall",
    "precision",
    "word × joint F1",
    "events found",
    "flags right",
    "false/min",
    "edges",
    "seconds",
)


def detection_tables(sections: Sequence[Section]) -> list[Table]:
    """One table for each row of the paper's, one for what goes beyond, one by kind of error."""
    main = [s for s in sections if s.experiment.is_main]
    alone = [s for s in sections if s.experiment.is_of_one_kind]
    rest = [s for s in sections if s not in main and s not in alone]
    tables = [_main_table(section) for section in main]
    if rest:
        rows = tuple(_detection_row(s.experiment.title, row) for s in rest for row in s.rows)
        tables.append(Table("Further rows", ("takes", *_DETECTION_HEAD[1:]), rows))
    if alone:
        tables.append(_kind_table(alone))
    return tables


def _main_table(section: Section) -> Table:
    key = (section.experiment.corpus, section.experiment.context)
    rows = [_detection_row(row.name, row) for row in section.rows]
    blank = ("",) * (len(_DETECTION_HEAD) - 3)
    for name, figures in (("paper 1", PAPER), ("to reach", REACH)):
        if key in figures:
            recall, precision = figures[key]
            rows.append((name, number(recall), number(precision), *blank))
    note = f"{len(section.takes)} takes, {section.errors} errors; recall and precision of words"
    return Table(section.experiment.title, _DETECTION_HEAD, tuple(rows), note)


def _detection_row(name: str, row: DetectionScores) -> tuple[str, ...]:
    s = row.scores
    return (
        name,
        number(s.words.recall),
        number(s.words.precision),
        number(s.word_joints.f1),
        f"{s.events.events_found} of {s.events.events}",
        number(s.flag_precision),
        number(s.false_flags_a_minute, 1),
        number(s.edge, 1),
        number(row.seconds, 1),
    )


def _kind_table(sections: Sequence[Section]) -> Table:
    rows = []
    for section in sections:
        for row in section.rows:
            events = row.scores.events
            rows.append(
                (
                    section.experiment.title,
                    number(events.frame_recall),
                    f"{events.events_found} of {events.events}",
                    number(row.scores.word_joints.f1),
                    number(row.scores.edge, 1),
                )
            )
    head = ("error", "frames found", "events found", "word × joint F1", "edges")
    return Table("Every kind by itself", head, tuple(rows))


def repair_tables(title: str, rows: Sequence[RepairScores]) -> list[Table]:
    """Table of all errors, of long ones, and by kind."""
    head = (
        "method",
        "Σ body",
        "max",
        "per joint",
        "max",
        "degrees",
        "max",
        "root cm",
        "jerk m/s³",
        "slide m/s",
        "stretch mm",
        "outside",
        "flags left",
        "seconds",
    )
    table = Table(
        title,
        head,
        tuple(_repair_row(row) for row in rows),
        "squared sums of half angles, rad², over erroneous frames; 'outside': samples changed"
        " outside what was declared; paper 1: ours 0.85 over the body and 0.21 per joint",
    )
    kinds = tuple(dict.fromkeys(kind for row in rows for kind in row.kinds()))
    by_kind = Table(
        f"{title}: degrees left on erroneous joints (root place: cm), by kind",
        ("method", *(kind.value for kind in kinds), f"over {LONG_SECONDS:g} s"),
        tuple(
            (
                row.name,
                *(_left(row.of_kind(kind)) for kind in kinds),
                number(row.of(lambda e: e.seconds > LONG_SECONDS).mean("degrees_mean"), 1),
            )
            for row in rows
        ),
    )
    return [table, by_kind]


def _left(row: RepairScores) -> str:
    degrees = row.mean("degrees_mean")
    if math.isnan(degrees):
        return number(row.mean("centimetres"), 1)
    return number(degrees, 1)


def _repair_row(row: RepairScores) -> tuple[str, ...]:
    return (
        row.name,
        *(number(row.mean(m)) for m in ("body_mean", "body_max", "joint_mean", "joint_max")),
        *(number(row.mean(m), 1) for m in ("degrees_mean", "degrees_max", "centimetres")),
        number(row.look("jerk"), 0),
        number(row.look("slide")),
        number(row.look("stretch"), 1),
        number(row.look("changed"), 0),
        str(sum(row.still_flagged)) if row.still_flagged else "",
        number(row.seconds, 2),
    )


def speed_table(rows: Sequence[SpeedRow]) -> Table:
    """Milliseconds beside those to be reached."""
    head = ("what", "ms", "processor ms", "to reach", "paper")
    lines = tuple(
        (row.name, *(number(1000.0 * x, 1) for x in (row.seconds, row.cpu, row.reach, row.paper)))
        for row in rows
    )
    grows = ", ".join(f"{series}: {power:.2f}" for series, power in growth(rows).items())
    note = f"milliseconds, warm, best of some runs; power with which cost grows by length, {grows}"
    return Table("Speed", head, lines, note)


def number(value: float, digits: int = 3) -> str:
    """Write a number, nothing for NaN."""
    return "" if math.isnan(value) else f"{value:.{digits}f}"
