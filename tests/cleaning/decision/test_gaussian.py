"""The Gaussian of whole motions against the textbook's conditional expectation."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mocapstudio.cleaning.decision import gaussian
from mocapstudio.cleaning.decision.gaussian import (
    OFFSETS,
    conditional_residuals,
    moments,
    rotation_vectors,
    stacked,
)

RIDGE = np.deg2rad(2.5) ** 2
LIMB = np.array([0, 0, 1, 2, 1])


def motion(frames: int, seed: int, joints: int = 5) -> np.ndarray:
    """(frames, 3 joints) smooth, correlated rotation vectors."""
    rng = np.random.default_rng(seed)
    mixing = rng.normal(size=(4, 3 * joints))
    waves = np.sin(np.arange(frames)[:, None] * rng.uniform(0.05, 0.4, 4) + rng.uniform(0, 6, 4))
    return 0.2 * waves @ mixing + 0.05 * rng.normal(size=(frames, 3 * joints))


def expected_residual(rows: np.ndarray, known: np.ndarray, part: np.ndarray) -> np.ndarray:
    """x_A - E[x_A | x_B] with mean and covariance of `known`, widened by the ridge."""
    mean = known.mean(axis=0)
    covariance = np.cov(known.T, bias=True) + RIDGE * np.eye(known.shape[1])
    rest = np.setdiff1d(np.arange(known.shape[1]), part)
    gain = np.linalg.solve(covariance[np.ix_(rest, rest)], covariance[np.ix_(rest, part)]).T
    return rows[:, part] - mean[part] - (rows[:, rest] - mean[rest]) @ gain.T


def test_residuals_are_departures_from_the_conditional_expectation() -> None:
    known, rows = stacked(motion(900, 0)), stacked(motion(60, 1))
    others, limbs = conditional_residuals(rows, moments(known), LIMB)
    for k, one in enumerate(LIMB):
        own = np.arange(3 * k, 3 * k + 3)
        away = expected_residual(rows, known, own)
        np.testing.assert_allclose(
            others[:, k], np.rad2deg(np.linalg.norm(away, axis=1)), rtol=1e-3, atol=1e-3
        )
        members = np.flatnonzero(one == LIMB)
        whole = np.concatenate([np.arange(3 * j, 3 * j + 3) for j in members])
        away = expected_residual(rows, known, whole)
        place = 3 * int(np.flatnonzero(members == k)[0])
        mine = np.linalg.norm(away[:, place : place + 3], axis=1)
        np.testing.assert_allclose(limbs[:, k], np.rad2deg(mine), rtol=1e-3, atol=1e-3)


def test_a_joint_that_is_off_stands_out_alone() -> None:
    known, rows = stacked(motion(900, 0)), motion(60, 0)
    rows[30, 6:9] += 0.5
    others, _ = conditional_residuals(stacked(rows), moments(known), LIMB)
    assert others[30].argmax() == 2
    assert others[30, 2] > 15.0


def test_moments_add_and_subtract() -> None:
    a, b = motion(50, 2), motion(70, 3)
    both = moments(a) + moments(b)
    whole = moments(np.concatenate([a, b]))
    assert both.count == whole.count == 120
    np.testing.assert_allclose(both.mean, np.concatenate([a, b]).mean(axis=0), atol=1e-12)
    np.testing.assert_allclose(both.precision, whole.precision, rtol=1e-6)
    rest = both - moments(b)
    np.testing.assert_allclose(rest.mean, moments(a).mean, atol=1e-9)
    np.testing.assert_allclose(rest.precision, moments(a).precision, rtol=1e-6)


def test_precision_is_the_inverse_of_the_widened_covariance() -> None:
    rows = motion(40, 4)
    covariance = np.cov(rows.T, bias=True) + RIDGE * np.eye(rows.shape[1])
    np.testing.assert_allclose(
        moments(rows).precision @ covariance, np.eye(rows.shape[1]), atol=1e-6
    )
    # The ridge keeps a take that never moves invertible.
    assert np.all(np.isfinite(moments(np.zeros((5, 6))).precision))


def test_rotation_vectors_are_relative_to_the_centre() -> None:
    rng = np.random.default_rng(5)
    q = Rotation.random(80, rng=6).as_quat().reshape(40, 2, 4)
    centre = Rotation.random(2, rng=7).as_quat()
    signs = rng.choice([-1.0, 1.0], (40, 2, 1))
    found = rotation_vectors((signs * q).astype(np.float32), centre.astype(np.float32))
    for k in range(2):
        expected = (Rotation.from_quat(centre[k]).inv() * Rotation.from_quat(q[:, k])).as_rotvec()
        np.testing.assert_allclose(found[:, 3 * k : 3 * k + 3], expected, atol=1e-5)
    still = rotation_vectors(centre[None].astype(np.float32), centre.astype(np.float32))
    np.testing.assert_allclose(still, 0.0, atol=1e-6)


@pytest.mark.parametrize("frames", [1, 3, 40])
def test_poses_are_stacked_with_their_past_and_future(frames: int) -> None:
    rows = motion(frames, 8)
    found = stacked(rows)
    assert found.shape == (frames, len(OFFSETS) * rows.shape[1])
    for t in range(frames):
        for i, offset in enumerate(OFFSETS):
            part = found[t, i * rows.shape[1] : (i + 1) * rows.shape[1]]
            np.testing.assert_array_equal(part, rows[min(max(t + offset, 0), frames - 1)])
    assert OFFSETS[0] == 0
    assert gaussian.moments(found).count == frames
