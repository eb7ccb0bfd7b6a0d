"""Joint weights: their file, their quality by definition, and what learning them is good for."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import naive_online as naive
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_takes import paced, walking

from mocapstudio.comparison.labels import Labels
from mocapstudio.comparison.model import Segment
from mocapstudio.comparison.online import Variant
from mocapstudio.comparison.online_reference import (
    MOTION,
    MOTION_WEIGHT,
    ROOT_WEIGHT,
    reference_of,
)
from mocapstudio.comparison.weights import FoldQuality, JointWeights, read_weights, write_weights
from mocapstudio.comparison.weights_examples import LabelledTake, example_set, repetitions
from mocapstudio.comparison.weights_quality import Example, Trials
from mocapstudio.comparison.weights_training import (
    PAPER,
    TrainingParameters,
    evolved,
    folds_of,
    surest,
    training,
)
from mocapstudio.comparison.weights_variance import variance_weights
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import FileError, MocapError, SkeletonMismatchError
from mocapstudio.motion.progress import run
from mocapstudio.similarity.online import kernels

NAMES = {Variant.PLAIN: "plain", Variant.DIAGONAL: "diagonal", Variant.PATH_LENGTH: "length"}


def labels(frames: int, name: str = "walk", rate: int = 30) -> Labels:
    """Four equal parts."""
    cuts = [round(frames * k / 4) for k in range(5)]
    parts = [Segment("abcd"[k], cuts[k], cuts[k + 1]) for k in range(4)]
    return Labels(name, Fraction(rate), tuple(parts))


def test_what_is_written_is_read(tmp_path: Path) -> None:
    fold = FoldQuality(("ann", "bob"), 0.9, 0.8, 0.7)
    learnt = JointWeights(
        {"Hips": 1.5, "Head": 0.0}, Variant.PATH_LENGTH, "t", (fold,), {"seed": 3}
    )
    write_weights(learnt, tmp_path / "w.json")
    assert read_weights(tmp_path / "w.json") == learnt


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("{", "1: is not JSON"),
        ("[]", "an object with weights"),
        ('{"weights": {"Hips": -1}}', "Hips is -1"),
        ('{"weights": {"Hips": "1"}}', "no number"),
        ('{"weights": {"Hips": NaN}}', "Hips is nan"),
        ('{"weights": {"Hips": 0}}', "no weight is above 0"),
        ('{"weights": {}}', "no weight is above 0"),
        ('{"weights": {"Hips": 1}, "variant": "round"}', "round"),
        ('{"weights": {"Hips": 1}, "folds": [{}]}', "performers is missing"),
    ],
)
def test_a_bad_file_is_said_in_one_line(tmp_path: Path, text: str, cause: str) -> None:
    (tmp_path / "w.json").write_text(text)
    with pytest.raises(FileError, match=cause) as error:
        read_weights(tmp_path / "w.json")
    assert "\n" not in str(error.value)


def test_weights_of_another_skeleton_are_refused() -> None:
    reference = reference_of(walking(1.0))
    with pytest.raises(SkeletonMismatchError):
        JointWeights({"pelvis": 3.0, "Head": 1.0}).fitting(reference)
    assert JointWeights({"Head": 2.0, "tail": 1.0}).fitting(reference) == {"Head": 2.0}
    assert JointWeights({"Head" + MOTION: 1.0}).motion


costs = st.tuples(st.integers(2, 7), st.integers(2, 7), st.integers(0, 10**6)).map(
    lambda given: np.random.default_rng(given[2]).integers(0, 33, given[:2]) / np.float32(16)
)


@given(costs, st.sampled_from(list(Variant)), st.booleans(), st.integers(1, 3))
@settings(max_examples=30)
def test_quality_is_the_share_of_cells_whose_segments_agree(
    matrix: np.ndarray, variant: Variant, closed: bool, sets: int
) -> None:
    rows, columns = matrix.shape
    source = np.arange(rows, dtype=np.int32) * 3 // rows
    source[0] = -1
    reference = np.arange(columns, dtype=np.int32) * 3 // columns
    stacked = np.stack([matrix * factor for factor in (1, 2, 4)[:sets]], axis=-1)
    seen = np.arange(1, rows + 1)
    out = np.empty((sets, rows))
    by_length, diagonal = variant is Variant.PATH_LENGTH, 1.0 + (variant is Variant.DIAGONAL)
    kernels.path_qualities(
        stacked.astype(np.float32), source, reference, seen, by_length, diagonal, closed, out
    )
    for count in seen:
        total, _, before = naive.matrices(matrix[:count], NAMES[variant])
        end = columns - 1 if closed else naive.open_end(total)
        cells = [(j, i) for j, i in naive.path(before, end) if source[i] >= 0]
        agree = sum(reference[j] == source[i] for j, i in cells)
        wanted = agree / len(cells) if cells else 1.0
        assert out[:, count - 1] == pytest.approx(wanted)


def test_trials_weigh_rows_as_equation_4_says() -> None:
    take, other = walking(2.0, seed=1), walking(1.5, seed=2)
    made = example_set(
        LabelledTake(take, labels(60)), [LabelledTake(other, labels(45))], motion=False
    )
    rng = np.random.default_rng(0)
    weights = rng.uniform(0, 2, (2, len(made.reference.names))).astype(np.float32)
    trials = Trials(made.reference, made.segments, made.examples, (0.5, 1.0))
    found = trials.qualities(weights)
    example = made.examples[0]
    for k, used in enumerate(weights):
        matrix = np.array(
            [[naive.pose_distance(a, b, used) for b in made.reference.rows] for a in example.rows]
        )
        total, _, before = naive.matrices(matrix, "plain")
        cells = naive.path(before, naive.open_end(total))
        wanted = np.mean([made.segments[j] == example.segments[i] for j, i in cells])
        # Single precision may take another of two nearly equal steps.
        assert found[0, k, 1] == pytest.approx(wanted, abs=0.02)


def test_variance_weights_follow_the_joint_that_moves() -> None:
    rows = np.tile(rot.IDENTITY, (2, 50, 3, 1))
    swing = np.sin(np.linspace(0, 6, 50))
    rows[:, :, 1] = rot.about_axis(0, 0.8 * swing)
    rows[:, :, 2] = rot.about_axis(1, 0.4 * swing)
    weights = variance_weights([one.astype(np.float32) for one in rows])
    np.testing.assert_allclose(weights, [0.0, 1.0, 0.25], atol=1e-3)


def test_performers_stay_together_and_takes_of_one_do_not_mix() -> None:
    empty = np.zeros((1, 1, 4), np.float32)
    none = np.zeros(1, np.int32)
    several = [Example(str(i), "xyzuvw"[i % 6], empty, none) for i in range(18)]
    folds = folds_of(several, 3, seed=1)
    assert sorted(k for fold in folds for k in fold) == list(range(18))
    owners = [{several[k].performer for k in fold} for fold in folds]
    assert sum(map(len, owners)) == 6
    one = [Example(str(i), "", empty, none) for i in range(10)]
    assert folds_of(one, 3, seed=1) == [(0, 1, 2, 3), (4, 5, 6), (7, 8, 9)]
    assert folds_of(one[:1], 3, seed=1) == []
    assert len(folds_of(one[:2], 5, seed=1)) == 2


def noisy_walks(count: int) -> list[LabelledTake]:
    """Walks at paces of their own, in which both arms do something else every time."""
    base = walking(4.0, seed=0, variation=0.0)
    arms = [j for j, name in enumerate(base.skeleton.names) if "Arm" in name or "Hand" in name]
    found = []
    for i in range(count):
        rng = np.random.default_rng(i)
        pace = 1.0 + 0.35 * np.sin(np.arange(base.frames) / 19.0 + i)
        take = paced(base, pace)
        truth = np.cumsum(pace)[: take.frames]
        time = np.arange(take.frames)[:, None] / 30
        angles = 1.3 * np.sin(rng.uniform(1, 4, len(arms)) * time + rng.uniform(0, 6, len(arms)))
        rotations = take.rotations.copy()
        rotations[:, arms] = rot.about_axis(0, angles)
        take = replace(take, name=f"walk {i}", rotations=rotations)
        cuts = [0, *(int(np.searchsorted(truth, 12 * k)) for k in range(1, 10)), take.frames]
        parts = [
            Segment("abc"[k % 3] + str(k), a, b) for k, (a, b) in enumerate(pairwise(cuts)) if b > a
        ]
        found.append(LabelledTake(take, Labels(take.name, Fraction(30), tuple(parts))))
    return found


def test_learning_finds_that_the_arms_say_nothing() -> None:
    walks = noisy_walks(9)
    made = example_set(walks[0], walks[1:], motion=False)
    kept, left_out = made.examples[:5], made.examples[5:]
    parameters = TrainingParameters(iterations=40, step=0.2, variance_start=False)
    learnt = run(evolved(made.reference, made.segments, kept, parameters))
    tested = Trials(made.reference, made.segments, left_out)
    both = np.stack([learnt.weights, np.ones_like(learnt.weights)])
    with_weights, without = tested.qualities(both, learnt.variant).mean(axis=(0, 2))
    assert with_weights > without + 0.02
    arms = [i for i, name in enumerate(made.reference.names) if "Arm" in name or "Hand" in name]
    legs = [i for i, name in enumerate(made.reference.names) if "Leg" in name]
    assert learnt.weights[arms].mean() < learnt.weights[legs].mean()


def test_a_training_is_cross_validated_and_repeatable() -> None:
    walks = noisy_walks(5)
    made = example_set(walks[0], walks[1:], motion=True)
    parameters = replace(PAPER, iterations=3, folds=2)
    first, again = (
        run(training(made.reference, made.segments, made.examples, parameters)) for _ in range(2)
    )
    assert first.weights == again.weights
    assert [fold.tested for fold in first.folds] == [(0, 1), (2, 3)]
    assert all(0 < fold.quality.test <= 1 for fold in first.folds)
    values = list(first.weights.weights.values())
    assert np.mean(values) == pytest.approx(1.0, abs=1e-5)
    assert min(values) >= 0
    with pytest.raises(MocapError, match="no labelled take"):
        run(training(made.reference, made.segments, (), parameters))


def test_a_take_that_repeats_its_action_gives_several() -> None:
    parts = [("down", 5, 20), ("up", 20, 40), ("down", 44, 60), ("up", 60, 75)]
    known = Labels("t", Fraction(30), tuple(Segment(*part) for part in parts))
    cut = repetitions(LabelledTake(walking(3.0), known, "ann"))
    assert [one.take.trim for one in cut] == [(5, 40), (44, 75)]
    assert {one.performer for one in cut} == {"ann"}
    once = LabelledTake(walking(3.0), labels(90))
    assert repetitions(once) == [once]


def test_other_weights_must_surpass_the_plain_ones_by_more_than_chance() -> None:
    rng = np.random.default_rng(0)
    plain = rng.uniform(0.7, 0.9, 12)
    surely = plain + 0.05 + rng.normal(0, 0.02, 12)
    by_chance = plain + 0.01 + rng.normal(0, 0.1, 12)
    rarely = plain.copy()
    rarely[3] += 0.9
    assert surest(np.stack([plain, by_chance, surely], axis=1)[None]) == (0, 2)
    assert surest(np.stack([plain, by_chance, rarely], axis=1)[None]) == (0, 0)
    alike = np.stack([plain, plain], axis=1)
    assert surest(np.stack([alike, alike])) == (0, 0)
    assert surest(np.stack([alike, np.stack([plain, surely], axis=1)])) == (1, 1)
    # Of one example nothing can be told.
    assert surest(np.array([[[0.5, 0.9]]])) == (0, 0)


def test_without_training_the_root_counts_more_where_motion_counts() -> None:
    take = walking(1.0)
    reference, poses = reference_of(take), reference_of(take, motion=False)
    hips = reference.names.index("Hips")
    count = len(reference.features.names)
    weights = reference.plain_weights
    assert weights[hips] == ROOT_WEIGHT > 1
    assert weights[count + hips] == ROOT_WEIGHT * MOTION_WEIGHT
    others = np.delete(np.arange(count), hips)
    assert set(weights[others]) == {1.0}
    assert set(weights[count + others]) == {MOTION_WEIGHT}
    assert set(poses.plain_weights) == {1.0}
