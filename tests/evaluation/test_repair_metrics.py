from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mocapstudio.cleaning.model import Kind
from mocapstudio.evaluation.cases import Case
from mocapstudio.evaluation.injection import corrupt, inject
from mocapstudio.evaluation.repair_benchmark import RepairScores
from mocapstudio.evaluation.repair_metrics import changed_outside, event_errors, jerk, looks
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.facing import ROOT_POSITION


def test_squared_sums_agree_with_summing_by_hand(make_take) -> None:
    take = make_take(20.0)
    kinds = (Kind.OFFSET, Kind.FLIP, Kind.LIMB)
    dirty, truths = corrupt(take, np.random.default_rng(3), 20.0, kinds)
    repaired = dirty.with_motion(rot.slerp(dirty.rotations, take.rotations, 0.6))
    case = Case(dirty, take, truths, ())
    mask = case.mask()
    errors = event_errors(case, repaired)
    assert len(errors) == len(truths) >= 4
    for truth, error in zip(truths, errors, strict=True):
        if "Hips" in truth.joints:
            continue
        bodies, singles = [], []
        for frame in range(truth.start, truth.end):
            here = [j for j in truth.joints if mask[frame, case.rows.index(j)]]
            if not here:
                continue
            a = Rotation.from_quat(take.rotations[frame])
            b = Rotation.from_quat(repaired.rotations[frame])
            halves = {
                n: ((a.inv() * b).magnitude()[k] / 2) ** 2
                for k, n in enumerate(take.skeleton.names)
            }
            bodies.append(sum(halves.values()))
            singles += [halves[j] for j in here]
        assert error.body_mean == pytest.approx(np.mean(bodies), rel=1e-6)
        assert error.body_max == pytest.approx(max(bodies), rel=1e-6)
        assert error.joint_mean == pytest.approx(np.mean(singles), rel=1e-6)
        assert error.joint_max == pytest.approx(max(singles), rel=1e-6)
        assert error.degrees_mean == pytest.approx(
            np.mean([math.degrees(2 * math.sqrt(x)) for x in singles]), rel=1e-6
        )


def test_nothing_is_left_of_a_perfect_repair(take) -> None:
    dirty, truth = inject(take, Kind.ROOT_POP, np.random.default_rng(0), magnitude=12.0)
    case = Case(dirty, take, (truth,), ())
    (before,), (after,) = event_errors(case, dirty), event_errors(case, take)
    assert before.centimetres == pytest.approx(12.0, rel=0.3)
    assert after.centimetres == 0.0
    assert after.body_max < 1e-12
    assert math.isnan(after.joint_mean)


def test_changes_outside_what_was_declared_are_counted(take) -> None:
    rotations, translations = take.rotations.copy(), take.translations.copy()
    rotations[10:14, 3] = rot.multiply(rotations[10:14, 3], rot.about_axis(0, 0.01))
    rotations[20:30, 5] *= -1
    translations[50, 0] += 1e-6
    changed = take.with_motion(rotations, translations)
    name = take.skeleton.names[3]
    assert changed_outside(take, changed, []) == 5
    assert changed_outside(take, changed, [Declared(name, 11, 14)]) == 2
    assert (
        changed_outside(take, changed, [Declared(name, 0, 99), Declared(ROOT_POSITION, 50, 51)])
        == 0
    )


def test_jerk_of_a_cubic_path_is_its_constant() -> None:
    time = np.arange(30) / 60.0
    path = np.stack([2.0 * time**3, 0 * time, time**2], axis=1)[:, None]
    assert jerk(path, 60.0) == pytest.approx(12.0, rel=1e-6)


def test_rotations_do_not_stretch_bones_and_translations_do(make_take) -> None:
    take = make_take(5.0)
    dirty, truth = inject(take, Kind.FLIP, np.random.default_rng(0))
    case = Case(dirty, take, (truth,), ())
    assert looks(case, dirty, []).stretch == pytest.approx(0.0, abs=1e-9)
    local = np.broadcast_to(take.skeleton.offsets[3], (take.frames, 1, 3))
    both = np.concatenate([take.translations, local], axis=1)
    free = replace(take, translated=(0, 3), translations=both)
    longer = both.copy()
    longer[10, 1] *= 1.1
    case = Case(free, free, (), ())
    length = 1000 * np.linalg.norm(take.skeleton.offsets[3])
    got = looks(case, free.with_motion(translations=longer), [])
    assert got.stretch == pytest.approx(0.1 * length)
    assert got.changed == 1


def test_a_sliding_foot_is_measured_where_the_clean_one_stands(make_take) -> None:
    take = make_take(5.0, still=True)
    stand = take.with_motion(
        np.broadcast_to(rot.IDENTITY, take.rotations.shape).copy(),
        np.broadcast_to([[0.0, 0.9, 0.0]], take.translations.shape).copy(),
    )
    slid = stand.translations.copy()
    slid[:, 0, 0] += 0.4 * np.arange(take.frames) / 30
    case = Case(stand, stand, (), ())
    assert looks(case, stand, []).slide == pytest.approx(0.0)
    assert looks(case, stand.with_motion(translations=slid), []).slide == pytest.approx(0.4)


def test_means_weigh_by_frames_and_leave_out_what_is_not_there(take) -> None:
    dirty, truth = inject(take, Kind.ROOT_POP, np.random.default_rng(0))
    root = event_errors(Case(dirty, take, (truth,), ()), dirty)[0]
    joint = replace(root, kind=Kind.OFFSET, degrees_mean=10.0, degrees_max=20.0, frames=30)
    other = replace(joint, kind=Kind.FLIP, degrees_mean=40.0, degrees_max=50.0, frames=10)
    row = RepairScores("x", (root, joint, other))
    assert row.mean("degrees_mean") == pytest.approx(17.5)
    assert row.mean("degrees_max") == pytest.approx(35.0)
    assert row.of_kind(Kind.FLIP).mean("degrees_mean") == 40.0
    assert math.isnan(row.of_kind(Kind.ROOT_POP).mean("degrees_mean"))
