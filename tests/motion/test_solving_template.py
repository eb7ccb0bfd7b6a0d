"""What a take tells of the body that markers are solved to: how joints turn and are held."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from test_solving import dancing, person, standing

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.solving.template import STIFF, Template, template_of
from mocapstudio.motion.take import Take

NOD = np.array([0.3, 0.0, 0.0])


@pytest.fixture(scope="module")
def nodding() -> Take:
    """A dance with the head bowed all the time, and feet that point down all the time."""
    take = dancing(person())
    rotations = take.rotations.copy()
    for name in ("Head", "LeftFoot", "RightFoot"):
        joint = take.skeleton.index[name]
        wobble = 0.02 * np.sin(np.arange(take.frames) / 5)[:, None]
        rotations[:, joint] = rot.from_rotation_vector(NOD + wobble)
    return replace(take, rotations=rotations)


def bent(template: Template, name: str) -> np.ndarray:
    return rot.to_rotation_vector(template.usual[template.skeleton.index[name]])


def test_what_a_take_holds_is_usual(nodding: Take) -> None:
    template = template_of(nodding)
    np.testing.assert_allclose(bent(template, "Head"), NOD, atol=0.01)
    for name in ("LeftFoot", "LeftForeArm", "RightUpLeg"):
        np.testing.assert_allclose(bent(template, name), 0, atol=1e-9)


def test_what_turns_much_is_near_its_standing_pose(nodding: Take) -> None:
    turns = np.linspace(0, 3 * STIFF["spine"], nodding.frames)[:, None] * [1.0, 0, 0]
    rotations = nodding.rotations.copy()
    rotations[:, nodding.skeleton.index["Head"]] = rot.from_rotation_vector(turns)
    template = template_of(replace(nodding, rotations=rotations))
    np.testing.assert_allclose(bent(template, "Head"), 0, atol=1e-9)


def test_one_frame_tells_nothing_of_how_joints_are_held(nodding: Take) -> None:
    template = template_of(standing(nodding.skeleton))
    np.testing.assert_array_equal(template.usual, template.standing)


def test_hinges_know_which_way_they_bend(nodding: Take) -> None:
    elbow, knee = np.array([[0, 1.0, 0]]), np.array([[1.0, 0, 0]])
    named = {"LeftForeArm": -elbow, "RightForeArm": -elbow, "LeftLeg": knee, "RightLeg": -knee}
    axes = tuple(named.get(name, np.eye(3)) for name in nodding.skeleton.names)
    skeleton = replace(nodding.skeleton, axes=axes)
    template = template_of(standing(skeleton))
    bends = {skeleton.names[joint]: sign for joint, (sign, _) in template.bends.items()}
    # About -Y a left forearm that points to +X swings to the front, +Z; a right one to the back.
    assert bends == {"LeftForeArm": 1, "RightForeArm": -1, "LeftLeg": 1, "RightLeg": -1}


def test_a_pose_that_stands_with_bent_knees_knows_where_they_are_straight(nodding: Take) -> None:
    knee, bend = np.array([[1.0, 0, 0]]), 0.6
    axes = tuple(
        knee if name.endswith("Leg") and "Up" not in name else np.eye(3)
        for name in nodding.skeleton.names
    )
    template = template_of(standing(replace(nodding.skeleton, axes=axes)))
    rotations = template.standing.copy()
    knees = [nodding.skeleton.index[f"{side}Leg"] for side in ("Left", "Right")]
    rotations[knees] = rot.from_rotation_vector(bend * knee)
    crouching = replace(template, standing=rotations)
    for one in (template, crouching):
        straight = {joint: round(angle, 6) for joint, (_, angle) in one.bends.items()}
        assert straight == dict.fromkeys(knees, 0.0)
