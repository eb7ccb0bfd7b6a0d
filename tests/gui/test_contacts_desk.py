"""The Contacts workspace in a real window, by mouse and keys."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from pathlib import Path

import mouse
import numpy as np
import pytest
from hands import CTRL, SHIFT, Hands
from PySide6.QtCore import QPointF, Qt
from PySide6.QtTest import QTest

from mocapstudio import formats
from mocapstudio.cleaning.contacts.model import Contact, Fixed, Floor, Following
from mocapstudio.cleaning.contacts.points import point_positions
from mocapstudio.cleaning.contacts.slide import measure_slide
from mocapstudio.cleaning.model import DigressionMap, Flag, Kind, Proposal
from mocapstudio.cleaning.parameters import DetectionParameters
from mocapstudio.evaluation.contacts_cases import made_case
from mocapstudio.gui.viewport.cast import ONION, Part
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.take import Take
from mocapstudio.review.model import Sitting

FRAMES = 150
DRIFT = 0.15
LANES = ["Left heel", "Left ball", "Left toe", "Right heel", "Right ball", "Right toe"]


@pytest.fixture(scope="module")
def slipping(tmp_path_factory) -> Path:
    """A walk that begins standing, as BVH; the whole body slips along x at 0.15 m/s."""
    take = made_case("60 Hz", "test", 7).take
    places = take.translations[:FRAMES].copy()
    places[:, 0, 0] += DRIFT * np.arange(FRAMES) / 60
    part = replace(take, rotations=take.rotations[:FRAMES], translations=places, trim=None)
    path = tmp_path_factory.mktemp("slipping") / "walk.bvh"
    formats.write(part, path)
    return path


@dataclass(frozen=True, eq=False)
class Flagged:
    """As much of an analysis as the document asks for."""

    take: Take
    map: DigressionMap
    flags: tuple[Flag, ...]
    context: tuple[Take, ...] = ()
    parameters: DetectionParameters = field(default_factory=DetectionParameters)
    unanalysed: tuple[str, ...] = ()

    def with_threshold(self, threshold: float) -> Flagged:
        return replace(self, parameters=replace(self.parameters, threshold=threshold))


class Contacts:
    """A user at the Contacts workspace of an open take."""

    def __init__(self, hands: Hands, *paths: Path, partners: tuple[Path, ...] = ()) -> None:
        self.hands, self.window = hands, hands.window
        # What is learnt and flagged is of no concern here.
        self.window.bridge.set_ui(learning=False)
        self.window.open(list(paths), [], list(partners))
        count = len(paths) + len(partners)
        hands.see(lambda: len(self.window.bridge.state.scene.performers) == count, 60)
        hands.press("2", CTRL)
        hands.see(lambda: self.space.objectName() == "contacts")
        hands.see(lambda: self.space.readings.now is not None, 60)

    @property
    def space(self):
        return self.window.switching.front

    @property
    def state(self):
        return self.window.bridge.state

    @property
    def document(self):
        return self.window.bridge.document

    @property
    def result(self) -> Take:
        return self.document.result(self.state.active)

    @property
    def plot(self):
        return self.space.lanes.plot

    def contacts(self, joint: str = "") -> list[Contact]:
        return [c for c in self.document.contacts(self.state.active) if joint in c.joint]

    def detect(self) -> None:
        self.hands.key(Qt.Key.Key_F5)
        self.hands.see(lambda: bool(self.contacts()) and not self.space.working.busy, 60)

    def solve(self) -> None:
        self.hands.key(Qt.Key.Key_Return, CTRL)
        self.hands.see(self.solved, 90)

    def solved(self) -> bool:
        reading = self.space.readings.now
        done = self.state.can_undo == "Solve contacts"
        return done and reading.solved and reading.after is self.result

    def at(self, contact: Contact, share: float) -> QPointF:
        """A place on a contact of the lanes: 0 its left edge, 1 its right edge."""
        box = self.plot.box_of(contact)
        inward = 1.0 if share == 0 else -1.0 if share == 1 else 0.0
        return QPointF(box.left() + share * box.width() + inward, box.center().y())

    def lane(self, name: str, frame: float) -> QPointF:
        """A place on a lane, by its name as it is shown."""
        names = [lane.name for lane in self.plot.lanes]
        height = self.plot.box_of(self.contacts()[0]).height() if self.contacts() else 24.0
        y = self.plot.area.top() + (names.index(name) + 0.5) * height
        return QPointF(self.plot.x_of(frame), y)

    def drag_lane(self, begin: QPointF, end: QPointF) -> None:
        mouse.drag(self.plot.viewport(), begin, end)

    def click_contact(self, contact: Contact, modifiers=mouse.PLAIN) -> None:
        mouse.click(self.plot.viewport(), self.at(contact, 0.5), modifiers=modifiers)

    def marker(self, contact: Contact) -> QPointF:
        """Where a contact's target is in the picture."""
        stage = self.space.stage
        names, places = stage.places()
        return stage.pixel_of(places[list(names).index(contact.id)])

    def drag_target(
        self,
        contact: Contact,
        way: QPointF,
        keys: tuple[Qt.Key, ...] = (),
        modifiers: Qt.KeyboardModifier = mouse.PLAIN,
    ) -> None:
        canvas, begin = self.space.stage.dragging.parent(), self.marker(contact)
        held = mouse.LEFT
        mouse.send(canvas, mouse.QEvent.Type.MouseButtonPress, begin, held, held, modifiers)
        for share in (0.3, 0.7, 1.0):
            at = begin + way * share
            mouse.send(canvas, mouse.QEvent.Type.MouseMove, at, mouse.NOTHING, held)
        for key in keys:
            self.hands.key(key)
        mouse.send(canvas, mouse.QEvent.Type.MouseButtonRelease, begin + way, held, mouse.NOTHING)
        # Until the body meets it, the target is shown where it was let go.
        self.hands.see(lambda: self.space.bridge.ui.held is None)

    def choose_kind(self, words: str) -> None:
        self.hands.choose("contact-kind", words)

    def export(self, path: Path) -> None:
        self.hands.press("E", CTRL)
        self.hands.answer_file_dialog(path)
        self.hands.see(path.exists, 30)


