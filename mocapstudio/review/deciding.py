"""Intents that decide: each is one undoable step."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from mocapstudio.cleaning.model import Flag, Proposal
from mocapstudio.motion.errors import MocapError
from mocapstudio.review import decisions, protection
from mocapstudio.review.core import new_id
from mocapstudio.review.keeping import Keeping
from mocapstudio.review.model import Edit, Protected, QueueItem, Verdict
from mocapstudio.review.replay import replay
from mocapstudio.review.rows import check_rows, check_span


class Deciding(Keeping):
    """Verdicts, edits, protected spans and trims of the active performer."""

    def accept(self, flag_ids: str | Iterable[str]) -> None:
        """Accept flags with their proposals: decisions and edits, one undo step together.

        An accepted flag whose proposal is another by now gets that in place of its edit.

        Raises
        ------
        MocapError
            If a proposal reaches into a protected span, or there is none.
        """
        items, edits = [], []
        stamp = self._stamp()
        for item in self._items(flag_ids):
            edit = self._edit_for(item, stamp)
            if edit is not None:
                items.append(item)
                edits.append(edit)
        self._decide(_labelled("Accept", items), items, Verdict.ACCEPTED, stamp, edits)

    def reject(self, flag_ids: str | Iterable[str]) -> None:
        """Reject flags: the motion is right as it is; an accepted one loses its edit."""
        self._judge("Reject", flag_ids, Verdict.REJECTED)

    def defer(self, flag_ids: str | Iterable[str]) -> None:
        """Leave flags for later, at the end of the queue; an accepted one loses its edit."""
        self._judge("Defer", flag_ids, Verdict.DEFERRED)

    def reopen(self, flag_ids: str | Iterable[str]) -> None:
        """Take back what was decided about flags."""
        self._judge("Reopen", flag_ids, Verdict.OPEN)

    def reject_like(self, flag_id: str, band: float = 0.1) -> int:
        """Reject a flag and the open ones like it; returns how many.

        Parameters
        ----------
        band
            How far the scores of flags of the same row and kind may lie apart.
        """
        item = self._item(flag_id)
        items = decisions.alike(item, self._state.queue, band)
        label = f"Reject {len(items)} like {item.flag.joint}"
        if len(items) == 1:
            label = _labelled("Reject", items)
        self._decide(label, items, Verdict.REJECTED, self._stamp(), ())
        return len(items)

    def add_edit(self, proposal: Proposal, label: str = "Edit") -> str:
        """Put samples over the active take without a flag; returns the edit's id."""
        performer, stamp = self._state.active, self._stamp()
        take = self._take(performer)
        edit = decisions.edit_of(take, performer, proposal, stamp, new_id(), None)
        sitting = self._history.present
        self._commit(label, replace(sitting, edits=(*sitting.edits, edit)))
        return edit.id

    def mute_edit(self, edit_id: str, muted: bool = True) -> None:
        """Switch an edit off, or on again."""
        edit = self._edit(edit_id)
        label = f"{'Mute' if muted else 'Unmute'} edit of {edit.rows[0]}"
        self._commit(label, decisions.with_edit_muted(self._history.present, edit_id, muted))

    def delete_edit(self, edit_id: str) -> None:
        """Delete an edit; the flag it was accepted for becomes open."""
        label = f"Delete edit of {self._edit(edit_id).rows[0]}"
        self._commit(label, decisions.without_edit(self._history.present, edit_id))

    def protect(self, joints: Iterable[str], start: int, end: int) -> None:
        """Let nothing change rows × [start, end) of the active take; no rows means all."""
        performer, rows = self._span_of_active(joints, start, end)
        stamp, sitting = self._stamp(), self._history.present
        added = Protected(performer, rows, start, end, stamp.author, stamp.time)
        if any(
            replace(p, author=added.author, time=added.time) == added for p in sitting.protected
        ):
            return
        self._commit("Protect", replace(sitting, protected=(*sitting.protected, added)))

    def unprotect(self, joints: Iterable[str], start: int, end: int) -> None:
        """Take rows × [start, end) out of the protected spans; no rows means all."""
        performer, rows = self._span_of_active(joints, start, end)
        sitting, take = self._history.present, self._take(performer)
        left = protection.unprotected(take, sitting.protected, performer, rows, start, end)
        self._commit("Unprotect", replace(sitting, protected=left))

    def trim(self, start: int, end: int) -> None:
        """Let analysis, report and, if asked, export look at [start, end) of the active take."""
        performer = self._state.active
        take = self._take(performer)
        check_span(take, start, end)
        before = self._trim(performer) or (0, take.frames)
        if before != (start, end):
            sitting = self._history.present
            others = tuple(t for t in sitting.trims if t[0] != performer)
            self._commit("Trim", replace(sitting, trims=(*others, (performer, (start, end)))))

    def _judge(self, word: str, flag_ids: str | Iterable[str], verdict: Verdict) -> None:
        items = [i for i in self._items(flag_ids) if i.verdict is not verdict]
        self._decide(_labelled(word, items), items, verdict, self._stamp(), ())

    def _decide(
        self,
        label: str,
        items: Sequence[QueueItem],
        verdict: Verdict,
        stamp: decisions.Stamp,
        edits: Sequence[Edit],
    ) -> None:
        if items:
            performer, queue, sitting = self._state.active, self._state.queue, self._history.present
            after = decisions.decide(sitting, performer, queue, items, verdict, stamp, edits)
            self._commit(label, after)

    def _edit_for(self, item: QueueItem, stamp: decisions.Stamp) -> Edit | None:
        """Make the edit that accepting would add; None where the flag has that very edit."""
        performer, flag = self._state.active, item.flag
        take = self._take(performer)
        proposal = self._state.proposals.get(flag.id)
        accepted = item.decision.edit if item.decision is not None else None
        if proposal is None:
            if accepted is not None:
                return None
            proposal = self._propose(performer, flag)
        if self._shared(performer, flag, proposal):
            proposal = self._onto_the_others(performer, flag) or proposal
        edit = decisions.edit_of(take, performer, proposal, stamp, new_id(), flag)
        if accepted is not None and decisions.same_samples(edit, self._edit(accepted)):
            return None
        return edit

    def _shared(self, performer: str, flag: Flag, proposal: Proposal) -> bool:
        """Tell whether another flag's repair already changes some of the same samples."""
        return any(
            set(edit.joints) & set(proposal.joints)
            and edit.start < proposal.end
            and proposal.start < edit.end
            for edit in self._history.present.edits
            if edit.performer == performer and edit.flag != flag.id and not edit.muted
        )

    def _onto_the_others(self, performer: str, flag: Flag) -> Proposal | None:
        """Make a proposal anew over what other flags' edits repair; None without an analysis."""
        from mocapstudio.cleaning.analysis import Analysis

        if not isinstance(self._analyses.latest.get(performer), Analysis):
            return None
        others = [
            edit
            for edit in self._history.present.edits
            if edit.performer == performer and edit.flag != flag.id
        ]
        repaired = replay(self._take(performer), others)
        return self._propose(performer, flag, replace(repaired, trim=self._trim(performer)))

    def _edit(self, edit_id: str) -> Edit:
        for edit in self._history.present.edits:
            if edit.id == edit_id:
                return edit
        raise MocapError(f"no edit {edit_id}")

    def _span_of_active(
        self, joints: Iterable[str], start: int, end: int
    ) -> tuple[str, frozenset[str]]:
        performer = self._state.active
        take = self._take(performer)
        rows = frozenset([joints] if isinstance(joints, str) else joints)
        check_rows(take, rows)
        check_span(take, start, end)
        return performer, rows


def _labelled(word: str, items: Sequence[QueueItem]) -> str:
    return f"{word} {items[0].flag.joint if len(items) == 1 else f'{len(items)} flags'}"
