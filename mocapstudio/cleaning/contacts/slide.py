"""Foot slide: how fast points move while they should rest."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.model import Contact, ContactPoint
from mocapstudio.cleaning.ik.slide import places
from mocapstudio.cleaning.ik.targets import Hold, holds
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ContactSlide:
    """Slide of one contact.

    Parameters
    ----------
    contact
        The contact.
    mean, worst
        Metres a second, over its frames; 0 for a contact of one frame.
    gap
        Metres: the largest distance between point and target.
    """

    contact: Contact
    mean: float
    worst: float
    gap: float


@dataclass(frozen=True, eq=False)
class TakeSlide:
    """Slide of a take.

    Parameters
    ----------
    contacts
        One entry a contact, in the order given.
    frames
        (F,) metres a second: mean over the points that are in contact in a frame and the next;
        NaN where there are none.
    mean
        Metres a second over all steps of all contacts; 0 where there are none.
    """

    contacts: tuple[ContactSlide, ...]
    frames: Array
    mean: float


def measure_slide(
    take: Take,
    contacts: Sequence[Contact],
    points: Sequence[ContactPoint],
    others: Mapping[str, Take] | None = None,
    laid: Sequence[Hold] | None = None,
) -> TakeSlide:
    """Measure how fast points in contact move against what they touch.

    Parameters
    ----------
    take
        F frames, before or after a clean-up.
    contacts, points
        What touches what, when; and the performer's contact points.
    others
        Takes of performers whose joints are followed, by id.
    laid
        The contacts as laid out over another version of the take, to measure the gaps of both
        against the same targets.

    Raises
    ------
    MocapError
        If a contact names an unknown joint, point or performer, or frames outside the take.
    """
    laid = holds(take, contacts, points, others or {}) if laid is None else laid
    rate = float(take.rate)
    total, count = np.zeros(take.frames), np.zeros(take.frames)
    found = []
    for hold, place in zip(laid, places(take, laid), strict=True):
        speed = hold.steps(place) * rate
        total[hold.contact.start : hold.contact.end - 1] += speed
        count[hold.contact.start : hold.contact.end - 1] += 1
        gap = float(hold.unmet(place).max())
        mean, worst = (float(f(speed)) if len(speed) else 0.0 for f in (np.mean, np.max))
        found.append(ContactSlide(hold.contact, mean, worst, gap))
    frames = np.divide(total, count, out=np.full(take.frames, np.nan), where=count > 0)
    mean = float(total.sum() / count.sum()) if count.any() else 0.0
    return TakeSlide(tuple(found), frames, mean)
