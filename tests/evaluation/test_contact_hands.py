"""How hands that hold each other are scored, and labels that cannot be read."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from made_takes import walking

from mocapstudio import formats
from mocapstudio.cleaning.contacts.model import Contact, Following
from mocapstudio.evaluation.contacts_hands import HandCase, marked_hands, score_hands
from mocapstudio.motion.errors import FileError

SPAN, HELD, UNSURE = (10, 80), (20, 50), (60, 70)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two walkers as files, and the labels of their hands."""
    folder = tmp_path_factory.mktemp("pair")
    for seed, name in enumerate(("one", "other")):
        formats.write(walking(3.0, rate=30, seed=seed), folder / f"{name}.bvh")
    (folder / "labels" / "hands").mkdir(parents=True)
    record = {
        "take": "one.bvh", "partner": "other.bvh", "span": SPAN,
        "held": {"LeftHand RightHand": [HELD], "LeftHand LeftHand": []},
        "unsure": {"LeftHand RightHand": [UNSURE]},
    }  # fmt: skip
    (folder / "labels" / "hands" / "one.json").write_text(json.dumps(record))
    return folder


@pytest.fixture(scope="module")
def case(folder: Path) -> HandCase:
    [found] = marked_hands([folder], folder / "labels")
    return found


def held(start: int, end: int, hand: str = "RightHand") -> Contact:
    target = Following("other", hand)
    return Contact(f"{hand}{start}", "LeftHand", "palm", start, end, target)


def test_labels_are_masks_of_the_pair(case: HandCase) -> None:
    pair = ("LeftHand", "RightHand")
    assert (case.take.name, case.partner.name) == ("one", "other")
    assert np.flatnonzero(case.truth[pair]).tolist() == list(range(*HELD))
    sure = set(range(*SPAN)) - set(range(*UNSURE))
    assert set(np.flatnonzero(case.sure[pair]).tolist()) == sure


def test_the_truth_scores_one_and_frames_that_are_not_sure_count_for_nothing(case) -> None:
    exact = score_hands("", [case], lambda take, partner: [held(*HELD), held(*UNSURE)])
    assert exact.strict.f1 == exact.tolerant.f1 == 1.0
    assert exact.strict.hit == pytest.approx((HELD[1] - HELD[0]) / 30)


def test_the_wrong_hand_is_found_wrongly_and_missed(case) -> None:
    wrong = score_hands("", [case], lambda take, partner: [held(*HELD, "LeftHand")])
    assert wrong.strict.hit == 0.0
    assert wrong.strict.false == wrong.strict.missed == pytest.approx(1.0)
    assert wrong.worst == (0.0, "one")


def test_takes_that_are_elsewhere_are_left_out_and_bad_labels_told(folder, tmp_path) -> None:
    assert marked_hands([tmp_path / "nowhere"], folder / "labels") == []
    bad = tmp_path / "bad.json"
    bad.write_text('{"held": {"LeftHand": []}, "take": "one.bvh", "partner": "other.bvh"}')
    with pytest.raises(FileError, match="does not hold marked hands"):
        marked_hands([folder], bad)
