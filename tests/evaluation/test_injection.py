from __future__ import annotations

import json
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mocapstudio.cleaning.model import Kind
from mocapstudio.evaluation import shapes, swaps
from mocapstudio.evaluation.cases import Conditions, cases
from mocapstudio.evaluation.injection import (
    KINDS,
    InjectionError,
    Truth,
    apply,
    corrupt,
    erroneous,
    inject,
    recur,
)
from mocapstudio.evaluation.truth import analysed_rows, departure
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take

HELD_STILL = {Kind.FREEZE, Kind.GAP, Kind.SWAP}
BOTH = st.sampled_from(shapes.FAMILIES)


def outside(take: Take, truth: Truth) -> np.ndarray:
    mask = np.ones(take.frames, dtype=bool)
    mask[truth.start : truth.end] = False
    return mask


@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
@given(kind=st.sampled_from(KINDS), seed=st.integers(0, 9999), family=BOTH)
def test_only_the_declared_span_and_rows_depart(make_take, kind, seed, family) -> None:
    take = make_take(10.0, 120, seed=seed % 3)
    spoilt, truth = inject(take, kind, np.random.default_rng(seed), family=family)
    rest = outside(take, truth)
    assert np.array_equal(spoilt.rotations[rest], take.rotations[rest])
    assert np.array_equal(spoilt.translations[rest], take.translations[rest])
    rows = analysed_rows(take.skeleton)
    wrong = erroneous(take, spoilt, [truth], rows)
    assert {row for i, row in enumerate(rows) if wrong[:, i].any()} == set(truth.joints)
    assert np.allclose(np.linalg.norm(spoilt.rotations, axis=-1), 1.0)


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(kind=st.sampled_from(KINDS), seed=st.integers(0, 9999), family=BOTH)
def test_a_truth_read_back_from_json_repeats_the_error(make_take, kind, seed, family) -> None:
    take = make_take(10.0, 60)
    spoilt, truth = inject(take, kind, np.random.default_rng(seed), family=family)
    again = Truth.from_json(json.loads(json.dumps(truth.to_json())))
    assert again == truth
    repeated = apply(take, again)
    assert np.array_equal(repeated.rotations, spoilt.rotations)
    assert np.array_equal(repeated.translations, spoilt.translations)


@pytest.mark.parametrize("family", shapes.FAMILIES)
@pytest.mark.parametrize("kind", [k for k in KINDS if k not in HELD_STILL])
def test_the_largest_departure_is_the_magnitude(take, kind, family) -> None:
    size = 25.0
    spoilt, truth = inject(take, kind, np.random.default_rng(3), magnitude=size, family=family)
    rows = analysed_rows(take.skeleton)
    # The hips' turn is split between tilt and heading.
    names = [n for n in truth.joints if n != "Hips"] or ["Hips"]
    away = departure(take, spoilt, names)
    assert away.max() == pytest.approx(size, rel=0.05)
    assert set(truth.joints) <= set(rows)


def test_spans_are_as_long_as_stated_at_any_rate(make_take: Callable[..., Take]) -> None:
    for rate in (30, 60, 120):
        take = make_take(12.0, rate)
        for seed in range(8):
            rng = np.random.default_rng(seed)
            spike = inject(take, Kind.SPIKE, rng)[1]
            assert 2 * rate / 24 - 1 <= spike.end - spike.start <= 4 * rate / 24 + 1
            offset = inject(take, Kind.OFFSET, rng)[1]
            assert 8 * rate / 24 - 1 <= offset.end - offset.start <= 30 * rate / 24 + 1
            pop = inject(take, Kind.POP, rng)[1]
            assert 1 <= pop.end - pop.start <= 3


