"""Repair that knows of contacts: the neighbour whose end effector comes closest (paper 1, 4).

Where a flagged joint carries a hand or foot that touches something, the motion to take is not that
of the neighbours' medoid but that which brings the end effector nearest to the contact; inverse
kinematics then has the least to bend.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.contacts.model import Contact, ContactPoint
from mocapstudio.cleaning.ik.slide import places
from mocapstudio.cleaning.ik.targets import Hold, holds
from mocapstudio.cleaning.model import Flag
from mocapstudio.cleaning.proposals import apply, propose
from mocapstudio.cleaning.reasons import neighbours
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.motion.take import Take


def donor_for_contacts(
    analysis: Analysis,
    flag: Flag,
    contacts: Sequence[Contact],
    points: Sequence[ContactPoint],
    others: Mapping[str, Take] | None = None,
    onto: Take | None = None,
) -> int | None:
    """Choose the donor of a flag's proposal by the contacts it has to meet.

    Parameters
    ----------
    analysis, flag, onto
        As for `proposals.propose`.
    contacts, points, others
        As for `ik.foot_skate.clean`.

    Returns
    -------
    int or None
        Which of `reasons.neighbours` comes closest, counted from 0. None, the engine's own choice,
        where the flag is a root row, moves no point in contact, or has no neighbours.

    Raises
    ------
    MocapError
        If a contact does not fit the take.
    """
    take = analysis.take if onto is None else onto
    if flag.joint in ROOT_ROWS:
        return None
    moved = set(take.skeleton.descendants(take.skeleton.index[flag.joint]))
    touched = [
        contact
        for contact in contacts
        if flag.overlaps(contact.start, contact.end)
        and take.skeleton.index.get(contact.joint) in moved
    ]
    count = len(neighbours(analysis, flag)) if touched else 0
    if not count:
        return None
    laid = holds(take, touched, points, others or {})
    gaps = [
        _gap(apply(take, propose(analysis, flag, choice, onto)), flag, laid)
        for choice in range(count)
    ]
    return int(np.argmin(gaps))


def _gap(repaired: Take, flag: Flag, laid: Sequence[Hold]) -> float:
    """Root mean square distance, metres, between points and targets inside the flag."""
    squares = []
    for hold, place in zip(laid, places(repaired, laid), strict=True):
        inside = (hold.frames >= flag.start) & (hold.frames < flag.end)
        squares.append(hold.gap(place)[inside] ** 2)
    return float(np.sqrt(np.concatenate(squares).mean()))
