"""The journal: every step of an open sitting, written down as it is done.

It lies beside the session file, or in the user's state folder while there is none, and is folded
in (begun anew) when the session is saved. Each record goes to the system at once, so that a crash
of the program costs nothing; to the disk at most once a second, so that a crash of the machine
costs a second. Its records are described in `journal_records`.
"""

from __future__ import annotations

import dataclasses
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import IO

import platformdirs

from mocapstudio.motion.errors import FileError
from mocapstudio.review import journal_records as records
from mocapstudio.review.comparing_kept import KeptComparison
from mocapstudio.review.comparing_wire import COMPARED, Recording, pack_comparison
from mocapstudio.review.core import new_id
from mocapstudio.review.document import Document
from mocapstudio.review.lock import Lock, holder, is_open_here, lock_path
from mocapstudio.review.manner import pack_manner
from mocapstudio.review.marker_model import MarkerPerformer
from mocapstudio.review.model import Performer, Sitting
from mocapstudio.review.opening import Opening, journal_path
from mocapstudio.review.records import Arrays
from mocapstudio.review.references import Relocate
from mocapstudio.review.session_record import FORMAT, VERSION, SessionRecord
from mocapstudio.review.state import DocumentState
from mocapstudio.review.take_record import absolute, refer

SYNC_SECONDS = 1.0
_SUFFIX = ".journal"


def unsaved_folder() -> Path:
    """Where journals of sittings without a session file lie."""
    return platformdirs.user_state_path("mocapstudio") / "unsaved"


def unfinished(folder: Path | None = None) -> list[Path]:
    """Journals of unsaved sittings whose program is gone, oldest first.

    Those in which nothing was decided are deleted.
    """
    folder = unsaved_folder() if folder is None else folder
    left = []
    for path in sorted(folder.glob(f"*{_SUFFIX}"), key=lambda p: (p.stat().st_mtime, p.name)):
        if holder(path) is not None or is_open_here(path):
            continue
        if any(_decides(event) for event in records.read(path).events):
            left.append(path)
        else:
            path.unlink(missing_ok=True)
            lock_path(path).unlink(missing_ok=True)
    return left


def recover(path: Path, relocate: Relocate | None = None, author: str | None = None) -> Document:
    """Make a document of the journal of a sitting that was never saved.

    Raises
    ------
    FileError
        If the journal cannot be read.
    """
    opening = Opening(SessionRecord(FORMAT, VERSION), {}, None, relocate)
    opening.replay(records.read(path))
    return opening.document(author)