@pytest.mark.parametrize("family", shapes.FAMILIES)
def test_jitter_lies_above_12_hertz_and_a_noise_burst_below(make_take, family) -> None:
    take = make_take(12.0, 120)

    def centre(kind: Kind) -> float:
        spoilt, truth = inject(
            take, kind, np.random.default_rng(5), joints=["Spine"], family=family
        )
        span = slice(truth.start, truth.end)
        joint = take.skeleton.index["Spine"]
        turn = rot.multiply(
            rot.conjugate(take.rotations[span, joint]), spoilt.rotations[span, joint]
        )
        power = (np.abs(np.fft.rfft(rot.to_rotation_vector(turn), n=1024, axis=0)) ** 2).sum(axis=1)
        hertz = np.fft.rfftfreq(1024, 1 / 120)
        return float(power[hertz >= 10].sum() / power.sum())

    assert centre(Kind.JITTER) > 0.9
    if family == "standard":
        assert centre(Kind.NOISE) < 0.3


def test_a_gap_is_the_straight_way_between_its_ends(take) -> None:
    spoilt, truth = inject(take, Kind.GAP, np.random.default_rng(1), joints=["LeftForeArm"])
    joint = take.skeleton.index["LeftForeArm"]
    run = spoilt.rotations[truth.start - 1 : truth.end + 1, joint]
    steps = rot.angle(run[1:], run[:-1])
    assert np.allclose(steps, steps[0])
    assert steps.sum() == pytest.approx(rot.angle(run[0], run[-1]))


def test_a_freeze_holds_and_then_rejoins(take) -> None:
    spoilt, truth = inject(take, Kind.FREEZE, np.random.default_rng(1), joints=["LeftForeArm"])
    joint = take.skeleton.index["LeftForeArm"]
    run = spoilt.rotations[truth.start - 1 : truth.end, joint]
    held = (truth.end - truth.start) * 3 // 4
    assert np.allclose(rot.angle(run[1:held], run[:1]), 0.0, atol=1e-6)
    ends = departure(take, spoilt, ["LeftForeArm"])[truth.end - 1, 0]
    assert ends < departure(take, spoilt, ["LeftForeArm"]).max() / 2


def test_root_errors_move_the_body_as_one(take) -> None:
    before, _ = take_pose(take)
    for kind in (Kind.ROOT_POP, Kind.HEIGHT_DRIFT):
        spoilt, truth = inject(take, kind, np.random.default_rng(2), magnitude=20.0)
        assert truth.joints == (ROOT_POSITION,)
        moved = take_pose(spoilt)[0] - before
        assert np.allclose(moved, moved[:, :1])
        assert np.linalg.norm(moved[:, 0], axis=1).max() == pytest.approx(0.2)
        if kind is Kind.HEIGHT_DRIFT:
            assert np.allclose(moved[..., [0, 2]], 0.0)


def test_a_heading_flip_leaves_place_and_tilt(take) -> None:
    spoilt, truth = inject(take, Kind.HEADING_FLIP, np.random.default_rng(2), magnitude=90.0)
    assert truth.joints == (ROOT_HEADING,)
    away = departure(take, spoilt, ["Hips", ROOT_POSITION, ROOT_HEADING])
    assert away[:, 0].max() < 0.01
    assert away[:, 1].max() < 1e-9
    assert away[truth.start, 2] == pytest.approx(90.0)


def test_swapped_labels_exchange_the_directions_of_bones(take) -> None:
    skeleton = take.skeleton
    joints = ["LeftArm", "LeftForeArm", "RightArm", "RightForeArm"]
    before, _ = take_pose(take)
    for seed in range(20):
        spoilt, truth = inject(take, Kind.SWAP, np.random.default_rng(seed), joints=["LeftArm"])
        if truth.params["manner"] != swaps.LABELS:
            continue
        after, _ = take_pose(spoilt)
        span = slice(truth.start, truth.end)

        def bone(positions, name):
            j = skeleton.index[name]
            return (positions[:, skeleton.children[j][0]] - positions[:, j])[span]  # noqa: B023

        for name in joints:
            mirror = (
                name.replace("Left", "Right") if "Left" in name else name.replace("Right", "Left")
            )
            assert np.allclose(bone(after, name), bone(before, mirror), atol=1e-9)
        return
    pytest.fail("no swap of labels was drawn")


