"""What the Contacts workspace is made of, without a window."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_takes import person, walking

from mocapstudio.cleaning.contacts.model import (
    Contact,
    ContactPoint,
    Fixed,
    Floor,
    Following,
    Line,
)
from mocapstudio.cleaning.contacts.points import contact_points, point_positions
from mocapstudio.cleaning.contacts.slide import measure_slide
from mocapstudio.cleaning.ik.ranges import joint_ranges
from mocapstudio.gui.contacts.lane_gestures import (
    Part,
    others_of,
    reshaped,
    room_for,
    swept,
)
from mocapstudio.gui.contacts.lanes import lanes_of
from mocapstudio.gui.contacts.measuring import measured
from mocapstudio.gui.contacts.reading import Reading
from mocapstudio.gui.contacts.targets import (
    converted,
    drawn_target,
    kind_of,
    moved,
    nearest_joint,
    place_at,
)
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take
from mocapstudio.review.beside import on_clock

FRAMES = 90


ORIGIN = Fixed((0.0, 0.0, 0.0))


def heel(start: int, end: int, target=ORIGIN, name: str = "") -> Contact:
    return Contact(name or f"heel-{start}", "LeftFoot", "heel", start, end, target)


@pytest.fixture(scope="module")
def reading() -> Reading:
    """A walker, and a second one beside them."""
    take, other = walking(3.0, seed=0), walking(3.0, seed=1)
    points = contact_points(take)
    places = point_positions(take, points)
    palms = {"other": contact_points(other)}
    ranges = joint_ranges([take])
    return Reading(take, points, take, take, places, places, {"other": other}, palms, ranges)


spans = st.lists(
    st.tuples(st.integers(0, FRAMES - 1), st.integers(1, 25)), min_size=1, max_size=6
).map(
    lambda pairs: _apart([(a, min(a + n, FRAMES)) for a, n in sorted(pairs)])
)  # fmt: skip


def _apart(found: list[tuple[int, int]]) -> list[Contact]:
    kept: list[Contact] = []
    for start, end in found:
        if not kept or start >= kept[-1].end:
            kept.append(heel(start, end))
    return kept


@settings(max_examples=60)
@given(spans, st.data())
def test_no_drag_makes_contacts_of_a_lane_overlap(contacts, data) -> None:
    one = data.draw(st.sampled_from(contacts))
    part, by = data.draw(st.sampled_from(list(Part))), data.draw(st.integers(-200, 200))
    others = others_of(one, contacts)
    shaped = reshaped(one, part, by, room_for(one.start, one.end, others, FRAMES))
    assert 0 <= shaped.start < shaped.end <= FRAMES
    assert not any(shaped.start < o.end and o.start < shaped.end for o in others)
    if part is Part.BODY:
        assert shaped.end - shaped.start == one.end - one.start
    elif part is Part.START:
        assert shaped.end == one.end
    else:
        assert shaped.start == one.start


@settings(max_examples=60)
@given(spans, st.integers(0, FRAMES - 1), st.integers(0, FRAMES - 1))
def test_a_sweep_fills_free_room_from_where_it_began(contacts, a, b) -> None:
    span = swept(a, b, contacts, FRAMES)
    taken = any(c.start <= a < c.end for c in contacts)
    assert (span is None) == taken
    if span is not None:
        low, high = span
        assert low <= a < high
        assert low >= 0
        assert high <= FRAMES
        assert min(a, b) <= low
        assert high <= max(a, b) + 1
        assert not any(low < c.end and c.start < high for c in contacts)


def test_lanes_stand_left_before_right_feet_before_hands() -> None:
    take = walking()
    lanes = lanes_of(take.skeleton, contact_points(take), ())
    assert [lane.name for lane in lanes] == [
        "Left heel", "Left ball", "Right heel", "Right ball", "Left palm", "Right palm",
    ]  # fmt: skip


def test_a_contact_of_another_joint_has_a_lane_too() -> None:
    elbow = Contact("e", "LeftForeArm", None, 1, 5, Fixed((0.0, 0.0, 0.0)))
    lanes = lanes_of(person(), (), [elbow])
    assert [lane.key for lane in lanes] == [("LeftForeArm", None)]


def test_curves_are_what_the_engine_measures(reading: Reading) -> None:
    contacts = [
        heel(5, 40, Floor(0.02)),
        heel(50, 51, Fixed((0.3, 0.0, 0.2))),
        heel(60, 80, Line((0.1, 0.0, 0.0), (0.0, 0.0, 2.0))),
        Contact("p", "LeftHand", "palm", 20, 70, Following("other", "RightHand", (0.0, 0.1, 0.0))),
    ]
    ours = measured(reading, contacts, after=False)
    engine = measure_slide(reading.source, contacts, reading.points, reading.others)
    assert ours.mean_slide == pytest.approx(100 * engine.mean)
    np.testing.assert_allclose(ours.slide, 100 * engine.frames)
    assert ours.worst_gap == pytest.approx(1000 * max(c.gap for c in engine.contacts))
    touched = np.zeros(reading.source.frames, dtype=bool)
    for one in contacts:
        touched[one.start : one.end] = True
    np.testing.assert_array_equal(np.isfinite(ours.gap), touched)


def test_a_contact_without_its_partner_is_told_and_left_out(reading: Reading) -> None:
    lost = Contact("p", "LeftHand", "palm", 20, 70, Following("nobody", "RightHand"))
    assert "nobody" in reading.trouble(lost)
    assert measured(reading, [lost], after=False).mean_slide == 0.0
    assert place_at(reading, lost, 30) is None


@pytest.mark.parametrize("kind", ["fixed", "floor", "line", "following"])
def test_another_kind_of_target_stays_about_where_the_point_is(reading: Reading, kind) -> None:
    palm = Contact("p", "LeftHand", "palm", 20, 30, Fixed((0.0, 0.0, 0.0)))
    middle = np.median(reading.place(palm), axis=0)
    one = replace(palm, target=Fixed(tuple(middle.tolist())))
    target = converted(reading, one, kind, 25)
    assert target is not None
    assert kind_of(target) == kind
    hold = reading.hold(replace(one, target=target))
    assert hold is not None
    reach = np.ptp(reading.place(one), axis=0).max() + 1e-9
    if kind == "following":
        other = take_pose(reading.others["other"], 20, 30)[0]
        reach += np.ptp(other, axis=0).max()
    assert np.abs(np.median(hold.target, axis=0) - middle).max() <= reach


def test_no_partner_no_following(reading: Reading) -> None:
    alone = replace(reading, others={}, palms={}, _laid={})
    assert converted(alone, heel(3, 9), "following", 4) is None


@pytest.mark.parametrize(
    "target",
    [
        Fixed((0.0, 0.0, 0.0)),
        Line((0.0, 0.0, 0.0), (1.0, 0.0, 0.0)),
        Following("other", "RightHand", (0.0, 0.0, 0.0)),
    ],
)
def test_a_dragged_target_is_where_it_was_dragged(reading: Reading, target) -> None:
    one, place = heel(10, 30, target), np.array([0.4, 0.7, -0.2])
    there = replace(one, target=moved(reading, one, place, 17, upright=False))
    assert kind_of(there.target) == kind_of(target)
    found = place_at(reading, there, 17)
    assert found is not None
    np.testing.assert_allclose(found, place, atol=1e-9)


def test_a_floor_that_is_dragged_sideways_becomes_a_point(reading: Reading) -> None:
    one, place = heel(10, 30, Floor(0.1)), np.array([0.4, 0.3, -0.2])
    assert moved(reading, one, place, 17, upright=False) == Fixed((0.4, 0.3, -0.2))
    assert moved(reading, one, place, 17, upright=True) == Floor(0.3)


def test_a_drawn_foot_stands_on_the_floor_of_its_lane(reading: Reading) -> None:
    point = next(p for p in reading.points if p.key == ("LeftFoot", "heel"))
    known = (heel(0, 5, Floor(0.3)), heel(60, 70, Floor(0.5)))
    assert drawn_target(reading, point, heel(50, 55), known) == Floor(0.5)
    alone = drawn_target(reading, point, heel(50, 55), ())
    assert isinstance(alone, Floor)
    heights = reading.place(heel(50, 55))[:, 1]
    assert heights.min() <= alone.height <= heights.max()


def test_a_drawn_hand_holds_the_partner_only_when_near(reading: Reading) -> None:
    point = next(p for p in reading.points if p.key == ("LeftHand", "palm"))
    palm = Contact("", "LeftHand", "palm", 10, 20, Fixed((0.0, 0.0, 0.0)))
    far = replace(reading, others={"other": shifted(reading.source, 3.0)}, _laid={})
    assert isinstance(drawn_target(far, point, palm, ()), Fixed)
    near = replace(reading, others={"other": shifted(reading.source, 0.05)}, _laid={})
    held = drawn_target(near, point, palm, ())
    assert isinstance(held, Following)
    assert (held.performer, held.joint) == ("other", "LeftHand")


def shifted(take: Take, metres: float) -> Take:
    places = take.translations.copy()
    places[:, 0, 0] += metres
    return take.with_motion(translations=places)


def test_the_nearest_joint_is_the_nearest(reading: Reading) -> None:
    other = reading.others["other"]
    positions = take_pose(other, 12, 13)[0][0]
    spot = positions[other.skeleton.index["RightHand"]] + 0.001
    assert nearest_joint(reading.others, spot, 12) == ("other", "RightHand")
    assert nearest_joint({}, spot, 12) is None


def test_a_partner_on_another_clock_is_seen_at_the_same_moment() -> None:
    take, other = walking(3.0, rate=30), walking(2.0, rate=60, seed=1)
    beside = on_clock(take, 0.5, other, 1.0)
    assert (beside.frames, beside.rate) == (take.frames, Fraction(30))
    for frame in range(take.frames):
        # Seconds of the scene, then the other's own frame.
        own = round((0.5 + frame / 30 - 1.0) * 60)
        own = min(max(own, 0), other.frames - 1)
        np.testing.assert_array_equal(beside.rotations[frame], other.rotations[own])
    assert on_clock(other, 0.5, other, 0.5) is other


def test_a_contact_point_that_is_not_known_is_the_joint(reading: Reading) -> None:
    elbow = Contact("e", "LeftForeArm", None, 4, 9, Fixed((0.0, 0.0, 0.0)))
    joint = reading.source.skeleton.index["LeftForeArm"]
    np.testing.assert_allclose(reading.place(elbow), take_pose(reading.source, 4, 9)[0][:, joint])
    assert isinstance(reading.point(elbow), ContactPoint)