def of(contacts: list[Contact], joint: str, point: str) -> Contact:
    return next(c for c in contacts if (c.joint, c.point) == (joint, point))


def slide(user: Contacts, take: Take) -> float:
    """Mean slide in contact as the engine measures it, metres a second."""
    reading = user.space.readings.now
    return measure_slide(take, user.contacts(), reading.points, reading.others).mean


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


@pytest.fixture
def salsa(data, tmp_path) -> tuple[Path, Path]:
    """A second and a half of both dancers, hands joined."""
    paths = []
    for name in ("60_10", "61_10"):
        take = formats.read(data / "cmu_salsa_pairs_bvh" / f"{name}_scaled.bvh")[0][0]
        part = slice(450, 630)
        cut = replace(
            take, rotations=take.rotations[part], translations=take.translations[part], trim=None
        )
        paths.append(tmp_path / f"{name}.bvh")
        formats.write(replace(cut, name=name, source=None), paths[-1])
    return paths[0], paths[1]


def test_joined_hands_stay_together_after_a_repair(hands: Hands, salsa, tmp_path) -> None:
    user = Contacts(hands, salsa[0], partners=(salsa[1],))
    user.detect()
    (held,) = [c for c in user.contacts() if isinstance(c.target, Following)][:1]
    assert (held.joint, held.target.performer) == ("lHand", "61_10")
    user.click_contact(held)
    assert hands.find("contact-followed").currentText() == held.target.joint

    # A repair of the arm takes the hand away.
    take = user.state.take
    arm = take.skeleton.index[take.skeleton.names[take.skeleton.parents[
        take.skeleton.parents[take.skeleton.index["lHand"]]]]]  # fmt: skip
    span = slice(held.start, held.end)
    turn = rot.from_rotation_vector(np.deg2rad([0.0, 18.0, 0.0]))
    repair = Proposal(
        (take.skeleton.names[arm],), held.start, held.end,
        rot.multiply(take.rotations[span, [arm]], turn), None, "neighbours",
    )  # fmt: skip
    user.document.add_edit(repair, "Repair")
    hands.see(lambda: user.space.readings.now.before.rotations is not take.rotations, 30)
    hands.see(
        lambda: np.array_equal(user.space.readings.now.before.rotations, user.result.rotations)
    )
    reading = user.space.readings.now
    apart = reading.hold(held).gap(reading.place(held))
    assert apart.max() > 0.05

    user.solve()
    reading = user.space.readings.now
    assert reading.hold_after(held).gap(reading.place(held, after=True)).max() < 1e-3
    assert not user.space.bridge.ui.unreached

    # Without the partner it says so, and the rest is solved.
    hands.press("Z", CTRL)
    user.document.close_performer("61_10")
    hands.see(lambda: user.space.readings.now.trouble(held) != "", 30)
    user.click_contact(held)
    assert "61_10" in hands.text("contact-trouble")
    QTest.qWait(50)