def test_a_mirrored_swap_done_twice_is_no_swap(make_take) -> None:
    take = make_take(8.0)
    joints = [take.skeleton.index[n] for n in ("LeftUpLeg", "LeftLeg", "RightUpLeg", "RightLeg")]
    once = take.rotations.copy()
    swaps.swap(take, 0, joints, swaps.MIRRORED, once)
    twice = once.copy()
    swaps.swap(take.with_motion(once), 0, joints, swaps.MIRRORED, twice)
    start, end = take_pose(take)[0], take_pose(take.with_motion(twice))[0]
    feet = [take.skeleton.index[n] for n in ("LeftFoot", "RightFoot")]
    assert np.allclose(start[:, feet], end[:, feet], atol=1e-6)
    assert np.abs(take_pose(take.with_motion(once))[0][:, feet] - start[:, feet]).max() > 0.05


def test_errors_keep_apart_and_repeat_from_the_seed(make_take) -> None:
    take = make_take(60.0)
    spoilt, truths = corrupt(take, np.random.default_rng(7), 20.0)
    again, same = corrupt(take, np.random.default_rng(7), 20.0)
    assert truths == same
    assert np.array_equal(spoilt.rotations, again.rotations)
    assert len(truths) >= 15
    for before, after in pairwise(truths):
        assert after.start - before.end >= 12 * 30 // 24
    assert truths[0].start >= 4
    assert truths[-1].end <= take.frames - 4
    step = take
    for truth in truths:
        step = apply(step, truth)
    assert np.allclose(rot.angle(step.rotations, spoilt.rotations), 0.0, atol=1e-6)


def test_no_errors_a_minute_is_a_negative_control(take) -> None:
    same, truths = corrupt(take, np.random.default_rng(0), 0.0)
    assert truths == ()
    assert not erroneous(take, same).any()


def test_the_same_error_recurs(make_take) -> None:
    take = make_take(30.0)
    spoilt, truth = inject(take, Kind.OFFSET, np.random.default_rng(4))
    many, truths = recur(spoilt, truth, np.random.default_rng(5), 3)
    assert len(truths) == 4
    away = departure(take, many, truth.joints)
    peaks = [away[t.start : t.end].max() for t in truths]
    assert np.allclose(peaks, peaks[0], rtol=0.02)


def test_pops_below_ten_degrees_count_by_their_span(take) -> None:
    spoilt, truth = inject(take, Kind.POP, np.random.default_rng(0), magnitude=6.0)
    assert not erroneous(take, spoilt).any()
    wrong = erroneous(take, spoilt, [truth], truth.joints)
    assert np.flatnonzero(wrong.all(axis=1)).tolist() == list(range(truth.start, truth.end))


def test_what_cannot_be_injected_is_refused(make_take) -> None:
    rng = np.random.default_rng(0)
    with pytest.raises(InjectionError, match="24 frames a second"):
        inject(make_take(10.0, 24), Kind.JITTER, rng)
    with pytest.raises(InjectionError, match="no place"):
        inject(make_take(0.5), Kind.DRIFT, rng)
    with pytest.raises(InjectionError, match="no place"):
        inject(make_take(10.0, still=True), Kind.FREEZE, rng)


def test_errors_find_their_place_in_real_takes(data) -> None:
    many = Conditions(errors_per_minute=30.0)
    for case in cases(data, "locomotion", "local", count=2, conditions=many):
        assert len(case.truths) >= 3
        mask = case.mask()
        for truth in case.truths:
            at = [case.rows.index(row) for row in truth.joints]
            assert mask[truth.start : truth.end, at].any(axis=0).all()
