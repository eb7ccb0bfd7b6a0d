"""Work done ahead of the one who waits for it."""

from __future__ import annotations

import threading

import pytest

from mocapstudio.similarity import parallel


@pytest.mark.parametrize("count", [0, 1, 2, 9])
@pytest.mark.parametrize("slots", [1, 3])
def test_results_come_in_order_and_no_slot_is_used_twice_at_once(count: int, slots: int) -> None:
    places: list[int | None] = [None] * slots

    def work(k: int) -> None:
        assert places[k % slots] is None
        places[k % slots] = k

    seen = []
    for k in parallel.ahead(count, work, slots):
        assert places[k % slots] == k
        places[k % slots] = None
        seen.append(k)
    assert seen == list(range(count))


def test_a_failure_is_raised_in_place_of_its_number() -> None:
    def work(k: int) -> None:
        if k == 2:
            raise ValueError("two")

    seen: list[int] = []
    with pytest.raises(ValueError, match="two"):
        seen.extend(parallel.ahead(5, work, 2))
    assert seen == [0, 1]


def test_given_up_early_nothing_runs_any_more() -> None:
    running, release = threading.Semaphore(0), threading.Event()
    ended = []

    def work(k: int) -> None:
        if k > 0:
            running.release()
            release.wait(5)
        ended.append(k)

    going = parallel.ahead(50, work, 3)
    assert next(going) == 0
    assert running.acquire(timeout=5)
    threading.Timer(0.05, release.set).start()
    going.close()
    count = len(ended)
    assert set(ended) <= {0, 1, 2}
    assert 1 in ended
    assert not running.acquire(timeout=0.1) or len(ended) == count
