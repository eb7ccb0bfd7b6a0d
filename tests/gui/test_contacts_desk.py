"""The Contacts workspace in a real window, by mouse and keys."""

from __future__ import annotations

from pathlib import Path

import mouse
import numpy as np
import pytest
from contacts_user import DRIFT, FRAMES, LANES, Contacts, of, slide
from hands import CTRL, SHIFT, Hands
from PySide6.QtCore import QPointF, Qt

from mocapstudio import formats
from mocapstudio.cleaning.contacts.model import Contact, Fixed, Floor
from mocapstudio.cleaning.contacts.points import point_positions
from mocapstudio.cleaning.contacts.slide import measure_slide
from mocapstudio.review.model import Sitting


def test_detect_shape_target_solve_undo_export(hands: Hands, slipping: Path, tmp_path) -> None:
    user = Contacts(hands, slipping)
    names = [lane.name for lane in user.plot.lanes]
    assert names[: len(LANES)] == LANES
    assert hands.find("contacts-hint").text()
    user.detect()
    assert not hands.shows("contacts-hint")
    heel = of(user.contacts(), "LeftFoot", "heel")
    source = user.state.take

    # The edge of a span.
    wanted = heel.end - 30
    edge = user.at(heel, 1)
    step = user.plot.x_of(1) - user.plot.x_of(0)
    user.drag_lane(edge, edge - QPointF(30 * step, 0))
    moved = next(c for c in user.contacts() if c.id == heel.id)
    assert (moved.start, moved.end, moved.drawn) == (heel.start, wanted, True)
    assert user.state.can_undo == "Resize contact"
    assert hands.text("contact-name") == "Left heel"
    assert hands.find("contact-last").value() == wanted - 1 + source.first_frame

    # Its target, by the mouse: the depth stays, so the picture says where it must be.
    user.document.set_frame(60)
    hands.choose("contact-kind", "Fixed point")
    begin, way = user.marker(moved), QPointF(18.0, -4.0)
    user.drag_target(moved, way)
    moved = next(c for c in user.contacts() if c.id == heel.id)
    assert isinstance(moved.target, Fixed)
    assert user.state.can_undo == "Move target"
    assert user.marker(moved).x() - begin.x() == pytest.approx(way.x(), abs=1.0)
    # So little above the floor it snaps to it.
    assert isinstance(heel.target, Floor)
    assert moved.target.position[1] == pytest.approx(heel.target.height, abs=1e-3)

    # Ball and toe of that foot would hold it back.
    for point in ("ball", "toe"):
        user.click_contact(of(user.contacts(), "LeftToe", point))
        hands.key(Qt.Key.Key_Delete)
    user.click_contact(moved)

    # Solve: the heel is where it was put, and nothing slides.
    assert slide(user, user.result) > 0.5 * DRIFT
    user.solve()
    assert slide(user, user.result) < 1e-3
    reading = user.space.readings.now
    away = reading.place(moved, after=True) - np.array(moved.target.position)
    assert not user.space.bridge.ui.unreached
    assert np.abs(away).max() < 1e-3
    assert hands.text("contact-slide-after") == "0.0 cm/s"

    # All of it is taken back, and the export is the source to the byte.
    while user.state.can_undo is not None:
        hands.press("Z", CTRL)
    assert user.contacts() == []
    assert user.state.sitting.edits == Sitting().edits
    np.testing.assert_array_equal(user.result.rotations, source.rotations)
    user.export(tmp_path / "undone.bvh")
    assert (tmp_path / "undone.bvh").read_bytes() == slipping.read_bytes()

    # Done again, the solve is one step, and the file has it.
    while user.state.can_redo is not None:
        hands.press("Y", CTRL)
    assert user.state.can_undo == "Solve contacts"
    user.export(tmp_path / "solved.bvh")
    written = formats.read(tmp_path / "solved.bvh")[0][0]
    points = user.space.readings.now.points
    assert measure_slide(written, user.contacts(), points).mean < 2e-3


