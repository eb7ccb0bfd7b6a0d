"""Online alignment: every step equals the batch result on the prefix, by definition."""

from __future__ import annotations

from fractions import Fraction

import naive_online as naive
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_takes import elsewhere, paced, walking
from scipy.spatial.transform import Rotation

from mocapstudio.comparison.labels import Labels
from mocapstudio.comparison.model import Segment
from mocapstudio.comparison.online import OnlineAligner, Variant
from mocapstudio.comparison.online_features import JointRotations
from mocapstudio.comparison.online_reference import MOTION, Reference, reference_of
from mocapstudio.motion.errors import MocapError, ParameterError

NAIVE = {Variant.PLAIN: "plain", Variant.DIAGONAL: "diagonal", Variant.PATH_LENGTH: "length"}


def any_reference(frames: int) -> Reference:
    poses = np.tile(np.float32([0, 0, 0, 1]), (frames, 1, 1))
    return Reference("made", JointRotations(("a",), None), poses, 30.0, Fraction(30))


# Sixteenths, so that sums are exact and ties are ties for both sides.
matrices = st.integers(3, 9).flatmap(
    lambda columns: st.lists(
        st.lists(st.integers(0, 32).map(lambda n: n / 16), min_size=columns, max_size=columns),
        min_size=1,
        max_size=9,
    ).map(lambda rows: np.array(rows, np.float32))
)


@given(matrices, st.sampled_from(list(Variant)))
@settings(max_examples=60)
def test_every_step_equals_the_batch_result_on_the_prefix(
    costs: np.ndarray, variant: Variant
) -> None:
    aligner = OnlineAligner(any_reference(costs.shape[1]), variant=variant, path_frames=20)
    for seen in range(1, len(costs) + 1):
        step = aligner.feed_costs(costs[seen - 1])
        total, length, before = naive.matrices(costs[:seen], NAIVE[variant])
        end = naive.open_end(total)
        assert step.at == end
        assert step.cost == pytest.approx(float(total[-1][end] / length[-1][end]), abs=1e-12)
        now, lengths = aligner.accumulated()
        assert now.tolist() == [float(value) for value in total[-1]]
        assert lengths.tolist() == length[-1]
        assert [tuple(pair) for pair in aligner.path().tolist()] == naive.path(before, end)


@given(matrices, st.integers(1, 4))
@settings(max_examples=30)
def test_a_short_memory_keeps_the_end_of_the_path(costs: np.ndarray, kept: int) -> None:
    reference = any_reference(costs.shape[1])
    whole, short = (OnlineAligner(reference, path_frames=n) for n in (20, kept))
    for row in costs:
        whole.feed_costs(row)
        short.feed_costs(row)
        pairs = whole.path().tolist()
        newest = pairs[-1][1]
        expected = [pair for pair in pairs if pair[1] > newest - kept]
        assert short.path().tolist() == expected


@pytest.mark.parametrize(("weighted", "motion"), [(False, False), (True, False), (True, True)])
def test_poses_are_compared_as_equations_1_and_4_say(weighted: bool, motion: bool) -> None:
    one, other = walking(2.0, seed=1), walking(1.0, seed=2)
    reference = reference_of(one, (other,), motion=motion)
    rng = np.random.default_rng(0)
    weights = {name: float(rng.uniform(0, 3)) for name in reference.names} if weighted else None
    aligner = OnlineAligner(reference, weights)
    used = [1.0 if weights is None else weights[name] for name in reference.names]
    expected = reference_of(other, motion=motion, features=reference.features).rows
    for i, pose in enumerate(reference.features.of(other)):
        step = aligner.feed(pose, i / 30)
        wanted = naive.pose_distance(expected[i], reference.rows[step.at], np.array(used))
        assert step.pose_cost == pytest.approx(wanted, abs=5e-5)


def test_motion_is_the_rotation_since_a_fifth_of_a_second_before() -> None:
    take = walking(2.0, seed=4)
    reference = reference_of(take)
    count = len(reference.features.names)
    assert reference.names[count] == reference.names[0] + MOTION
    head = reference.features.names.index("Head")
    own = Rotation.from_quat(take.rotations[:, take.skeleton.index["Head"]])
    for frame in (3, 6, 30, 59):
        expected = own[max(frame - 6, 0)].inv() * own[frame]
        found = Rotation.from_quat(reference.rows[frame, count + head])
        assert (expected.inv() * found).magnitude() < 2e-3


