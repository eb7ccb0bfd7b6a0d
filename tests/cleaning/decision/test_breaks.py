"""Breaks: rotations faster than people turn make what is around them doubtful."""

from __future__ import annotations

import numpy as np
import pytest
from made_takes import faced, turned, walking

from mocapstudio.cleaning.decision.breaks import doubtful, limits, speeds
from mocapstudio.motion.take import Take
from mocapstudio.similarity.texture import BodyMotion, body_motion, texture_of

AROUND = 0.75


def motion(take: Take) -> BodyMotion:
    return body_motion(take, take.skeleton.names)


@pytest.mark.parametrize("rate", [24, 30, 120])
def test_speed_is_that_of_the_larger_step(rate: int) -> None:
    take = walking(4.0, rate)
    found = speeds(motion(turned(take, "Head", 2 * rate, 2 * rate + 1, 90)))
    head = take.skeleton.index["Head"]
    assert found.shape == (4 * rate, len(take.skeleton))
    fast = np.flatnonzero(found[:, head] > np.deg2rad(70) * rate)
    assert fast.tolist() == [2 * rate - 1, 2 * rate, 2 * rate + 1]
    assert found[2 * rate, head] == pytest.approx(np.deg2rad(90) * rate, rel=0.1)


@pytest.mark.parametrize("rate", [30, 120])
def test_a_break_makes_its_own_row_doubtful_for_a_while(rate: int) -> None:
    clean = walking(8.0, rate)
    broken = motion(turned(clean, "Head", 4 * rate, 5 * rate, 120))
    limit = limits([motion(clean)])
    texture = texture_of(broken)
    found = doubtful(broken, texture, limit)
    assert found.shape == (len(texture), len(clean.skeleton) + 2)
    assert not doubtful(motion(clean), texture, limit).any()
    rows = np.flatnonzero(found.any(axis=0))
    assert rows.tolist() == [clean.skeleton.index["Head"]]
    seconds = np.flatnonzero(found[:, rows[0]]) / 24
    assert seconds.min() == pytest.approx(4 - AROUND, abs=0.1)
    assert seconds.max() == pytest.approx(5 + AROUND, abs=0.1)


def test_a_broken_heading_makes_both_root_rows_doubtful() -> None:
    clean = walking(8.0, 30)
    flipped = motion(faced(clean, 120, 150, 160))
    found = doubtful(flipped, texture_of(flipped), limits([motion(clean)]))
    joints = len(clean.skeleton)
    assert np.flatnonzero(found.any(axis=0)).tolist() == [joints, joints + 1]


def test_what_is_usual_for_a_joint_is_no_break() -> None:
    """A limit is never below twice what most takes reach, however fast that is."""
    fast = [motion(turned(walking(4.0, 30, seed=s), "Head", 60, 61, 100)) for s in range(3)]
    limit = limits(fast)
    head = fast[0].joints.index("Head")
    assert limit[head] > 1.5 * np.deg2rad(100) * 30
    assert np.all(np.delete(limit, head) == np.deg2rad(1400.0))
    assert not doubtful(fast[0], texture_of(fast[0]), limit).any()
    # The first and last moments of a capture do not count.
    at_the_end = [motion(turned(walking(4.0, 30, seed=s), "Head", 119, 120, 100)) for s in range(3)]
    assert limits(at_the_end)[head] == np.deg2rad(1400.0)
