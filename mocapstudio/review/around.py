"""Contacts around repairs: the parts of them that an accepted repair may have moved."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from mocapstudio.cleaning.contacts.model import Contact
from mocapstudio.motion.take import Take
from mocapstudio.review.model import Edit

ROOM = 0.3
"""Seconds before and after a repair in which contacts are held as well: there they stood well."""


def around_repairs(
    take: Take, contacts: Iterable[Contact], edits: Iterable[Edit]
) -> tuple[Contact, ...]:
    """Cut contacts to the frames around repairs that move their points.

    Parameters
    ----------
    take
        The performer's.
    contacts
        In any order.
    edits
        The performer's; only those in force that a flag was accepted with count.

    Returns
    -------
    tuple of Contact
        Pieces, by their start; those of one contact share its id.
    """
    room = round(ROOM * float(take.rate))
    repairs = [
        (one.start - room, one.end + room, _carried(take, one))
        for one in edits
        if one.flag is not None and not one.muted
    ]
    pieces = [
        replace(contact, start=start, end=end)
        for contact in contacts
        for start, end in _parts(
            contact,
            [(a, b) for a, b, joints in repairs if take.skeleton.index[contact.joint] in joints],
        )
    ]
    return tuple(sorted(pieces, key=lambda one: (one.start, one.joint, one.point or "")))


def _carried(take: Take, edit: Edit) -> frozenset[int]:
    """Joints that an edit turns or carries along."""
    skeleton = take.skeleton
    if edit.translations is not None:
        return frozenset(range(len(skeleton)))
    turned = (skeleton.index[name] for name in edit.joints)
    return frozenset(int(j) for one in turned for j in (one, *skeleton.descendants(one)))


def _parts(contact: Contact, spans: Sequence[tuple[int, int]]) -> list[tuple[int, int]]:
    """Parts of a contact inside spans, joined where they touch."""
    found: list[tuple[int, int]] = []
    for start, end in sorted(spans):
        low, high = max(start, contact.start), min(end, contact.end)
        if low >= high:
            continue
        if found and low <= found[-1][1]:
            found[-1] = found[-1][0], max(found[-1][1], high)
        else:
            found.append((low, high))
    return found
