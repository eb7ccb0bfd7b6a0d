"""Hands and feet stay when a joint nearer the trunk is repaired."""

from __future__ import annotations

import numpy as np
import pytest
from made_takes import turned, walking

from mocapstudio.cleaning.ik.keep_ends import keep_ends
from mocapstudio.formats.changes import covered
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.kinematics import take_pose


@pytest.fixture(scope="module")
def walk():
    take = walking(2.0, rate=30)
    rotations = take.rotations.copy()
    for side, sign in (("Left", -1.0), ("Right", 1.0)):
        at = take.skeleton.index[side + "ForeArm"]
        bent = rot.about_axis(1, np.deg2rad(70.0 * sign))
        rotations[:, at] = rot.multiply(rotations[:, at], bent)
    return take.with_motion(rot.continuous(rotations))


def test_hands_stay_when_the_chest_turns(walk):
    repaired = turned(walk, "Chest", 20, 40, 6)
    hands = [walk.skeleton.index[name] for name in ("LeftHand", "RightHand")]
    was, moved = take_pose(walk), take_pose(repaired)
    assert np.linalg.norm(moved[0][30, hands] - was[0][30, hands], axis=1).min() > 0.02
    kept = keep_ends(walk, repaired)
    now = take_pose(kept.take)
    np.testing.assert_allclose(now[0][:, hands], was[0][:, hands], atol=1e-3)
    assert np.degrees(rot.angle(now[1][:, hands], was[1][:, hands])).max() < 1.0
    assert max(kept.gaps.values()) < 1e-3
    # The repair itself is not undone, and only arms change beyond it.
    at = walk.skeleton.index["Chest"]
    np.testing.assert_array_equal(kept.take.rotations[:, at], repaired.rotations[:, at])
    allowed = covered(walk, kept.declared).rotations
    assert not ((kept.take.rotations != repaired.rotations).any(axis=2) & ~allowed).any()
    assert {one.row[-3:] for one in kept.declared} <= {"der", "Arm", "and"}


def test_a_repaired_limb_is_left_as_it_is(walk):
    repaired = turned(walk, "LeftArm", 20, 40, 15)
    kept = keep_ends(walk, repaired)
    np.testing.assert_array_equal(kept.take.rotations, repaired.rotations)
    assert kept.declared == ()
    assert "LeftHand" not in kept.gaps


def test_other_takes_are_refused(walk):
    with pytest.raises(MocapError, match="no version"):
        keep_ends(walk, walking(1.0, rate=30))
