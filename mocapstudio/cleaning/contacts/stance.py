"""Contacts of one foot that stand together, and so go together."""

from __future__ import annotations

from collections.abc import Sequence

from mocapstudio.cleaning.contacts.anatomy import carried_by
from mocapstudio.cleaning.contacts.model import Contact
from mocapstudio.motion.skeleton import Skeleton


def standing_with(
    skeleton: Skeleton, contact: Contact, contacts: Sequence[Contact]
) -> tuple[Contact, ...]:
    """Return the other contacts of a contact's foot or hand that cannot stay where it goes.

    They overlap it in time, or overlap what overlaps it: heel, ball and toe of one step.

    Parameters
    ----------
    contact
        One of `contacts`, or a version of it: the one of its id is not among the answer.
    """
    carrier = carried_by(skeleton)

    def limb(one: Contact) -> int | None:
        joint = skeleton.index.get(one.joint)
        return None if joint is None else carrier.get(joint, joint)

    waiting = [one for one in contacts if one.id != contact.id and limb(one) == limb(contact)]
    found, asked = [], [contact]
    while asked:
        here = asked.pop()
        met = [one for one in waiting if one.start < here.end and here.start < one.end]
        waiting = [one for one in waiting if one not in met]
        found += met
        asked += met
    return tuple(sorted(found, key=lambda one: (one.start, one.joint, one.point or "")))
