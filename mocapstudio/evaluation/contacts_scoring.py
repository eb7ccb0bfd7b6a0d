"""How well contacts are found: frames in contact, found and missed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from mocapstudio.cleaning.contacts.model import Contact
from mocapstudio.evaluation.contacts_cases import ContactCase, Mask
from mocapstudio.motion.take import Take

TOLERANCE = 1 / 30
"""Seconds around a true edge that are not scored: an edge is not told better by eye."""

Detector = Callable[[Take], Sequence[Contact]]


@dataclass(frozen=True)
class Tally:
    """Seconds of contact found rightly, found wrongly, and missed."""

    hit: float = 0.0
    false: float = 0.0
    missed: float = 0.0

    def __add__(self, other: Tally) -> Tally:
        return Tally(self.hit + other.hit, self.false + other.false, self.missed + other.missed)

    @property
    def recall(self) -> float:
        """Share of contact that was found; NaN where there is none."""
        return _share(self.hit, self.hit + self.missed)

    @property
    def precision(self) -> float:
        """Share of what was found that is contact; NaN where nothing was found."""
        return _share(self.hit, self.hit + self.false)

    @property
    def f1(self) -> float:
        """Harmonic mean of recall and precision."""
        return _share(2 * self.hit, 2 * self.hit + self.false + self.missed)


@dataclass(frozen=True)
class ContactScores:
    """Scores of a detector.

    Parameters
    ----------
    name
        The detector.
    tolerant
        Without what lies within `TOLERANCE` of a true edge.
    strict
        Every frame.
    points
        Tolerant, by kind of point.
    worst
        Lowest tolerant F1 of a take, and that take's name.
    """

    name: str
    tolerant: Tally = field(default_factory=Tally)
    strict: Tally = field(default_factory=Tally)
    points: dict[str, Tally] = field(default_factory=dict)
    worst: tuple[float, str] = (1.0, "")


def score_contacts(name: str, detector: Detector, cases: Sequence[ContactCase]) -> ContactScores:
    """Run a detector over cases and add its scores up."""
    tolerant, strict, worst = Tally(), Tally(), (1.0, "")
    points: dict[str, Tally] = {}
    for case in cases:
        found = detector(case.take)
        rate = float(case.take.rate)
        own = Tally()
        for key, truth in case.truth.items():
            claimed = np.zeros(len(truth), dtype=bool)
            for contact in found:
                if (contact.joint, contact.point) == key:
                    claimed[contact.start : contact.end] = True
            sure = case.sure[key]
            clear = tolerated(truth, sure, rate)
            strict += tally(claimed, truth, sure, rate)
            one = tally(claimed, truth, clear, rate)
            own += one
            points[key[1] or ""] = points.get(key[1] or "", Tally()) + one
        tolerant += own
        worst = min(worst, (own.f1, case.take.name))
    return ContactScores(name, tolerant, strict, points, worst)


def tally(claimed: Mask, truth: Mask, where: Mask, rate: float) -> Tally:
    """Compare what was found with the truth, (F,) each, in the frames `where`; `rate` in Hz."""
    hit, false, missed = (
        float(np.sum(a & b & where)) / rate
        for a, b in ((claimed, truth), (claimed, ~truth), (~claimed, truth))
    )
    return Tally(hit, false, missed)


def tolerated(truth: Mask, sure: Mask, rate: float) -> Mask:
    """(F,) frames that are sure, and farther than `TOLERANCE` from a true edge."""
    return sure & ~_near_edges(truth, max(1, round(TOLERANCE * rate)))


def _near_edges(truth: Mask, reach: int) -> Mask:
    near = np.zeros(len(truth), dtype=bool)
    for edge in np.flatnonzero(np.diff(truth)) + 1:
        near[max(0, edge - reach) : edge + reach] = True
    return near


def _share(part: float, whole: float) -> float:
    return part / whole if whole > 0 else float("nan")
