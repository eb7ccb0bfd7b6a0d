"""Keeps the journal of the open sitting, so that a crash costs a second at most."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QObject, QTimer

from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.messages import Messages
from mocapstudio.motion.errors import MocapError
from mocapstudio.review.document import Document
from mocapstudio.review.journal import Journal, unfinished
from mocapstudio.review.lock import LockedError, lock_path


class Journalling(QObject):
    """Attaches a journal to each document that comes to the desk.

    Parameters
    ----------
    bridge
        The document's door.
    messages
        Is told when the journal cannot be written.
    parent
        Qt's parent.
    """

    def __init__(
        self, bridge: DocumentBridge, messages: Messages, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._bridge, self._messages = bridge, messages
        self._journal: Journal | None = None
        self._timer = QTimer(self)
        self._timer.setInterval(1000)
        self._timer.timeout.connect(self._sync)
        self._timer.start()
        self._attach(bridge.document, force=False)

    def swap(self, document: Document, ask: Callable[[LockedError], None]) -> None:
        """Put a document on the desk, unless somebody else has its session open.

        Parameters
        ----------
        ask
            Called instead where the session is locked.
        """
        if document.state.path is not None and document.state.path == self._bridge.state.path:
            # The same session once more: its journal is the one that is open.
            self.close()
        try:
            fresh = Journal(document)
        except LockedError as error:
            ask(error)
            return
        except MocapError as error:
            self._messages.complain(error, _DOING)
            self._take_over(document, None)
            return
        self._take_over(document, fresh)

    def swap_by_force(self, document: Document) -> None:
        """Put a document on the desk although somebody else has its session open."""
        self._take_over(document, None)
        self._attach(document, force=True)

    def close(self) -> None:
        """End the journal: everything was saved, or is to be forgotten."""
        if self._journal is not None:
            self._journal.close()
            self._journal = None

    def _take_over(self, document: Document, journal: Journal | None) -> None:
        if self._journal is not None:
            self._journal.close()
        self._journal = journal
        self._bridge.replace(document)

    def _attach(self, document: Document, *, force: bool) -> None:
        try:
            self._journal = Journal(document, force=force)
        except MocapError as error:
            self._messages.complain(error, _DOING)

    def _sync(self) -> None:
        if self._journal is None:
            return
        try:
            self._journal.sync()
        except MocapError as error:
            self._messages.complain(error, _DOING)


def left_behind() -> list[Path]:
    """Journals of sittings that ended in a crash before they were saved; none if unreadable."""
    try:
        return unfinished()
    except (MocapError, OSError):
        return []


def discard(journal: Path) -> None:
    """Forget what a crash left behind."""
    for path in (journal, lock_path(journal)):
        path.unlink(missing_ok=True)


_DOING = "The journal cannot be written: what you decide is safe only once it is saved"
