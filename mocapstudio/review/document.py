"""The document of a sitting: the one place where its state changes."""

from __future__ import annotations

import getpass
import uuid
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from mocapstudio.cleaning.model import Flag, Proposal
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError, ParameterError
from mocapstudio.motion.take import Take
from mocapstudio.review import decisions, protection, replay, walk
from mocapstudio.review.analyses import Analyses
from mocapstudio.review.announcer import Announcer
from mocapstudio.review.history import History, same
from mocapstudio.review.model import (
    Edit,
    Performer,
    Protected,
    QueueItem,
    Scene,
    Selection,
    Sitting,
    Verdict,
)
from mocapstudio.review.queue import merge
from mocapstudio.review.rows import check_rows, check_span, rows_of, union
from mocapstudio.review.state import DocumentState, SessionProblem, differing

if TYPE_CHECKING:
    from mocapstudio.cleaning.analysis import Analysis

__all__ = ["Document", "DocumentState", "Recorder", "SessionProblem"]


class Recorder(Protocol):
    """Is told of everything that a crash must not cost; see `review.journal`."""

    def opened(self, performer: Performer) -> None:
        """A take was opened."""

    def closed(self, performer: str) -> None:
        """A performer was closed, and all about it forgotten."""

    def stepped(self, label: str, before: Sitting, after: Sitting) -> None:
        """A step was done."""

    def undone(self) -> None:
        """The last step was undone."""

    def redone(self) -> None:
        """The last undone step was done again."""

    def settled(self, state: DocumentState) -> None:
        """Context, threshold, mode or the active performer changed."""


