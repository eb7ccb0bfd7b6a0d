"""The skeleton: what it refuses, and what it knows of its joints."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from made_takes import build, chain, horse, person

from mocapstudio.motion.errors import MocapError, SkeletonMismatchError


def test_repeated_names_are_refused() -> None:
    skeleton = person()
    with pytest.raises(MocapError, match="repeat"):
        replace(skeleton, names=("Hips", *skeleton.names[:-1]))


@pytest.mark.parametrize("parents", [[0, 0, 1], [-1, 2, 0], [-1, 0, 2], [1, -1, 0]])
def test_parents_come_before_their_children(parents: list[int]) -> None:
    with pytest.raises(MocapError, match="parents before"):
        replace(chain(3), parents=np.array(parents))


def test_the_family_of_a_joint() -> None:
    skeleton = person()
    names, index = skeleton.names, skeleton.index
    below = [names[j] for j in skeleton.descendants(index["LeftArm"])]
    assert below == ["LeftArm", "LeftForeArm", "LeftHand"]
    above = [names[j] for j in skeleton.ancestors(index["LeftForeArm"])]
    assert above == ["LeftArm", "LeftShoulder", "Chest", "Spine", "Hips"]
    assert skeleton.descendants(0) == list(range(len(skeleton)))
    assert skeleton.ancestors(0) == []
    for joint, below_it in enumerate(skeleton.children):
        assert all(skeleton.parents[child] == joint for child in below_it)
    assert sum(map(len, skeleton.children)) == len(skeleton) - 1
    ends = {name for name, below in zip(names, skeleton.children, strict=True) if not below}
    assert ends == {"Head", "LeftHand", "RightHand", "LeftFoot", "RightFoot"}


def test_joints_are_matched_by_name() -> None:
    mine, other = person(), person(fingers=True)
    np.testing.assert_array_equal(mine.match(other), [other.index[n] for n in mine.names])
    found = other.match(mine)
    for joint, at in enumerate(found):
        there = other.names[joint] in mine.index
        assert (mine.names[at] == other.names[joint]) if there else at == -1


def test_a_stranger_is_named() -> None:
    with pytest.raises(SkeletonMismatchError, match=r"19 of 19 joints.*Pelvis, Loin"):
        horse().match(chain())


def test_half_of_the_joints_are_enough_to_match() -> None:
    mine = chain(4)
    other = build([("c0", "", (0, 0, 0)), ("c1", "c0", (0, 1, 0)), ("x", "c1", (0, 1, 0))])
    np.testing.assert_array_equal(mine.match(other), [0, 1, -1, -1])
    with pytest.raises(SkeletonMismatchError):
        chain(5).match(other)
