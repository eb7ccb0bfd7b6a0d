"""Which contacts of a foot go where one of them goes."""

from __future__ import annotations

from made_takes import walking

from mocapstudio.cleaning.contacts.model import Contact, Floor
from mocapstudio.cleaning.contacts.stance import standing_with


def touching(name: str, joint: str, point, start: int, end: int) -> Contact:
    return Contact(name, joint, point, start, end, Floor(0.0))


def test_a_step_goes_as_a_whole_and_nothing_else_goes():
    skeleton = walking(1.0).skeleton
    heel = touching("heel", "LeftFoot", "heel", 0, 20)
    ball = touching("ball", "LeftFoot", "ball", 10, 40)
    toe = touching("toe", "LeftFoot", "toe", 30, 50)
    others = (
        touching("next step", "LeftFoot", "heel", 50, 60),
        touching("other foot", "RightFoot", "heel", 0, 60),
        touching("hand", "LeftHand", "palm", 0, 60),
    )
    known = (*others, toe, heel, ball)
    assert standing_with(skeleton, heel, known) == (ball, toe)
    assert standing_with(skeleton, toe, known) == (heel, ball)
    assert standing_with(skeleton, others[1], known) == ()
