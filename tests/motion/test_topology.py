"""Topology of made-up skeletons: people, a horse, a chain, and anything that is a tree."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from made_takes import Bone, build, chain, horse, nameless, person

from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.topology import Topology, side_of, topology


def limbs(skeleton: Skeleton) -> dict[str, list[str]]:
    parts = topology(skeleton)
    return {limb.name: [skeleton.names[j] for j in limb.joints] for limb in parts.limbs}


def check_partition(skeleton: Skeleton) -> Topology:
    """Every joint is in one limb, and its mirror image's mirror image is itself."""
    parts = topology(skeleton)
    assert sorted(j for limb in parts.limbs for j in limb.joints) == list(range(len(skeleton)))
    assert len({limb.name for limb in parts.limbs}) == len(parts.limbs)
    for joint in range(len(skeleton)):
        assert joint in parts.limb_of(joint).joints
    np.testing.assert_array_equal(parts.mirror[parts.mirror], np.arange(len(skeleton)))
    left_out = parts.details | parts.above_hips
    assert set(parts.body_joints()) == set(range(len(skeleton))) - left_out
    for limb in parts.limbs:
        assert list(limb.joints) == sorted(limb.joints)
    return parts


PERSON = {
    "spine": ["Hips", "Spine", "Chest"],
    "head": ["Neck", "Head"],
    "left arm": ["LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand"],
    "right arm": ["RightShoulder", "RightArm", "RightForeArm", "RightHand"],
    "left leg": ["LeftUpLeg", "LeftLeg", "LeftFoot"],
    "right leg": ["RightUpLeg", "RightLeg", "RightFoot"],
}


def test_a_person_has_arms_and_legs() -> None:
    assert limbs(person()) == PERSON
    assert list(limbs(person())) == list(PERSON)
    assert check_partition(person()).hips == 0


def test_the_mirror_image_of_a_name_is_its_other_side() -> None:
    for skeleton in (person(fingers=True), horse()):
        mirror = check_partition(skeleton).mirror
        for joint, other in enumerate(mirror):
            name, twin = skeleton.names[joint], skeleton.names[other]
            swapped = name.replace("Left", "#").replace("Right", "Left").replace("#", "Right")
            assert twin == swapped


@pytest.mark.parametrize("skeleton", [person(), person(fingers=True), horse()])
def test_geometry_tells_what_names_do(skeleton: Skeleton) -> None:
    named, bare = topology(skeleton), topology(nameless(skeleton))
    assert [(one.name, one.joints) for one in named.limbs] == [
        (one.name, one.joints) for one in bare.limbs
    ]
    np.testing.assert_array_equal(named.mirror, bare.mirror)
    assert named.hips == bare.hips


def test_fingers_and_eyes_are_details() -> None:
    skeleton = person(fingers=True)
    details = {skeleton.names[j] for j in check_partition(skeleton).details}
    fingers = {n for n in skeleton.names if any(f in n for f in ("Thumb", "Index", "Pinky"))}
    assert details == fingers | {"LeftEye", "RightEye"}
    bare = topology(nameless(skeleton))
    assert {skeleton.names[j] for j in bare.details} == fingers


def test_a_finger_word_on_the_trunk_is_no_finger() -> None:
    trunk: list[Bone] = [("Root", "", (0, 0, 0)), ("Middle", "Root", (0, 1, 0))]
    sides: list[Bone] = [("LeftLeg", "Root", (1, -1, 0)), ("RightLeg", "Root", (-1, -1, 0))]
    assert not check_partition(build([*trunk, *sides])).details


def test_a_horse_has_four_legs_a_neck_and_a_tail() -> None:
    found = limbs(horse())
    assert found["head"] == ["Neck", "Skull"]
    assert found["spine"] == ["Pelvis", "Loin", "Withers", "Tail1", "Tail2"]
    assert found["left leg"] == ["LeftHindUpper", "LeftHindLower", "LeftHindHoof"]
    assert sorted(map(len, found.values())) == [2, 3, 3, 3, 3, 5]


@pytest.mark.parametrize("joints", [1, 2, 6])
def test_a_chain_is_one_limb(joints: int) -> None:
    parts = check_partition(chain(joints))
    assert [limb.name for limb in parts.limbs] == ["spine"]
    assert parts.hips == 0


def test_what_is_above_the_hips_moves_the_world() -> None:
    bones: list[Bone] = [("World", "", (0, 0, 0)), ("Reference", "World", (0, 0, 0))]
    body = person()
    bones += [
        (
            name,
            body.names[parent] if parent >= 0 else "Reference",
            tuple(float(x) for x in body.offsets[j]),  # type: ignore[misc]
        )
        for j, (name, parent) in enumerate(zip(body.names, body.parents, strict=True))
    ]
    parts = check_partition(build(bones))
    assert parts.hips == 2
    assert parts.above_hips == {0, 1}
    assert parts.body_joints() == tuple(range(2, len(bones)))


