"""What those of the desk have in common who have long work done."""

from __future__ import annotations

from collections.abc import Callable, Generator
from typing import Any

from PySide6.QtCore import QObject

from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.jobs import Job, Jobs
from mocapstudio.gui.messages import Messages
from mocapstudio.motion.progress import Progress


class Worker(QObject):
    """Has work done in the background, and tells the user where it fails.

    Parameters
    ----------
    bridge
        The document's door.
    jobs
        Runs the work.
    messages
        Is told what came of it, or what went wrong.
    parent
        Qt's parent.
    """

    def __init__(
        self,
        bridge: DocumentBridge,
        jobs: Jobs,
        messages: Messages,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self._bridge, self._jobs, self._messages = bridge, jobs, messages

    def _have_done(
        self,
        title: str,
        work: Generator[Progress, None, Any],
        done: Callable[[Any], None],
        failed: str,
        key: str | None = None,
    ) -> Job:
        """Start work; see `Jobs.start`. `failed` heads what the user is told of a failure."""
        return self._jobs.start(
            title, work, done, lambda error: self._messages.complain(error, failed), key=key
        )
