"""The take refuses what is no take; progress and recordings."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from made_takes import walking

from mocapstudio.motion.errors import CancelledError, MocapError
from mocapstudio.motion.progress import Progress, run
from mocapstudio.motion.recording import same_recording, without_itself
from mocapstudio.motion.take import Source, Take


@pytest.fixture(scope="module")
def take() -> Take:
    return walking(1.0)


@pytest.mark.parametrize(
    ("change", "cause"),
    [
        ({"rotations": np.zeros((30, 3, 4))}, "rotations must have shape"),
        ({"rotations": np.zeros((30, 19, 3))}, "rotations must have shape"),
        ({"translations": np.zeros((29, 1, 3))}, "translations must have shape"),
        ({"translations": np.zeros((30, 2, 3))}, "translations must have shape"),
        ({"translated": (1,)}, "root"),
        ({"translated": (), "translations": np.zeros((30, 0, 3))}, "root"),
        ({"rotations": np.zeros((0, 19, 4)), "translations": np.zeros((0, 1, 3))}, "one frame"),
        ({"rate": Fraction(0)}, "positive rate"),
        ({"trim": (5, 31)}, "outside"),
        ({"trim": (5, 5)}, "outside"),
        ({"trim": (-1, 5)}, "outside"),
    ],
)
def test_what_is_no_take_is_refused(take: Take, change: dict[str, object], cause: str) -> None:
    with pytest.raises(MocapError, match=cause):
        replace(take, **change)  # type: ignore[arg-type]


def test_time_and_trim(take: Take) -> None:
    assert (take.frames, take.duration, take.span) == (30, 1.0, (0, 30))
    assert take.seconds(15) == 0.5
    assert replace(take, trim=(3, 8)).span == (3, 8)
    slow = replace(take, rate=Fraction(120000, 1001))
    assert slow.duration == pytest.approx(30 * 1001 / 120000)


def test_other_samples_leave_the_rest(take: Take) -> None:
    other = take.with_motion(translations=take.translations + 1.0)
    assert other.rotations is take.rotations
    assert (other.name, other.rate, other.skeleton) == (take.name, take.rate, take.skeleton)


def test_a_recording_is_known_by_its_file_or_its_content(take: Take) -> None:
    def of(path: str, digest: str, performer: int = 0) -> Take:
        return replace(take, source=Source(Path(path), "bvh", digest, performer=performer))

    one = of("a.bvh", "1")
    assert same_recording(take, take)
    assert not same_recording(take, replace(take))
    assert not same_recording(take, one)
    assert same_recording(one, of("./a.bvh", "2"))
    assert same_recording(one, of("b.bvh", "1"))
    assert not same_recording(one, of("b.bvh", "2"))
    assert not same_recording(one, of("a.bvh", "1", performer=1))
    others = (of("b.bvh", "2"), of("c.bvh", "1"), one)
    assert without_itself(others, one) == others[:1]


def counting(closed: list[bool]) -> Generator[Progress, None, str]:
    try:
        for n in range(3):
            yield Progress(n / 3, "counting")
    finally:
        closed.append(True)
    return "three"


def test_work_is_driven_to_its_value() -> None:
    seen: list[float] = []
    assert run(counting([]), lambda progress: seen.append(progress.done)) == "three"
    assert seen == [0, 1 / 3, 2 / 3]


def test_a_cancel_closes_the_work() -> None:
    closed: list[bool] = []

    def stop(_: Progress) -> None:
        raise CancelledError("stopped")

    with pytest.raises(CancelledError):
        run(counting(closed), stop)
    assert closed == [True]
