"""The ways of repair: kriging, swaps undone, groups, ranges, the root's path."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_takes import faced, moved, turned, walking

from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.model import Flag, Kind
from mocapstudio.cleaning.proposals import apply, propose
from mocapstudio.cleaning.repair import kriging
from mocapstudio.cleaning.repair.group import together
from mocapstudio.cleaning.repair.kriging import Kernel
from mocapstudio.cleaning.repair.material import material
from mocapstudio.cleaning.repair.ranges import joint_ranges
from mocapstudio.cleaning.repair.regression import unwrapped
from mocapstudio.cleaning.repair.swap import MANNERS, exchanged
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION, split_heading
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take

LEGS = ("LeftUpLeg", "LeftLeg", "RightUpLeg", "RightLeg")


def flag(row: str, start: int, end: int, *others: str) -> Flag:
    joints = (row, *others)
    return Flag(f"{row}@{start}", row, joints, start, end, 0.9, start, 0.9, Kind.OFFSET)


def exchange(take: Take, names: tuple[str, ...], start: int, end: int, manner: str) -> Take:
    columns = [take.skeleton.index[name] for name in names]
    rotations = take.rotations.copy()
    rotations[start:end, columns] = exchanged(take, columns, start, end, manner)
    return take.with_motion(rotations)


@given(
    st.integers(1, 20),
    st.floats(0.05, 0.5),
    st.booleans(),
    st.floats(-3.0, 3.0),
    st.integers(0, 99),
)
@settings(max_examples=20)
def test_what_is_led_across_meets_both_flanks(
    gap: int, seconds: float, smooth: bool, level: float, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    slow = np.cumsum(np.cumsum(rng.normal(0, 1e-3, (90, 2)), axis=0), axis=0) + level
    usable = np.ones(90, dtype=bool)
    usable[40 : 40 + gap] = False
    spoilt = slow.copy()
    spoilt[~usable] = 1e6
    led = kriging.led_across(spoilt, usable, 40, 40 + gap, 30.0, Kernel(seconds, smooth))
    assert led.shape == (gap, 2)
    # A frame from either flank it is still near: 1/30 s is little to any of the kernels.
    near = 3 * np.abs(np.diff(slow, axis=0)).max() + 0.25 * np.abs(slow).max()
    assert np.abs(led[0] - slow[39]).max() < near
    assert np.abs(led[-1] - slow[40 + gap]).max() < near


def test_kriging_is_the_conditional_mean_of_a_gaussian() -> None:
    kernel, known, wanted = Kernel(0.2), np.array([0.0, 0.1, 0.5]), np.array([0.2, 0.3])
    at = np.concatenate([known, wanted])
    covariance = kernel(at[:, None] - at) + 1e-4 * np.eye(5)
    precision = np.linalg.inv(covariance)
    expected = -np.linalg.solve(precision[3:, 3:], precision[3:, :3])
    # The nugget of what is wanted has no part in its mean.
    np.testing.assert_allclose(kriging.weights(kernel, known, wanted), expected, atol=1e-9)


@given(st.floats(0.01, 0.5), st.integers(0, 99))
@settings(max_examples=15)
def test_turning_round_and_round_runs_on(step: float, seed: int) -> None:
    axis = np.random.default_rng(seed).normal(size=3)
    axis /= np.linalg.norm(axis)
    angles = 1.0 + step * np.arange(60)
    vectors = rot.to_rotation_vector(rot.from_rotation_vector(angles[:, None] * axis))
    found = unwrapped(vectors, np.ones(60, dtype=bool))
    np.testing.assert_allclose(np.diff(found @ axis), step, atol=1e-6)


@pytest.mark.parametrize("manner", MANNERS)
def test_an_exchange_is_its_own_inverse(take: Take, manner: str) -> None:
    twice = exchange(exchange(take, LEGS, 50, 80, manner), LEGS, 50, 80, manner)
    before, after = take_pose(take)[0], take_pose(twice)[0]
    np.testing.assert_allclose(after, before, atol=1e-6)


@pytest.mark.parametrize("manner", MANNERS)
def test_sides_exchanged_are_exchanged_back_by_one_proposal(
    take: Take, context: tuple[Take, ...], manner: str
) -> None:
    spoilt = exchange(take, LEGS, 100, 125, manner)
    columns = [take.skeleton.index[name] for name in LEGS]
    away = rot.angle(spoilt.rotations[100:125, columns], take.rotations[100:125, columns])
    assert np.rad2deg(away.mean()) > 10, "the exchange is no error here"
    flags = tuple(flag(name, 100, 125, *(n for n in LEGS if n != name)) for name in LEGS)
    analysis = replace(run(detect(spoilt, context)), flags=flags)
    proposal = propose(analysis, flags[0])
    assert proposal.method == "swap"
    assert set(proposal.joints) == set(LEGS)
    result = apply(spoilt, proposal)
    left = rot.angle(result.rotations[:, columns], take.rotations[:, columns])
    assert np.rad2deg(left).max() < 1.0
    # Where the flags do not know of each other, the exchange is found all the same.
    alone = replace(analysis, flags=tuple(replace(one, joints=(one.joint,)) for one in flags))
    assert propose(alone, alone.flags[0]).method == "swap"
    # The flags of the other joints then have nothing left to do.
    for other in flags[1:]:
        again = apply(result, propose(analysis, other, onto=result))
        np.testing.assert_array_equal(again.rotations, result.rotations)


def test_joints_wrong_against_each_other_are_repaired_at_once(
    take: Take, context: tuple[Take, ...]
) -> None:
    spoilt = turned(turned(take, "Spine", 100, 130, 60), "Chest", 100, 130, -60)
    flags = (flag("Spine", 100, 130), flag("Chest", 102, 130), flag("LeftLeg", 100, 130))
    analysis = replace(run(detect(spoilt, context)), flags=flags)
    assert [one.joint for one in together(analysis, flags[0], spoilt)] == ["Spine", "Chest"]
    proposal = propose(analysis, flags[0])
    assert proposal.joints == ("Spine", "Chest")
    result = apply(spoilt, proposal)
    columns = [take.skeleton.index[name] for name in proposal.joints]
    away = rot.angle(result.rotations[102:130, columns], take.rotations[102:130, columns])
    assert np.rad2deg(away.mean()) < 10


def test_no_repair_leaves_the_ranges_that_were_seen(take: Take, context: tuple[Take, ...]) -> None:
    joint = "LeftForeArm"
    spoilt = turned(take, joint, 100, 160, 70)
    analysis = replace(run(detect(spoilt, context)), flags=())
    one = flag(joint, 100, 160)
    known = material(analysis, one, spoilt)
    column = known.joints.index(joint)
    low, high = joint_ranges(known, context, column)
    for choice in (None, 0, 1):
        result = apply(spoilt, propose(analysis, one, choice))
        q = result.rotations[100:160, take.skeleton.index[joint]]
        vectors = rot.to_rotation_vector(rot.multiply(rot.conjugate(known.centre[column]), q))
        assert np.all(vectors > low - 1e-6) and np.all(vectors < high + 1e-6)


def test_errors_of_the_context_teach_the_repair_nothing(
    take: Take, context: tuple[Take, ...]
) -> None:
    joint = "LeftForeArm"
    first, *others = context
    analysis = run(detect(take, [turned(first, joint, 30, 60, 80), *others]))
    clean = run(detect(take, context))
    doubts = ((Declared(joint, 28, 62),), *(() for _ in others))
    one = flag(joint, 100, 130)
    ranges, spreads = [], []
    for each in (clean, analysis, replace(analysis, doubts=doubts)):
        known = material(each, one, take)
        column = known.joints.index(joint)
        ranges.append(joint_ranges(known, each.context, column, each.doubts))
        assert known.known is not None
        spreads.append(np.diag(known.known.covariance)[3 * column : 3 * column + 3].sum())
    # Poses are measured from the mean pose, which an error shifts by little.
    assert np.abs(ranges[1] - ranges[0]).max() > np.deg2rad(20)
    assert np.abs(ranges[2] - ranges[0]).max() < np.deg2rad(5)
    assert spreads[1] > 2 * spreads[0] > 1.6 * spreads[2]


@pytest.mark.parametrize("wider", [0, 1])
@pytest.mark.parametrize("degrees", [60.0, -150.0, 180.0])
def test_a_flipped_heading_keeps_its_own_motion(
    take: Take, context: tuple[Take, ...], degrees: float, wider: int
) -> None:
    spoilt = faced(take, 100, 125, degrees)
    proposal = propose(run(detect(spoilt, context)), flag(ROOT_HEADING, 100 - wider, 125 + wider))
    assert proposal.method == "turned back"
    away = split_heading(apply(spoilt, proposal))[0] - split_heading(take)[0]
    assert np.rad2deg(np.abs(np.angle(np.exp(1j * away)))).max() < 2


def test_a_lifted_body_comes_down_and_keeps_its_way(take: Take, context: tuple[Take, ...]) -> None:
    spoilt = moved(take, 100, 150, (0.0, 0.15, 0.0))
    proposal = propose(run(detect(spoilt, context)), flag(ROOT_POSITION, 100, 150))
    result = apply(spoilt, proposal)
    away = result.translations[:, 0] - take.translations[:, 0]
    assert np.abs(away[:, 1]).max() < 0.03
    assert np.abs(away[102:148, [0, 2]]).max() < 1e-9


def test_where_nothing_can_be_learnt_the_flanks_are_joined() -> None:
    take = walking(1.5, 30)
    spoilt = turned(take, "LeftArm", 18, 24, 60)
    proposal = propose(run(detect(spoilt)), flag("LeftArm", 18, 24))
    assert proposal.method in ("interpolation", "prediction")
    column = take.skeleton.index["LeftArm"]
    result = apply(spoilt, proposal)
    assert np.rad2deg(rot.angle(result.rotations[:, column], take.rotations[:, column])).max() < 25
