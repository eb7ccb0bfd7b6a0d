"""Repair that knows of contacts: which donor is taken."""

from __future__ import annotations

import numpy as np
import pytest
from made_takes import turned, walking

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.contacts.aware import donor_for_contacts
from mocapstudio.cleaning.contacts.model import Contact, ContactPoint, Fixed
from mocapstudio.cleaning.contacts.points import point_positions
from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.model import Flag, Kind
from mocapstudio.cleaning.proposals import apply, propose
from mocapstudio.cleaning.reasons import neighbours
from mocapstudio.motion.facing import ROOT_POSITION
from mocapstudio.motion.progress import run

HAND = ContactPoint("LeftHand", "palm", np.array([0.06, 0.0, 0.0]))


@pytest.fixture(scope="module")
def analysis() -> Analysis:
    take = turned(walking(10.0, 30, seed=0), "LeftArm", 100, 125, 50.0)
    return run(detect(take, [walking(10.0, 30, seed=1), walking(10.0, 30, seed=2)]))


def flag(row: str) -> Flag:
    return Flag("f", row, (row,), 100, 125, 0.9, 105, 0.9, Kind.OFFSET)


def contact(analysis: Analysis, reach: float, start: int = 105, end: int = 115) -> Contact:
    place = point_positions(analysis.take, [HAND])[110, 0] + [reach, 0.4 * reach, 0.0]
    x, y, z = (float(v) for v in place)
    return Contact("c", "LeftHand", "palm", start, end, Fixed((x, y, z)))


@pytest.mark.parametrize("reach", [-0.3, 0.0, 0.3])
def test_the_neighbour_that_comes_closest_is_taken(analysis: Analysis, reach: float) -> None:
    one = contact(analysis, reach)
    assert isinstance(one.target, Fixed)
    choice = donor_for_contacts(analysis, flag("LeftArm"), [one], [HAND])
    gaps = []
    for k in range(len(neighbours(analysis, flag("LeftArm")))):
        repaired = apply(analysis.take, propose(analysis, flag("LeftArm"), k))
        place = point_positions(repaired, [HAND])[105:115, 0]
        gaps.append(np.sqrt(((place - one.target.position) ** 2).sum(axis=1).mean()))
    assert choice == int(np.argmin(gaps))
    assert len(gaps) > 1


def test_flags_that_move_no_contact_keep_the_engines_choice(analysis: Analysis) -> None:
    one = contact(analysis, 0.0)
    assert donor_for_contacts(analysis, flag("RightArm"), [one], [HAND]) is None
    assert donor_for_contacts(analysis, flag(ROOT_POSITION), [one], [HAND]) is None
    later = contact(analysis, 0.0, 125, 140)
    assert donor_for_contacts(analysis, flag("LeftArm"), [later], [HAND]) is None
    assert donor_for_contacts(analysis, flag("LeftArm"), [], [HAND]) is None
