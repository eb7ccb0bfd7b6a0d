"""Proposals: what they change, what they leave, and whether they are any good."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from made_takes import below_a_reference, faced, moved, turned, walking

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.model import Flag, Kind, Proposal
from mocapstudio.cleaning.proposals import apply, propose
from mocapstudio.cleaning.reasons import neighbours
from mocapstudio.cleaning.repair.donors import medoid, sample_rotations
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import ParameterError
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION, carrier, split_heading
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

SPANS = [
    (100, 125), (100, 101), (60, 140), (0, 1), (1, 25), (3, 4),
    (299, 300), (275, 299), (296, 297), (0, 300), (1, 299),
]  # fmt: skip


def flag(row: str, start: int, end: int) -> Flag:
    return Flag(f"{row}@{start}", row, (row,), start, end, 0.9, start, 0.9, Kind.OFFSET)


def spoilt(take: Take, row: str, start: int, end: int) -> Take:
    if row == ROOT_POSITION:
        return moved(take, start, end, (0.1, 0.25, 0.0))
    if row == ROOT_HEADING:
        return faced(take, start, end, 100)
    return turned(take, row, start, end, 45, (1.0, 0.0, 0.0))


def choices(analysis: Analysis, one: Flag) -> list[int | None]:
    if one.joint in (ROOT_POSITION, ROOT_HEADING):
        return [None]
    count = len(neighbours(analysis, one))
    return [None, *sorted({0, count - 1} & set(range(count)))]


def check_untouched(take: Take, proposal: Proposal) -> Take:
    """Nothing outside joints x span changes, bit for bit; what is inside is a motion."""
    result = apply(take, proposal)
    inside = np.zeros(take.rotations.shape[:2], dtype=bool)
    columns = [take.skeleton.index[name] for name in proposal.joints]
    inside[proposal.start : proposal.end, columns] = True
    np.testing.assert_array_equal(result.rotations[~inside], take.rotations[~inside])
    if proposal.translations is None:
        assert result.translations is take.translations
    else:
        led = np.zeros(take.translations.shape[:2], dtype=bool)
        led[proposal.start : proposal.end, carrier(take)] = True
        np.testing.assert_array_equal(result.translations[~led], take.translations[~led])
    np.testing.assert_allclose(np.linalg.norm(result.rotations, axis=-1), 1.0, atol=1e-9)
    assert np.all(np.isfinite(result.translations))
    return result


def steps(take: Take, row: str) -> np.ndarray:
    """Degrees, or metres, from frame to frame of one row."""
    if row == ROOT_POSITION:
        place = take.translations[:, carrier(take)]
        return np.linalg.norm(np.diff(place, axis=0), axis=1)
    if row == ROOT_HEADING:
        return np.abs(np.rad2deg(np.diff(split_heading(take)[0])))
    q = take.rotations[:, take.skeleton.index[row]]
    return np.rad2deg(rot.angle(q[1:], q[:-1]))


@pytest.mark.parametrize("row", ["LeftForeArm", "LeftUpLeg", "Hips", ROOT_POSITION, ROOT_HEADING])
@pytest.mark.parametrize(("start", "end"), SPANS)
def test_a_proposal_changes_its_span_alone_and_joins_what_stays(
    take: Take, context: tuple[Take, ...], row: str, start: int, end: int
) -> None:
    bad = spoilt(take, row, start, end)
    analysis, one = run(detect(bad, context)), flag(row, start, end)
    largest = steps(take, row).max()
    for choice in choices(analysis, one):
        proposal = propose(analysis, one, choice)
        assert 0 <= proposal.start <= start < end <= proposal.end <= take.frames
        assert start - proposal.start <= 0.05 * 30 and proposal.end - end <= 0.05 * 30
        expected = () if row == ROOT_POSITION else ("Hips",) if row == ROOT_HEADING else (row,)
        assert proposal.joints == expected
        result = check_untouched(bad, proposal)
        if proposal.end - proposal.start < take.frames - 1:
            seams = [k for k in (proposal.start - 1, proposal.end - 1) if 0 <= k < take.frames - 1]
            assert steps(result, row)[seams].max() <= 1.5 * largest


@pytest.mark.parametrize("trim", [(100, 200), (99, 126)])
def test_a_proposal_stays_inside_the_trimmed_span(
    take: Take, context: tuple[Take, ...], trim: tuple[int, int]
) -> None:
    analysis = run(detect(replace(turned(take, "LeftArm", 100, 125, 45), trim=trim), context))
    for row in ("LeftArm", ROOT_POSITION, ROOT_HEADING):
        proposal = propose(analysis, flag(row, trim[0], 125))
        assert trim[0] <= proposal.start and proposal.end <= trim[1]
        check_untouched(analysis.take, proposal)


@pytest.mark.parametrize("joint", ["LeftForeArm", "RightUpLeg", "Spine", "Head", "Hips"])
@pytest.mark.parametrize(("start", "end"), [(100, 125), (60, 140), (100, 103), (0, 25), (280, 300)])
def test_the_repair_comes_near_the_truth(
    take: Take, context: tuple[Take, ...], joint: str, start: int, end: int
) -> None:
    bad = spoilt(take, joint, start, end)
    proposal = propose(run(detect(bad, context)), flag(joint, start, end))
    column = take.skeleton.index[joint]
    result = apply(bad, proposal)
    away = rot.angle(result.rotations[start:end, column], take.rotations[start:end, column])
    # Over several cycles a donor at an even pace falls out of step some way.
    left = 0.35 if end - start > 30 else 0.25
    assert np.rad2deg(away).mean() < left * 45


def test_with_the_truth_as_donor_the_truth_comes_back(take: Take) -> None:
    bad = turned(take, "LeftForeArm", 100, 130, 60)
    analysis, one = run(detect(bad, [take])), flag("LeftForeArm", 100, 130)
    proposal = propose(analysis, one, 0)
    assert proposal.method == "neighbours"
    assert proposal.donor is not None and proposal.donor.index == 1
    column = take.skeleton.index["LeftForeArm"]
    result = apply(bad, proposal)
    assert np.rad2deg(rot.angle(result.rotations[:, column], take.rotations[:, column])).max() < 5


def test_every_choice_is_another_donor(take: Take, context: tuple[Take, ...]) -> None:
    analysis = run(detect(turned(take, "LeftForeArm", 100, 130, 60), context))
    one = flag("LeftForeArm", 100, 130)
    near = neighbours(analysis, one)
    proposals = [propose(analysis, one, k) for k in range(len(near))]
    assert [p.donor for p in proposals] == list(near)
    for proposal, donor in zip(proposals, near, strict=True):
        # In the middle the replacement moves as the donor does.
        other = (analysis.take, *context)[donor.index]
        pace = (donor.end - donor.start) / 30
        at = donor.start + np.arange(10, 21) * pace
        expected = sample_rotations(other, ("LeftForeArm",), at)[:, 0]
        offset = one.start - proposal.start
        inside = proposal.rotations[offset + 10 : offset + 21, 0]
        turn = rot.multiply(inside, rot.conjugate(expected))
        # The warping path may lie a frame beside the even pace.
        assert np.rad2deg(rot.angle(turn[1:], turn[:-1])).max() < 5
    for one_of_them, other in pairwise(proposals):
        assert np.abs(one_of_them.rotations - other.rotations).max() > 1e-4


@pytest.mark.parametrize("choice", [-1, 5, 99])
def test_a_neighbour_that_is_not_there_is_refused(
    take: Take, context: tuple[Take, ...], choice: int
) -> None:
    analysis = run(detect(take, context))
    with pytest.raises(ParameterError, match=f"no neighbour {choice + 1} "):
        propose(analysis, flag("LeftArm", 100, 130), choice)


def test_a_flag_longer_than_every_take_is_led_across(take: Take) -> None:
    bad = turned(take, "LeftArm", 20, 280, 60)
    analysis = run(detect(bad, [walking(3.0, 30, seed=1)]))
    one = flag("LeftArm", 20, 280)
    proposal = propose(analysis, one)
    assert proposal.donor is None
    check_untouched(bad, proposal)
    with pytest.raises(ParameterError):
        propose(analysis, one, 0)


def test_the_medoid_is_the_neighbour_closest_to_all_others(
    take: Take, context: tuple[Take, ...]
) -> None:
    analysis = run(detect(take, context))
    near = neighbours(analysis, flag("LeftForeArm", 100, 130))
    takes, joint = (take, *context), ("LeftForeArm",)
    motions = [
        sample_rotations(takes[n.index], joint, np.linspace(n.start, n.end - 1, 12))[:, 0]
        for n in near
    ]
    sums = [sum(rot.angle(a, b).mean() for b in motions) for a in motions]
    assert medoid(analysis, near, joint) == near[int(np.argmin(sums))]
    assert medoid(analysis, near[:2], joint) == near[0]


@pytest.mark.parametrize("end", [101, 104, 106])
def test_a_short_gap_in_an_even_turn_is_closed(end: int) -> None:
    take = walking(10.0, 30)
    column = take.skeleton.index["LeftForeArm"]
    rotations = take.rotations.copy()
    axis = np.array([0.48, 0.6, 0.64])
    rotations[:, column] = rot.from_rotation_vector(0.05 * np.arange(300)[:, None] * axis)
    even = take.with_motion(rot.continuous(rotations))
    bad = turned(even, "LeftForeArm", 100, end, 70)
    proposal = propose(run(detect(bad)), flag("LeftForeArm", 100, end))
    result = apply(bad, proposal)
    # Several whole turns over the take, a frame each 2.9 degrees.
    assert rot.angle(result.rotations[:, column], even.rotations[:, column]).max() < np.deg2rad(2)


@pytest.mark.parametrize("reference", [False, True])
@pytest.mark.parametrize("choice", [None, 0])
def test_hips_keep_their_heading(
    take: Take, context: tuple[Take, ...], reference: bool, choice: int | None
) -> None:
    bad = turned(take, "Hips", 100, 130, 40, (1.0, 0.0, 0.0))
    others = context
    if reference:
        turn = rot.from_euler("YX", np.array([0.7, -1.2]))
        bad = below_a_reference(bad, turn)
        others = tuple(below_a_reference(one, turn) for one in context)
    proposal = propose(run(detect(bad, others)), flag("Hips", 100, 130), choice)
    assert proposal.method == ("prediction" if choice is None else "neighbours")
    result = check_untouched(bad, proposal)
    heading, tilt = split_heading(result)
    clean_heading, clean_tilt = split_heading(take)
    away = np.angle(np.exp(1j * (heading - clean_heading)))
    assert np.rad2deg(np.abs(away)).max() < 3
    assert np.rad2deg(rot.angle(tilt, clean_tilt)).max() < 6


@pytest.mark.parametrize("reference", [False, True])
def test_a_root_pop_is_led_over(take: Take, context: tuple[Take, ...], reference: bool) -> None:
    bad = moved(take, 100, 103, (0.1, 0.3, -0.2))
    others, clean = context, take.translations[:, 0]
    if reference:
        turn = rot.from_euler("YX", np.array([0.7, -1.2]))
        bad = below_a_reference(bad, turn)
        others = tuple(below_a_reference(one, turn) for one in context)
        clean = below_a_reference(take, turn).translations[:, 1]
    proposal = propose(run(detect(bad, others)), flag(ROOT_POSITION, 100, 103))
    result = check_untouched(bad, proposal)
    assert np.linalg.norm(result.translations[:, carrier(bad)] - clean, axis=1).max() < 0.02


@pytest.mark.parametrize("reference", [False, True])
@pytest.mark.parametrize("degrees", [90.0, 179.0, -120.0])
def test_a_heading_flip_is_turned_back_and_the_tilt_stays(
    take: Take, context: tuple[Take, ...], reference: bool, degrees: float
) -> None:
    bad = faced(take, 100, 120, degrees)
    others = context
    if reference:
        turn = rot.from_euler("YX", np.array([0.7, -1.2]))
        bad = below_a_reference(bad, turn)
        others = tuple(below_a_reference(one, turn) for one in context)
    proposal = propose(run(detect(bad, others)), flag(ROOT_HEADING, 100, 120))
    assert proposal.joints == (bad.skeleton.names[topology(bad.skeleton).hips],)
    result = check_untouched(bad, proposal)
    heading, tilt = split_heading(result)
    clean, same = split_heading(take)
    away = np.angle(np.exp(1j * (heading - clean)))
    assert np.rad2deg(np.abs(away)).max() < 5
    assert rot.angle(tilt, same).max() < 1e-6


def test_it_tells_how_far_hands_and_feet_move(take: Take, context: tuple[Take, ...]) -> None:
    bad = turned(take, "LeftArm", 100, 130, 45)
    analysis = run(detect(bad, context))
    proposal = propose(analysis, flag("LeftArm", 100, 130))
    before, after = take_pose(bad)[0], take_pose(apply(bad, proposal))[0]
    far = np.linalg.norm(after - before, axis=-1).max(axis=0)
    assert set(proposal.displacement) == {"LeftHand"}
    hand = bad.skeleton.index["LeftHand"]
    assert proposal.displacement["LeftHand"] == pytest.approx(far[hand], abs=1e-9)
    whole = propose(analysis, flag("Hips", 100, 130)).displacement
    assert set(whole) == {"Head", "LeftHand", "RightHand", "LeftFoot", "RightFoot"}
    own = propose(analysis, flag("LeftHand", 100, 130)).displacement
    assert own == {}


def test_flags_repaired_one_after_the_other_do_not_meet_again(
    take: Take, context: tuple[Take, ...]
) -> None:
    """Accepting everything leaves a take in which hardly anything is flagged."""
    bad = turned(turned(take, "LeftForeArm", 60, 85, 50), "RightLeg", 180, 184, 60)
    bad = faced(moved(bad, 130, 132, (0, 0.3, 0)), 230, 250, 100)
    analysis = run(detect(bad, context))
    assert len(analysis.flags) >= 4
    result = bad
    for one in analysis.flags:
        result = apply(result, propose(analysis, one))
    assert len(run(detect(result, context)).flags) <= 1
