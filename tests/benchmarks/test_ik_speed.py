"""How long clean-up and dragging take."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import count

import numpy as np

from mocapstudio.cleaning.contacts.detection import detect_contacts
from mocapstudio.cleaning.contacts.model import ContactPoint
from mocapstudio.cleaning.contacts.points import contact_points
from mocapstudio.cleaning.ik import foot_skate
from mocapstudio.cleaning.ik.drag import Drag
from mocapstudio.cleaning.ik.ranges import joint_ranges
from mocapstudio.evaluation.demo.take import demo_take
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.progress import run

FRAMES, CONTACTS = 2400, 60


def twenty_seconds():
    """Walk at 120 fps, by taking the demo's frames for half as long as they are."""
    take = demo_take()
    return replace(
        take.with_motion(take.rotations[:FRAMES], take.translations[:FRAMES]), rate=Fraction(120)
    )


def test_clean_up_of_twenty_seconds(benchmark):
    take = twenty_seconds()
    points = contact_points(take)
    contacts = detect_contacts(take, points=points)
    # Walks of that speed have fewer; long ones are parted until there are sixty.
    while len(contacts) < CONTACTS:
        longest = max(contacts, key=lambda c: c.end - c.start)
        middle = (longest.start + longest.end) // 2
        contacts = (
            *(c for c in contacts if c is not longest),
            replace(longest, end=middle - 6),
            replace(longest, id=f"{longest.id}-{middle}", start=middle + 6),
        )
    contacts = contacts[:CONTACTS]
    benchmark.extra_info["contacts"] = len(contacts)
    result = benchmark(lambda: run(foot_skate.clean(take, contacts, points)))
    assert result.declared


def test_drag_of_a_hand_with_the_whole_body(benchmark):
    take = twenty_seconds()
    skeleton = take.skeleton
    hand, left, right = (
        next(n for n in skeleton.names if side in n and part in n)
        for side, part in (("Left", "Hand"), ("Left", "Foot"), ("Right", "Foot"))
    )
    pins = tuple(ContactPoint(name, None, np.zeros(3)) for name in (left, right))
    drag = Drag(
        take,
        600,
        ContactPoint(hand, None, np.zeros(3)),
        pins=pins,
        whole_body=True,
        ranges=joint_ranges([take]),
    )
    start = take_pose(take, 600, 601)[0][0, skeleton.index[hand]]
    up = (np.array([0.0, 0.003 * (k % 100), 0.0]) for k in count())
    benchmark(lambda: drag.to(start + next(up)))
