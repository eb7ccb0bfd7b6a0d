"""Slide and gap of contacts, before and after the solve."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.model import Contact
from mocapstudio.cleaning.ik.targets import Hold
from mocapstudio.gui.contacts.lanes import Key, key_of
from mocapstudio.gui.contacts.reading import Reading

Array = NDArray[np.float64]

CENTI, MILLI = 100.0, 1000.0


@dataclass(frozen=True, eq=False)
class Measured:
    """Curves over a take's F frames, NaN where nothing is in contact.

    Parameters
    ----------
    slide
        (F,) cm/s: how fast points in contact move against their targets, mean over the contacts.
    gap
        (F,) mm: how far they are from their targets, the largest of the contacts.
    mean_slide
        cm/s over all steps.
    worst_gap
        mm.
    """

    slide: Array
    gap: Array
    mean_slide: float
    worst_gap: float


def measured(reading: Reading, contacts: Iterable[Contact], *, after: bool) -> Measured:
    """Measure contacts before the solve, or after it."""
    frames, rate = reading.source.frames, float(reading.source.rate)
    total, count = np.zeros(frames), np.zeros(frames)
    gap = np.full(frames, np.nan)
    for contact in contacts:
        hold = reading.hold_after(contact) if after else reading.hold(contact)
        if hold is None:
            continue
        place = reading.place(contact, after=after)
        speed, away = _speed(hold, place, rate), MILLI * hold.gap(place)
        total[contact.start : contact.end - 1] += speed
        count[contact.start : contact.end - 1] += 1
        span = slice(contact.start, contact.end)
        gap[span] = np.fmax(gap[span], away)
    slide = np.divide(total, count, out=np.full(frames, np.nan), where=count > 0)
    mean = float(total.sum() / count.sum()) if count.any() else 0.0
    worst = float(np.nanmax(gap)) if np.isfinite(gap).any() else 0.0
    return Measured(slide, gap, mean, worst)


def lane_slides(reading: Reading, contacts: Iterable[Contact]) -> dict[Key, str]:
    """Mean slide of each lane in words: cm/s before, and after where there is a solve."""
    lanes: dict[Key, list[Contact]] = {}
    for one in contacts:
        if one.id:
            lanes.setdefault(key_of(one), []).append(one)
    found = {}
    for key, own in lanes.items():
        before = measured(reading, own, after=False).mean_slide
        found[key] = f"{before:.1f}"
        if reading.solved:
            after = measured(reading, own, after=True).mean_slide
            found[key] = f"{before:.{int(before < 10)}f} → {after:.{int(after < 100)}f}"
    return found


def _speed(hold: Hold, place: Array, rate: float) -> Array:
    return CENTI * rate * hold.steps(place)
