"""Run detectors over cases and score them."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from mocapstudio.cleaning.model import Flag
from mocapstudio.evaluation.cases import Case
from mocapstudio.evaluation.scoring import Counts, Scores, score
from mocapstudio.motion.progress import Progress, run
from mocapstudio.motion.take import Take


@dataclass(frozen=True)
class Detection:
    """Flags of one take, and what other thresholds would have flagged.

    Parameters
    ----------
    flags
        At the detector's own threshold.
    sweep
        Flags by threshold, for the precision–recall curve.
    """

    flags: Sequence[Flag]
    sweep: Mapping[float, Sequence[Flag]] = field(default_factory=dict)


Detector = Callable[[Take, Sequence[Take]], Sequence[Flag] | Detection]
"""Finds what is wrong in a take, given the takes of its context."""


@dataclass(frozen=True)
class DetectionScores:
    """One row of the table.

    Parameters
    ----------
    name
        What was measured.
    scores
        All cases added up.
    cases
        Number of cases.
    seconds
        Time the detector took for all of them.
    """

    name: str
    scores: Scores
    cases: int
    seconds: float

    def to_json(self) -> dict[str, Any]:
        """Plain objects for JSON."""
        s = self.scores
        return {
            "name": self.name,
            "cases": self.cases,
            "minutes": s.minutes,
            "seconds": self.seconds,
            "word": _counts(s.words),
            "word_joint": _counts(s.word_joints),
            "events": s.events.events,
            "event_recall": s.events.event_recall,
            "flag_precision": s.flag_precision,
            "false_flags_a_minute": s.false_flags_a_minute,
            "edge_frames": s.edge,
            "kinds": {
                kind.value: {
                    "events": one.events,
                    "event_recall": one.event_recall,
                    "frame_recall": one.frame_recall,
                }
                for kind, one in s.kinds.items()
            },
            "curve": [
                {"threshold": t, "word": _counts(words), "word_joint": _counts(cells)}
                for t, (words, cells) in sorted(s.curve.items())
            ],
        }


def evaluate_detector(detector: Detector, cases: Sequence[Case], name: str = "") -> DetectionScores:
    """Run a detector over cases and add its scores up."""
    return run(evaluating(detector, cases, name))


def evaluating(
    detector: Detector, cases: Sequence[Case], name: str = ""
) -> Generator[Progress, None, DetectionScores]:
    """Do what `evaluate_detector` does, yielding progress after each case."""
    total, seconds = Scores(), 0.0
    for i, case in enumerate(cases):
        yield Progress(i / len(cases), f"{name}: {case.clean.name}")
        started = time.perf_counter()
        found = detector(case.dirty, case.context)
        seconds += time.perf_counter() - started
        detection = found if isinstance(found, Detection) else Detection(found)
        total = total + score(
            detection.flags,
            case.mask(),
            case.truths,
            case.rows,
            float(case.clean.rate),
            ignore=case.ignore,
            sweep=detection.sweep or None,
        )
    return DetectionScores(name, total, len(cases), seconds)


def _counts(counts: Counts) -> dict[str, float | int | None]:
    return {
        "hits": counts.hits,
        "false": counts.false,
        "missed": counts.missed,
        "recall": counts.recall,
        "precision": counts.precision,
        "f1": counts.f1,
    }