def test_onion_skins_show_the_chosen_limb_before_and_after(hands: Hands, slipping: Path) -> None:
    user = Contacts(hands, slipping)
    user.drag_lane(user.lane("Left ball", 20), user.lane("Left ball", 59))
    user.document.set_frame(60)
    plain = hands.window.bridge.ui
    hands.press("G", SHIFT)
    roles = [one for one in user.space.stage.director.roles if one.part in ONION]
    # Three on each side, a tenth of a second apart: at 60 frames a second every sixth.
    assert sorted(one.frame(60) for one in roles) == [42, 48, 54, 66, 72, 78]
    assert [one.frame(3) for one in roles if one.part is Part.BEFORE] == [None, None, None]
    assert hands.window.actions_["onion"].isChecked()
    hands.press("G", SHIFT)
    assert hands.window.bridge.ui == plain
    assert not [one for one in user.space.stage.director.roles if one.part in ONION]


def test_contacts_that_cannot_be_met_say_so(hands: Hands, slipping: Path) -> None:
    user = Contacts(hands, slipping)

    def draw(start: int, end: int, place: tuple[float, float, float]) -> str:
        made = Contact("", "LeftToe", "ball", start, end, Fixed(place))
        return user.document.add_contact(made)

    # One frame, far out of reach.
    one = draw(60, 61, (3.0, 2.0, 0.9))
    user.space.bridge.choose(one)
    user.solve()
    assert re.fullmatch(
        r"Out of reach by \d+ mm in 1 frame: the nearest pose was taken\.",
        hands.text("contact-trouble"),
    )
    # Two at once that ask for different places.
    user.document.delete_contacts([one])
    one = draw(50, 90, (0.1, 0.0, 0.8))
    draw(70, 100, (0.1, 0.3, 1.3))
    user.space.bridge.choose(one)
    assert "asks for another place in 20 frames" in hands.text("contact-trouble")


def test_contacts_are_met_around_an_accepted_repair_only(hands: Hands, slipping: Path) -> None:
    user = Contacts(hands, slipping)
    assert not hands.window.actions_["contacts-around"].isEnabled()
    take = user.state.take
    thigh = take.skeleton.index["RightUpLeg"]
    flag = Flag("f", "RightUpLeg", ("RightUpLeg",), 60, 66, 0.9, 62, 0.9, Kind.POP)
    turn = rot.from_rotation_vector(np.deg2rad([6.0, 0.0, 0.0]))
    repair = Proposal(
        ("RightUpLeg",), 60, 66, rot.multiply(take.rotations[60:66, [thigh]], turn), None, "swap"
    )
    performer = user.state.active
    grid = np.zeros((take.frames, 1), np.float32)
    analysis = Flagged(take, DigressionMap(("RightUpLeg",), grid, grid), (flag,))
    user.document.finish_analysis(performer, user.document.begin_analysis(performer), analysis)
    user.document.set_proposal("f", None, repair)
    user.document.accept("f")
    hands.see(lambda: np.array_equal(user.space.readings.now.before.rotations,
                                     user.result.rotations))  # fmt: skip
    repaired = user.result
    # Nothing is detected yet: that comes first.
    hands.key(Qt.Key.Key_Return, CTRL | SHIFT)
    hands.see(user.solved, 90)
    changed = np.flatnonzero((user.result.rotations != repaired.rotations).any(axis=(1, 2)))
    room = round(0.3 * 60)
    # As much again eases in and out.
    assert changed.min() >= 60 - 2 * room
    assert changed.max() < 66 + 2 * room
    held = [c for c in user.contacts("Right") if c.start < 66 and c.end > 60]
    assert held
    reading = user.space.readings.now
    for contact in held:
        inside = np.arange(max(60, contact.start), min(66, contact.end)) - contact.start
        place = reading.place(contact, after=True)[inside]
        assert np.linalg.norm(np.diff(place, axis=0), axis=1).max() < 1e-3


def test_a_key_lets_proposals_keep_hands_and_feet(hands: Hands, slipping: Path) -> None:
    user = Contacts(hands, slipping)
    hands.press("H")
    assert not user.state.keep_ends
    hands.press("1", CTRL)
    action = hands.window.actions_["keep-ends"]
    hands.press("H")
    assert user.state.keep_ends
    assert action.isChecked()
    # It is no step of the sitting.
    assert user.state.can_undo is None
    assert not user.state.dirty
    hands.press("H")
    assert not user.state.keep_ends
    assert not action.isChecked()