class Journal:
    """Writes down what a document does, until it is closed.

    Attach one right after a document was made or opened. Call `sync` once a second while the
    program idles, and `close` at the end.

    Parameters
    ----------
    document
        The document; what it holds beyond its session file is written first.
    folder
        For journals of unsaved sittings; by default in the user's state folder.
    force
        Open the session although somebody else has it open.
    clock
        Seconds, for tests.

    Raises
    ------
    LockedError
        If somebody else has the session open.
    FileError
        If the journal cannot be written.
    """

    def __init__(
        self,
        document: Document,
        folder: Path | None = None,
        force: bool = False,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._folder = unsaved_folder() if folder is None else folder
        self._clock = clock
        self._synced = -SYNC_SECONDS
        self._behind = False
        # Takes that were written down as compared, and what they are called here.
        self._compared: dict[Recording, str] = {}
        self.failure: FileError | None = None
        recovered = document.recovered
        if recovered is not None and not recovered.path.exists():
            recovered = None
        self.path = recovered.path if recovered is not None else self._place(document)
        self._lock = Lock(document.state.path or self.path, force)
        if recovered is not None and recovered.length > 0:
            self._file: IO[bytes] | None = _open(self.path, "r+b")
            self._file.truncate(recovered.length)
            self._file.seek(recovered.length)
        else:
            self._set_aside(document)
            self._file = _open(self.path, "wb")
            self._begin(document)
        document.recorder = self

    def opened(self, performer: Performer | MarkerPerformer) -> None:
        """Write down that a take was opened."""
        arrays = Arrays()
        take = refer(performer, None, arrays)
        self._write(records.Opened(take, records.to_text(arrays)))

    def closed(self, performer: str) -> None:
        """Write down that a performer was closed."""
        self._write(records.Closed(performer))

    def stepped(self, label: str, before: Sitting, after: Sitting) -> None:
        """Write down a step."""
        self._write(records.Stepped(label, records.difference(before, after)))

    def undone(self, label: str, before: Sitting, after: Sitting) -> None:
        """Write down that a step was undone."""
        self._write(records.Undone(label, records.difference(before, after)))

    def redone(self, label: str, before: Sitting, after: Sitting) -> None:
        """Write down that a step was done again."""
        self._write(records.Redone(label, records.difference(before, after)))

    def settled(self, state: DocumentState) -> None:
        """Write down what lasts but cannot be undone."""
        self._write(
            records.Settled(
                state.active,
                tuple(str(absolute(path)) for path in state.context),
                dataclasses.asdict(state.parameters),
                {p.id: (p.offset, p.partner) for p in state.scene.performers},
                pack_manner(state.manner),
            )
        )

    def compared(self, kept: KeptComparison) -> None:
        """Write down what is compared; takes without a file once only."""
        arrays = Arrays()
        known = set(self._compared.values())

        def name(take: Recording) -> str:
            return self._compared.setdefault(take, f"{COMPARED}{new_id()}")

        record = pack_comparison(kept, None, arrays, name)
        old = tuple(f"takes/{one}/" for one in known)
        fresh = {key: one for key, one in arrays.items() if not key.startswith(old)}
        self._write(records.Compared(record, records.to_text(fresh)))

    def saved(self, document: Document) -> None:
        """Begin anew beside the session file that was just written."""
        old, path = self.path, self._place(document, keep=False)
        self._end()
        if path != old:
            old.unlink(missing_ok=True)
            self._lock.release()
            self._lock = Lock(document.state.path or path, force=True)
        self.path, self.failure, self._compared = path, None, {}
        try:
            self._file = _open(path, "wb")
        except FileError as error:
            self.failure = error
            return
        self._begin(document)

    def sync(self) -> None:
        """Bring what was written to the disk, if a second has passed since the last time.

        Raises
        ------
        FileError
            Once, if the journal can no longer be written: what is decided from then on is not
            safe before the next save.
        """
        if self._file is not None and self._behind:
            self._to_disk(self._file)
        if self.failure is not None:
            failure, self.failure = self.failure, None
            raise failure

    def close(self, keep: bool = False) -> None:
        """Stop writing and give the lock back; the journal is deleted unless it is to be kept."""
        self._end()
        if not keep:
            self.path.unlink(missing_ok=True)
        self._lock.release()

    def _place(self, document: Document, keep: bool = True) -> Path:
        session = document.state.path
        if session is not None:
            return journal_path(session)
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise FileError(self._folder, f"cannot be made: {error.strerror or error}") from error
        return self._folder / f"{new_id()}{_SUFFIX}"

    def _set_aside(self, document: Document) -> None:
        """Keep a journal that says more than the session file but was not replayed."""
        try:
            found = records.read(self.path) if self.path.exists() else None
        except FileError:
            stale = False
        else:
            stale = found is None or not found.events or found.base != document.save
        if not stale:
            self.path.replace(self.path.with_name(f"{self.path.name}.{new_id()}"))

    def _begin(self, document: Document) -> None:
        """Write the head, and what the document holds beyond the session file."""
        state = document.state
        self._write(records.Head(records.FORMAT, records.VERSION, document.save))
        saved = document.saved_ids if state.path else frozenset[str]()
        for performer in state.everyone:
            if performer.id not in saved:
                self.opened(performer)
        if document.saved_sitting is not state.sitting:
            self.stepped(state.can_undo or "Decide", document.saved_sitting, state.sitting)
        if state.path is None or state.dirty:
            self.settled(state)
            if state.comparison != KeptComparison():
                self.compared(state.comparison)

    def _write(self, record: records.Head | records.Event) -> None:
        if self._file is None:
            return
        try:
            self._file.write(records.encode(record))
            self._file.flush()
            self._behind = True
            self._to_disk(self._file)
        except OSError as error:
            # A gap would make all that follows unreadable: nothing more is written.
            self._end()
            cause = f"cannot be written: {error.strerror or error}"
            self.failure = FileError(self.path, cause)

    def _to_disk(self, file: IO[bytes]) -> None:
        now = self._clock()
        if now - self._synced >= SYNC_SECONDS:
            self._synced = now
            os.fsync(file.fileno())
            self._behind = False

    def _end(self) -> None:
        if self._file is not None:
            file, self._file = self._file, None
            try:
                file.close()
            except OSError as error:
                self.failure = FileError(self.path, f"cannot be closed: {error}")


def _decides(event: records.Event) -> bool:
    if isinstance(event, records.Compared):
        return bool(event.comparison.segments)
    return isinstance(event, records.Stepped)


def _open(path: Path, mode: str) -> IO[bytes]:
    try:
        return path.open(mode)
    except OSError as error:
        raise FileError(path, f"cannot be written: {error.strerror or error}") from error
