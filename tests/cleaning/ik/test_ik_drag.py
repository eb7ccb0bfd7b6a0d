"""Dragging: the preview reaches the mouse, and the edit looks as the preview did."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from made_takes import walking

from mocapstudio.cleaning.contacts.model import ContactPoint
from mocapstudio.cleaning.ik.drag import Drag
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take

HAND = ContactPoint("LeftHand", "palm", np.array([0.05, 0.0, 0.0]))
FEET = tuple(ContactPoint(f"{side}Foot", None, np.zeros(3)) for side in ("Left", "Right"))
FRAME = 45


@pytest.fixture(scope="module")
def walk() -> Take:
    """Elbows and knees bent, so that there is room to move."""
    take = walking(3.0, rate=30)
    rotations = take.rotations.copy()
    for name, axis, degrees in (
        ("LeftForeArm", 1, -60.0),
        ("LeftUpLeg", 0, -25.0),
        ("LeftLeg", 0, 50.0),
        ("RightUpLeg", 0, -25.0),
        ("RightLeg", 0, 50.0),
    ):
        at = take.skeleton.index[name]
        bent = rot.about_axis(axis, np.deg2rad(degrees))
        rotations[:, at] = rot.multiply(rotations[:, at], bent)
    return take.with_motion(rot.continuous(rotations))


def place(take: Take, point: ContactPoint) -> np.ndarray:
    positions, world = take_pose(take)
    joint = take.skeleton.index[point.joint]
    return positions[:, joint] + rot.rotate(world[:, joint], point.offset)


def test_the_hand_comes_to_the_mouse_and_the_trunk_stays(walk):
    start = place(walk, HAND)[FRAME]
    drag = Drag(walk, FRAME, HAND)
    for share in np.linspace(0.0, 1.0, 5):
        target = start + share * np.array([-0.03, 0.1, 0.05])
        shown = drag.to(target)
        assert shown.gap == 0.0
        np.testing.assert_allclose(place(shown.take, HAND)[0], target, atol=1e-3)
    arm = {"LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand"}
    for name, joint in walk.skeleton.index.items():
        if name not in arm:
            np.testing.assert_array_equal(
                shown.take.rotations[0, joint], walk.rotations[FRAME, joint]
            )


def test_small_steps_of_the_mouse_make_small_steps_of_the_pose(walk):
    start = place(walk, HAND)[FRAME]
    drag = Drag(walk, FRAME, HAND)
    up = np.array([0.0, 0.01, 0.0])
    poses = [drag.to(start + k * up).take.rotations[0] for k in range(12)]
    steps = [np.degrees(rot.angle(a, b)).max() for a, b in pairwise(poses)]
    assert max(steps) < 8.0


def test_out_of_reach_the_arm_points_there_and_the_gap_is_told(walk):
    target = place(walk, HAND)[FRAME] + np.array([0.0, 3.0, 0.0])
    drag = Drag(walk, FRAME, HAND)
    for _ in range(6):
        shown = drag.to(target)
    got = place(shown.take, HAND)[0]
    assert shown.gap == pytest.approx(np.linalg.norm(got - target), abs=1e-9)
    assert shown.gap > 1.0
    shoulder = take_pose(shown.take)[0][0, walk.skeleton.index["LeftArm"]]
    assert np.linalg.norm(got - shoulder) > 0.95 * (0.3 + 0.25 + 0.05)


@pytest.mark.parametrize("pinned", [False, True])
def test_release_looks_as_the_preview_and_fades_out(walk, pinned):
    start = place(walk, HAND)[FRAME]
    drag = Drag(walk, FRAME, HAND, whole_body=pinned, pins=FEET if pinned else ())
    for share in (0.5, 1.0):
        shown = drag.to(start + share * np.array([-0.02, 0.12, 0.08]))
    result = drag.release(0.5)
    same = rot.angle(result.take.rotations[FRAME], shown.take.rotations[0])
    np.testing.assert_allclose(same, 0.0, atol=1e-7)
    np.testing.assert_allclose(result.take.translations[FRAME], shown.take.translations[0])
    away = np.linalg.norm(place(result.take, HAND) - place(walk, HAND), axis=1)
    assert away[FRAME] > 0.14
    assert np.abs(np.diff(away)).max() < 0.04
    assert {one.start for one in result.declared} >= {min(np.flatnonzero(away > 1e-6))}
    outside = np.r_[0 : FRAME - 15, FRAME + 16 : walk.frames]
    np.testing.assert_array_equal(result.take.rotations[outside], walk.rotations[outside])
    if pinned:
        for foot in FEET:
            np.testing.assert_allclose(place(result.take, foot), place(walk, foot), atol=1e-3)
    else:
        rows = {one.row for one in result.declared}
        assert rows <= {"LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand"}


def test_hips_go_down_on_pinned_feet(walk):
    hips = ContactPoint("Hips", None, np.zeros(3))
    drag = Drag(walk, FRAME, hips, pins=FEET)
    target = walk.translations[FRAME, 0] + np.array([0.02, -0.1, 0.0])
    for _ in range(3):
        shown = drag.to(target)
    np.testing.assert_allclose(shown.take.translations[0, 0], target, atol=1e-3)
    for foot in FEET:
        np.testing.assert_allclose(place(shown.take, foot)[0], place(walk, foot)[FRAME], atol=1e-3)


def test_at_the_ends_of_the_take(walk):
    for frame in (0, walk.frames - 1):
        drag = Drag(walk, frame, HAND)
        shown = drag.to(place(walk, HAND)[frame] + [0.0, 0.05, 0.0])
        result = drag.release(0.4)
        same = rot.angle(result.take.rotations[frame], shown.take.rotations[0])
        np.testing.assert_allclose(same, 0.0, atol=1e-7)


def test_bad_frames_and_joints_are_told(walk):
    with pytest.raises(MocapError, match="no frame 90"):
        Drag(walk, 90, HAND)
    with pytest.raises(MocapError, match="no joint Paw"):
        Drag(walk, 0, ContactPoint("Paw", None, np.zeros(3)))
