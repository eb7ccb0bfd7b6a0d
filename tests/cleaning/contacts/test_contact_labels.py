"""Detection on real takes: against what was marked by eye, and the hands of a pair."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mocapstudio import formats
from mocapstudio.cleaning.contacts.detection import detect_contacts
from mocapstudio.cleaning.contacts.model import Following
from mocapstudio.evaluation.contacts_cases import marked
from mocapstudio.evaluation.contacts_hands import marked_hands, score_hands
from mocapstudio.evaluation.contacts_peers import threshold
from mocapstudio.evaluation.contacts_scoring import score_contacts

LABELS = Path(__file__).parents[2] / "contacts"


def test_marked_contacts_are_found_and_better_than_by_thresholds(data: Path) -> None:
    cases = [case for case in marked([data], LABELS) if case.part == "test"]
    assert len(cases) == 12
    ours = score_contacts("ours", detect_contacts, cases)
    assert ours.tolerant.f1 >= 0.95
    assert ours.worst[0] >= 0.9
    # Thresholds that suit the development half best.
    inf = float("inf")
    for height, speed in ((0.03, inf), (inf, 0.4), (0.05, 0.4)):
        peer = score_contacts("peer", threshold(height, speed), cases)
        assert peer.strict.f1 < ours.strict.f1
        assert peer.tolerant.f1 < ours.tolerant.f1


def test_joined_hands_of_a_pair(data: Path) -> None:
    folder = data / "cmu_salsa_pairs_bvh"
    one, other = (formats.read(folder / f"{n}_10_scaled.bvh")[0][0] for n in (60, 61))
    found = [c for c in detect_contacts(one, (other,)) if isinstance(c.target, Following)]
    # They dance hand in hand from 4 s on: his left, her right.
    joined = np.zeros(one.frames, bool)
    for contact in found:
        assert isinstance(contact.target, Following)
        assert contact.target.performer == other.name
        if (contact.joint, contact.target.joint) == ("lHand", "rHand"):
            joined[contact.start : contact.end] = True
    assert joined[490:600].mean() == pytest.approx(1.0, abs=0.05)
    assert not joined[:300].any()


def test_hands_that_were_seen_to_hold_each_other(data: Path) -> None:
    [case] = marked_hands([data], LABELS / "hands" / "60_11.json")
    scores = score_hands("ours", [case])
    assert scores.strict.precision > 0.95
    assert scores.strict.recall > 0.85
    everything = marked_hands([data], LABELS)
    assert [one.take.name for one in everything] == ["60_02_scaled", "60_11_scaled"]
    # The files of feet, beside them, are read without them.
    assert marked([data], LABELS / "hands") == []
