"""Departures in standard deviations, nearest rotations and feet, against their definitions."""

from __future__ import annotations

import numpy as np
import pytest
from made_takes import turned, walking
from scipy.spatial.transform import Rotation

from mocapstudio.cleaning.decision import gaussian, kernels, plausibility
from mocapstudio.cleaning.decision.general import general_judge, share_of_general
from mocapstudio.cleaning.decision.surroundings import anatomy_of
from mocapstudio.similarity.texture import body_motion, texture_of

LIMB = np.array([0, 0, 1, 2, 1])
RIDGE = np.deg2rad(2.5) ** 2


@pytest.fixture(scope="module")
def poses() -> tuple[np.ndarray, np.ndarray]:
    """Known and new stacked poses of five joints that move together."""
    rng = np.random.default_rng(0)
    mixing = rng.normal(size=(4, 15))

    def motion(frames: int) -> np.ndarray:
        at = np.arange(frames)[:, None]
        waves = np.sin(at * rng.uniform(0.05, 0.4, 4) + rng.uniform(0, 6, 4))
        return 0.2 * waves @ mixing + 0.05 * rng.normal(size=(frames, 15))

    return gaussian.stacked(motion(700)), gaussian.stacked(motion(40))


def mahalanobis(rows: np.ndarray, known: np.ndarray) -> np.ndarray:
    covariance = np.cov(known.T, bias=True) + RIDGE * np.eye(known.shape[1])
    away = rows - known.mean(axis=0)
    return np.sqrt(np.sum(away * np.linalg.solve(covariance, away.T).T, axis=1))


def given(rows: np.ndarray, known: np.ndarray, part: np.ndarray, rest: np.ndarray) -> np.ndarray:
    """Mahalanobis length of `part` given `rest`, by the textbook."""
    columns = np.concatenate([part, rest])
    covariance = np.cov(known[:, columns].T, bias=True) + RIDGE * np.eye(len(columns))
    mean, n = known[:, columns].mean(axis=0), len(part)
    gain = np.linalg.solve(covariance[n:, n:], covariance[n:, :n]).T
    left = covariance[:n, :n] - gain @ covariance[n:, :n]
    away = rows[:, part] - mean[:n] - (rows[:, rest] - mean[n:]) @ gain.T
    return np.sqrt(np.sum(away * np.linalg.solve(left, away.T).T, axis=1))


def columns_of(joints: np.ndarray) -> np.ndarray:
    return (3 * joints[:, None] + np.arange(3)).ravel()


def test_scores_are_lengths_in_standard_deviations(poses) -> None:
    known, rows = poses
    found = plausibility.scores(rows, gaussian.moments(known), LIMB)
    every = np.arange(known.shape[1])
    for k in range(5):
        own = columns_of(np.array([k]))
        mates = np.flatnonzero((LIMB[k] == LIMB) & (np.arange(5) != k))
        limb = columns_of(np.flatnonzero(LIMB[k] == LIMB))
        expected = [
            mahalanobis(rows[:, own], known[:, own]),
            mahalanobis(*(x[:, 30 + own] - x[:, 15 + own] for x in (rows, known))),
            given(rows, known, own, np.setdiff1d(every, own)),
            given(rows, known, own, np.setdiff1d(every, limb)),
            given(rows, known, own, columns_of(mates)),
        ]  # fmt: skip
        np.testing.assert_allclose(found[:, k], np.stack(expected, axis=1), rtol=2e-3, atol=2e-3)


def test_nearest_rotation_is_the_nearest_of_all() -> None:
    rng = np.random.default_rng(1)
    corpus = Rotation.random(60 * 3, random_state=2).as_quat().reshape(60, 3, 4)
    source = corpus[:20] * rng.choice([-1.0, 1.0], (20, 3, 1))
    mate = np.array([1, 0, 1])
    planes = np.ascontiguousarray(corpus.transpose(1, 2, 0), dtype=np.float32)
    dots = np.abs(np.einsum("skc,tkc->stk", source, corpus)).clip(max=1.0)
    for begin, end, apart in ((20, 60, -1), (0, 20, 5)):
        out = np.empty((20, 3, 2), np.float32)
        span = np.array([begin, end, apart])
        kernels.nearest_rotations(source.astype(np.float32), planes, mate, span, out)
        for t in range(20):
            kept = [j for j in range(begin, end) if apart < 0 or abs(j - begin - t) > apart]
            alone = np.rad2deg(2 * np.arccos(dots[t, kept].max(axis=0)))
            both = 8 * ((1 - dots[t, kept]) + (1 - dots[t, kept][:, mate]))
            np.testing.assert_allclose(out[t, :, 0], alone, atol=0.1)
            np.testing.assert_allclose(
                out[t, :, 1], np.rad2deg(np.sqrt(both.min(axis=0))), atol=0.1
            )


def test_where_no_frame_is_left_nothing_is_nearest() -> None:
    source = np.tile(np.array([0, 0, 0, 1], np.float32), (4, 1, 1))
    planes = np.ascontiguousarray(source.transpose(1, 2, 0))
    out = np.zeros((4, 1, 2), np.float32)
    kernels.nearest_rotations(source, planes, np.array([0]), np.array([0, 4, 9]), out)
    assert np.isnan(out).all()


def test_a_bent_knee_moves_its_own_foot_only() -> None:
    take = walking(4.0, 60, seed=0)
    joints = take.skeleton.names
    limb = anatomy_of(take.skeleton, joints).limb
    left, right = joints.index("LeftLeg"), joints.index("RightLeg")

    def of(one) -> np.ndarray:
        motion = body_motion(one, joints)
        return plausibility.feet(motion, texture_of(motion), limb)

    clean, bent = of(take), of(turned(take, "LeftLeg", 100, 130, 50))
    inside = slice(42, 50)
    assert np.nanmax(np.abs(bent - clean)[inside, left, 0]) > 0.05
    np.testing.assert_allclose(bent[inside, right, 0], clean[inside, right, 0], atol=1e-6)
    np.testing.assert_allclose(bent[:, right, 2], bent[:, left, 0], atol=1e-6)
    assert np.isnan(clean[:, joints.index("Head"), 0]).all()


def test_the_shipped_judge_sees_many_contexts_and_yields_to_long_ones() -> None:
    judge = general_judge()
    assert len(judge.joints.roots) > 50
    assert share_of_general(0) == 1.0
    assert share_of_general(500) > share_of_general(5000) > 0.0
