"""What carries the document: its state, its history, its listeners."""

from __future__ import annotations

import getpass
import uuid
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any, cast

from mocapstudio.cleaning.contacts.model import ContactPoint
from mocapstudio.cleaning.model import Flag
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.take import Take
from mocapstudio.review import protection
from mocapstudio.review.analyses import Analyses
from mocapstudio.review.announcer import Announcer
from mocapstudio.review.decisions import Stamp
from mocapstudio.review.history import History, same
from mocapstudio.review.marker_replay import replay_markers
from mocapstudio.review.model import QueueItem, Sitting
from mocapstudio.review.queue import Queue
from mocapstudio.review.recorder import Nobody, Recorder
from mocapstudio.review.remembered import Remembered
from mocapstudio.review.replay import Results
from mocapstudio.review.state import DocumentState, differing
from mocapstudio.review.take_record import TakeRecord

_LASTING = frozenset({"active", "scene", "markers", "context", "parameters", "manner"})


class Core:
    """State, history and listeners; every intent ends in `_put` or `_commit`.

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
        self.recorder: Recorder = Nobody()
        self._clock = clock or (lambda: datetime.now(UTC))
        self._announcer: Announcer[DocumentState] = Announcer()
        self._state = DocumentState()
        self._history = History()
        # Label, id and the history before it, of the group that is open.
        self._group: tuple[str, str, History] | None = None
        self._analyses = Analyses()
        self._sources, self._results, self._uncorrected = Results(), Results(), Results()
        self._marker_results = Remembered(replay_markers)
        self._unfilled = Remembered(replay_markers)
        self._points_of: dict[str, tuple[Take, tuple[ContactPoint, ...]]] = {}
        self._context: tuple[Take, ...] = ()
        self._queue_of: tuple[str, object, object, tuple[QueueItem, ...]] = ("", (), (), ())
        self._saved = lasting(self._state)
        self._queues: dict[str, tuple[tuple[Flag, ...], Queue]] = {}
        # Performers whose takes were not found; what was decided about them is kept.
        self.absent: tuple[TakeRecord, ...] = ()

    @property
    def state(self) -> DocumentState:
        """The frozen state as of now."""
        return self._state

    def subscribe(
        self, listener: Callable[[DocumentState, DocumentState], None]
    ) -> Callable[[], None]:
        """Call `listener(old, new)` at every change; returns what ends that."""
        return self._announcer.subscribe(listener)

    def result(self, performer: str) -> Take:
        """Return the source with all unmuted edits replayed over it, and the sitting's trim.

        The same object as long as nothing about it changes.
        """
        edits = (e for e in self._state.sitting.edits if e.performer == performer)
        return self._results.of(performer, self._take(performer), edits, self._trim(performer))

    @contextmanager
    def group(self, label: str) -> Iterator[None]:
        """Make one undo step of all intents inside; none of them where one raises."""
        if self._group is not None:
            yield
            return
        start = self._history
        self._group = (label, new_id(), start)
        try:
            yield
        except BaseException:
            self._history = start
            raise
        else:
            self._history = start.push(label, self._history.present)
            if self._history is not start:
                self.recorder.stepped(label, start.present, self._history.present)
        finally:
            self._group = None
            self._put()

    def undo(self) -> None:
        """Take the last step back."""
        self._travel(self._history.undo(), self._state.can_undo, self.recorder.undone)

    def redo(self) -> None:
        """Do the step again that was undone last."""
        self._travel(self._history.redo(), self._state.can_redo, self.recorder.redone)

    def queue(self, performer: str) -> tuple[QueueItem, ...]:
        """Return the queue of any performer, worst first."""
        decided = (d for d in self._history.present.decisions if d.performer == performer)
        flags = self._analyses.flags(performer)
        known, queue = self._queues.get(performer, (None, None))
        if queue is None or known is not flags:
            queue = Queue(flags)
            self._queues[performer] = (flags, queue)
        return queue.merged(decided)

    def _put(self, **changes: Any) -> None:
        """Change fields of the state, bring what follows from them up to date, tell listeners."""
        old = self._state
        before, now = old.sitting, self._history.present
        if before.contacts is not now.contacts or before.points is not now.points:
            # What was proposed kept to other contacts.
            self._analyses.withdraw()
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
            queue=self._shown_queue(new.active),
            choices=self._analyses.choices(new.active),
            proposals=self._analyses.proposals(new.active),
        )
        if new.selection.flag is not None and new.selected is None:
            new = replace(new, selection=replace(new.selection, flag=None))
        new = replace(new, dirty=self._is_dirty(new))
        changed = differing(old, new)
        if changed:
            self._state = new
            if changed & _LASTING:
                self.recorder.settled(new)
            if "comparison" in changed:
                self.recorder.compared(new.comparison)
            self._announcer.announce(old, new)

    def _commit(self, label: str, sitting: Sitting) -> None:
        """Go on to another sitting, as one step unless a group is open."""
        before = self._history.present
        if same(before, sitting):
            self._put()
            return
        for performer in self._state.scene.performers:
            protection.check_edits(performer.take, performer.id, before, sitting)
        if self._group is None:
            self._history = self._history.push(label, sitting)
            self.recorder.stepped(label, before, sitting)
        else:
            self._history = replace(self._history, present=sitting)
        self._put()

    def _travel(
        self,
        history: History,
        label: str | None,
        record: Callable[[str, Sitting, Sitting], None],
    ) -> None:
        if self._group is not None:
            raise MocapError("undo and redo have no place inside a group")
        if history is not self._history and label is not None:
            before, self._history = self._history.present, history
            record(label, before, history.present)
            self._put()

    def _shown_queue(self, performer: str) -> tuple[QueueItem, ...]:
        flags, decided = self._analyses.flags(performer), self._history.present.decisions
        known, known_flags, known_decided, queue = self._queue_of
        if performer != known or flags is not known_flags or decided is not known_decided:
            queue = self.queue(performer)
            self._queue_of = (performer, flags, decided, queue)
        return queue

    def _is_dirty(self, state: DocumentState) -> bool:
        if not same(cast("Sitting", self._saved["sitting"]), state.sitting):
            return True
        # Only what was decided is worth saving where there is no file yet.
        return state.path is not None and any(
            self._saved[name] is not kept and self._saved[name] != kept
            for name, kept in lasting(state).items()
            if name not in {"sitting", "active"}
        )

    def _stamp(self) -> Stamp:
        group = new_id() if self._group is None else self._group[1]
        time = self._clock().astimezone(UTC).isoformat(timespec="seconds")
        return Stamp(self.author, time.replace("+00:00", "Z"), group)

    def _item(self, flag_id: str) -> QueueItem:
        item = self._state.item(flag_id)
        if item is None:
            raise MocapError(f"no flag {flag_id} in the queue")
        return item

    def _items(self, flag_ids: str | Iterable[str]) -> list[QueueItem]:
        ids = [flag_ids] if isinstance(flag_ids, str) else list(dict.fromkeys(flag_ids))
        return [self._item(one) for one in ids]

    def _take(self, performer: str) -> Take:
        try:
            return self._state.scene.performer(performer).take
        except KeyError:
            what = f"no performer {performer}" if performer else "no take is open"
            raise MocapError(what) from None

    def _free_id(self, name: str) -> str:
        """Return a name that no performer has, by joints or by markers, found or not."""
        state = self._state
        taken = {one.id for one in state.everyone} | {one.id for one in self.absent}
        free, n = name, 2
        while free in taken:
            free, n = f"{name}#{n}", n + 1
        return free

    def _trim(self, performer: str) -> tuple[int, int] | None:
        take = self._take(performer)
        trim = dict(self._history.present.trims).get(performer, take.trim)
        return None if trim == (0, take.frames) else trim


def new_id() -> str:
    """Return an id that no other edit or group has, in any sitting."""
    return uuid.uuid4().hex[:12]


def lasting(state: DocumentState) -> dict[str, object]:
    """Fields of a state that outlive it in the session file, by name."""
    found = {name: getattr(state, name) for name in ("sitting", *_LASTING)}
    return found | {"comparison": state.comparison.lasting}


def _user() -> str:
    try:
        return getpass.getuser()
    except (OSError, KeyError, ImportError):
        return "unknown"
