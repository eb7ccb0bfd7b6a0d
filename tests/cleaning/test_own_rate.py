"""Pops and jitter at the take's own rate."""

from __future__ import annotations

import numpy as np
import pytest
from made_takes import faced, moved, person, turned, walking

from mocapstudio.cleaning import own_rate
from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.model import Kind
from mocapstudio.cleaning.own_rate import OwnRate
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take
from mocapstudio.similarity.texture import body_motion

JOINTS = person().names
ROWS = (*JOINTS, *ROOT_ROWS)
RATES = [24, 25, 30, 60, 100, 120, 240]


def rates_of(take: Take) -> OwnRate:
    return own_rate.of_motion(body_motion(take, JOINTS))


def popping(take: Take) -> dict[str, list[int]]:
    """Frames that pop, by row."""
    found = rates_of(take).pops >= 1.0
    return {
        ROWS[r]: np.flatnonzero(found[:, r]).tolist() for r in np.flatnonzero(found.any(axis=0))
    }


@pytest.mark.parametrize("rate", RATES)
def test_smooth_motion_neither_pops_nor_jitters(rate: int) -> None:
    for seed in range(3):
        rates = rates_of(walking(6.0, rate, seed=seed, variation=0.15))
        assert rates.pops.shape == rates.jitter.shape == (6 * rate, len(ROWS))
        assert rates.pops.max() < 1.0
        assert rates.jitter.max() < 1.0


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("joint", ["LeftForeArm", "Spine", "RightLeg"])
@pytest.mark.parametrize("at", [0.31, 0.5, 0.77])
def test_one_frame_off_pops_there(rate: int, joint: str, at: float) -> None:
    frame = round(at * 6 * rate)
    spoilt = turned(walking(6.0, rate), joint, frame, frame + 1, 35)
    rates = rates_of(spoilt)
    column = ROWS.index(joint)
    assert int(rates.pops[:, column].argmax()) == frame
    assert rates.pops[frame, column] >= 1.0
    assert set(popping(spoilt)) == {joint}
    # The frames from which the bad one is looked at depart too, half as far.
    reach = 2 * max(1, round(own_rate.POP_SECONDS * rate / 2))
    far = np.abs(np.arange(len(rates.pops)) - frame) > reach
    assert rates.pops[far, column].max() < 1.0
    near = rates.pops[np.arange(len(far)) != frame, column].max()
    assert near < 0.75 * rates.pops[frame, column]
    # One frame that is off is no trembling.
    assert rates.jitter[:, column].max() < 1.0


def test_at_120_fps_a_frame_that_24_fps_never_sees_is_flagged_exactly() -> None:
    take = walking(6.0, 120)
    for frame in (301, 302, 303, 304):  # none of them a multiple of five
        analysis = run(detect(turned(take, "LeftHand", frame, frame + 1, 35)))
        flags = [f for f in analysis.flags if f.joint == "LeftHand"]
        assert len(flags) == 1
        assert (flags[0].start, flags[0].end) == (frame, frame + 1)
        assert flags[0].kind is Kind.POP
        assert len(analysis.flags) == 1


@pytest.mark.parametrize("rate", [30, 120])
def test_the_roots_pops_are_its_own(rate: int) -> None:
    take, frame = walking(6.0, rate), 2 * rate
    assert set(popping(moved(take, frame, frame + 1, (0, 0.12, 0)))) == {ROOT_ROWS[0]}
    assert set(popping(faced(take, frame, frame + 1, 60))) == {ROOT_ROWS[1]}


@pytest.mark.parametrize("rate", [60, 120])
def test_a_trembling_joint_jitters_while_it_trembles(rate: int) -> None:
    take = walking(8.0, rate)
    start, end = 3 * rate, 4 * rate
    rotations = take.rotations.copy()
    column = JOINTS.index("LeftForeArm")
    time = np.arange(end - start) / rate
    tremble = np.deg2rad(6.0) * np.sin(2 * np.pi * 20.0 * time)[:, None] * [0.6, 0.0, 0.8]
    rotations[start:end, column] = rot.multiply(
        rotations[start:end, column], rot.from_rotation_vector(tremble)
    )
    jitter = rates_of(take.with_motion(rotations)).jitter
    assert jitter[start + rate // 5 : end - rate // 5, column].min() >= 1.0
    assert jitter[: start - rate // 5].max() < 1.0 and jitter[end + rate // 5 :].max() < 1.0
    assert np.delete(jitter, column, axis=1).max() < 1.0


@pytest.mark.parametrize("frames", range(1, 12))
def test_takes_of_a_few_frames_are_looked_at(frames: int) -> None:
    whole = walking(6.0, 30)
    q = whole.rotations[:frames]
    rates = own_rate.of_rotations(q, 30.0)
    assert rates.pops.shape == (frames, len(JOINTS))
    assert np.all(np.isfinite(rates.pops)) and np.all(np.isfinite(rates.jitter))
    assert rates.pops.max() < 1.0


def test_a_trimmed_span_is_laid_into_its_take() -> None:
    small = OwnRate(np.ones((3, 2), np.float32), np.full((3, 2), 2, np.float32))
    placed = small.placed(4, 10)
    np.testing.assert_array_equal(placed.pops[:, 0], [0, 0, 0, 0, 1, 1, 1, 0, 0, 0])
    np.testing.assert_array_equal(placed.jitter[:, 1], [0, 0, 0, 0, 2, 2, 2, 0, 0, 0])


def test_a_jump_to_another_place_is_no_pop() -> None:
    """An offset begins and ends in one frame each; a pop comes back at once."""
    spoilt = turned(walking(6.0, 120), "LeftForeArm", 300, 500, 35)
    found = popping(spoilt).get("LeftForeArm", [])
    assert all(min(abs(f - 300), abs(f - 500)) <= 12 for f in found)


def test_heading_that_crosses_half_a_turn_does_not_pop() -> None:
    take = walking(8.0, 60)
    turned_whole = faced(take, 0, take.frames, 170)
    assert popping(turned_whole) == {}
