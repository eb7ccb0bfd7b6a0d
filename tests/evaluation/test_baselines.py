from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mocapstudio.cleaning.model import Kind
from mocapstudio.evaluation.baselines import learn, learnt_and_tuned
from mocapstudio.evaluation.cases import Case
from mocapstudio.evaluation.detection_benchmark import Detection, evaluate_detector
from mocapstudio.evaluation.injection import corrupt, inject
from mocapstudio.evaluation.map_detector import detector_of, flags_above, tuned
from mocapstudio.motion import rotations as rot


@pytest.fixture(scope="module")
def clean(make_take):
    return [make_take(8.0, seed=0), make_take(5.0, seed=0)]


def test_what_was_learnt_from_lies_within_the_limits(clean) -> None:
    limits = learn(clean)
    for take in clean:
        assert limits.beyond_limits(take)[1].max() == 0.0
        rows, speeds = limits.too_fast(take)
        share = (speeds > 0.5 + 1e-9).mean(axis=0)
        assert share.max() < 0.01
        assert rows == limits.rows


def test_a_joint_turned_beyond_its_range_is_found_by_how_far(clean) -> None:
    take, limits = clean[0], replace(learn(clean), margin=5.0)
    joint = take.skeleton.index["Chest"]
    away = rot.to_rotation_vector(
        rot.multiply(
            rot.conjugate(limits.centre[limits.rows.index("Chest")]), take.rotations[:, joint]
        )
    )
    rotations = take.rotations.copy()
    centre = limits.centre[limits.rows.index("Chest")]
    target = np.degrees(away[100]) * 0.0
    target[0] = limits.high[limits.rows.index("Chest"), 0] + 15.0
    rotations[100, joint] = rot.multiply(centre, rot.from_rotation_vector(np.radians(target)))
    _, values = limits.beyond_limits(take.with_motion(rotations))
    assert values[100, limits.rows.index("Chest")] == pytest.approx(15 / 20)
    assert (values > 0).sum() == 1


def test_a_leap_is_too_fast_at_both_edges(clean) -> None:
    take = clean[0]
    dirty, truth = inject(take, Kind.FLIP, np.random.default_rng(0), joints=["Chest"])
    limits = learn(clean)
    column = limits.rows.index("Chest")
    before, values = limits.too_fast(take)[1], limits.too_fast(dirty)[1]
    flagged = np.flatnonzero((values[:, column] > 0.5) & (before[:, column] <= 0.5))
    edges = {truth.start - 1, truth.start, truth.end - 1, truth.end}
    assert edges <= set(flagged)
    assert flagged.min() == truth.start - 1
    assert flagged.max() == truth.end


def test_tuning_takes_the_best_on_the_training_cases(clean) -> None:
    training = []
    for seed in range(3):
        dirty, truths = corrupt(
            clean[0], np.random.default_rng(seed), 30.0, [Kind.FLIP, Kind.SPIKE]
        )
        training.append(Case(dirty, clean[0], truths, tuple(clean)))
    limits = learn(clean)
    margins = {m: replace(limits, margin=m).beyond_limits for m in (0.1, 10.0, 170.0)}
    best = tuned(margins, training)
    scores = {
        m: evaluate_detector(detector_of(one), training).scores.words.f1
        for m, one in margins.items()
    }
    assert scores[best] == max(scores.values())
    assert scores[best] > scores[170.0]
    rows = learnt_and_tuned(clean, training)
    f1 = {name: evaluate_detector(one, training).scores.words.f1 for name, one in rows.items()}
    assert set(f1) == {"(a) joint limits", "(b) derivative", "(c) both"}
    untuned = {
        "(a) joint limits": limits.beyond_limits,
        "(b) derivative": limits.too_fast,
        "(c) both": limits.either,
    }
    for name, one in untuned.items():
        assert f1[name] >= evaluate_detector(detector_of(one), training).scores.words.f1


def test_flags_are_runs_above_the_threshold() -> None:
    values = np.zeros((60, 2))
    values[10:15, 0], values[17:20, 0], values[40:42, 0] = 0.7, 0.9, 0.6
    values[30, 1] = 0.55
    found = flags_above(values, ("a", "b"), 0.5, 30.0)
    assert [(f.joint, f.start, f.end, f.peak_frame, f.score) for f in found] == [
        ("a", 10, 20, 17, 0.9), ("a", 40, 42, 40, 0.6), ("b", 30, 31, 30, 0.55),
    ]  # fmt: skip
    assert [f.start for f in flags_above(values, ("a", "b"), 0.65, 30.0)] == [10]


def test_the_curve_runs_from_all_to_nothing(make_take) -> None:
    take = make_take(10.0)
    dirty, truths = corrupt(take, np.random.default_rng(1), 30.0)
    case = Case(dirty, take, truths, ())
    values = case.mask() * 0.6 + 0.3
    result = evaluate_detector(detector_of(lambda t, c: (case.rows, values)), [case])
    curve = result.scores.curve
    assert curve[0.25][0].precision < 1.0
    assert curve[0.5][0].recall == curve[0.5][0].precision == 1.0
    assert curve[0.95][0].recall == 0.0
    assert isinstance(detector_of(lambda t, c: (case.rows, values))(dirty, ()), Detection)
