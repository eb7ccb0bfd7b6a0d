"""Contact points: where heel, ball, toe and palm are, on skeletons of many kinds."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from made_takes import below_a_reference, chain, elsewhere, nameless, walking
from planted import planted, scaled, without_tips

from mocapstudio import formats
from mocapstudio.cleaning.contacts.anatomy import extremities, leg_length
from mocapstudio.cleaning.contacts.model import ContactPoint
from mocapstudio.cleaning.contacts.points import contact_points, named, point_positions
from mocapstudio.evaluation.demo.skeleton import ANKLE_HEIGHT, HEEL, SHANK, THIGH
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take


@pytest.fixture(scope="module")
def take() -> Take:
    return planted("60 Hz").take


def test_feet_of_the_made_performer(take: Take) -> None:
    found = named(contact_points(take))
    assert set(found) == {
        *((f"{side}Foot", "heel") for side in ("Left", "Right")),
        *((f"{side}Toe", point) for side in ("Left", "Right") for point in ("ball", "toe")),
        *((f"{side}Hand", "palm") for side in ("Left", "Right")),
    }
    heel = found["LeftFoot", "heel"].offset
    assert np.linalg.norm(heel - HEEL) < 0.02
    assert heel[2] < 0
    assert heel[1] == pytest.approx(-ANKLE_HEIGHT, abs=0.01)
    # The tip lies 65 mm before the ball; ball and tip are on the sole, below their joints.
    assert found["LeftToe", "toe"].offset[2] == pytest.approx(0.065, abs=0.01)
    assert -0.03 < found["LeftToe", "ball"].offset[1] < -0.005
    assert found["LeftHand", "palm"].offset == pytest.approx([0.085, 0.0, 0.0])
    assert leg_length(take.skeleton) == pytest.approx(THIGH + SHANK)


def test_points_of_one_foot_lie_on_one_sole(take: Take) -> None:
    """Standing flat, heel, ball and toe are at one height."""
    points = [p for p in contact_points(take) if p.joint.startswith("Left") and p.point != "palm"]
    heights = point_positions(take, points)[..., 1]
    flat = np.flatnonzero(heights.max(axis=1) < np.percentile(heights.max(axis=1), 10))
    assert np.ptp(heights[flat], axis=1).max() < 0.012


def test_missing_tips_are_put_where_toes_end(take: Take) -> None:
    found = named(contact_points(without_tips(take)))
    toe = found["LeftToe", "toe"].offset
    assert 0.03 < toe[2] < 0.09
    assert abs(toe[0]) < 0.015
    assert np.linalg.norm(found["LeftHand", "palm"].offset) > 0.03


def test_offsets_follow_scale_and_not_place(take: Take) -> None:
    own = contact_points(take)
    for other, factor in ((scaled(take, 0.01), 0.01), (elsewhere(take, 70.0, (3.0, 0.0, -2.0)), 1)):
        for a, b in zip(own, contact_points(other), strict=True):
            assert a.key == b.key
            np.testing.assert_allclose(b.offset, a.offset * factor, atol=1e-9)


def test_a_reference_above_the_hips_changes_nothing(take: Take) -> None:
    turn = rot.from_rotation_vector(np.array([-np.pi / 2, 0.0, 0.0]))
    own, hung = contact_points(take), contact_points(below_a_reference(take, turn))
    for a, b in zip(own, hung, strict=True):
        np.testing.assert_allclose(b.offset, a.offset, atol=1e-9)


def test_ankle_is_found_without_names(take: Take) -> None:
    skeleton = take.skeleton
    known = [foot.joint for foot in extremities(skeleton, "leg")]
    assert [skeleton.names[j] for j in known] == ["LeftFoot", "RightFoot"]
    assert sorted(f.joint for f in extremities(nameless(skeleton), "leg")) == sorted(known)


def test_leg_without_a_foot_has_one_point() -> None:
    # The foot of a person who stands in the rest pose goes straight down: it has no sole.
    walk = walking(2.0)
    still = walk.with_motion(np.tile(rot.IDENTITY, (*walk.rotations.shape[:2], 1)))
    points = contact_points(still)
    assert {p.key for p in points if p.point != "palm"} == {("LeftFoot", None), ("RightFoot", None)}


def test_skeleton_without_limbs_has_no_points() -> None:
    skeleton = chain()
    bare = Take("bare", skeleton, np.tile(rot.IDENTITY, (3, 5, 1)), np.zeros((3, 1, 3)), 30)
    assert contact_points(bare) == ()
    assert leg_length(skeleton) > 0


def test_places_are_those_of_the_joint_frame(take: Take) -> None:
    point = ContactPoint("LeftFoot", "heel", np.array([0.01, -0.02, 0.03]))
    positions, world = take_pose(take)
    j = take.skeleton.index["LeftFoot"]
    expected = positions[7, j] + rot.to_matrix(world[7, j]) @ point.offset
    np.testing.assert_allclose(point_positions(take, [point])[7, 0], expected, atol=1e-12)
    with pytest.raises(MocapError, match="no joint Tail"):
        point_positions(take, [ContactPoint("Tail", None, np.zeros(3))])


@pytest.mark.parametrize(
    ("name", "balls"),
    [
        ("cmu_locomotion_bvh/16_15.bvh", 2),
        ("cmu_dance_bvh/131_01.bvh", 2),
        ("cmu_salsa_pairs_bvh/60_10_scaled.bvh", 2),
        ("bandai_2_normal_bvh_CCBYNC4/dataset-2_run_normal_004.bvh", 2),
        ("rokoko_animated_drawings_bvh_MIT/dab.bvh", 2),
    ],
)
def test_real_feet_have_their_size(data: Path, name: str, balls: int) -> None:
    take = formats.read(data / name)[0][0]
    found = contact_points(take)
    leg = leg_length(take.skeleton)
    by = [{p.point: p for p in found if take.skeleton.names.index(p.joint) in side}
          for side in _legs(take)]  # fmt: skip
    assert len(by) == balls
    places = point_positions(take, found)
    for foot in by:
        heel, ball = (places[:, found.index(foot[p])] for p in ("heel", "ball"))
        # From heel to ball a foot measures about a fifth of the leg.
        assert 0.15 < np.median(np.linalg.norm(heel - ball, axis=1)) / leg < 0.3


def _legs(take: Take) -> list[set[int]]:
    legs = extremities(take.skeleton, "leg")
    return [set(take.skeleton.descendants(leg.joint)) for leg in legs]
