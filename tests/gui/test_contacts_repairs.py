"""Contacts and repairs of flags together, in a real window: hands joined, feet kept."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pytest
from contacts_user import Contacts
from hands import CTRL, SHIFT, Hands
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from mocapstudio import formats
from mocapstudio.cleaning.contacts.model import Contact, Fixed, Following
from mocapstudio.cleaning.model import DigressionMap, Flag, Kind, Proposal
from mocapstudio.cleaning.parameters import DetectionParameters
from mocapstudio.gui.viewport.cast import ONION, Part
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.take import Take


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