def person_bones() -> list[Bone]:
    body = person()
    return [
        (name, body.names[parent] if parent >= 0 else "", tuple(map(float, body.offsets[j])))  # type: ignore[misc]
        for j, (name, parent) in enumerate(zip(body.names, body.parents, strict=True))
    ]


@pytest.mark.parametrize("at", [3, 5, 19])
def test_a_pack_on_the_back_belongs_to_the_spine(at: int) -> None:
    bones = person_bones()
    bones.insert(at, ("Backpack", "Chest", (0, 0, -0.2)))
    skeleton = build(bones)
    check_partition(skeleton)
    found = limbs(skeleton)
    assert set(found.pop("spine")) == {"Hips", "Spine", "Chest", "Backpack"}
    assert found == {name: joints for name, joints in PERSON.items() if name != "spine"}


def test_a_tail_is_no_head() -> None:
    bones = [b for b in person_bones() if not any(w in b[0] for w in ("Arm", "Hand", "Should"))]
    skeleton = build([*bones, ("Tail", "Hips", (0, 0, -0.3))])
    check_partition(skeleton)
    assert limbs(skeleton)["head"] == ["Spine", "Chest", "Neck", "Head"]
    assert limbs(skeleton)["spine"] == ["Hips", "Tail"]


def test_a_sword_in_one_hand_leaves_the_arms_a_pair() -> None:
    skeleton = build([*person_bones(), ("Sword", "RightHand", (0, 0, 0.3))])
    parts = check_partition(skeleton)
    assert limbs(skeleton) == {
        **PERSON,
        "right arm": [*PERSON["right arm"], "Sword"],
    }
    assert parts.mirror[skeleton.index["Sword"]] == skeleton.index["Sword"]
    assert parts.mirror[skeleton.index["LeftHand"]] == skeleton.index["RightHand"]


def test_the_order_of_children_does_not_matter() -> None:
    trunk: list[Bone] = [("Hips", "", (0, 0, 0)), ("Spine", "Hips", (0, 1, 0))]
    left: list[Bone] = [
        ("LeftHip", "Hips", (1, 0, 0)),
        ("LeftTwist", "LeftHip", (0.5, 0, 0)),
        ("LeftKnee", "LeftHip", (0, -1, 0)),
        ("LeftFoot", "LeftKnee", (0, -1, 0)),
    ]
    right: list[Bone] = [
        ("RightHip", "Hips", (-1, 0, 0)),
        ("RightKnee", "RightHip", (0, -1, 0)),
        ("RightFoot", "RightKnee", (0, -1, 0)),
        ("RightTwist", "RightHip", (-0.5, 0, 0)),
    ]
    skeleton = build([*trunk, *left, *right])
    for bones in (skeleton, nameless(skeleton)):
        mirror = check_partition(bones).mirror
        twins = {skeleton.names[j]: skeleton.names[mirror[j]] for j in range(2, 6)}
        assert all(twin == name.replace("Left", "Right") for name, twin in twins.items())


def test_namesakes_are_paired_before_look_alikes() -> None:
    trunk: list[Bone] = [("Body", "", (0, 0, 0)), ("Head", "Body", (0, 1, 0))]
    branches: list[Bone] = [
        ("LeftLeg", "Body", (1, -1, 0)),
        ("RightWing", "Body", (-1, 1, 0)),
        ("RightLeg", "Body", (-1, -1, 0)),
        ("LeftWing", "Body", (1, 1, 0)),
    ]
    np.testing.assert_array_equal(
        check_partition(build([*trunk, *branches])).mirror, [0, 1, 4, 5, 2, 3]
    )


@given(st.data())
def test_the_limbs_of_any_tree_partition_it(data: st.DataObject) -> None:
    count = data.draw(st.integers(1, 12))
    bones: list[Bone] = []
    for j in range(count):
        side = data.draw(st.sampled_from(["Left", "Right", ""]))
        parent = bones[data.draw(st.integers(0, j - 1))][0] if j else ""
        x = data.draw(st.sampled_from([-1.0, 0.0, 1.0]))
        bones.append((f"{side}j{data.draw(st.integers(0, 4))}-{j}", parent, (x, 1, 0)))
    check_partition(build(bones))


@pytest.mark.parametrize(
    ("name", "side"),
    [
        ("LeftArm", "left"), ("mixamorig:LeftArm", "left"), ("lArm", "left"), ("arm_l", "left"),
        ("L_Arm", "left"), ("Arm.L", "left"), ("LThumb", "left"), ("leftarm", "left"),
        ("lfemur", ""), ("RightUpLeg", "right"), ("r_hand", "right"), ("HandRight", "right"),
        ("ArmRgt", "right"), ("Hips", ""), ("Collar", ""), ("Pelvis", ""), ("Leg", ""),
        ("Roll", ""), ("Hand_R", "right"), ("RHipJoint", "right"), ("Bip01 L Thigh", "left"),
    ],
)  # fmt: skip
def test_names_tell_the_side(name: str, side: str) -> None:
    assert side_of(name) == side
