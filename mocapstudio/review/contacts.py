"""Intents about contacts: each is one undoable step."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from mocapstudio.cleaning.contacts.changes import METHOD
from mocapstudio.cleaning.contacts.model import Contact, ContactPoint, Target
from mocapstudio.cleaning.model import Proposal
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.take import Take
from mocapstudio.review import decisions
from mocapstudio.review.core import Core, new_id
from mocapstudio.review.model import Edit, OwnContact, OwnPoints
from mocapstudio.review.rows import check_rows, check_span

KEY_POSE = "key pose"
"""Method of edits that were dragged in the viewport."""


class Contacting(Core):
    """Contacts, their points, and the edits that meet them."""

    def contacts(self, performer: str) -> tuple[Contact, ...]:
        """Contacts of a performer, by their start."""
        own = self._history.present.contacts
        found = (one.contact for one in own if one.performer == performer)
        return tuple(sorted(found, key=lambda c: (c.start, c.joint, c.point or "")))

    def contact_points(self, performer: str) -> tuple[ContactPoint, ...] | None:
        """Contact points of a performer where they were adjusted; None where the take tells."""
        own = self._history.present.points
        return next((one.points for one in own if one.performer == performer), None)

    def uncorrected(self, performer: str) -> Take:
        """Return the take with all edits but those that meet contacts: what a solve starts from."""
        edits = (
            edit
            for edit in self._history.present.edits
            if edit.performer == performer and edit.method != METHOD
        )
        return self._uncorrected.of(performer, self._take(performer), edits, self._trim(performer))

    def add_contact(self, contact: Contact) -> str:
        """Add a contact of the active performer, drawn by hand; returns its id.

        Raises
        ------
        MocapError
            If joint or span do not fit the take.
        """
        drawn = replace(contact, id=new_id(), drawn=True, confidence=1.0)
        self._commit_contacts("Draw contact", gone=(), new=(drawn,))
        return drawn.id

    def change_contact(
        self, contact_id: str, label: str = "Change contact", **changes: Any
    ) -> None:
        """Change fields of a contact of the active performer; from then on it counts as drawn.

        Raises
        ------
        MocapError
            If there is no such contact, or it would no longer fit the take.
        """
        old = self._contact(contact_id)
        new = replace(old, **changes, drawn=True, confidence=1.0)
        if replace(new, drawn=old.drawn, confidence=old.confidence) != old:
            self._commit_contacts(label, gone=(old.id,), new=(new,))

    def split_contact(self, contact_id: str, frame: int) -> tuple[str, str]:
        """Cut a contact in two before `frame`; returns both ids.

        Raises
        ------
        MocapError
            If the frame does not lie within it.
        """
        old = self._contact(contact_id)
        if not old.start < frame < old.end:
            raise MocapError(f"frame {frame} does not lie inside the contact")
        first = replace(old, end=frame, drawn=True, confidence=1.0)
        second = replace(first, id=new_id(), start=frame, end=old.end)
        self._commit_contacts("Split contact", gone=(old.id,), new=(first, second))
        return first.id, second.id

    def merge_contacts(self, contact_ids: Iterable[str]) -> str:
        """Make one contact of several of one point, gaps included; returns its id.

        The longest of them gives its target.

        Raises
        ------
        MocapError
            If they are fewer than two, or of different points.
        """
        chosen = [self._contact(one) for one in dict.fromkeys(contact_ids)]
        keys = {(one.joint, one.point) for one in chosen}
        if len(chosen) < 2 or len(keys) != 1:
            raise MocapError("two or more contacts of the same point are merged")
        start, end = min(c.start for c in chosen), max(c.end for c in chosen)
        longest = max(chosen, key=lambda c: c.end - c.start)
        merged = replace(longest, start=start, end=end, drawn=True, confidence=1.0)
        between = {
            one.id
            for one in self.contacts(self._state.active)
            if (one.joint, one.point) in keys and one.start < end and start < one.end
        }
        gone = between | {one.id for one in chosen}
        self._commit_contacts(f"Merge {len(gone)} contacts", gone=gone, new=(merged,))
        return merged.id

    def delete_contacts(self, contact_ids: Iterable[str]) -> None:
        """Delete contacts of the active performer."""
        gone = {self._contact(one).id for one in contact_ids}
        if gone:
            label = "Delete contact" if len(gone) == 1 else f"Delete {len(gone)} contacts"
            self._commit_contacts(label, gone=gone, new=())

    def set_detected(self, performer: str, found: Sequence[Contact]) -> None:
        """Put detected contacts in the place of those detected before; drawn ones stay."""
        own = [one for one in self._history.present.contacts if one.performer == performer]
        drawn = [one.contact for one in own if one.contact.drawn]
        new = [
            one
            for one in found
            if not one.drawn and not any(_overlap(one, other) for other in drawn)
        ]
        taken = {one.id for one in drawn}
        new = [one if one.id not in taken else replace(one, id=new_id()) for one in new]
        gone = {one.contact.id for one in own if not one.contact.drawn}
        self._commit_contacts("Detect contacts", gone=gone, new=new, performer=performer)

    def load_contacts(self, contacts: Sequence[Contact], points: Sequence[ContactPoint]) -> None:
        """Put a file's contacts and points in the place of those of the active take."""
        performer = self._state.active
        take = self._take(performer)
        check_rows(take, {point.joint for point in points})
        own = {one.id for one in self.contacts(performer)}
        kept = tuple(p for p in self._history.present.points if p.performer != performer)
        named = (OwnPoints(performer, tuple(points)),) if points else ()
        self._commit_contacts("Load contacts", gone=own, new=contacts, points=(*kept, *named))

    def set_corrections(self, performer: str, proposals: Sequence[Proposal]) -> None:
        """Put what a solve changed in the place of what the one before it changed.

        Raises
        ------
        MocapError
            If it reaches into a protected span.
        """
        take, stamp, sitting = self._take(performer), self._stamp(), self._history.present
        kept = tuple(e for e in sitting.edits if e.performer != performer or e.method != METHOD)
        edits = tuple(
            decisions.edit_of(take, performer, one, stamp, new_id(), None) for one in proposals
        )
        self._commit("Solve contacts", replace(sitting, edits=(*kept, *edits)))

    def move_targets(self, targets: Mapping[str, Target], proposals: Sequence[Proposal]) -> None:
        """Give contacts of the active performer other targets, and the take what meets them.

        One step. Where the last solve, or an earlier move, said something else about the same
        samples, this counts.

        Parameters
        ----------
        targets
            By id of the contact.
        proposals
            What brings the body there; none where only the targets move.

        Raises
        ------
        MocapError
            If there is no such contact, or it reaches into a protected span.
        """
        performer, stamp, sitting = self._state.active, self._stamp(), self._history.present
        take = self._take(performer)
        new = [
            replace(self._contact(one), target=target, drawn=True, confidence=1.0)
            for one, target in targets.items()
        ]
        edits = tuple(
            decisions.edit_of(take, performer, one, stamp, new_id(), None) for one in proposals
        )
        kept = tuple(
            one
            for one in sitting.edits
            if one.performer != performer
            or one.method != METHOD
            or not any(_covers(edit, one) for edit in edits)
        )
        self._commit_contacts("Move target", gone=targets, new=new, edits=(*kept, *edits))

    def add_key_pose(self, proposals: Sequence[Proposal]) -> None:
        """Put what was dragged in the viewport over the active take."""
        performer, stamp, sitting = self._state.active, self._stamp(), self._history.present
        take = self._take(performer)
        edits = tuple(
            decisions.edit_of(take, performer, replace(one, method=KEY_POSE), stamp, new_id(), None)
            for one in proposals
        )
        self._commit("Key pose", replace(sitting, edits=(*sitting.edits, *edits)))

    def _contact(self, contact_id: str) -> Contact:
        for one in self.contacts(self._state.active):
            if one.id == contact_id:
                return one
        raise MocapError(f"no contact {contact_id}")

    def _commit_contacts(
        self,
        label: str,
        *,
        gone: Iterable[str],
        new: Iterable[Contact],
        performer: str | None = None,
        **changes: Any,
    ) -> None:
        performer = self._state.active if performer is None else performer
        take, lost = self._take(performer), frozenset(gone)
        added = tuple(OwnContact(performer, _whole(one)) for one in new)
        for one in added:
            check_rows(take, {one.contact.joint})
            check_span(take, one.contact.start, one.contact.end)
        sitting = self._history.present
        kept = tuple(
            one
            for one in sitting.contacts
            if one.performer != performer or one.contact.id not in lost
        )
        if added or changes or len(kept) != len(sitting.contacts):
            self._commit(label, replace(sitting, contacts=(*kept, *added), **changes))


def _overlap(one: Contact, other: Contact) -> bool:
    same = (one.joint, one.point) == (other.joint, other.point)
    return same and one.start < other.end and other.start < one.end


def _covers(edit: Edit, other: Edit) -> bool:
    """Tell whether an edit replaces every sample that another one of the same take replaces."""
    return (
        set(other.joints) <= set(edit.joints)
        and edit.start <= other.start
        and other.end <= edit.end
        and (other.translations is None or edit.translations is not None)
    )


def _whole(contact: Contact) -> Contact:
    """Bring frames that came from numpy to whole numbers of Python, as files hold them."""
    if isinstance(contact.start, np.integer) or isinstance(contact.end, np.integer):
        return replace(contact, start=int(contact.start), end=int(contact.end))
    return contact
