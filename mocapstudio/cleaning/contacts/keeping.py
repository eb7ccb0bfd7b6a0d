"""Repairs that leave hands and feet where they were, or on what they touch (paper 1, section 4).

A repair near the trunk carries whole limbs away, and a repaired limb misses what it held. So of a
flag's neighbours the one is taken whose end effector comes closest to the contact (`aware`), limbs
that the repair carries along are bent back (`ik.keep_ends`), and points in contact are brought to
their targets.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.contacts.aware import donor_for_contacts
from mocapstudio.cleaning.contacts.model import ENDS_KEPT, ON_CONTACTS, Contact, ContactPoint
from mocapstudio.cleaning.ik import windows
from mocapstudio.cleaning.ik.agreement import agreed
from mocapstudio.cleaning.ik.apply import declared_changes, with_departures
from mocapstudio.cleaning.ik.foot_skate import SkateParameters
from mocapstudio.cleaning.ik.keep_ends import keep_ends
from mocapstudio.cleaning.ik.meet import bend
from mocapstudio.cleaning.ik.ranges import JointRanges, joint_ranges
from mocapstudio.cleaning.ik.slide import places
from mocapstudio.cleaning.ik.targets import Hold, holds
from mocapstudio.cleaning.model import Flag, Proposal
from mocapstudio.cleaning.proposals import apply, measured, propose
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.facing import ROOT_POSITION, carrier
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]

_CARRIED = 1e-4
"""Metres: a point in contact that a repair moves by less is left alone."""


@dataclass(frozen=True, eq=False)
class Kept:
    """What repairs of a take leave where it is.

    Parameters
    ----------
    ends
        Whether hands and feet of limbs that a repair only carries along stay where they were.
    contacts
        Points that stay on their targets.
    points
        The performer's contact points.
    others
        Takes of the performers that targets follow, by id, on this take's clock.
    """

    ends: bool = False
    contacts: tuple[Contact, ...] = ()
    points: tuple[ContactPoint, ...] = ()
    others: Mapping[str, Take] = field(default_factory=dict)

    @property
    def nothing(self) -> bool:
        """Whether a repair is free to move what it moves."""
        return not self.ends and not self.contacts


def propose_keeping(
    analysis: Analysis,
    flag: Flag,
    choice: int | None = None,
    onto: Take | None = None,
    *,
    kept: Kept,
) -> Proposal:
    """Make the replacement motion for a flag, bent so that it keeps what it should.

    Parameters
    ----------
    analysis, flag, choice, onto
        As for `proposals.propose`; without a choice the neighbour that comes closest to a contact
        that the flag moves.
    kept
        What stays.

    Returns
    -------
    Proposal
        Its joints and span are those of the repair and of what was bent; its method says so.

    Raises
    ------
    MocapError
        If there is no such neighbour, or a contact does not fit the take.
    """
    take = analysis.take if onto is None else onto
    if choice is None and kept.contacts:
        near = kept.contacts, kept.points, kept.others
        choice = donor_for_contacts(analysis, flag, *near, onto=onto)
    proposal = propose(analysis, flag, choice, onto)
    if kept.nothing:
        return proposal
    return keeping(take, proposal, kept)


def keeping(take: Take, proposal: Proposal, kept: Kept) -> Proposal:
    """Bend a proposal so that hands, feet and contacts stay.

    Parameters
    ----------
    take
        What the proposal is put over.

    Raises
    ------
    MocapError
        If a contact does not fit the take.
    """
    now, ranges = apply(take, proposal), joint_ranges([take])
    further: list[Declared] = []
    method = [proposal.method]
    if kept.ends:
        stayed = keep_ends(take, now, ranges)
        if stayed.declared:
            now, further = stayed.take, [*stayed.declared]
            method.append(ENDS_KEPT)
    bent, declared = _on_contacts(take, now, (proposal.start, proposal.end), kept, ranges)
    if declared:
        now, further = bent, [*further, *declared]
        method.append(ON_CONTACTS)
    if not further:
        return proposal
    merged = _merged(now, proposal, further)
    merged = replace(merged, method=", ".join(method), donor=proposal.donor)
    return measured(take, merged, own=proposal.joints)


def _on_contacts(
    take: Take, now: Take, span: tuple[int, int], kept: Kept, ranges: JointRanges
) -> tuple[Take, tuple[Declared, ...]]:
    """Bring points in contact that a repair moved inside `span` to their targets there."""
    inside = [c for c in kept.contacts if c.start < span[1] and span[0] < c.end]
    if not inside:
        return now, ()
    # Where floors are stood on, the frames beside the repair decide as well.
    laid = agreed(now, holds(now, inside, kept.points, kept.others))
    was = places(take, laid)
    touched = [
        _within(hold, *span)
        for hold, before in zip(laid, was, strict=True)
        if np.linalg.norm(hold.place - before, axis=1).max() > _CARRIED
    ]
    if not touched:
        return now, ()
    easing = SkateParameters().easing
    departures = [
        bend(now, [h for h in touched if low <= h.contact.start < high], (low, high), ranges)
        for low, high in windows.cut(now, touched, easing)
    ]
    return with_departures(now, departures), declared_changes(now, departures)


def _within(hold: Hold, start: int, end: int) -> Hold:
    """Cut a hold to the frames [start, end)."""
    contact = hold.contact
    low, high = max(start, contact.start), min(end, contact.end)
    part = slice(low - contact.start, high - contact.start)
    each = hold.projection.ndim == 3
    return replace(
        hold,
        contact=replace(contact, start=low, end=high),
        place=hold.place[part],
        target=hold.target[part],
        projection=hold.projection[part] if each else hold.projection,
    )


def _merged(now: Take, proposal: Proposal, further: Sequence[Declared]) -> Proposal:
    """Make one proposal of a repair and of what was bent for it."""
    start = min(proposal.start, *(one.start for one in further))
    end = max(proposal.end, *(one.end for one in further))
    rows = {one.row for one in further} - set(proposal.joints)
    moves = proposal.translations is not None or ROOT_POSITION in rows
    bent = (name for name in now.skeleton.names if name in rows)
    joints = (*proposal.joints, *bent)
    columns = [now.skeleton.index[name] for name in joints]
    return Proposal(
        joints,
        start,
        end,
        now.rotations[start:end, columns].copy(),
        now.translations[start:end, carrier(now)].copy() if moves else None,
        proposal.method,
    )
