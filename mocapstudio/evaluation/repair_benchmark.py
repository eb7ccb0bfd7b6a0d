"""Repair cases with known errors by every method and compare."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Generator, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.model import Flag, Kind, Proposal
from mocapstudio.cleaning.parameters import DetectionParameters
from mocapstudio.cleaning.proposals import apply, propose
from mocapstudio.cleaning.reasons import neighbours
from mocapstudio.cleaning.refined import detect_refined
from mocapstudio.cleaning.repair.donors import medoid
from mocapstudio.evaluation.cases import Case
from mocapstudio.evaluation.repair_metrics import (
    EventError,
    Looks,
    changed_outside,
    event_errors,
    looks,
)
from mocapstudio.evaluation.repair_peers import PEERS, Peer
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION, ROOT_ROWS
from mocapstudio.motion.progress import Progress, run
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

LONG_SECONDS = 0.5
"""Spans longer than this are told apart: half the error of the best peer is to be reached."""


@dataclass(frozen=True)
class Repaired:
    """A repaired take and what was declared to change."""

    take: Take
    declared: tuple[Declared, ...]


Repairer = Callable[[Case, Analysis], Repaired]
"""Repairs a case's dirty take, whose analysis against the case's context is given."""


@dataclass(frozen=True)
class RepairScores:
    """One row of the table.

    Parameters
    ----------
    name
        The method.
    events
        What is left of every error.
    looks
        One a case.
    seconds
        Time taken, without the analysis.
    still_flagged
        Flags that detection raises on the results, by case; empty where it was not asked.
    """

    name: str
    events: tuple[EventError, ...] = ()
    looks: tuple[Looks, ...] = ()
    seconds: float = 0.0
    still_flagged: tuple[int, ...] = field(default=())

    def of(self, chosen: Callable[[EventError], bool]) -> RepairScores:
        """Keep some of the events."""
        return replace(self, events=tuple(e for e in self.events if chosen(e)))

    def of_kind(self, kind: Kind) -> RepairScores:
        """Keep the events of one kind."""
        return self.of(lambda event: event.kind is kind)

    def kinds(self) -> tuple[Kind, ...]:
        """Kinds of error among the events."""
        return tuple(dict.fromkeys(e.kind for e in self.events))

    def mean(self, what: str) -> float:
        """Mean of a measure over erroneous frames, NaN left out; maxima over events."""
        values = np.array([getattr(e, what) for e in self.events])
        weights = np.array([1.0 if what.endswith("max") else e.frames for e in self.events])
        there = ~np.isnan(values) if len(values) else np.zeros(0, dtype=bool)
        return float(np.average(values[there], weights=weights[there])) if there.any() else math.nan

    def look(self, what: str) -> float:
        """Mean of a `Looks` measure over cases; the largest stretch, the sum of changed samples."""
        values = np.array([getattr(one, what) for one in self.looks], dtype=float)
        values = values[~np.isnan(values)]
        if not len(values):
            return math.nan
        if what == "stretch":
            return float(values.max())
        return float(values.sum() if what == "changed" else values.mean())

    def to_json(self) -> dict[str, Any]:
        """Plain objects for JSON."""
        measures = [
            "body_mean",
            "body_max",
            "joint_mean",
            "joint_max",
            "degrees_mean",
            "degrees_max",
            "centimetres",
        ]

        def block(scores: RepairScores) -> dict[str, Any]:
            return {"events": len(scores.events), **{m: scores.mean(m) for m in measures}}

        return {
            "name": self.name,
            "seconds": self.seconds,
            **block(self),
            "long": block(self.of(lambda e: e.seconds > LONG_SECONDS)),
            "kinds": {kind.value: block(self.of_kind(kind)) for kind in self.kinds()},
            **{w: self.look(w) for w in ("jerk", "slide", "stretch", "changed")},
            "still_flagged": sum(self.still_flagged) if self.still_flagged else None,
        }


def tuned_peers(training: Sequence[Case]) -> dict[str, Peer]:
    """Each peer with the settings of least squared error on the training cases."""
    best: dict[str, Peer] = {}
    for name, family in PEERS.items():
        members = family.members()
        best[name] = min(members.values(), key=lambda peer: _training_error(peer, training))
    return best


def _training_error(peer: Peer, training: Sequence[Case]) -> float:
    events = [
        event
        for case in training
        for event in event_errors(case, peer(case.dirty, case.context, true_spans(case)))
    ]
    scores = RepairScores("", tuple(events))
    # Over all joints: what smoothing does to joints that were right counts too.
    joint, place = scores.mean("body_mean"), scores.mean("centimetres")
    # One square centimetre of the root weighs as much as one square degree (half angle, rad).
    return float(np.nansum([joint, place**2 * (0.5 * np.radians(1.0)) ** 2]))


def true_spans(case: Case) -> list[Declared]:
    """Rows × spans of the truths."""
    return [Declared(row, t.start, t.end) for t in case.truths for row in t.joints]


def by_peer(peer: Peer) -> Repairer:
    """Repair the true spans by a peer."""

    def repairer(case: Case, _: Analysis) -> Repaired:
        spans = true_spans(case)
        return Repaired(peer(case.dirty, case.context, spans), tuple(spans))

    return repairer


def untouched(case: Case, _: Analysis) -> Repaired:
    """Leave the errors in: what there is to be gained."""
    return Repaired(case.dirty, ())


def perfect(case: Case, _: Analysis) -> Repaired:
    """Return the clean take: what jerk, foot slide and flags are in true motion."""
    return Repaired(case.clean, tuple(true_spans(case)))


def ours_given_truth(case: Case, analysis: Analysis) -> Repaired:
    """Accept the engine's proposals for flags that have exactly the true rows and spans."""
    told = _told(case, analysis)
    return _accepted(told, told.flags)


