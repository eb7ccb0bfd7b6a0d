"""How contacts are scored, the peers, and the two-bone clean-up."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mocapstudio.cleaning.contacts.model import Contact, Fixed
from mocapstudio.cleaning.contacts.points import contact_points, point_positions
from mocapstudio.evaluation.contacts_cases import ContactCase, made_case, marked
from mocapstudio.evaluation.contacts_peers import threshold
from mocapstudio.evaluation.contacts_scoring import score_contacts
from mocapstudio.evaluation.contacts_two_bone import two_bone
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.kinematics import take_pose

HEEL = ("LeftFoot", "heel")
WALKING = slice(180, 540)


@pytest.fixture(scope="module")
def case() -> ContactCase:
    """Six seconds of walking at 60 Hz."""
    whole = made_case("60 Hz", "test", 5)
    take = whole.take.with_motion(whole.take.rotations[WALKING], whole.take.translations[WALKING])
    return replace(
        whole,
        take=take,
        truth={key: mask[WALKING] for key, mask in whole.truth.items()},
        sure={key: mask[WALKING] for key, mask in whole.sure.items()},
    )


def spans(mask: np.ndarray) -> list[tuple[int, int]]:
    edges = np.flatnonzero(np.diff(np.r_[0, mask.astype(int), 0]))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))


def truth_as_contacts(case: ContactCase, late: int = 0) -> list[Contact]:
    return [
        Contact("", joint, point, start + late * (start > 0), end, Fixed((0.0, 0.0, 0.0)))  # type: ignore[arg-type]
        for (joint, point), mask in case.truth.items()
        for start, end in spans(mask)
        if end - start > late
    ]


def test_truth_of_made_takes_is_planted(case: ContactCase) -> None:
    """What counts as contact stands still: the ball of a standing foot moves under 2 mm a frame."""
    joint = case.take.skeleton.index["LeftToe"]
    place = take_pose(case.take)[0][:, joint]
    steps = np.linalg.norm(np.diff(place, axis=0), axis=1)
    planted = case.truth["LeftToe", "ball"]
    both = planted[1:] & planted[:-1]
    assert np.percentile(steps[both], 95) < 0.002
    assert np.median(steps[~planted[1:]]) > 0.01
    assert 0.4 < planted.mean() < 0.8


def test_perfect_late_and_empty_answers(case: ContactCase) -> None:
    perfect = score_contacts("", lambda take: truth_as_contacts(case), [case])
    assert (perfect.strict.f1, perfect.tolerant.f1) == (1.0, 1.0)
    late = score_contacts("", lambda take: truth_as_contacts(case, late=2), [case])
    # Two frames at 60 Hz lie within the tolerance; strictly they are missed.
    assert late.tolerant.f1 == 1.0
    assert late.strict.precision == 1.0
    starts = sum(start > 0 for mask in case.truth.values() for start, _ in spans(mask))
    total = sum(mask.sum() for mask in case.truth.values())
    assert 0 < 1 - late.strict.recall <= 2 * (starts + 6) / total
    nothing = score_contacts("", lambda take: [], [case])
    assert nothing.strict.recall == 0.0
    assert np.isnan(nothing.strict.precision)


def test_what_is_unsure_is_not_scored(case: ContactCase) -> None:
    wrong = [Contact("", "LeftFoot", "heel", 0, 360, Fixed((0.0, 0.0, 0.0)))]
    blind = replace(case, sure={key: np.zeros(360, bool) for key in case.sure})
    assert score_contacts("", lambda take: wrong, [blind]).strict.false == 0.0
    only = replace(case, truth={HEEL: case.truth[HEEL]}, sure={HEEL: case.sure[HEEL]})
    scored = score_contacts("", lambda take: wrong, [only])
    assert scored.strict.false == pytest.approx(np.sum(~case.truth[HEEL]) / 60)


def test_thresholds_are_those_of_height_and_speed(case: ContactCase) -> None:
    everything = threshold(9.0, 99.0)(case.take)
    assert {(c.start, c.end) for c in everything} == {(0, 360)}
    assert threshold(-1.0, 99.0)(case.take) == []
    low = threshold(0.02, float("inf"))(case.take)
    points = {p.key: p for p in contact_points(case.take)}
    for contact in low:
        heights = point_positions(case.take, [points[contact.joint, contact.point]])[:, 0, 1]
        limit = np.percentile(heights, 2) + 0.02 * 0.86
        assert heights[contact.start : contact.end].max() < limit


def test_two_bones_bring_the_foot_to_its_place(case: ContactCase) -> None:
    heel = next(p for p in contact_points(case.take) if p.key == HEEL)
    where = point_positions(case.take, [heel])[:, 0]
    start, end = next(s for s in spans(case.truth[HEEL]) if s[0] > 0)
    target = where[(start + end) // 2] + [0.01, 0.02, -0.015]
    contact = Contact("c", *HEEL, start, end, Fixed(tuple(float(v) for v in target)))  # type: ignore[arg-type]
    held = two_bone(case.take, [contact], [heel])
    np.testing.assert_allclose(
        point_positions(held, [heel])[start:end, 0], np.tile(target, (end - start, 1)), atol=1e-9
    )
    np.testing.assert_array_equal(held.rotations[:start], case.take.rotations[:start])
    positions, world = take_pose(held)
    before, directions = take_pose(case.take)
    foot = case.take.skeleton.index["LeftFoot"]
    agree = np.abs(np.sum(world[start:end, foot] * directions[start:end, foot], axis=1))
    np.testing.assert_allclose(agree, 1.0, atol=1e-9)
    other = case.take.skeleton.index["RightToe"]
    np.testing.assert_allclose(positions[:, other], before[:, other], atol=1e-12)


def test_out_of_reach_the_leg_is_straight(case: ContactCase) -> None:
    heel = next(p for p in contact_points(case.take) if p.key == HEEL)
    contact = Contact("c", "LeftFoot", "heel", 50, 60, Fixed((0.0, -30.0, 0.0)))
    positions, _ = take_pose(two_bone(case.take, [contact], [heel]))
    hip, knee, foot = (case.take.skeleton.index[f"Left{n}"] for n in ("UpLeg", "Leg", "Foot"))
    upper, lower = (
        positions[50:60, knee] - positions[50:60, hip],
        (positions[50:60, foot] - positions[50:60, knee]),
    )
    straight = np.sum(upper * lower, axis=1) / (0.43 * 0.43)
    np.testing.assert_allclose(straight, 1.0, atol=1e-4)


def test_labels_that_are_none(tmp_path: Path) -> None:
    take = tmp_path / "set" / "a.bvh"
    take.parent.mkdir()
    bad = tmp_path / "bad.json"
    bad.write_text("{")
    with pytest.raises(FileError, match="no JSON"):
        marked([tmp_path], bad)
    bad.write_text(json.dumps({"take": 7}))
    with pytest.raises(FileError, match="marked contacts"):
        marked([tmp_path], bad)
    bad.write_text(json.dumps({"take": "set/none.bvh"}))
    assert marked([tmp_path], bad) == []
