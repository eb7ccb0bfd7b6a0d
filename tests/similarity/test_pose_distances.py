"""Pose distances against equation 1 of paper 1, joint by joint."""

from __future__ import annotations

import naive
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mocapstudio.similarity import kernels
from mocapstudio.similarity.words import trim_count


def poses(frames: int, joints: int, seed: int, spread: float = 3.0) -> np.ndarray:
    """(frames, joints, 4): random rotations by up to `spread` radians, of random sign."""
    rng = np.random.default_rng(seed)
    vectors = rng.normal(size=(frames * joints, 3))
    vectors *= rng.uniform(0, spread, (len(vectors), 1)) / np.linalg.norm(vectors, axis=1)[:, None]
    q = Rotation.from_rotvec(vectors).as_quat() * rng.choice([-1, 1], (len(vectors), 1))
    return q.reshape(frames, joints, 4).astype(np.float32)


def planes(q: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(q.transpose(1, 2, 0))


def distances(source: np.ndarray, target: np.ndarray, trim: int) -> np.ndarray:
    out = np.full((len(source), len(target)), np.nan, dtype=np.float32)
    kernels.pose_distances(source, planes(target), trim, out)
    return out


@pytest.mark.parametrize("frames", [1, 127, 128, 129, 300])
@pytest.mark.parametrize(("joints", "trim"), [(24, 3), (6, 1), (6, 0), (5, 4), (1, 0), (3, 3)])
def test_it_is_equation_one_without_the_largest_joints(frames: int, joints: int, trim: int) -> None:
    source, target = poses(3, joints, 1), poses(frames, joints, 2)
    expected = naive.pose_distances(source, target, trim)
    np.testing.assert_allclose(distances(source, target, trim), expected, rtol=1e-5, atol=2e-5)


def test_small_angles_are_told_apart() -> None:
    source, target = poses(4, 10, 3, spread=0.02), poses(50, 10, 4, spread=0.02)
    expected = naive.pose_distances(source, target, 2)
    np.testing.assert_allclose(distances(source, target, 2), expected, atol=1e-5)


def test_signs_do_not_matter_and_a_pose_is_no_distance_from_itself() -> None:
    target = poses(200, 8, 5)
    np.testing.assert_allclose(np.diag(distances(target, -target, 1)), 0.0, atol=1e-5)
    np.testing.assert_array_equal(
        distances(target[:5], target, 1), distances(-target[:5], target, 1)
    )


def test_half_turns_are_the_farthest() -> None:
    identity = np.array([[[0, 0, 0, 1]]], dtype=np.float32)
    half = np.array([[[1, 0, 0, 0]]], dtype=np.float32)
    assert distances(identity, half, 0)[0, 0] == pytest.approx((np.pi / 2) ** 2, rel=1e-5)


@pytest.mark.parametrize("frames", [100, 128, 200])
def test_nothing_outside_the_arrays_is_read_or_written(frames: int) -> None:
    source, target = poses(3, 7, 6), poses(frames, 7, 7)
    room = np.full((9, 4, frames + 300), np.nan, dtype=np.float32)
    view = room[1:8, :, 150 : 150 + frames]
    view[:] = planes(target)
    kept = np.full((5, frames + 300), np.float32(77.0))
    kernels.pose_distances(source, view, 2, kept[1:4, 150 : 150 + frames])
    np.testing.assert_array_equal(kept[1:4, 150 : 150 + frames], distances(source, target, 2))
    kept[1:4, 150 : 150 + frames] = 77.0
    assert np.all(kept == 77.0)


@pytest.mark.parametrize(
    ("joints", "whole", "left_out"),
    [(24, True, 3), (22, True, 3), (16, True, 2), (8, True, 1), (1, True, 1),
     (24, False, 1), (6, False, 1), (1, False, 0)],
)  # fmt: skip
def test_three_of_24_are_left_out_and_one_of_a_group(
    joints: int, whole: bool, left_out: int
) -> None:
    assert trim_count(joints, whole_body=whole) == left_out
