"""Jobs: results arrive in the desk's thread, whatever the work does."""

from __future__ import annotations

import threading
import time
from collections.abc import Generator

import pytest

from mocapstudio.gui.jobs import Jobs
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.progress import Progress


def counting(log: list[object], steps: int, pause: float = 0.0) -> Generator[Progress, None, int]:
    try:
        for step in range(steps):
            log.append(threading.get_ident())
            yield Progress(step / steps, "counting")
            time.sleep(pause)
        return steps
    finally:
        log.append("closed")


@pytest.fixture
def jobs(qapp):
    jobs = Jobs()
    yield jobs
    jobs.cancel()
    assert jobs.wait(5)


def collect(jobs: Jobs, work, **options):
    results: list[object] = []
    failures: list[BaseException] = []
    job = jobs.start(
        "work",
        work,
        lambda value: results.append((value, threading.get_ident())),
        failures.append,
        **options,
    )
    return job, results, failures


def test_the_result_arrives_in_the_thread_of_the_desk(jobs, qtbot):
    log: list[object] = []
    _, results, failures = collect(jobs, counting(log, 3))
    qtbot.waitUntil(lambda: bool(results))
    assert results == [(3, threading.get_ident())]
    assert failures == []
    assert threading.get_ident() not in log
    assert log[-1] == "closed"
    assert jobs.running == ()


@pytest.mark.parametrize(
    "error",
    [RuntimeError("engine"), FileError("a.bvh", "not a BVH", line=3), MemoryError(), SystemExit(3)],
)
def test_every_exception_of_the_work_is_delivered(jobs, qtbot, error):
    def failing() -> Generator[Progress, None, None]:
        yield Progress(0.5, "about to fail")
        raise error

    _, results, failures = collect(jobs, failing())
    qtbot.waitUntil(lambda: bool(failures))
    assert failures == [error]
    assert results == []
    assert jobs.running == ()


def test_a_cancelled_job_is_closed_and_delivers_nothing(jobs, qtbot):
    log: list[object] = []
    job, results, failures = collect(jobs, counting(log, 10_000, 0.002))
    qtbot.waitUntil(lambda: len(log) > 3)
    with qtbot.waitSignal(job.ended):
        job.cancel()
    assert log[-1] == "closed"
    assert len(log) < 10_000
    assert (results, failures) == ([], [])


def test_a_result_that_comes_after_the_cancel_is_dropped(jobs, qtbot):
    gate = threading.Event()

    def deaf() -> Generator[Progress, None, str]:
        yield Progress(0.0, "waiting")
        gate.wait(5)
        return "late"

    job, results, _ = collect(jobs, deaf())
    qtbot.waitUntil(lambda: job.progress.what == "waiting")
    job.cancel()
    with qtbot.waitSignal(job.ended):
        gate.set()
    assert results == []


def test_a_new_job_of_the_same_key_supersedes_the_old_one(jobs, qtbot):
    log: list[object] = []
    old, stale, _ = collect(jobs, counting(log, 10_000, 0.002), key="analysis")
    _, fresh, _ = collect(jobs, counting([], 2), key="analysis")
    assert old.cancelled
    qtbot.waitUntil(lambda: bool(fresh))
    assert [value for value, _ in fresh] == [2]
    assert stale == []


def test_time_left_shrinks_with_progress(jobs, qtbot):
    log: list[object] = []
    job, results, _ = collect(jobs, counting(log, 40, 0.03))
    seen: list[float] = []
    job.progressed.connect(lambda _: seen.append(job.seconds_left() or -1.0))
    qtbot.waitUntil(lambda: bool(results))
    told = [left for left in seen if left >= 0]
    assert told, "no estimate was given in more than a second of work"
    assert told[-1] < told[0]
