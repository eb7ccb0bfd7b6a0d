"""The one pool of threads for kernels; apart from `gui.jobs` the only place that knows threads.

Kernels are serial and release the GIL, so blocks of rows run side by side without numba's own
threading layers, which abort or need system libraries.
"""

from __future__ import annotations

import contextlib
import os
import sys
import threading
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor, wait

_lock = threading.Lock()
_pool: ThreadPoolExecutor | None = None
_NICENESS = 5


def cores() -> int:
    """How many cores this process may use."""
    if sys.platform == "linux":
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _step_back() -> None:
    # On Linux niceness belongs to the thread: the interface stays ahead of the analysis.
    if sys.platform == "linux":
        with contextlib.suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), _NICENESS)


def _shared_pool() -> ThreadPoolExecutor:
    global _pool
    with _lock:
        if _pool is None:
            _pool = ThreadPoolExecutor(cores(), "kernels", initializer=_step_back)
        return _pool


def blocks(rows: int, at_least: int = 16) -> Iterator[tuple[int, int]]:
    """Cut `rows` into half-open blocks: a few a core, none smaller than `at_least`."""
    size = max(at_least, -(-rows // (4 * cores())))
    for start in range(0, rows, size):
        yield start, min(rows, start + size)


def for_blocks(rows: int, work: Callable[[int, int], None], at_least: int = 16) -> None:
    """Run ``work(start, end)`` for every block of rows, several at once; wait for all.

    Raises
    ------
    Exception
        The first that `work` raised; the other blocks have ended by then.
    """
    pieces = list(blocks(rows, at_least))
    if len(pieces) == 1:
        work(*pieces[0])
        return
    pending = [_shared_pool().submit(work, *piece) for piece in pieces]
    failures = [future.exception() for future in pending]
    for failure in failures:
        if failure is not None:
            raise failure


def ahead(count: int, work: Callable[[int], None], slots: int) -> Iterator[int]:
    """Run ``work(0)`` to ``work(count - 1)``, and yield each number in order when it is done.

    While the caller goes on with number k, those up to ``k + slots - 1`` are worked on, so that a
    result may be kept in one of `slots` places in turn. Nothing runs any more when this ends, be
    it before its time.

    Raises
    ------
    Exception
        What `work` raised, in place of its number.
    """
    if count == 1:
        work(0)
        yield 0
        return
    pending: deque[Future[None]] = deque()
    submitted = 0
    try:
        for k in range(count):
            while submitted < min(count, k + slots):
                pending.append(_shared_pool().submit(work, submitted))
                submitted += 1
            pending.popleft().result()
            yield k
    finally:
        for future in pending:
            future.cancel()
        wait(pending)
