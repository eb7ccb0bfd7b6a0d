from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import butter, sosfiltfilt

from mocapstudio.formats.guesses import guess_unit, synthetic_start
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.skeleton import Skeleton


def person(scale: float) -> Skeleton:
    """Hips, two legs of 0.43 + 0.41 m, a spine and a head, in units of 1/scale metres."""
    offsets = [
        *([0, 0, 0], [0.09, 0, 0], [0, -0.43, 0], [0, -0.41, 0]),
        *([-0.09, 0, 0], [0, -0.43, 0], [0, -0.41, 0], [0, 0.5, 0], [0, 0.2, 0]),
    ]
    names = ("Hips", "LeftUpLeg", "LeftLeg", "LeftFoot", "RightUpLeg", "RightLeg", "RightFoot")
    return Skeleton(
        (*names, "Spine", "Head"),
        np.array([-1, 0, 1, 2, 0, 4, 5, 0, 7]),
        np.array(offsets) * scale,
        np.zeros(0, dtype=np.int64),
        np.zeros((0, 3)),
    )


@pytest.mark.parametrize("unit", [1.0, 0.01, 0.001, 0.0254, 0.0254 / 0.45])
@pytest.mark.parametrize("size", [0.79, 1.0, 1.12])
def test_usual_units_are_told_from_the_legs(unit: float, size: float) -> None:
    assert guess_unit(person(size / unit))[0] == unit


def test_an_unusual_unit_is_estimated() -> None:
    assert guess_unit(person(1 / 0.04))[0] == pytest.approx(0.04)
    assert guess_unit(person(1 / 0.1))[0] == pytest.approx(0.1)
    assert guess_unit(person(1 / 7.0))[0] == pytest.approx(7.0)


def test_a_skeleton_without_lengths_has_some_unit() -> None:
    unit, why = guess_unit(person(0.0))
    assert unit == 0.01
    assert "no bone" in why


def dance(frames: int = 200, joints: int = 12) -> np.ndarray:
    time = np.arange(frames)[:, None, None] / 120
    phase = np.random.default_rng(2).uniform(0, 6, (1, joints, 3))
    return rot.from_rotation_vector(0.5 + 0.4 * np.sin(2 * time + phase))


def test_a_t_pose_before_the_motion() -> None:
    motion = dance()
    assert synthetic_start(motion) == 0
    for rows in (1, 2, 3):
        started = motion.copy()
        started[:rows] = rot.IDENTITY
        started[:rows, :3] = rot.from_rotation_vector(np.array([0.0, 0.4, 0.0]))
        assert synthetic_start(started) == rows


@pytest.mark.parametrize("cutoff", [8.0, 12.0, 20.0])
def test_a_t_pose_that_a_filter_has_smeared(cutoff: float) -> None:
    vectors = rot.to_rotation_vector(dance())
    vectors[:2] = 0.0
    low_pass = butter(2, cutoff, fs=120, output="sos")
    smeared = rot.from_rotation_vector(sosfiltfilt(low_pass, vectors, axis=0, padtype="constant"))
    rows = synthetic_start(smeared)
    assert 3 <= rows <= 16
    off = rot.angle(smeared[rows:-10], dance()[rows:-10]).mean(axis=1)
    assert off.max() < 0.1 * rot.angle(dance()[0], rot.IDENTITY).mean()


def test_a_filtered_dance_has_no_t_pose() -> None:
    vectors = rot.to_rotation_vector(dance())
    low_pass = butter(2, 12.0, fs=120, output="sos")
    assert synthetic_start(rot.from_rotation_vector(sosfiltfilt(low_pass, vectors, axis=0))) == 0


def test_a_performer_who_leaves_a_t_pose_is_no_synthetic_row() -> None:
    motion = dance()
    slowly = np.clip(np.arange(200) / 100, 0, 1)[:, None]
    leaving = rot.slerp(
        np.broadcast_to(rot.IDENTITY, motion.shape), motion, slowly + 0 * motion[..., 0]
    )
    assert synthetic_start(leaving) == 0


def test_a_pop_in_the_second_frame_is_no_t_pose() -> None:
    motion = dance()
    motion[0] = rot.multiply(motion[0], rot.from_rotation_vector(np.array([0.6, 0.2, 0.1])))
    assert synthetic_start(motion) == 0


def test_a_filtered_pop_at_the_start_is_no_t_pose() -> None:
    vectors = rot.to_rotation_vector(dance())
    vectors[:2] += np.array([0.6, 0.2, 0.1])
    low_pass = butter(2, 12.0, fs=120, output="sos")
    popping = sosfiltfilt(low_pass, vectors, axis=0, padtype="constant")
    assert synthetic_start(rot.from_rotation_vector(popping)) == 0


def test_short_and_still_takes_have_no_t_pose() -> None:
    assert synthetic_start(dance(frames=3)) == 0
    assert synthetic_start(np.tile(rot.IDENTITY, (50, 5, 1))) == 0
