"""Tables and pictures of online alignment (paper 3, figures 2, 4 and 5)."""

from __future__ import annotations

import html
from collections.abc import Generator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from mocapstudio.comparison.weights_quality import SHARES
from mocapstudio.evaluation import page
from mocapstudio.evaluation.alignment_benchmark import (
    DIAGONAL,
    METHODS,
    MOTION,
    OFFLINE,
    OURS,
    PAPER_WEIGHTS,
    PATH_LENGTH,
    PLAIN,
    VARIANCE,
    ActionScores,
    mean_scores,
    scoring,
)
from mocapstudio.evaluation.alignment_cases import actions
from mocapstudio.evaluation.alignment_page import share_curves
from mocapstudio.evaluation.alignment_speed import online_speed
from mocapstudio.evaluation.alignment_warps import OnlineWarpRow, following_warps
from mocapstudio.evaluation.kata_benchmark import (
    kata_speed,
    kata_tables,
    recovered_warps,
    suggested_boundaries,
)
from mocapstudio.evaluation.kata_events import event_table, found_events
from mocapstudio.evaluation.reports import Report, without_nan
from mocapstudio.evaluation.speed_benchmark import SpeedRow
from mocapstudio.evaluation.tables import Table, number
from mocapstudio.motion.progress import Progress

FIGURES = {
    "figure 2: offline and open-end": (OFFLINE, PLAIN),
    "figure 4: what path-length weighting does": (PLAIN, PATH_LENGTH, DIAGONAL),
    "figure 5: what weights do": (PATH_LENGTH, VARIANCE, PAPER_WEIGHTS),
    "beyond the paper: motion counts too": (OFFLINE, PLAIN, MOTION, OURS),
}


class _Effort(NamedTuple):
    """How thoroughly qualities are measured."""

    references: int
    folds: int
    iterations: int


_FULL, _BRIEF = _Effort(3, 5, 300), _Effort(1, 3, 60)


def alignment(
    data: Sequence[Path],
    labels: Sequence[Path],
    seed: int,
    limit: int,
    *,
    events: Sequence[Path] = (),
    brief: bool = False,
) -> Generator[Progress, None, Report]:
    """Measure online alignment on labelled actions and on known warps, and the kata comparison.

    Parameters
    ----------
    data
        Takes or folders.
    labels
        Files of segments; without any, only known warps are measured.
    limit
        How many takes are performed again.
    events
        Files of segments of which every two performances, be they by different people, are
        compared.
    brief
        One reference an action, short training, no training speed.
    """
    effort = _BRIEF if brief else _FULL
    known = actions(data, labels) if labels else []
    scores: list[ActionScores] = []
    for action in known:
        scores += [(yield from scoring(action, *effort, seed))]
    followed = yield from following_warps(data, seed=seed, limit=min(limit, 2 if brief else 6))
    speed = yield from online_speed(long=not brief)
    recovered = yield from recovered_warps(data, seed=seed, limit=min(limit, 1 if brief else 3))
    boundaries = yield from suggested_boundaries(data, labels)
    met = yield from found_events(data, events)
    peers = [] if brief else (yield from kata_speed(seed=seed))
    if len(scores) > 1:
        scores.append(mean_scores(scores))
    tables = [*map(_quality_table, scores)]
    tables += [_goal_table(scores)] if scores else []
    tables += [_warp_table(followed)] if followed else []
    tables.append(_speed_table(speed))
    tables += kata_tables(recovered, peers, boundaries)
    tables += [event_table(met)] if met else []
    record: dict[str, Any] = {
        "quality": [one.to_json() for one in scores],
        "folds": effort.folds,
        "iterations": effort.iterations,
        "followed": [row.to_json() for row in followed],
        "speed": [row.to_json() for row in speed],
        "recovered": [row.to_json() for row in recovered],
        "boundaries": [row.to_json() for row in boundaries],
        "events": [row.to_json() for row in met],
        "peers": [row.to_json() for row in peers],
    }
    lead = f"seed {seed}; qualities of performances that the weights were not learnt from"
    body = [_figures_html(one) for one in reversed(scores)]
    body += [page.table_html(table) for table in tables]
    text = page.page("mocapstudio: alignment", lead, body, "mocapstudio evaluate")
    return Report(without_nan({"alignment": record}), tuple(tables), text)


def _quality_table(scores: ActionScores) -> Table:
    head = ("quality in % after", *(f"{100 * share:.0f} %" for share in SHARES), "mean")
    rows = tuple(
        (name, *(number(100 * x, 1) for x in curve), number(100 * float(curve.mean()), 1))
        for name, curve in ((name, scores.curves[name]) for name in METHODS)
    )
    note = (
        f"{scores.performances} performances, {scores.references} of them reference in turn;"
        " offline: the whole movement"
    )
    return Table(f"Alignment, {scores.action.replace('_', ' ')}", head, rows, note)


def _goal_table(scores: Sequence[ActionScores]) -> Table:
    head = ("action", "behind offline from 40 %", "least above plain", "mean above plain")
    rows = tuple(
        (
            one.action.replace("_", " "),
            number(100 * one.behind_offline, 1),
            number(100 * one.above_plain[0], 1),
            number(100 * one.above_plain[1], 1),
        )
        for one in scores
    )
    note = f"points of quality, {OURS}; to reach: at most 2, at least 0, above 0"
    return Table("Alignment, what is to be reached", head, rows, note)


def _warp_table(rows: Sequence[OnlineWarpRow]) -> Table:
    head = ("performance", "method", "takes", "median", "90 %", "within 0.5 s")
    lines = tuple(
        (
            row.disturbance,
            row.method,
            str(row.takes),
            number(row.median, 1),
            number(row.high, 1),
            number(100 * row.near, 1) + " %",
        )
        for row in rows
    )
    note = "distance from the true frame at each frame as it arrives, in frames at 25 Hz"
    return Table("Online alignment, known warps", head, lines, note)


def _speed_table(rows: Sequence[SpeedRow]) -> Table:
    head = ("what", "ms", "processor ms", "to reach", "paper")
    lines = tuple(
        (row.name, *(number(1000 * x, 3) for x in (row.seconds, row.cpu, row.reach, row.paper)))
        for row in rows
    )
    return Table("Online alignment, speed", head, lines, "median of 500 frames; training once")


def _figures_html(scores: ActionScores) -> str:
    title = html.escape(scores.action.replace("_", " ").capitalize())
    figures = "".join(
        share_curves(name, SHARES, {one: scores.curves[one] for one in methods}, METHODS)
        for name, methods in FIGURES.items()
    )
    return f'<h2>{title}</h2><div class="curves">{figures}</div>'
