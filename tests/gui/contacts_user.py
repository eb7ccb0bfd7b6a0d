"""What a user of the Contacts workspace does and sees there, and a walk that slips."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import mouse
import numpy as np
from hands import CTRL, Hands
from PySide6.QtCore import QPointF, Qt

from mocapstudio import formats
from mocapstudio.cleaning.contacts.model import Contact
from mocapstudio.cleaning.contacts.slide import measure_slide
from mocapstudio.evaluation.contacts_cases import made_case
from mocapstudio.motion.take import Take

FRAMES = 150
DRIFT = 0.15
LANES = ["Left heel", "Left ball", "Left toe", "Right heel", "Right ball", "Right toe"]


def write_slipping(path: Path) -> Path:
    """A walk that begins standing, as BVH; the whole body slips along x at 0.15 m/s."""
    take = made_case("60 Hz", "test", 7).take
    places = take.translations[:FRAMES].copy()
    places[:, 0, 0] += DRIFT * np.arange(FRAMES) / 60
    part = replace(take, rotations=take.rotations[:FRAMES], translations=places, trim=None)
    formats.write(part, path)
    return path


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
