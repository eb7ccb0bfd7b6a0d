"""A foot of which one contact is moved, with the others that stand with it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mocapstudio.cleaning.contacts.model import Contact, Fixed, Floor
from mocapstudio.cleaning.contacts.points import contact_points, point_positions
from mocapstudio.cleaning.ik.drag import Drag
from mocapstudio.cleaning.ik.meet import Met, meet
from mocapstudio.evaluation.contacts_cases import made_case
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take

WAY = np.array([0.05, 0.03, -0.04])
HEEL, BALL = ("RightFoot", "heel"), ("RightToe", "ball")


@pytest.fixture(scope="module")
def standing() -> Take:
    """A second of standing, before the walk begins."""
    take = made_case("60 Hz", "test", 7).take
    return replace(
        take, rotations=take.rotations[:90], translations=take.translations[:90], trim=None
    )


def places(take: Take, key: tuple[str, str], start: int, end: int) -> np.ndarray:
    points = contact_points(take)
    number = [point.key for point in points].index(key)
    return point_positions(take, points)[start:end, number]


def moved(take: Take, along: bool) -> tuple[np.ndarray, Contact, Contact, Met]:
    """Move a heel by WAY while the ball stands."""
    heel_at, ball_at = places(take, HEEL, 20, 50), places(take, BALL, 25, 60)
    goal = heel_at.mean(axis=0) + WAY
    heel = Contact("heel", *HEEL, 20, 50, Fixed(tuple(goal)))
    raised = float(ball_at[:, 1].mean() + along * WAY[1])
    ball = Contact("ball", *BALL, 25, 60, Floor(raised))
    work = meet(take, heel, contact_points(take), along=[ball] if along else [])
    return goal, heel, ball, run(work)


def test_the_ball_goes_as_far_as_the_heel(standing: Take) -> None:
    goal, _, _, met = moved(standing, along=True)
    assert met.unreached == ()
    assert np.abs(places(met.take, HEEL, 20, 50) - goal).max() < 1e-3
    ball = places(met.take, BALL, 25, 60)
    assert np.linalg.norm(ball - ball.mean(axis=0), axis=1).max() < 1e-3
    gone = ball.mean(axis=0) - places(standing, BALL, 25, 60).mean(axis=0)
    np.testing.assert_allclose(gone, WAY, atol=4e-3)


def test_alone_the_heel_leaves_the_ball_to_itself(standing: Take) -> None:
    goal, _, _, met = moved(standing, along=False)
    assert np.abs(places(met.take, HEEL, 20, 50) - goal).max() < 1e-3
    # The toes may go with the leg, but nothing holds them anywhere.
    assert np.ptp(places(met.take, BALL, 50, 60), axis=0).max() > 5e-3


def test_the_dragged_frame_is_kept(standing: Take) -> None:
    frame = 40
    points = {point.key: point for point in contact_points(standing)}
    goal, heel, ball, _ = moved(standing, along=True)
    drag = Drag(standing, frame, points[HEEL], along=[points[BALL]])
    ball_goal = places(standing, BALL, frame, frame + 1)[0] + WAY
    pose = drag.to(goal, [ball_goal])
    assert pose.gap < 1e-3
    assert np.linalg.norm(places(pose.take, BALL, 0, 1)[0] - ball_goal) < 3e-3
    work = meet(standing, heel, contact_points(standing), along=[ball], kept=drag.kept)
    met = run(work)
    shown = point_positions(pose.take, contact_points(standing))[0]
    after = point_positions(met.take, contact_points(standing))[frame]
    np.testing.assert_allclose(after, shown, atol=5e-3)