class Document:
    """State of a sitting, the intents that change it, and the listeners that are told.

    Intents act on the active performer unless they name one. An intent that cannot be done raises
    `MocapError` and changes nothing. Listeners hear once of each intent that changed the state.

    Parameters
    ----------
    author
        Who decides; by default the name of the user who is logged in.
    clock
        Returns the present time, for tests.
    """

    def __init__(
        self, author: str | None = None, clock: Callable[[], datetime] | None = None
    ) -> None:
        self.author = _user() if author is None else author
        self._clock = clock or (lambda: datetime.now(UTC))
        self._announcer: Announcer[DocumentState] = Announcer()
        self._state = DocumentState()
        self._history = History()
        self._group: tuple[str, str, History] | None = None
        self._analyses = Analyses()
        self._results = replay.Results()
        self._context: tuple[Take, ...] = ()
        self._queue_of: tuple[str, object, object, tuple[QueueItem, ...]] = ("", (), (), ())
        self._saved: tuple[object, ...] = _lasting(self._state)
        self._resume: tuple[str, int] | None = None
        self.recorder: Recorder | None = None

    # -- what is

    @property
    def state(self) -> DocumentState:
        """The frozen state as of now."""
        return self._state

    @property
    def context_takes(self) -> tuple[Take, ...]:
        """The takes searched for neighbours, as last set."""
        return self._context

    def subscribe(
        self, listener: Callable[[DocumentState, DocumentState], None]
    ) -> Callable[[], None]:
        """Call `listener(old, new)` at every change; returns what ends that."""
        return self._announcer.subscribe(listener)

    def source(self, performer: str) -> Take:
        """Return the source take with the sitting's trim: what detection works on."""
        return self._results.of(
            f"{performer}\0source", self._take(performer), (), self._trim(performer)
        )

    def result(self, performer: str) -> Take:
        """Return the source with all unmuted edits replayed over it, and the sitting's trim.

        The same object as long as nothing about it changes.
        """
        edits = (e for e in self._state.sitting.edits if e.performer == performer)
        return self._results.of(performer, self._take(performer), edits, self._trim(performer))

    def declared(self, performer: str) -> tuple[Declared, ...]:
        """Rows × spans that unmuted edits of a performer may change."""
        self._take(performer)
        return replay.declared(e for e in self._state.sitting.edits if e.performer == performer)

    def normal(self, performer: str) -> tuple[Declared, ...]:
        """Rejected rows × spans: normal for the next analysis."""
        return union(
            Declared(d.flag.joint, d.flag.start, d.flag.end)
            for d in self._state.sitting.decisions
            if d.performer == performer and d.verdict is Verdict.REJECTED
        )

    def protected(self, performer: str) -> tuple[Declared, ...]:
        """Protected rows × spans of a performer."""
        every = rows_of(self._take(performer))
        return union(
            Declared(row, p.start, p.end)
            for p in self._state.sitting.protected
            if p.performer == performer
            for row in (p.joints or every)
        )

    def queue(self, performer: str) -> tuple[QueueItem, ...]:
        """Return the queue of any performer, worst first."""
        decided = (d for d in self._history.present.decisions if d.performer == performer)
        return merge(self._analyses.flags(performer), decided)

    # -- the scene

    def open_take(self, take: Take, partner: bool = False, offset: float = 0.0) -> str:
        """Add a take to the scene and return its performer's id.

        The first take that is no partner becomes active.

        Parameters
        ----------
        partner
            True for a take that is only shown beside the one under review.
        offset
            Seconds by which the take starts after the scene's zero.
        """
        scene = self._state.scene
        taken = {p.id for p in scene.performers}
        name, n = take.name, 2
        while name in taken:
            name, n = f"{take.name}#{n}", n + 1
        performer = Performer(name, take, offset, partner)
        first = not any(not p.partner for p in scene.performers)
        changes: dict[str, Any] = {"scene": Scene((*scene.performers, performer))}
        if not scene.performers or (first and not partner):
            frame = walk.same_moment(self._state.performer, performer, self._state.frame)
            changes |= {"active": name, "selection": Selection(name), "frame": frame}
        if self.recorder is not None:
            self.recorder.opened(performer)
        self._put(**changes)
        return name

    def close_performer(self, performer: str) -> None:
        """Take a performer out of the scene and forget all about it, in the history too."""
        self._take(performer)
        left = tuple(p for p in self._state.scene.performers if p.id != performer)
        self._history = self._history.forget(performer)
        self._analyses.forget(performer)
        for key in (performer, f"{performer}\0source"):
            self._results.forget(key)
        changes: dict[str, Any] = {"scene": Scene(left)}
        if self._state.active == performer:
            heir = next((p for p in left if not p.partner), left[0] if left else None)
            gone = self._state.performer
            frame = 0 if heir is None else walk.same_moment(gone, heir, self._state.frame)
            active = "" if heir is None else heir.id
            changes |= {"active": active, "selection": Selection(active), "frame": frame}
        if self.recorder is not None:
            self.recorder.closed(performer)
        self._put(**changes)

    def set_active(self, performer: str) -> None:
        """Put another performer under review, at the same moment of the scene."""
        self._take(performer)
        if performer == self._state.active:
            return
        to = self._state.scene.performer(performer)
        frame = walk.same_moment(self._state.performer, to, self._state.frame)
        self._put(active=performer, selection=Selection(performer), frame=frame)

    def set_frame(self, n: int) -> None:
        """Go to a frame of the active take; numbers outside are brought to its ends."""
        take = self._state.take
        self._put(frame=0 if take is None else min(max(int(n), 0), take.frames - 1))

    # -- selection

    def select(
        self,
        joints: Iterable[str] | None = None,
        span: tuple[int, int] | tuple[()] | None = None,
        flag: str | None = None,
    ) -> None:
        """Select rows, a span or a flag; None leaves that part as it is, an empty value clears it.

        Raises
        ------
        MocapError
            If the active take has no such row or frames, or the queue no such flag.
        """
        take = self._take(self._state.active)
        selection = self._state.selection
        if joints is not None:
            rows = frozenset([joints] if isinstance(joints, str) else joints)
            check_rows(take, rows)
            selection = replace(selection, joints=rows)
        if span is not None:
            if span:
                check_span(take, *span)
            selection = replace(selection, span=(span[0], span[1]) if span else None)
        if flag is not None:
            selection = replace(selection, flag=self._item(flag).flag.id if flag else None)
        self._put(selection=selection)

    def clear_selection(self) -> None:
        """Select nothing."""
        self._put(selection=Selection(self._state.active))

    def select_flag(self, flag_id: str) -> None:
        """Select a flag with its row and span, and go to the frame of its peak."""
        flag = self._item(flag_id).flag
        selection = Selection(
            self._state.active, frozenset([flag.joint]), (flag.start, flag.end), flag.id
        )
        self._put(selection=selection, frame=flag.peak_frame)

    def next_flag(self, step: int = 1, undecided: bool = False) -> None:
        """Select the flag `step` lines further down the queue (up if negative), around its ends.

        Parameters
        ----------
        undecided
            Skip flags that were accepted or rejected.
        """
        queue = self._state.queue
        flag = walk.next_item(queue, self._state.selection.flag, step, undecided, self._resume)
        if flag is not None:
            self.select_flag(flag)

    # -- analysis

    def set_threshold(self, x: float) -> None:
        """Flag again above another value of the map; decided flags stay.

        Raises
        ------
        ParameterError
            If `x` lies outside 0..1.
        """
        if not 0.0 <= x <= 1.0:
            raise ParameterError(f"threshold {x:g} lies outside 0 to 1")
        if x != self._state.threshold:
            self._analyses.reflag(x)
            self._put(threshold=float(x))

    def set_mode(self, mode: str) -> None:
        """Choose the mode of the next analysis."""
        self._put(mode=str(mode))

    def set_parameters(self, parameters: Any) -> None:
        """Set all parameters of detection; threshold and mode follow them."""
        if parameters.threshold != self._state.threshold:
            self._analyses.reflag(parameters.threshold)
        self._put(parameters=parameters, threshold=parameters.threshold, mode=str(parameters.mode))

    def set_context(self, paths: Iterable[Path | str], takes: Iterable[Take] = ()) -> None:
        """Set the context: its paths as shown and its takes."""
        self._context = tuple(takes)
        self._put(context=tuple(paths))

    def begin_analysis(self, performer: str) -> int:
        """Return the generation of a new analysis; earlier ones of that performer are stale."""
        self._take(performer)
        return self._analyses.begin(performer)

    def finish_analysis(self, performer: str, generation: int, analysis: Analysis) -> bool:
        """Take an analysis over. False, and nothing changes, where it is stale."""
        if not self._analyses.finish(performer, generation, analysis, self._state.threshold):
            return False
        self._put()
        return True

    def set_proposal(self, flag_id: str, choice: int | None, proposal: Proposal) -> bool:
        """Keep the proposal of a flag, made with the k-th neighbour or the engine's own choice.

        False, and nothing changes, where the flag is no longer in the queue.
        """
        if self._state.item(flag_id) is None:
            return False
        self._analyses.offer(self._state.active, flag_id, choice, proposal)
        self._put()
        return True

    # -- decisions

    def accept(self, flag_ids: str | Iterable[str], advance: bool = False) -> None:
        """Accept flags with their proposals: decisions and edits, one undo step together.

        An accepted flag whose proposal is another by now gets that in place of its edit.

        Parameters
        ----------
        advance
            Select the next undecided flag.

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
        self._decide("Accept", items, Verdict.ACCEPTED, stamp, edits, advance)

    def reject(self, flag_ids: str | Iterable[str], advance: bool = False) -> None:
        """Reject flags: the motion is right as it is; an accepted one loses its edit."""
        self._judge("Reject", flag_ids, Verdict.REJECTED, advance)

    def defer(self, flag_ids: str | Iterable[str], advance: bool = False) -> None:
        """Leave flags for later, at the end of the queue; an accepted one loses its edit."""
        self._judge("Defer", flag_ids, Verdict.DEFERRED, advance)

    def reopen(self, flag_ids: str | Iterable[str]) -> None:
        """Take back what was decided about flags."""
        self._judge("Reopen", flag_ids, Verdict.OPEN, False)

    def reject_like(self, flag_id: str, band: float = 0.1, advance: bool = False) -> int:
        """Reject a flag and the open ones like it; returns how many.

        Parameters
        ----------
        band
            How far the scores of flags of the same row and kind may lie apart.
        """
        item = self._item(flag_id)
        items = decisions.alike(item, self._state.queue, band)
        label = f"Reject {len(items)} like {item.flag.joint}" if len(items) > 1 else "Reject"
        self._decide(label, items, Verdict.REJECTED, self._stamp(), (), advance)
        return len(items)

    def add_edit(self, proposal: Proposal, label: str = "Edit") -> str:
        """Put samples over the active take without a flag; returns the edit's id."""
        performer, stamp = self._state.active, self._stamp()
        take = self._take(performer)
        edit = decisions.edit_of(take, performer, proposal, stamp, _new_id(), None)
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

    # -- history

    @contextmanager
    def group(self, label: str) -> Iterator[None]:
        """Make one undo step of all intents inside; none of them where one raises."""
        if self._group is not None:
            yield
            return
        start = self._history
        self._group = (label, _new_id(), start)
        try:
            yield
        except BaseException:
            self._history = start
            raise
        else:
            self._history = start.push(label, self._history.present)
        finally:
            self._group = None
            if self.recorder is not None and self._history is not start:
                self.recorder.stepped(label, start.present, self._history.present)
            self._put()

    def undo(self) -> None:
        """Take the last step back."""
        self._travel(self._history.undo(), "undone")

    def redo(self) -> None:
        """Do the step again that was undone last."""
        self._travel(self._history.redo(), "redone")

    # -- for the session file

    def restore(
        self,
        scene: Scene,
        history: History,
        flags: Mapping[str, Sequence[Flag]],
        choices: Mapping[str, Mapping[str, int | None]],
        **view: Any,
    ) -> None:
        """Put a saved sitting in the place of an empty one.

        Parameters
        ----------
        flags, choices
            By performer id.
        view
            Other fields of `DocumentState`.
        """
        self._history = history
        for performer, kept in flags.items():
            self._analyses.restore(performer, kept, choices.get(performer, {}))
        self._put(scene=scene, **view)

    def mark_saved(self, path: Path, sitting: Sitting | None = None) -> None:
        """Note that the document, or that sitting of it, is what stands in the session file."""
        self._put(path=Path(path))
        self._saved = _lasting(
            self._state if sitting is None else replace(self._state, sitting=sitting)
        )
        self._put()

    # -- inside

    def _put(self, **changes: Any) -> None:
        old = self._state
        new = replace(
            old,
            sitting=self._history.present,
            can_undo=self._history.can_undo,
            can_redo=self._history.can_redo,
            analyses=self._analyses.latest,
            **changes,
        )
        new = replace(
            new,
            queue=self._queue(new.active),
            choices=self._analyses.choices(new.active),
            proposals=self._analyses.proposals(new.active),
        )
        if new.selection.flag is not None and new.selected is None:
            new = replace(new, selection=replace(new.selection, flag=None))
        new = replace(new, dirty=self._is_dirty(new))
        changed = differing(old, new)
        if "selection" in changed:
            self._resume = None
        if changed:
            self._state = new
            if self.recorder is not None and changed & {"context", "threshold", "mode", "active"}:
                self.recorder.settled(new)
            self._announcer.announce(old, new)

    def _queue(self, performer: str) -> tuple[QueueItem, ...]:
        flags, decided = self._analyses.flags(performer), self._history.present.decisions
        known, known_flags, known_decided, queue = self._queue_of
        if performer != known or flags is not known_flags or decided is not known_decided:
            queue = self.queue(performer)
            self._queue_of = (performer, flags, decided, queue)
        return queue

    def _is_dirty(self, state: DocumentState) -> bool:
        saved_sitting, *saved = self._saved
        sitting, *rest = _lasting(state)
        # Only what was decided is worth saving where there is no file yet.
        lasts = state.path is not None and any(
            a is not b and a != b for a, b in zip(saved, rest, strict=True)
        )
        return lasts or not same(saved_sitting, sitting)  # type: ignore[arg-type]

    def _commit(self, label: str, sitting: Sitting, **changes: Any) -> None:
        before = self._history.present
        if same(before, sitting):
            self._put(**changes)
            return
        for performer in self._state.scene.performers:
            protection.check_edits(performer.take, performer.id, before, sitting)
        if self._group is None:
            self._history = self._history.push(label, sitting)
            if self.recorder is not None:
                self.recorder.stepped(label, before, sitting)
        else:
            self._history = replace(self._history, present=sitting)
        self._put(**changes)

    def _travel(self, history: History, what: str) -> None:
        if self._group is not None:
            raise MocapError("undo and redo have no place inside a group")
        if history is self._history:
            return
        self._history = history
        if self.recorder is not None:
            getattr(self.recorder, what)()
        self._put()

    def _judge(
        self, word: str, flag_ids: str | Iterable[str], verdict: Verdict, advance: bool
    ) -> None:
        items = [i for i in self._items(flag_ids) if i.verdict is not verdict]
        self._decide(word, items, verdict, self._stamp(), (), advance)

    def _decide(
        self,
        label: str,
        items: Sequence[QueueItem],
        verdict: Verdict,
        stamp: decisions.Stamp,
        edits: Sequence[Edit],
        advance: bool,
    ) -> None:
        queue, selected = self._state.queue, self._state.selection.flag
        deferred = {i.flag.id for i in items} if verdict is Verdict.DEFERRED else set()
        place = walk.place(queue, selected) if selected in deferred else None
        following = walk.following(queue, {i.flag.id for i in items}) if advance else None
        if len(items) == 1:
            label = f"{label} {items[0].flag.joint}" if " " not in label else label
        elif " " not in label:
            label = f"{label} {len(items)} flags"
        performer, sitting = self._state.active, self._history.present
        if items:
            after = decisions.decide(sitting, performer, queue, items, verdict, stamp, edits)
            self._commit(label, after, **self._at(following))
        elif following is not None:
            self._put(**self._at(following))
        if place is not None and selected is not None and following is None:
            self._resume = (selected, place)

    def _at(self, item: QueueItem | None) -> dict[str, Any]:
        if item is None:
            return {}
        flag = item.flag
        rows = frozenset([flag.joint])
        selection = Selection(self._state.active, rows, (flag.start, flag.end), flag.id)
        return {"selection": selection, "frame": flag.peak_frame}

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
        edit = decisions.edit_of(take, performer, proposal, stamp, _new_id(), flag)
        if accepted is not None and decisions.same_samples(edit, self._edit(accepted)):
            return None
        return edit

    def _propose(self, performer: str, flag: Flag) -> Proposal:
        from mocapstudio.cleaning.proposals import propose

        analysis = self._analyses.latest.get(performer)
        if analysis is None:
            raise MocapError(f"no proposal for {flag.joint} yet: analyse the take first")
        proposal: Proposal = propose(analysis, flag, self._state.choices.get(flag.id))
        return proposal

    def _stamp(self) -> decisions.Stamp:
        group = _new_id() if self._group is None else self._group[1]
        time = self._clock().astimezone(UTC).isoformat(timespec="seconds")
        return decisions.Stamp(self.author, time.replace("+00:00", "Z"), group)

    def _item(self, flag_id: str) -> QueueItem:
        item = self._state.item(flag_id)
        if item is None:
            raise MocapError(f"no flag {flag_id} in the queue")
        return item

    def _items(self, flag_ids: str | Iterable[str]) -> list[QueueItem]:
        ids = [flag_ids] if isinstance(flag_ids, str) else list(dict.fromkeys(flag_ids))
        return [self._item(one) for one in ids]

    def _edit(self, edit_id: str) -> Edit:
        for edit in self._history.present.edits:
            if edit.id == edit_id:
                return edit
        raise MocapError(f"no edit {edit_id}")

    def _take(self, performer: str) -> Take:
        try:
            return self._state.scene.performer(performer).take
        except KeyError:
            what = f"no performer {performer}" if performer else "no take is open"
            raise MocapError(what) from None

    def _trim(self, performer: str) -> tuple[int, int] | None:
        take = self._take(performer)
        trim = dict(self._history.present.trims).get(performer, take.trim)
        return None if trim == (0, take.frames) else trim

    def _span_of_active(
        self, joints: Iterable[str], start: int, end: int
    ) -> tuple[str, frozenset[str]]:
        performer = self._state.active
        take = self._take(performer)
        rows = frozenset([joints] if isinstance(joints, str) else joints)
        check_rows(take, rows)
        check_span(take, start, end)
        return performer, rows


def _lasting(state: DocumentState) -> tuple[object, ...]:
    """Return what a session file keeps for good, in the order of its weight."""
    return (
        state.sitting,
        state.scene,
        state.context,
        state.threshold,
        state.mode,
        state.parameters,
    )


def _new_id() -> str:
    return uuid.uuid4().hex[:12]


def _user() -> str:
    try:
        return getpass.getuser()
    except (OSError, KeyError, ImportError):
        return "unknown"