def test_contacts_are_drawn_moved_cut_joined_and_deleted(
    hands: Hands, slipping: Path, tmp_path
) -> None:
    user = Contacts(hands, slipping)
    user.drag_lane(user.lane("Left ball", 20), user.lane("Left ball", 59))
    (drawn,) = user.contacts()
    assert (drawn.joint, drawn.point, drawn.start, drawn.end) == ("LeftToe", "ball", 20, 60)
    assert isinstance(drawn.target, Floor)
    reading = user.space.readings.now
    assert drawn.target.height == pytest.approx(np.median(reading.place(drawn)[:, 1]), abs=0.01)

    # Moved as a whole, it keeps its length; the take's end stops it.
    user.drag_lane(user.at(drawn, 0.5), user.at(drawn, 0.5) + QPointF(5000, 0))
    (moved,) = user.contacts()
    assert (moved.start, moved.end) == (FRAMES - 40, FRAMES)

    # A second one ends where the first begins.
    user.drag_lane(user.lane("Left ball", 80), user.lane("Left ball", 140))
    assert [(c.start, c.end) for c in user.contacts()] == [(80, 110), (110, 150)]

    # Cut at the play head, join by Ctrl and M.
    _, second = user.contacts()
    user.click_contact(second)
    user.document.set_frame(130)
    hands.press("S")
    assert [(c.start, c.end) for c in user.contacts()] == [(80, 110), (110, 130), (130, 150)]
    user.click_contact(user.contacts()[0])
    user.click_contact(user.contacts()[1], CTRL)
    hands.press("M")
    assert [(c.start, c.end) for c in user.contacts()] == [(80, 130), (130, 150)]
    hands.key(Qt.Key.Key_Delete)
    assert [(c.start, c.end) for c in user.contacts()] == [(130, 150)]
    hands.press("Z", CTRL)
    assert len(user.contacts()) == 2

    # Detecting leaves both alone.
    before = user.contacts()
    user.detect()
    hands.see(lambda: len(user.contacts()) > 2)
    assert [c for c in user.contacts() if c.drawn] == before

    # Saved and loaded.
    kept = [(c.joint, c.point, c.start, c.end, c.drawn) for c in user.contacts()]
    hands.menu("Contacts", "Save Contacts As")
    hands.answer_file_dialog(tmp_path / "c.json")
    hands.see((tmp_path / "c.json").exists)
    user.document.delete_contacts([c.id for c in user.contacts()])
    hands.menu("Contacts", "Load Contacts")
    hands.answer_file_dialog(tmp_path / "c.json")
    hands.see(lambda: bool(user.contacts()))
    assert [(c.joint, c.point, c.start, c.end, c.drawn) for c in user.contacts()] == kept


def test_an_axis_is_locked_and_a_drag_given_up(hands: Hands, slipping: Path) -> None:
    user = Contacts(hands, slipping)
    user.detect()
    hands.press("S", Qt.KeyboardModifier.ShiftModifier)
    toe = of(user.contacts(), "RightToe", "ball")
    user.click_contact(toe)
    user.document.set_frame(60)
    assert isinstance(toe.target, Floor)

    # Y alone: the floor rises, and is still a floor.
    user.drag_target(toe, QPointF(30, -20), (Qt.Key.Key_Y,))
    risen = next(c for c in user.contacts() if c.id == toe.id)
    assert isinstance(risen.target, Floor)
    assert risen.target.height > toe.target.height + 0.01
    assert risen.target.normal == toe.target.normal

    # X alone: nothing but x changes.
    hands.choose("contact-kind", "Fixed point")
    fixed = next(c for c in user.contacts() if c.id == toe.id)
    user.drag_target(fixed, QPointF(30, -20), (Qt.Key.Key_X,))
    moved = next(c for c in user.contacts() if c.id == toe.id)
    assert moved.target.position[0] != pytest.approx(fixed.target.position[0], abs=1e-3)
    assert moved.target.position[1:] == pytest.approx(fixed.target.position[1:])

    # Escape: nothing at all.
    sitting = user.state.sitting
    user.drag_target(moved, QPointF(30, -20), (Qt.Key.Key_Escape,))
    assert user.state.sitting is sitting
    assert user.space.bridge.ui.held is None

    # A hand itself, by the mouse: it goes where it is put, and what was put is an edit.
    hands.press("B")
    stage = user.space.stage
    names, places = stage.places()
    number = names.index("LeftHand palm")
    begin = stage.pixel_of(places[number])
    canvas, rotations = stage.dragging.parent(), user.result.rotations
    mouse.drag(canvas, begin, begin + QPointF(12, -16))
    assert user.state.can_undo == "Key pose"
    hands.see(lambda: np.array_equal(user.space.readings.now.after.rotations,
                                     user.result.rotations))  # fmt: skip
    seen = stage.pixel_of(stage.places()[1][number]) - (begin + QPointF(12, -16))
    assert abs(seen.x()) + abs(seen.y()) < 3.0
    hands.press("Z", CTRL)
    np.testing.assert_array_equal(user.result.rotations, rotations)