def medoid_given_truth(case: Case, analysis: Analysis) -> Repaired:
    """Accept the neighbours' medoid for every true row and span, as paper 1 does.

    The root rows, and spans without neighbours, are repaired as the engine does.
    """
    told = _told(case, analysis)

    def choice(flag: Flag) -> int | None:
        near = () if flag.joint in ROOT_ROWS else neighbours(told, flag)
        return near.index(medoid(told, near, (flag.joint,))) if near else None

    return _accepted(told, told.flags, choice)


def _told(case: Case, analysis: Analysis) -> Analysis:
    """Put flags with exactly the true rows and spans in the place of the engine's own.

    As the peers are, the engine is told of all that is wrong. The kind is that of a flag which the
    engine itself raised there, else an offset's: the true kind is not given away.
    """
    flags = []
    for truth in case.truths:
        for row in truth.joints:
            own = [
                f for f in analysis.flags if f.joint == row and f.overlaps(truth.start, truth.end)
            ]
            kind = own[0].kind if own else Kind.OFFSET
            middle = (truth.start + truth.end) // 2
            name = f"{row}@{truth.start}"
            flags.append(
                Flag(name, row, truth.joints, truth.start, truth.end, 1.0, middle, 1.0, kind)
            )
    return replace(analysis, flags=tuple(flags))


def ours_as_detected(_: Case, analysis: Analysis) -> Repaired:
    """Accept the engine's proposals for its own flags."""
    return _accepted(analysis, analysis.flags)


def _accepted(
    analysis: Analysis,
    flags: Iterable[Flag],
    choice: Callable[[Flag], int | None] = lambda _: None,
) -> Repaired:
    """Accept flag by flag, each upon the result of those before; the root after the joints."""
    declared: list[Declared] = []
    take = analysis.take
    hips = take.skeleton.names[topology(take.skeleton).hips]
    for flag in sorted(flags, key=lambda f: f.joint in ROOT_ROWS):
        proposal = propose(analysis, flag, choice(flag), onto=take)
        take = apply(take, proposal)
        declared += _declared(proposal, hips)
    outside = changed_outside(analysis.take, take, declared)
    assert outside == 0, f"{take.name}: {outside} samples changed outside what was declared"
    return Repaired(take, tuple(declared))


def _declared(proposal: Proposal, hips: str) -> list[Declared]:
    span = (proposal.start, proposal.end)
    rows = [ROOT_HEADING if name == hips else name for name in proposal.joints]
    if proposal.translations is not None:
        rows.append(ROOT_POSITION)
    return [Declared(row, *span) for row in rows]


def repairing(
    repairers: dict[str, Repairer],
    cases: Sequence[Case],
    *,
    again: bool = False,
    parameters: DetectionParameters | None = None,
) -> Generator[Progress, None, list[RepairScores]]:
    """Repair every case by every method.

    Parameters
    ----------
    repairers
        Methods by name.
    cases
        With errors.
    again
        Whether the results go through detection again.
    parameters
        Of detection.
    """
    parameters = parameters or DetectionParameters()
    rows = {name: RepairScores(name) for name in repairers}
    for i, case in enumerate(cases):
        yield Progress(i / len(cases), f"repairing {case.clean.name}")
        analysis = run(detect_refined(case.dirty, case.context, parameters))
        for name, repairer in repairers.items():
            started = time.perf_counter()
            result = repairer(case, analysis)
            row = rows[name]
            rows[name] = replace(
                row,
                seconds=row.seconds + time.perf_counter() - started,
                events=(*row.events, *event_errors(case, result.take)),
                looks=(*row.looks, looks(case, result.take, result.declared)),
            )
            if again:
                second = run(detect_refined(result.take, case.context, parameters))
                flags = (*rows[name].still_flagged, len(second.flags))
                rows[name] = replace(rows[name], still_flagged=flags)
    return list(rows.values())
