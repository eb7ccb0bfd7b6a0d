"""Neighbours of a flagged span: found without its joints, never flagged themselves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from made_takes import paced, turned, walking

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.model import Flag, Kind
from mocapstudio.cleaning.parameters import DetectionParameters
from mocapstudio.cleaning.reasons import neighbours
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take


def flag(joint: str, start: int, end: int, *others: str) -> Flag:
    joints = (joint, *others)
    return Flag(f"{joint}@{start}", joint, joints, start, end, 0.9, start, 0.9, Kind.OFFSET)


def check(analysis: Analysis, one: Flag) -> None:
    near = neighbours(analysis, one)
    assert len(near) <= analysis.parameters.neighbours
    takes = (analysis.take, *analysis.context)
    assert [n.distance for n in near] == sorted(n.distance for n in near)
    for n in near:
        take = takes[n.index]
        assert n.take == take.name
        assert 0 <= n.start < n.end <= take.frames
        if n.index == 0:
            for other in (one, *analysis.flags):
                shared = set(other.joints) & set(one.joints)
                assert not (shared and other.overlaps(n.start, n.end))
    pairs = [(n.index, n.start, n.end) for n in near]
    assert len(set(pairs)) == len(pairs)


def test_the_same_motion_elsewhere_is_the_nearest(take: Take) -> None:
    spoilt = turned(take, "LeftArm", 100, 130, 50)
    analysis = run(detect(spoilt, [take]))
    best = neighbours(analysis, flag("LeftArm", 100, 130))[0]
    assert best.index == 1
    assert abs(best.start - 100) <= 2 and abs(best.end - 130) <= 2
    assert best.distance < 0.5


def test_an_error_does_not_choose_its_own_neighbours(take: Take, context: tuple[Take, ...]) -> None:
    """Without the flagged joint the neighbours are the same, however it was spoilt."""
    found = []
    for degrees in (40.0, 90.0, 175.0):
        spoilt = turned(take, "LeftForeArm", 105, 125, degrees)
        analysis = replace(run(detect(spoilt, context)), flags=())
        found.append(neighbours(analysis, flag("LeftForeArm", 100, 130)))
    assert found[0] == found[1] == found[2]
    assert len(found[0]) == 5


def test_distance_is_the_angle_of_a_joint_in_degrees() -> None:
    """A copy whose every joint is 10 degrees off is 10 degrees away, but for trimmed joints."""
    take = walking(4.0, 30)
    off = take
    for joint in take.skeleton.names:
        off = turned(off, joint, 0, take.frames, 10.0, (1.0, 0.0, 0.0))
    # The flag leaves no room for a neighbour in the take itself.
    best = neighbours(run(detect(take, [off])), flag("LeftArm", 30, 80))[0]
    compared = len(take.skeleton) - 1
    least = 10.0 * np.sqrt((compared - 3) / compared)
    assert best.index == 1
    assert least - 0.5 < best.distance < 10.5


@pytest.mark.parametrize("neighbour_count", [1, 3, 15])
@pytest.mark.parametrize(("start", "end"), [(0, 1), (0, 30), (299, 300), (270, 300), (150, 151)])
def test_any_flag_of_any_place_has_sound_neighbours(
    take: Take, context: tuple[Take, ...], neighbour_count: int, start: int, end: int
) -> None:
    parameters = DetectionParameters(neighbours=neighbour_count)
    analysis = run(detect(take, context, parameters))
    one = flag("LeftArm", start, end)
    check(analysis, one)
    assert len(neighbours(analysis, one)) == neighbour_count


def test_what_is_flagged_itself_is_no_neighbour() -> None:
    """Even where the motion changes its pace, so that neighbours last longer or shorter."""
    rng = np.random.default_rng(0)
    base = walking(25, 30, 0, variation=0.3)
    take = paced(base, 1 + 0.75 * np.sin(np.arange(900) / 60))
    analysis = run(detect(take))
    inside = 0
    for _ in range(40):
        spans = rng.integers(0, take.frames - 60, 6)
        one = flag("LeftArm", int(spans[0]), int(spans[0] + rng.integers(10, 60)))
        others = [flag("LeftArm", int(s), int(s) + 20) for s in spans[1:]]
        check(replace(analysis, flags=(one, *others)), one)
        inside += len(neighbours(replace(analysis, flags=(one, *others)), one))
    assert inside > 100


def test_flags_of_other_joints_do_not_bar_a_span(take: Take) -> None:
    analysis = run(detect(take))
    one = flag("LeftArm", 100, 130)
    free = neighbours(replace(analysis, flags=(one,)), one)
    other = [flag("RightLeg", n.start, n.end) for n in free]
    assert neighbours(replace(analysis, flags=(one, *other)), one) == free
    same = [flag("LeftHand", n.start, n.end, "LeftArm") for n in free]
    assert not set(neighbours(replace(analysis, flags=(one, *same)), one)) & set(free)


def test_where_nothing_is_long_enough_there_is_none(take: Take) -> None:
    short = walking(3.0, 30, seed=1)
    analysis = run(detect(take, [short]))
    assert neighbours(analysis, flag("LeftArm", 20, 280)) == ()
    long = walking(14.0, 30, seed=3)
    analysis = run(detect(long, [walking(20.0, 30, seed=1)]))
    assert neighbours(analysis, flag("LeftArm", 5, 400)) == ()


def test_neighbours_are_counted_in_frames_of_their_own_take() -> None:
    slow, fast = walking(8.0, 30, seed=0), walking(8.0, 120, seed=0)
    analysis = replace(run(detect(turned(slow, "LeftArm", 60, 90, 40), [fast])), flags=())
    best = neighbours(analysis, flag("LeftArm", 60, 90))[0]
    assert best.index == 1
    assert abs(best.start - 240) <= 8 and abs(best.end - 360) <= 8


def test_trimmed_frames_of_a_context_are_not_searched(take: Take) -> None:
    trimmed = replace(walking(10.0, 30, seed=1), trim=(100, 220))
    analysis = run(detect(take, [trimmed]))
    for start in (20, 120, 200):
        for n in neighbours(analysis, flag("LeftArm", start, start + 25)):
            if n.index == 1:
                assert 100 <= n.start < n.end <= 220 + 1


def test_the_donor_shows_what_the_joint_should_do(take: Take, context: tuple[Take, ...]) -> None:
    spoilt = turned(take, "LeftForeArm", 100, 130, 60)
    analysis = run(detect(spoilt, context))
    column = take.skeleton.index["LeftForeArm"]
    for n in neighbours(analysis, flag("LeftForeArm", 100, 130)):
        donor = (spoilt, *context)[n.index].rotations[:, column]
        at = np.linspace(n.start, n.end - 1, 30)
        clean = take.rotations[100:130, column]
        assert np.rad2deg(rot.angle(donor[at.round().astype(int)], clean)).mean() < 12


def test_what_looks_wrong_in_the_context_is_no_neighbour() -> None:
    take = turned(walking(3.0, 30, seed=0), "LeftArm", 40, 50, 60)
    analysis = run(detect(take, [walking(6.0, 30, seed=1)]))
    one = flag("LeftArm", 40, 50)
    best = next(n for n in neighbours(analysis, one) if n.index == 1)
    for row, barred in (("LeftArm", True), ("root position", True), ("Head", False)):
        doubts = ((Declared(row, best.start, best.end),),)
        found = neighbours(replace(analysis, doubts=doubts), one)
        assert (best in found) is not barred
        assert not barred or not any(
            n.index == 1 and n.start < best.end and n.end > best.start for n in found
        )