def test_neither_place_nor_heading_of_the_performer_counts() -> None:
    one, other = walking(3.0, seed=1), walking(3.0, seed=2)
    there = elsewhere(other, 140.0, (3.0, 0.0, -2.0))
    reference = reference_of(one, (other,))
    near, far = OnlineAligner(reference), OnlineAligner(reference)
    for a, b in zip(reference.features.of(other), reference.features.of(there), strict=True):
        here, elsewhere_ = near.feed(a), far.feed(b)
        assert elsewhere_.at == here.at
        assert elsewhere_.cost == pytest.approx(here.cost, abs=1e-4)


def test_a_known_pace_is_recovered_and_told_in_seconds() -> None:
    take = walking(8.0, seed=3)
    pace = 1.0 + 0.4 * np.sin(np.arange(take.frames) / 25.0)
    slower = paced(take, pace)
    truth = np.cumsum(pace)[: slower.frames]
    labels = Labels("t", Fraction(30), (Segment("a", 0, 100), Segment("b", 110, 240)))
    reference = reference_of(take)
    aligner = OnlineAligner(reference, labels=labels)
    steps = [aligner.feed(pose, i / 30) for i, pose in enumerate(reference.features.of(slower))]
    found = np.array([step.reference_frame for step in steps])
    # The open end follows within a frame or two once the walk has got going.
    assert np.median(np.abs(found - truth)[15:]) <= 1.0
    assert np.abs(found - truth)[15:].max() <= 4.0
    ahead = np.array([step.misalignment for step in steps])
    np.testing.assert_allclose(ahead, (found - np.arange(len(found))) / 30, atol=1e-9)
    assert [step.label for step in steps] == [labels.at(frame) for frame in found]
    assert [step.ready for step in steps[:4]] == [False, False, True, True]


def test_another_rate_of_alignment_keeps_the_takes_own_frames() -> None:
    fast, slow = walking(4.0, rate=120, seed=5), walking(4.0, rate=30, seed=5)
    reference = reference_of(fast, (slow,), rate=30)
    assert len(reference) == 120
    aligner = OnlineAligner(reference)
    found = [aligner.feed(pose).reference_frame for pose in reference.features.of(slow)]
    np.testing.assert_allclose(found, 4 * np.arange(120), atol=4)


def test_restarted_it_knows_nothing_of_before() -> None:
    take, other = walking(2.0, seed=1), walking(2.0, seed=2)
    reference = reference_of(take, (other,))
    poses = reference.features.of(other)
    fresh, used = OnlineAligner(reference, path_frames=99), OnlineAligner(reference, path_frames=99)
    for pose in reference.features.of(take):
        used.feed(pose)
    used.restart()
    for pose in poses:
        assert fresh.feed(pose) == used.feed(pose)
    assert fresh.path().tolist() == used.path().tolist()


def test_joints_that_are_missing_for_a_while_do_not_stop_it() -> None:
    take = walking(4.0, seed=1)
    reference = reference_of(take)
    poses = reference.features.of(take)
    poses[20:60, 3:9] = np.nan
    poses[40:45] = np.nan
    aligner = OnlineAligner(reference)
    steps = [aligner.feed(pose) for pose in poses]
    assert [step is None for step in steps] == [40 <= i < 45 for i in range(len(poses))]
    off = [0 if step is None else abs(step.reference_frame - i) for i, step in enumerate(steps)]
    assert max(off[:40]) == 0
    assert max(off[60:]) <= 1


def test_wrong_weights_and_a_path_that_is_not_kept_are_refused() -> None:
    reference = reference_of(walking(1.0))
    for weights in ({"Nobody": 1.0}, {"Head": -1.0}, {"Head": float("nan")}, {"Head": 0.0}):
        with pytest.raises(ParameterError):
            OnlineAligner(reference, weights)
    with pytest.raises(MocapError, match="path"):
        OnlineAligner(reference).path()


@pytest.mark.parametrize(
    ("variant", "pattern"), [(Variant.PLAIN, "symmetric1"), (Variant.DIAGONAL, "symmetric2")]
)
def test_accumulated_costs_are_those_of_dtw_python(variant: Variant, pattern: str) -> None:
    dtw = pytest.importorskip("dtw", reason="dtw-python is a peer, not a dependency")
    costs = np.random.default_rng(1).random((40, 55)).astype(np.float32)
    aligner = OnlineAligner(any_reference(55), variant=variant)
    peer = dtw.dtw(costs.astype(float), step_pattern=pattern, keep_internals=True)
    for row, wanted in zip(costs, peer.costMatrix, strict=True):
        aligner.feed_costs(row)
        np.testing.assert_allclose(aligner.accumulated()[0], wanted, atol=1e-9)
