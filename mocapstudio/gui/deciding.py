"""The user's decisions: what they apply to, and which flag comes next."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Sequence
from typing import TYPE_CHECKING, Protocol

from PySide6.QtCore import QObject, Signal

from mocapstudio.cleaning.model import Flag, Proposal
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.messages import Messages
from mocapstudio.gui.worker import Worker
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.progress import Progress
from mocapstudio.review.model import Verdict

if TYPE_CHECKING:
    from mocapstudio.cleaning.analysis import Analysis
    from mocapstudio.cleaning.contacts.keeping import Kept

_AT_ONCE = 3
"""So many missing proposals are made while the user waits; more go into the background."""


class Order(Protocol):
    """The queue as the user sees it, filtered and sorted."""

    @property
    def selected(self) -> tuple[str, ...]:
        """Ids of the selected flags."""

    def beside(self, step: int) -> str | None:
        """Id of the flag `step` rows away."""

    def following(self, decided: Iterable[str]) -> str | None:
        """Id of the next open flag after those."""


class Deciding(Worker):
    """Turns commands into intents on the selected flags.

    Parameters
    ----------
    bridge
        The document's door.
    order
        The queue as shown.
    jobs
        Makes proposals for many flags at once.
    messages
        Is told what could not be done.
    parent
        Qt's parent.
    """

    edit_wanted = Signal(str)
    """Emitted with the id of a flag whose repair is to be shown."""

    def __init__(
        self,
        bridge: DocumentBridge,
        order: Order,
        jobs: Jobs,
        messages: Messages,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(bridge, jobs, messages, parent)
        self._order = order

    def go(self, step: int) -> None:
        """Go to the next flag, or the previous one."""
        flag = self._order.beside(step)
        if flag is not None:
            self._bridge.document.select_flag(flag)

    def accept(self) -> None:
        """Accept the selected flags."""
        ids = self._order.selected
        state, document = self._bridge.state, self._bridge.document
        chosen = [item for item in state.queue if item.flag.id in ids]
        missing = [
            item.flag
            for item in chosen
            if item.flag.id not in state.proposals and item.verdict is not Verdict.ACCEPTED
        ]
        analysis = state.analysis
        if len(missing) <= _AT_ONCE or analysis is None:
            self._decide(ids, lambda: document.accept(ids))
            return

        def done(proposals: Sequence[tuple[str, Proposal]]) -> None:
            if self._bridge.document is not document or document.state.analysis is not analysis:
                return
            for flag, proposal in proposals:
                document.set_proposal(flag, None, proposal)
            self._decide(ids, lambda: document.accept(ids))

        self._have_done(
            f"Preparing {len(missing)} repairs",
            _proposing(analysis, missing, document.kept(state.active)),
            done,
            "The flags could not be accepted",
            "accept",
        )

    def reject(self) -> None:
        """Reject the selected flags."""
        ids = self._order.selected
        self._decide(ids, lambda: self._bridge.document.reject(ids))

    def defer(self) -> None:
        """Leave the selected flags for later."""
        ids = self._order.selected
        self._decide(ids, lambda: self._bridge.document.defer(ids))

    def reopen(self) -> None:
        """Take the verdicts on the selected flags back."""
        ids = self._order.selected
        self._try("This could not be reopened", lambda: self._bridge.document.reopen(ids))

    def reject_like(self) -> None:
        """Reject the selected flag and the open ones like it."""
        flag = self._bridge.state.selection.flag
        if flag is None:
            return
        counts: list[int] = []
        document = self._bridge.document
        self._decide((flag,), lambda: counts.append(document.reject_like(flag)))
        if counts and counts[0] > 1:
            self._messages.tell(f"{counts[0]} flags rejected. Ctrl+Z takes that back.")

    def protect(self) -> None:
        """Protect the selected joints in the selected span."""
        selection, document = self._bridge.state.selection, self._bridge.document
        span = selection.span
        if span is not None:
            doing = "This could not be protected"
            if self._try(doing, lambda: document.protect(selection.joints, *span)):
                self._messages.tell("Nothing will change there. Shift+U lifts the protection.")

    def unprotect(self) -> None:
        """Lift the protection of the selected joints in the selected span, or everywhere."""
        state, document = self._bridge.state, self._bridge.document
        take = state.take
        if take is not None:
            span = state.selection.span or (0, take.frames)
            doing = "The protection could not be lifted"
            self._try(doing, lambda: document.unprotect(state.selection.joints, *span))

    def edit(self) -> None:
        """Show the repair of the selected flag in the list of edits."""
        item = self._bridge.state.selected
        if item is not None:
            decided = item.flag if item.decision is None else item.decision.flag
            self.edit_wanted.emit(decided.id)

    def trim(self, *, start: bool) -> None:
        """Let the take begin, or end, with the current frame."""
        state, document = self._bridge.state, self._bridge.document
        take = state.take
        if take is None:
            return
        first, end = dict(state.sitting.trims).get(state.active) or take.span
        if start:
            first, end = state.frame, end if state.frame < end else take.frames
        else:
            first, end = first if first <= state.frame else 0, state.frame + 1
        self._try("The take could not be trimmed", lambda: document.trim(first, end))

    def clear_trim(self) -> None:
        """Look at the whole take again."""
        take, document = self._bridge.state.take, self._bridge.document
        if take is not None:
            self._try("The trim could not be cleared", lambda: document.trim(0, take.frames))

    def _decide(self, ids: Sequence[str], intent: Callable[[], object]) -> None:
        if not ids:
            return
        following = self._order.following(ids)
        if not self._try("This could not be decided", intent):
            return
        if following is not None and self._bridge.state.item(following) is not None:
            self._bridge.document.select_flag(following)
        elif following is None:
            self._messages.tell("No open flag is left in the queue. Ctrl+E exports the clean take.")

    def _try(self, doing: str, intent: Callable[[], object]) -> bool:
        try:
            intent()
        except MocapError as error:
            self._messages.complain(error, doing)
            return False
        return True


def _proposing(
    analysis: Analysis, flags: Sequence[Flag], kept: Kept
) -> Generator[Progress, None, list[tuple[str, Proposal]]]:
    from mocapstudio.cleaning.contacts.keeping import propose_keeping

    made = []
    for done, flag in enumerate(flags):
        yield Progress(done / len(flags), f"repair of {flag.joint}")
        made.append((flag.id, propose_keeping(analysis, flag, kept=kept)))
    return made
