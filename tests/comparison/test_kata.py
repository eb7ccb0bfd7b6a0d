"""The kata comparison from recordings to misalignment (paper 4)."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from made_takes import elsewhere, horse, paced, person, turned, walking

from mocapstudio import formats
from mocapstudio.comparison.kata import compare
from mocapstudio.comparison.model import Comparison
from mocapstudio.comparison.parameters import (
    BOX,
    PAPER,
    ROOT,
    ROTATIONS,
    ComparisonParameters,
)
from mocapstudio.evaluation.kata_warps import Disturbance, WarpedTake, perform_again
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError, SkeletonMismatchError
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take


def dance(seconds: float = 12.0, rate: int = 30, seed: int = 0) -> Take:
    """A motion of which no part is like another: slow random turns of every joint."""
    rng = np.random.default_rng(seed)
    skeleton = person()
    time = np.arange(round(seconds * rate)) / rate
    angles = np.zeros((len(time), len(skeleton), 3))
    for frequency in (0.13, 0.31, 0.52):
        phase = rng.uniform(0, 2 * np.pi, (1, len(skeleton), 3))
        size = rng.normal(0, 0.35, (1, len(skeleton), 3))
        angles += size * np.sin(2 * np.pi * frequency * time[:, None, None] + phase)
    places = np.tile([0.0, 0.9, 0.0], (len(time), 1, 1))
    rotations = rot.continuous(rot.from_rotation_vector(angles))
    return Take(f"dance {seed}", skeleton, rotations, places, Fraction(rate))


def as_markers(take: Take, name: str = "markers") -> MarkerTake:
    return MarkerTake(name, take.skeleton.names, take_pose(take)[0], take.rate)


def check(found: Comparison, reference: Take | MarkerTake, source: Take | MarkerTake) -> None:
    """What must hold of every comparison."""
    rows = len(found.rows)
    assert found.reference_poses.shape == (reference.frames, rows, 3)
    assert found.source_poses.shape == (source.frames, rows, 3)
    assert found.joint_difference.shape == (source.frames, rows)
    for one in (
        found.warp,
        found.misalignment,
        found.misalignment_relative,
        found.timing,
        found.pose_difference,
    ):
        assert one.shape == (source.frames,)
        assert np.isfinite(one).all()
    steps = np.diff(found.path, axis=0)
    assert set(map(tuple, steps.tolist())) <= {(1, 1), (1, 0), (0, 1)}
    assert found.path[0].tolist() == [reference.span[0], source.span[0]]
    assert found.path[-1].tolist() == [reference.span[1] - 1, source.span[1] - 1]
    assert found.dissimilarity >= 0


@pytest.mark.parametrize("features", [BOX, ROOT, ROTATIONS])
@pytest.mark.parametrize("true_speed", [False, True])
def test_a_take_is_on_time_with_itself(features: str, true_speed: bool) -> None:
    take = dance()
    chosen = ComparisonParameters(features=features, true_speed=true_speed)
    found = run(compare(take, take, chosen))
    check(found, take, take)
    assert found.dissimilarity == 0
    assert not found.misalignment.any()
    assert not found.misalignment_relative.any()
    assert not found.timing.any()
    np.testing.assert_allclose(found.pose_difference, 0, atol=1e-6)
    assert found.warnings == ()


@pytest.mark.parametrize("features", [BOX, ROOT, ROTATIONS])
def test_place_direction_and_size_do_not_matter(features: str) -> None:
    take = dance()
    moved = elsewhere(take, 130, (3.0, 0.0, -2.0))
    large = replace(
        moved,
        skeleton=replace(moved.skeleton, offsets=1.4 * moved.skeleton.offsets),
        translations=1.4 * moved.translations,
    )
    found = run(compare(take, large, ComparisonParameters(features=features)))
    assert found.dissimilarity < 1e-5
    np.testing.assert_allclose(found.reference_poses, found.source_poses, atol=1e-5)


def test_positions_lie_in_the_unit_box_with_the_neck_at_its_centre() -> None:
    take = dance()
    found = run(compare(take, take))
    assert found.reference_poses.min() >= 0
    assert found.reference_poses.max() <= 1
    touches = np.abs(found.reference_poses - 0.5).max()
    assert touches == pytest.approx(0.5)
    neck, head = found.rows.index("Neck"), found.rows.index("Head")
    np.testing.assert_allclose(found.reference_poses[:, neck], 0.5, atol=1e-6)
    np.testing.assert_allclose(found.reference_poses[:, head, :2], 0.5, atol=1e-6)
    assert (found.reference_poses[:, head, 2] > 0.5).all()


@pytest.fixture(scope="module")
def again() -> tuple[Take, WarpedTake]:
    take = dance(20.0)
    return take, perform_again(take, Disturbance(pace=1.4, pauses=1), 3)


@pytest.mark.parametrize(
    "chosen",
    [
        ComparisonParameters(),
        ComparisonParameters(true_speed=True),
        ComparisonParameters(features=ROOT),
        ComparisonParameters(features=ROTATIONS),
        PAPER,
    ],
    ids=["box", "true speed", "root", "rotations", "paper"],
)
def test_known_timing_is_found(
    again: tuple[Take, WarpedTake], chosen: ComparisonParameters
) -> None:
    take, known = again
    found = run(compare(take, known.take, chosen))
    check(found, take, known.take)
    error = np.abs(found.warp - known.truth) / float(take.rate) * 25
    assert np.median(error) < 2
    assert not [w for w in found.warnings if "doubtful" in w]


def test_misalignment_follows_from_the_path(again: tuple[Take, WarpedTake]) -> None:
    take, known = again
    found = run(compare(take, known.take))
    rate = float(take.rate)
    for frame in range(0, known.take.frames, 17):
        matched = found.path[found.path[:, 1] == frame, 0]
        assert found.misalignment[frame] == pytest.approx((matched.mean() - frame) / rate)
        assert found.warp[frame] == pytest.approx(matched.mean())
        tempo = (take.frames - 1) / (known.take.frames - 1)
        relative = (matched.mean() - frame * tempo) / rate
        assert found.misalignment_relative[frame] == pytest.approx(relative, abs=1e-9)


def test_who_hurries_is_hastened_and_who_lingers_delayed() -> None:
    take = dance(20.0)
    pace = np.concatenate([np.full(150, 1.0), np.full(100, 1.8), np.full(400, 0.6)])
    source = paced(take, pace)
    found = run(compare(take, source, ComparisonParameters(true_speed=True)))
    assert (found.timing[20:130] == 0).mean() > 0.9
    assert (found.timing[165:235] == 1).mean() > 0.9
    assert (found.timing[265:380] == -1).mean() > 0.9
    # Positive slope is hastened (paper 4, section 4.2).
    gains = np.diff(found.misalignment)
    assert gains[160:240].sum() > 0 > gains[265:380].sum()


def test_ten_times_slower_is_aligned_and_said() -> None:
    take = dance(6.0)
    slow = paced(take, np.full(1790, 0.1))
    for true_speed in (False, True):
        found = run(compare(take, slow, ComparisonParameters(true_speed=true_speed)))
        check(found, take, slow)
        error = np.abs(found.warp - 0.1 * np.arange(1, slow.frames + 1))
        assert np.median(error) < 1.0
        assert np.abs(found.misalignment_relative).max() < 0.5
        assert any("10.0 times as long" in one for one in found.warnings)


@pytest.mark.parametrize("rate", [24, 60, 120])
def test_rates_may_differ(rate: int) -> None:
    reference, source = walking(6.0, 30, variation=0.2), walking(6.0, rate, variation=0.2)
    found = run(compare(reference, source))
    check(found, reference, source)
    seconds = np.arange(source.frames) / rate
    assert np.abs(found.warp / 30 - seconds).max() < 0.1
    assert np.abs(found.misalignment).max() < 0.1


def test_stillness_at_the_ends_is_said_and_does_not_spoil_the_middle() -> None:
    take = dance(12.0)
    held = [np.repeat(one[:1], 90, axis=0) for one in (take.rotations, take.translations)]
    rotations = np.concatenate([held[0], take.rotations])
    source = replace(
        take, rotations=rotations, translations=np.concatenate([held[1], take.translations])
    )
    found = run(compare(take, source))
    assert any("3.0 s of the source answer to the first frame" in w for w in found.warnings)
    truth = np.maximum(np.arange(source.frames) - 90, 0)
    assert np.abs(found.warp - truth)[100:].max() < 3
    open_begin = run(compare(take, source, ComparisonParameters(true_speed=True, begin="source")))
    assert open_begin.path[0, 0] == 0
    assert open_begin.path[0, 1] == pytest.approx(90, abs=2)


def test_two_different_motions_are_doubtful() -> None:
    found = run(compare(dance(seed=1), dance(seed=2)))
    assert any("doubtful" in one for one in found.warnings)
    assert found.doubt > 0.8


def test_unreliable_samples_are_no_difference() -> None:
    take = dance(8.0)
    bad = turned(turned(take, "LeftArm", 60, 120, 90), "LeftForeArm", 60, 120, 60)
    mask = np.zeros((take.frames, len(take.skeleton)), bool)
    arm = [take.skeleton.index[f"Left{name}"] for name in ("Arm", "ForeArm", "Hand")]
    mask[60:120, arm] = True
    blind = run(compare(take, bad))
    seeing = run(compare(take, bad, source_unreliable=mask))
    assert blind.pose_difference[60:120].mean() > 0.05
    np.testing.assert_allclose(seeing.pose_difference, 0, atol=0.02)
    assert seeing.unreliable is not None
    hand = seeing.rows.index("LeftHand")
    assert seeing.unreliable[60:120, hand].all()
    assert not seeing.joint_difference[60:120, hand].any()
    assert np.abs(seeing.misalignment).max() < 0.05


def test_markers_named_like_joints_compare_with_joints() -> None:
    take = dance(8.0)
    found = run(compare(take, as_markers(take)))
    check(found, take, as_markers(take))
    assert len(found.rows) == 19
    assert np.abs(found.misalignment).max() < 0.1


def test_missing_markers_are_completed_or_left_out() -> None:
    take = as_markers(dance(8.0))
    positions = take.positions.copy()
    hand, foot, head = (take.index[name] for name in ("LeftHand", "RightFoot", "Head"))
    positions[50:58, hand] = np.nan
    positions[100:160, foot] = np.nan
    positions[:, head] = np.nan
    gappy = replace(take, name="gappy", positions=positions)
    found = run(compare(take, gappy))
    check(found, take, gappy)
    assert "Head" not in found.rows
    assert any("never seen: Head" in one for one in found.warnings)
    assert found.unreliable is not None
    assert found.unreliable[105:155, found.rows.index("RightFoot")].all()
    assert not found.unreliable[50:58, found.rows.index("LeftHand")].any()


def test_other_names_answer_by_place_in_the_body_or_by_a_map() -> None:
    take = dance(8.0)
    skeleton = take.skeleton
    renamed = replace(
        take, skeleton=replace(skeleton, names=tuple(f"{n}X" for n in skeleton.names))
    )
    by_place = run(compare(take, renamed))
    assert len(by_place.rows) >= 15
    assert any("place in the body" in one for one in by_place.warnings)
    assert any("SpineX" in one for one in by_place.warnings)
    assert by_place.dissimilarity < 1e-5
    names = {f"{n}X": n for n in skeleton.names}
    by_map = run(compare(take, renamed, names=names))
    assert len(by_map.rows) == 19
    assert by_map.warnings == ()


def test_what_cannot_be_compared_is_refused() -> None:
    take = dance(2.0)
    strange = replace(as_markers(take), labels=tuple(f"m{i}" for i in range(19)))
    with pytest.raises(SkeletonMismatchError, match="joint map"):
        run(compare(take, strange))
    with pytest.raises(MocapError, match="no rotations"):
        run(compare(take, as_markers(take), ComparisonParameters(features=ROTATIONS)))
    gone = replace(as_markers(take), positions=np.full_like(as_markers(take).positions, np.nan))
    with pytest.raises(MocapError, match="ever seen"):
        run(compare(take, gone))


@pytest.mark.parametrize("frames", [1, 2, 3])
def test_the_shortest_takes(frames: int) -> None:
    take = dance(3.0)
    short = take.with_motion(take.rotations[:frames], take.translations[:frames])
    for one, other in ((take, short), (short, take), (short, short)):
        check(run(compare(one, other)), one, other)


def test_only_the_trimmed_span_is_compared() -> None:
    take = dance(8.0)
    rotations = take.rotations.copy()
    rotations[:20] = rot.IDENTITY
    slated = replace(take, rotations=rotations, trim=(20, take.frames))
    found = run(compare(take, slated, ComparisonParameters(true_speed=True, begin="reference")))
    assert found.path[0, 1] == 20
    assert found.path[0, 0] == pytest.approx(20, abs=1)
    assert np.abs(found.warp[20:] - np.arange(20, take.frames)).max() < 2


def test_a_creature_without_arms_can_be_compared() -> None:
    skeleton = horse()
    time = np.arange(150) / 30
    angles = np.zeros((150, len(skeleton), 3))
    angles[:, 3:, 0] = 0.4 * np.sin(time[:, None] * np.linspace(1, 3, len(skeleton) - 3))
    take = Take(
        "horse",
        skeleton,
        rot.from_rotation_vector(angles),
        np.zeros((150, 1, 3)),
        Fraction(30),
    )
    found = run(compare(take, paced(take, np.full(100, 1.3))))
    assert found.dissimilarity < 0.05


def test_the_kata_is_recovered_from_a_disturbed_performance(data: Path) -> None:
    path = data / "karate_rmocap_GPL3" / "heian.nidan.bvh"
    if not path.exists():
        pytest.skip(f"no {path}")
    take = formats.read(path)[0][0]
    known = perform_again(take, Disturbance(), 77)
    found = run(compare(take, known.take))
    check(found, take, known.take)
    assert np.median(np.abs(found.warp - known.truth)) / 100 * 25 < 2


@pytest.mark.parametrize("style", ["active", "old", "tired"])
def test_one_action_in_another_style_is_no_other_action(data: Path, style: str) -> None:
    folder = data / "bandai_1_styles_bvh_CCBYNC4"
    if not folder.is_dir():
        pytest.skip(f"no {folder}")
    bow = [folder / f"dataset-1_bow_{one}_001.bvh" for one in ("normal", style)]
    found = run(compare(*(formats.read(path)[0][0] for path in bow)))
    assert not [one for one in found.warnings if "doubtful" in one]
    other = formats.read(folder / "dataset-1_call_normal_001.bvh")[0][0]
    kick = formats.read(folder / "dataset-1_kick_normal_001.bvh")[0][0]
    assert any("doubtful" in one for one in run(compare(kick, other)).warnings)
