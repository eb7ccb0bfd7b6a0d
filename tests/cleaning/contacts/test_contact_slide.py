"""The measure of slide on motion whose slide is known."""

from __future__ import annotations

import numpy as np
import pytest
from made_takes import walking

from mocapstudio.cleaning.contacts.model import Contact, ContactPoint, Fixed, Following
from mocapstudio.cleaning.contacts.slide import measure_slide
from mocapstudio.cleaning.ik.targets import holds
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take

POINTS = (
    ContactPoint("LeftFoot", "heel", np.array([0.0, -0.05, -0.05])),
    ContactPoint("RightHand", "palm", np.array([-0.05, 0.0, 0.0])),
)


def gliding(metres_a_second: float) -> Take:
    """A stiff body that glides along +x at 50 Hz."""
    walk = walking(2.0, 50)
    rotations = np.tile(rot.IDENTITY, (*walk.rotations.shape[:2], 1))
    place = np.zeros((walk.frames, 1, 3))
    place[:, 0, 0] = metres_a_second * np.arange(walk.frames) / 50
    return walk.with_motion(rotations, place)


def contact(start: int, end: int, joint: str = "LeftFoot", point: str = "heel") -> Contact:
    return Contact(f"{joint}{start}", joint, point, start, end, Fixed((0.0, 0.0, 0.0)))  # type: ignore[arg-type]


def test_speed_of_a_gliding_point() -> None:
    take = gliding(0.3)
    found = measure_slide(take, [contact(10, 60), contact(70, 71)], POINTS)
    assert found.mean == pytest.approx(0.3)
    assert [c.mean for c in found.contacts] == pytest.approx([0.3, 0.0])
    assert found.contacts[0].worst == pytest.approx(0.3)
    assert np.isnan(found.frames[:10]).all()
    np.testing.assert_allclose(found.frames[10:59], 0.3)
    assert np.isnan(found.frames[59:]).all()


def test_mean_is_over_steps_not_contacts() -> None:
    take = gliding(0.0)
    moving = take.translations.copy()
    moving[50:, 0, 2] = 0.01 * np.arange(take.frames - 50)
    take = take.with_motion(translations=moving)
    # 39 steps at rest, and 10 at half a metre a second.
    found = measure_slide(take, [contact(0, 40), contact(60, 71)], POINTS)
    assert found.mean == pytest.approx(0.5 * 10 / 49)


def test_what_follows_a_partner_does_not_slide_with_it() -> None:
    take = gliding(0.4)
    target = Following("partner", "LeftHand", (0.0, 0.1, 0.0))
    hold = Contact("h", "RightHand", "palm", 5, 50, target)
    assert measure_slide(take, [hold], POINTS, {"partner": take}).mean == pytest.approx(0, abs=1e-9)
    still = measure_slide(take, [hold], POINTS, {"partner": gliding(0.0)})
    assert still.mean == pytest.approx(0.4)


def test_without_contacts_nothing_slides() -> None:
    found = measure_slide(gliding(1.0), [], POINTS)
    assert found.mean == 0.0
    assert np.isnan(found.frames).all()


def test_gaps_are_measured_against_one_set_of_targets() -> None:
    take = gliding(0.0)
    touched = [contact(0, 20)]
    laid = holds(take, touched, POINTS, {})
    away = take.with_motion(translations=take.translations + np.array([0.0, 0.03, 0.04]))
    foot = take_pose(take)[0][0, take.skeleton.index["LeftFoot"]]
    for version, step in ((take, np.zeros(3)), (away, np.array([0.0, 0.03, 0.04]))):
        # The target is the world's origin.
        expected = np.linalg.norm(foot + POINTS[0].offset + step)
        [one] = measure_slide(version, touched, POINTS, laid=laid).contacts
        assert one.gap == pytest.approx(expected)
