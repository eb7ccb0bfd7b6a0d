"""Long work in threads: the only module of the desk that knows them.

A job is a generator that yields `Progress` and returns its result. It runs on a thread of the
pool; everything it reports arrives in the thread of `Jobs`, which is the desk's.
"""

from __future__ import annotations

import contextlib
import os
import queue
import select
import sys
import threading
import time
from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import QObject, QRunnable, Qt, QThreadPool, Signal

from mocapstudio.motion.progress import Progress

Work = Generator[Progress, None, Any]
_REPORT_EVERY = 0.05
_SETTLE = 0.5
_LOOK_UP = 0.1
_LONGEST = 1 << 20


class Job(QObject):
    """One piece of work under way.

    Parameters
    ----------
    title
        What is being done, for the user.
    key
        Jobs of one key supersede each other: starting one cancels the one before, and whatever
        the old one still delivers is dropped.
    parent
        Qt's parent.
    """

    progressed = Signal(object)
    """Emitted with the latest `Progress`."""

    ended = Signal()
    """Emitted once, whatever the end was."""

    def __init__(self, title: str, key: str, parent: QObject) -> None:
        super().__init__(parent)
        self.title = title
        self.key = key
        self.progress = Progress(0.0, title)
        self._started = time.monotonic()
        self._stop = threading.Event()

    @property
    def cancelled(self) -> bool:
        """Whether the user, or a newer job of the same key, asked this one to stop."""
        return self._stop.is_set()

    def cancel(self) -> None:
        """Ask the work to stop at its next yield; its result will not be delivered."""
        self._stop.set()

    def seconds_left(self) -> float | None:
        """Estimate of the time left, or None while it is too early to tell."""
        spent = time.monotonic() - self._started
        if self.progress.done <= 0.02 or spent < _SETTLE:
            return None
        return spent * (1.0 - self.progress.done) / self.progress.done


@dataclass(frozen=True)
class _Message:
    job: Job
    kind: str
    value: Any


class _Runner(QRunnable):
    """Drives one generator on a thread of the pool and reports by one signal."""

    def __init__(
        self, job: Job, work: Work, report: Callable[[_Message], None], *, awaited: bool
    ) -> None:
        super().__init__()
        self.setAutoDelete(False)
        self._job, self._work, self._report = job, work, report
        self._awaited = awaited

    def run(self) -> None:
        if not self._awaited:
            _yield_to_the_desk()
        # Whatever goes wrong in the work must reach the desk, or the job would never end there.
        try:
            message = self._drive()
        except BaseException as error:
            message = _Message(self._job, "failed", error)
        try:
            self._work.close()
        except BaseException as error:
            message = _Message(self._job, "failed", error)
        self._tell(message)

    def _tell(self, message: _Message) -> None:
        # A desk that was closed meanwhile no longer listens.
        with contextlib.suppress(RuntimeError):
            self._report(message)

    def _drive(self) -> _Message:
        reported = 0.0
        while not self._job.cancelled:
            try:
                progress = next(self._work)
            except StopIteration as stop:
                return _Message(self._job, "result", stop.value)
            now = time.monotonic()
            if now - reported >= _REPORT_EVERY:
                reported = now
                self._tell(_Message(self._job, "progress", progress))
        return _Message(self._job, "cancelled", None)


