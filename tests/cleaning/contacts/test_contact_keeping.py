"""Repairs that leave hands and feet where they were, or on what they touch."""

from __future__ import annotations

import numpy as np
import pytest
from made_takes import turned, walking

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.contacts.aware import donor_for_contacts
from mocapstudio.cleaning.contacts.keeping import Kept, keeping, propose_keeping
from mocapstudio.cleaning.contacts.model import (
    ENDS_KEPT,
    ON_CONTACTS,
    Contact,
    ContactPoint,
    Fixed,
)
from mocapstudio.cleaning.contacts.points import point_positions
from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.model import Flag, Kind, Proposal
from mocapstudio.cleaning.proposals import apply, propose
from mocapstudio.cleaning.reasons import neighbours
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take

HAND = ContactPoint("LeftHand", "palm", np.array([0.06, 0.0, 0.0]))
START, END = 40, 60


@pytest.fixture(scope="module")
def walk() -> Take:
    """Its arms are bent, so that they can give way."""
    take = walking(4.0, 30, seed=0)
    for side, way in (("Left", -1), ("Right", 1)):
        take = turned(take, f"{side}ForeArm", 0, take.frames, 70.0 * way)
    return take


@pytest.fixture(scope="module")
def chest(walk: Take) -> Proposal:
    """A repair that carries both arms along."""
    moved = turned(walk, "Chest", START, END, 8.0)
    at = walk.skeleton.index["Chest"]
    return Proposal(
        ("Chest",), START, END, moved.rotations[START:END, [at]].copy(), None, "prediction"
    )


def hold(walk: Take, start: int, end: int, way: tuple[float, float, float]) -> Contact:
    place = point_positions(walk, [HAND])[(START + END) // 2, 0] + way
    x, y, z = (float(value) for value in place)
    return Contact("c", "LeftHand", "palm", start, end, Fixed((x, y, z)))


def outside(take: Take, proposal: Proposal, other: Take) -> np.ndarray:
    """(F, J): samples that differ though the proposal does not declare them."""
    changed = (take.rotations != other.rotations).any(axis=2)
    columns = [take.skeleton.index[name] for name in proposal.joints]
    changed[proposal.start : proposal.end, columns] = False
    return changed


def test_hands_stay_and_it_is_said(walk: Take, chest: Proposal) -> None:
    kept = keeping(walk, chest, Kept(ends=True))
    hands = [walk.skeleton.index[name] for name in ("LeftHand", "RightHand")]
    was = take_pose(walk)[0][:, hands]
    plain, bent = apply(walk, chest), apply(walk, kept)
    assert np.linalg.norm(take_pose(plain)[0][50, hands] - was[50], axis=1).min() > 0.02
    np.testing.assert_allclose(take_pose(bent)[0][:, hands], was, atol=1e-3)
    assert kept.method == f"prediction, {ENDS_KEPT}"
    assert kept.joints[0] == "Chest"
    assert {"LeftArm", "RightArm"} <= set(kept.joints)
    assert not outside(walk, kept, bent).any()
    np.testing.assert_array_equal(bent.translations, walk.translations)
    # The repair itself is as it was, and what hands do is told.
    at = walk.skeleton.index["Chest"]
    np.testing.assert_array_equal(bent.rotations[:, at], plain.rotations[:, at])
    assert all(kept.displacement.get(name, 0.0) < 1e-3 for name in ("LeftHand", "RightHand"))


def test_a_hand_in_contact_stays_on_its_target_where_the_repair_would_take_it_away(
    walk: Take, chest: Proposal
) -> None:
    one = hold(walk, 48, 53, (0.0, 0.0, 0.0))
    kept = keeping(walk, chest, Kept(contacts=(one,), points=(HAND,)))
    bent = apply(walk, kept)
    away = point_positions(bent, [HAND])[48:53, 0] - one.target.position
    assert np.linalg.norm(away, axis=1).max() < 1e-3
    assert kept.method == f"prediction, {ON_CONTACTS}"
    # It eases in and out, and says so; the other arm goes with the chest.
    assert kept.start <= START
    assert kept.end >= END
    assert not outside(walk, kept, bent).any()
    assert not any(name.startswith("Right") for name in kept.joints)


def test_what_a_repair_does_not_move_is_left_alone(walk: Take, chest: Proposal) -> None:
    later = hold(walk, 80, 100, (0.02, 0.0, 0.0))
    assert keeping(walk, chest, Kept(contacts=(later,), points=(HAND,))) is chest
    at = walk.skeleton.index["Chest"]
    still = Proposal(("Chest",), START, END, walk.rotations[START:END, [at]], None, "prediction")
    near = hold(walk, 30, 70, (0.02, 0.0, 0.0))
    assert keeping(walk, still, Kept(True, (near,), (HAND,))) is still


@pytest.fixture(scope="module")
def analysis() -> Analysis:
    take = turned(walking(10.0, 30, seed=0), "LeftArm", 100, 125, 50.0)
    return run(detect(take, [walking(10.0, 30, seed=1), walking(10.0, 30, seed=2)]))


def test_the_nearest_neighbour_is_taken_and_bent_to_the_contact(analysis: Analysis) -> None:
    flag = Flag("f", "LeftArm", ("LeftArm",), 100, 125, 0.9, 105, 0.9, Kind.OFFSET)
    plain = apply(analysis.take, propose(analysis, flag))
    x, y, z = (float(v) for v in point_positions(plain, [HAND])[112, 0] + [0.0, -0.03, 0.03])
    one = Contact("c", "LeftHand", "palm", 112, 115, Fixed((x, y, z)))
    kept = propose_keeping(analysis, flag, kept=Kept(contacts=(one,), points=(HAND,)))
    choice = donor_for_contacts(analysis, flag, [one], [HAND])
    assert choice is not None
    assert kept.donor == neighbours(analysis, flag)[choice]
    assert kept.method == f"neighbours, {ON_CONTACTS}"
    place = point_positions(apply(analysis.take, kept), [HAND])[112:115, 0]
    assert np.linalg.norm(place - [x, y, z], axis=1).max() < 1e-3
    # A neighbour that is chosen by hand is bent as well.
    other = (choice + 1) % len(neighbours(analysis, flag))
    chosen = propose_keeping(analysis, flag, other, kept=Kept(contacts=(one,), points=(HAND,)))
    assert chosen.donor == neighbours(analysis, flag)[other]
    assert chosen.method == f"neighbours, {ON_CONTACTS}"
    free = propose_keeping(analysis, flag, kept=Kept())
    assert free.method == propose(analysis, flag).method