def test_the_body_follows_a_dragged_target_and_stays_when_it_is_let_go(
    hands: Hands, slipping: Path
) -> None:
    user = Contacts(hands, slipping)
    user.detect()
    ball = of(user.contacts(), "RightToe", "ball")
    user.click_contact(ball)
    user.document.set_frame(60)
    hands.choose("contact-kind", "Fixed point")
    fixed = next(c for c in user.contacts() if c.id == ball.id)
    stage, before, sitting = user.space.stage, user.result, user.state.sitting
    was = stage.director.points(60).copy()
    elsewhere = stage.director.points(30).copy()

    # While the button is held: the foot goes along, at this frame alone, and nothing is kept.
    canvas, begin, held = stage.dragging.parent(), user.marker(fixed), mouse.LEFT
    end = begin + QPointF(14.0, -30.0)
    mouse.send(canvas, mouse.QEvent.Type.MouseButtonPress, begin, held, held)
    for share in (0.4, 1.0):
        at = begin + (end - begin) * share
        mouse.send(canvas, mouse.QEvent.Type.MouseMove, at, mouse.NOTHING, held)
    bent = stage.director.points(60).copy()
    foot = user.state.take.skeleton.index["RightToe"]
    assert np.linalg.norm(bent[foot] - was[foot]) > 0.03
    np.testing.assert_array_equal(stage.director.points(30), elsewhere)
    assert user.state.sitting is sitting
    reached = stage.pixel_of(stage.bending.place_at(60)) - end
    assert abs(reached.x()) + abs(reached.y()) < 1.5

    # Let go: one step, and the frame looks as it did under the hand.
    mouse.send(canvas, mouse.QEvent.Type.MouseButtonRelease, end, held, mouse.NOTHING)
    hands.see(lambda: user.space.bridge.ui.held is None)
    assert user.state.can_undo == "Move target"
    np.testing.assert_allclose(stage.director.points(60), bent, atol=1e-3)
    moved = next(c for c in user.contacts() if c.id == ball.id)
    reading = user.space.readings.now
    positions = point_positions(user.result, reading.points)[moved.start : moved.end]
    number = [p.key for p in reading.points].index(("RightToe", "ball"))
    away = np.linalg.norm(positions[:, number] - moved.target.position, axis=1)
    assert away.max() < 1e-3
    # Only its own leg moved.
    changed = np.flatnonzero((user.result.rotations != before.rotations).any(axis=(0, 2)))
    assert {user.state.take.skeleton.names[j][:5] for j in changed} == {"Right"}
    np.testing.assert_array_equal(user.result.translations, before.translations)
    hands.press("Z", CTRL)
    np.testing.assert_array_equal(user.result.rotations, before.rotations)
    assert next(c for c in user.contacts() if c.id == ball.id).target == fixed.target


def test_a_foot_goes_as_a_whole_unless_a_point_is_dragged_alone(
    hands: Hands, slipping: Path
) -> None:
    user = Contacts(hands, slipping)
    user.detect()
    user.solve()
    hands.press("S", SHIFT)
    joints = ("RightFoot", "heel"), ("RightToe", "ball")
    heel, ball = (of(user.contacts(), *one) for one in joints)
    frame = max(heel.start, ball.start) + 3
    assert frame < min(heel.end, ball.end)
    user.document.set_frame(frame)
    user.click_contact(heel)
    sitting, steps, start = user.state.sitting, user.state.can_undo, user.result
    points = user.space.readings.now.points
    numbers = [[p.key for p in points].index(key) for key in joints]

    def feet() -> np.ndarray:
        return point_positions(user.result, points)[frame, numbers]

    def ring(contact: Contact) -> QPointF:
        return user.marker(next(c for c in user.contacts() if c.id == contact.id))

    # Both points go the same way, and so do both rings.
    before, rings = feet(), [ring(heel), ring(ball)]
    user.drag_target(heel, QPointF(12.0, -24.0))
    assert user.state.can_undo == "Move target"
    hands.see(lambda: user.space.readings.now.after is user.result)
    gone = feet() - before
    assert np.linalg.norm(gone[0]) > 0.02
    np.testing.assert_allclose(gone[1], gone[0], atol=4e-3)
    unmet = {one.contact for one in user.space.bridge.ui.unreached}
    assert not unmet & {heel.id, ball.id}
    for was, contact in zip(rings, (heel, ball), strict=True):
        way = ring(contact) - was
        assert way.x() == pytest.approx(12.0, abs=3.0)
        assert way.y() == pytest.approx(-24.0, abs=3.0)
    hands.press("Z", CTRL)
    assert user.state.sitting == sitting
    assert user.state.can_undo == steps
    np.testing.assert_array_equal(user.result.rotations, start.rotations)

    # With Ctrl the other target stays what it was.
    hands.see(lambda: user.space.readings.now.after is user.result)
    user.drag_target(heel, QPointF(12.0, -24.0), modifiers=CTRL)
    kept = {c.id: c for c in user.contacts()}
    assert kept[heel.id].target != heel.target
    assert kept[ball.id] == ball