class Jobs(QObject):
    """Runs generators in threads and hands results, failures and progress to the desk's thread."""

    changed = Signal()
    """Emitted when a job starts, progresses or ends."""

    _arrived = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._pool = QThreadPool(self)
        self._pool.setMaxThreadCount(3)
        # A thread that has lowered its priority cannot raise it again.
        self._prompt = QThreadPool(self)
        self._prompt.setMaxThreadCount(1)
        self._running: dict[Job, tuple[_Runner, Callable[[Any], None], Callable[..., None]]] = {}
        self._arrived.connect(self._receive, Qt.ConnectionType.QueuedConnection)

    @property
    def running(self) -> tuple[Job, ...]:
        """Jobs under way that were not cancelled, oldest first."""
        return tuple(job for job in self._running if not job.cancelled)

    def start(
        self,
        title: str,
        work: Work,
        on_result: Callable[[Any], None],
        on_failure: Callable[[BaseException], None],
        *,
        key: str | None = None,
        awaited: bool = False,
    ) -> Job:
        """Start work on a thread.

        Parameters
        ----------
        title
            What is being done, for the user.
        work
            The generator; cancelling closes it between two yields.
        on_result, on_failure
            Called in the desk's thread with the generator's value or its exception, unless the
            job was cancelled.
        key
            See `Job`; by default a key of its own.
        awaited
            Whether the user waits for it with a hand on the mouse: such work is short and need not
            yield to the desk.
        """
        job = Job(title, key or f"{title} {id(work)}", self)
        for other in self.running:
            if key is not None and other.key == key:
                other.cancel()
        runner = _Runner(job, work, self._arrived.emit, awaited=awaited)
        self._running[job] = (runner, on_result, on_failure)
        (self._prompt if awaited else self._pool).start(runner)
        self.changed.emit()
        return job

    def cancel(self, key: str | None = None) -> None:
        """Cancel the jobs of one key, or all of them."""
        for job in self.running:
            if key is None or job.key == key:
                job.cancel()
        self.changed.emit()

    def wait(self, seconds: float) -> bool:
        """Wait for the threads to end; tell whether they did."""
        return all(one.waitForDone(int(seconds * 1000)) for one in (self._pool, self._prompt))

    def _receive(self, message: _Message) -> None:
        job = message.job
        if message.kind == "progress":
            job.progress = message.value
            if not job.cancelled:
                job.progressed.emit(message.value)
                self.changed.emit()
            return
        _, on_result, on_failure = self._running.pop(job)
        cancelled = job.cancelled
        job.ended.emit()
        job.deleteLater()
        self.changed.emit()
        if not cancelled and message.kind == "result":
            on_result(message.value)
        elif not cancelled and message.kind == "failed":
            on_failure(message.value)


def _yield_to_the_desk() -> None:
    # Linux schedules threads one by one; elsewhere the setting would hit the whole process.
    if sys.platform.startswith("linux"):
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), 10)


class Lines:
    """Lines that come in by a pipe, read ahead by a thread of their own.

    At most `most` lines wait to be taken; then the sender waits. Nothing here ever does.

    Parameters
    ----------
    descriptor
        What is read from; it stays open.
    most
        How many lines may wait.
    """

    def __init__(self, descriptor: int, most: int = 256) -> None:
        self._descriptor = descriptor
        self._waiting: queue.Queue[tuple[float, bytes]] = queue.Queue(most)
        self._stop, self._read_all = threading.Event(), threading.Event()
        # What blocks in a read must not keep the process from ending.
        self._thread = threading.Thread(target=self._run, name="lines", daemon=True)
        self._thread.start()

    @property
    def ended(self) -> bool:
        """Whether the sender has closed the pipe and every line was taken."""
        return self._read_all.is_set() and self._waiting.empty()

    @property
    def running(self) -> bool:
        """Whether the thread still reads."""
        return self._thread.is_alive()

    def take(self) -> tuple[float, bytes] | None:
        """Return when the next line came, and the line without its end; None without one.

        The time is that of `time.perf_counter`, seconds.
        """
        try:
            return self._waiting.get_nowait()
        except queue.Empty:
            return None

    def close(self) -> None:
        """Read no more."""
        self._stop.set()

    def _run(self) -> None:
        try:
            for line in self._lines():
                came = time.perf_counter()
                while not self._stop.is_set():
                    with contextlib.suppress(queue.Full):
                        self._waiting.put((came, line), timeout=_LOOK_UP)
                        break
        except OSError:
            # Whoever owned the pipe has closed it under us: that is its end.
            pass
        self._read_all.set()

    def _lines(self) -> Iterator[bytes]:
        rest = b""
        while not self._stop.is_set():
            if not self._is_ready():
                continue
            part = os.read(self._descriptor, 1 << 16)
            *whole, rest = (rest + part).split(b"\n")
            yield from whole
            if not part:
                if rest:
                    yield rest
                return
            if len(rest) > _LONGEST:
                # No frame is that long: it is told as a bad line, and what follows as another.
                yield rest
                rest = b""

    def _is_ready(self) -> bool:
        if sys.platform == "win32":
            return True
        return bool(select.select([self._descriptor], [], [], _LOOK_UP)[0])
