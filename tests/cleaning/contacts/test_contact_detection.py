"""Detection as a whole: made takes, invariances, drawn contacts, odd takes."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from made_takes import chain, elsewhere
from planted import planted, rod, scaled, without_tips

from mocapstudio.cleaning.contacts.detection import detect_contacts, detecting
from mocapstudio.cleaning.contacts.model import Contact, Fixed, Floor, Following
from mocapstudio.cleaning.contacts.points import contact_points, point_positions
from mocapstudio.cleaning.contacts.spans import set_down
from mocapstudio.evaluation.contacts_scoring import score_contacts
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.take import Take


@pytest.fixture(scope="module")
def take() -> Take:
    return planted("60 Hz").take


@pytest.fixture(scope="module")
def found(take: Take) -> tuple[Contact, ...]:
    return detect_contacts(take)


def spans(contacts: tuple[Contact, ...]) -> list[tuple[str, str | None, int, int]]:
    return [(c.joint, c.point, c.start, c.end) for c in contacts]


@pytest.mark.parametrize("kind", ["24 Hz", "240 Hz", "noise", "small", "slope"])
def test_planted_feet_are_found(kind: str) -> None:
    case = planted(kind)
    scores = score_contacts(kind, detect_contacts, [case])
    assert scores.tolerant.f1 > 0.95
    if kind != "noise":
        # Where nothing blurs the edges they are told to the frame.
        assert scores.strict.f1 > 0.95


def test_feet_rest_on_the_floor_they_are_on(take: Take, found: tuple[Contact, ...]) -> None:
    points = {p.key: p for p in contact_points(take)}
    for contact in found:
        assert isinstance(contact.target, Floor)
        place = point_positions(take, [points[contact.joint, contact.point]])[:, 0]
        inside = place[contact.start : contact.end, 1]
        assert inside.min() <= contact.target.height <= inside.max()
        assert contact.target.normal[1] > 0.99
        assert 0.5 <= contact.confidence <= 1.0
        assert not contact.drawn
    assert len({contact.id for contact in found}) == len(found)
    assert [c.start for c in found] == sorted(c.start for c in found)


def test_units_place_and_heading_do_not_matter(take: Take, found: tuple[Contact, ...]) -> None:
    assert spans(detect_contacts(scaled(take, 0.01))) == spans(found)
    assert spans(detect_contacts(elsewhere(take, 130.0, (5.0, 0.7, -3.0)))) == spans(found)


def test_missing_end_sites_hardly_matter(take: Take) -> None:
    case = replace(planted("60 Hz"), take=without_tips(take))
    assert score_contacts("", detect_contacts, [case]).tolerant.f1 > 0.95


def test_drawn_contacts_stay_and_nothing_is_found_over_them(
    take: Take, found: tuple[Contact, ...]
) -> None:
    first = next(c for c in found if c.point == "ball" and c.end - c.start > 30)
    drawn = replace(
        first, start=first.start + 5, end=first.end - 5, target=Fixed((1.0, 2.0, 3.0)), drawn=True
    )
    stale = Contact("old", "LeftFoot", "heel", 0, 400, Fixed((0.0, 0.0, 0.0)))
    again = detect_contacts(take, keep=(drawn, stale))
    assert drawn in again
    assert stale not in again
    assert len({c.id for c in again}) == len(again)
    own = [c for c in again if (c.joint, c.point) == (drawn.joint, drawn.point) and c != drawn]
    assert all(c.end <= drawn.start or c.start >= drawn.end for c in own)
    others = [s for s in spans(found) if s[:2] != (drawn.joint, drawn.point)]
    assert [s for s in spans(again) if s[:2] != (drawn.joint, drawn.point)] == others


def test_what_the_trim_leaves_out_does_not_count(take: Take) -> None:
    # A pose in a far corner, as some conversions put before the motion.
    translations = take.translations.copy()
    translations[:40] += [9.0, 3.0, 9.0]
    rotations = take.rotations.copy()
    rotations[:40] = rot.IDENTITY
    found = detect_contacts(replace(take.with_motion(rotations, translations), trim=(40, 700)))
    cut = detect_contacts(take.with_motion(take.rotations[40:700], take.translations[40:700]))
    assert spans(found) == [(joint, point, a + 40, b + 40) for joint, point, a, b in spans(cut)]


def test_feet_held_up_and_idle_hands_touch_nothing(take: Take) -> None:
    """All stand still for four seconds, the right leg raised for two of them."""
    skeleton = take.skeleton
    rotations = np.tile(rot.IDENTITY, (240, len(skeleton), 1))
    rise = np.clip(np.minimum(np.arange(240) - 40, 200 - np.arange(240)) / 20, 0, 1)
    rotations[:, skeleton.index["RightUpLeg"]] = rot.about_axis(0, -1.4 * rise)
    rotations[:, skeleton.index["RightLeg"]] = rot.about_axis(0, 1.2 * rise)
    place = np.tile([0.0, 0.97, 0.0], (240, 1, 1))
    still = replace(take, rotations=rotations, translations=place)
    found = detect_contacts(still)
    assert not [c for c in found if c.point == "palm"]
    right = [c for c in found if c.joint.startswith("Right")]
    assert right
    assert all(c.end <= 46 or c.start >= 194 for c in right)
    left = [c for c in found if c.joint.startswith("Left")]
    assert {(c.start, c.end) for c in left} == {(0, 240)}
    assert {c.point for c in left} == {"heel", "ball", "toe"}


def test_progress_rises_and_points_can_be_chosen(take: Take) -> None:
    heel = next(p for p in contact_points(take) if p.key == ("LeftFoot", "heel"))
    steps = detecting(take, points=[heel])
    seen: list[float] = []
    try:
        while True:
            step = next(steps)
            assert isinstance(step, Progress)
            seen.append(step.done)
    except StopIteration as stop:
        assert {(c.joint, c.point) for c in stop.value} == {heel.key}
    assert seen == sorted(seen)


@pytest.mark.parametrize("frames", [1, 2, 5])
def test_takes_of_few_frames(take: Take, frames: int) -> None:
    few = take.with_motion(take.rotations[:frames], take.translations[:frames])
    for contact in detect_contacts(few):
        assert 0 <= contact.start < contact.end <= frames


def test_a_chain_touches_nothing() -> None:
    rotations = np.tile(rot.IDENTITY, (50, 5, 1))
    assert detect_contacts(Take("c", chain(), rotations, np.zeros((50, 1, 3)), Fraction(30))) == ()


def test_a_hop_parts_a_contact() -> None:
    place = np.zeros((120, 3))
    place[60:64, 0] = np.linspace(0, 0.2, 4)
    place[64:, 0] = 0.2
    speed = np.r_[np.linalg.norm(np.diff(place, axis=0), axis=1) * 60 / 0.86, 0]
    assert set_down((0, 120), place, speed, 60.0, 0.86) == [(0, 60), (63, 120)]
    creep = np.zeros((120, 3))
    creep[:, 0] = np.linspace(0, 0.2, 120)
    assert set_down((0, 120), creep, np.full(120, 0.1), 60.0, 0.86) == [(0, 120)]
    assert set_down((0, 120), 0.1 * place, 0.1 * speed, 60.0, 0.86) == [(0, 120)]


def test_a_held_prop_is_found_while_it_is_held(take: Take) -> None:
    positions, world = take_pose(take)
    hand = take.skeleton.index["RightHand"]
    frames = np.arange(take.frames)
    held = (frames >= 200) & (frames < 500)
    grip = positions[:, hand] + rot.rotate(world[:, hand], np.array([-0.09, 0.0, 0.0]))
    lying = np.array([30.0, 0.0, 0.0])
    place = np.where(held[:, None], grip, lying)
    turn = np.where(held[:, None], world[:, hand], rot.IDENTITY)
    prop = rod(place, rot.continuous(turn), take.rate)
    touching = [c for c in detect_contacts(take, (prop,)) if isinstance(c.target, Following)]
    [contact] = touching
    assert (contact.joint, contact.point) == ("RightHand", "palm")
    assert contact.target.performer == "rod"
    assert contact.target.joint == "Rod"
    assert abs(contact.start - 200) <= 3
    assert abs(contact.end - 500) <= 3
    by_id = detect_contacts(take, {"prop-1": prop})
    assert any(isinstance(c.target, Following) and c.target.performer == "prop-1" for c in by_id)
    short = prop.with_motion(prop.rotations[:10], prop.translations[:10])
    with pytest.raises(MocapError, match="not as long"):
        detect_contacts(take, (short,))
