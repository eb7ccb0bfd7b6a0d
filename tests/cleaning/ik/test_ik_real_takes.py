"""Foot skate of real takes, with the contacts that detection finds in them."""

from __future__ import annotations

import numpy as np
import pytest

from mocapstudio import formats
from mocapstudio.cleaning.contacts.anatomy import extremities
from mocapstudio.cleaning.contacts.detection import detect_contacts
from mocapstudio.cleaning.contacts.points import contact_points
from mocapstudio.cleaning.ik import foot_skate
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.progress import run

TAKES = (
    "cmu_locomotion_bvh/16_31.bvh",
    "cmu_locomotion_bvh/35_17.bvh",
    "bandai_2_normal_bvh_CCBYNC4/dataset-2_walk-turn-left_normal_001.bvh",
)


@pytest.fixture(scope="module", params=TAKES)
def cleaned(data, request):
    take = formats.read(data / request.param)[0][0]
    points = contact_points(take)
    contacts = detect_contacts(take, points=points)
    assert contacts
    return take, points, contacts, run(foot_skate.clean(take, contacts, points))


def test_slide_stays_below_a_millimetre_a_frame(cleaned):
    result = cleaned[-1]
    assert result.slide.before * 1e3 / 120 > 0.2
    assert result.slide.worst_after * 1e3 / 120 < 1.0
    assert result.unreached == ()


def test_no_joint_pops(cleaned):
    """No joint turns faster than the take's fastest does anyway, nor by half a turn."""
    take, _, _, result = cleaned
    start, end = take.span
    before, after = (one.rotations[start:end] for one in (take, result.take))
    speed = [np.degrees(rot.angle(q[1:], q[:-1])) for q in (before, after)]
    assert speed[1].max() < 1.2 * speed[0].max()
    assert np.degrees(rot.angle(before, after)).max() < 45.0


def test_jerk_at_the_edges_of_contacts(cleaned):
    """Ankles and knees near edges: at most 1.2 times what the take has, there or anywhere."""
    take, _, contacts, result = cleaned
    start, end = take.span
    ankles = [foot.joint for foot in extremities(take.skeleton, "leg")]
    joints = [*ankles, *(int(take.skeleton.parents[ankle]) for ankle in ankles)]
    before, after = (
        np.linalg.norm(np.diff(take_pose(one)[0][start:end, joints], 3, axis=0), axis=2)
        for one in (take, result.take)
    )
    near = np.zeros(len(before), dtype=bool)
    for contact in contacts:
        for edge in (contact.start - start, contact.end - start):
            if 3 < edge < len(before):
                near[edge - 5 : edge + 3] = True
    own = max(np.percentile(before, 99), np.percentile(before[near], 99))
    assert np.percentile(after[near], 99) < 1.2 * own
