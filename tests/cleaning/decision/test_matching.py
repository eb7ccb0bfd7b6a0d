"""Matching without one limb, and residuals, against definitions in plain numpy."""

from __future__ import annotations

from itertools import pairwise

import naive_decision as naive
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mocapstudio.cleaning.decision import kernels
from mocapstudio.cleaning.decision.matching import (
    APART,
    HOP,
    KEEP,
    KEEP_OWN,
    LEAST_FRAMES,
    Matches,
    match,
    nearest_takes,
)
from mocapstudio.motion import rotations as rot
from mocapstudio.similarity.texture import MotionTexture

LIMB = np.array([0, 0, 1, 1, 1, 2])


def texture(frames: int, seed: int) -> MotionTexture:
    """Rough motion: no two windows are nearly equally far apart."""
    rng = np.random.default_rng(seed)
    vectors = 0.4 * rng.normal(size=(frames, 6, 3)) + 0.1 * np.cumsum(
        rng.normal(size=(frames, 6, 3)), axis=0
    )
    q = rot.continuous(Rotation.from_rotvec(vectors.reshape(-1, 3)).as_quat().reshape(frames, 6, 4))
    still = np.zeros((frames, 3), np.float32)
    names = tuple("abcdef")
    return MotionTexture(names, q.astype(np.float32), still, still[:, 0], 0, 1.0)


def corpus_of(parts: list[MotionTexture]) -> np.ndarray:
    return np.concatenate([one.quaternions for one in parts]).astype(float)


def usable(lengths: list[int], barred: tuple[int, ...] = ()) -> np.ndarray:
    parts = []
    for i, length in enumerate(lengths):
        part = np.zeros(length, dtype=bool)
        if i - 1 not in barred:
            part[naive.HALF : max(length - naive.HALF, naive.HALF)] = True
        parts.append(part)
    return np.concatenate(parts)


def check(
    found: Matches, parts: list[MotionTexture], limb: np.ndarray, barred: tuple[int, ...] = ()
) -> None:
    source, corpus = parts[0].quaternions.astype(float), corpus_of(parts)
    allowed = usable([len(one) for one in parts], barred)
    for c, centre in enumerate(found.centres):
        for part in range(limb.max() + 2):
            others, itself, costs = naive.match(
                source, corpus, int(centre), np.flatnonzero(limb == part), allowed,
                (0, len(source)), APART, (KEEP, KEEP_OWN),
            )  # fmt: skip
            for places, distance, expected in (
                (found.found[c, part], found.distance[c, part], others),
                (found.own_found[c, part], found.own_distance[c, part], itself),
            ):
                there = places >= 0
                assert places[there].tolist() == expected
                np.testing.assert_allclose(distance[there], costs[expected], rtol=1e-4)
                assert np.all(np.isnan(distance[~there]))


@pytest.mark.parametrize("barred", [(), (0,), (1, 2), (0, 1, 2)])
def test_windows_are_matched_as_defined(barred: tuple[int, ...]) -> None:
    parts = [texture(50, 0), texture(40, 1), texture(12, 2), texture(31, 3)]
    check(match(parts[0], parts[1:], LIMB, barred), parts, LIMB, barred)


@pytest.mark.parametrize("frames", [LEAST_FRAMES, LEAST_FRAMES + 1, 25, 90])
def test_a_take_without_others_is_matched_with_itself(frames: int) -> None:
    alone = texture(frames, 4)
    found = match(alone, [], LIMB)
    assert np.all(found.found == -1)
    check(found, [alone], LIMB)


def test_long_takes_do_not_lose_precision() -> None:
    """Sums run along diagonals for hundreds of frames, in blocks of their own."""
    parts = [texture(330, 5), texture(60, 6)]
    found = match(parts[0], parts[1:], LIMB)
    source, corpus = parts[0].quaternions.astype(float), corpus_of(parts)
    for c in (0, 23, 24, len(found.centres) - 1):
        costs = naive.window_costs(source, corpus, int(found.centres[c]), np.arange(6))
        places = found.found[c, -1]
        np.testing.assert_allclose(found.distance[c, -1], costs[places], rtol=2e-4)


def test_every_frame_goes_by_its_nearest_centre() -> None:
    found = match(texture(53, 7), [], LIMB)
    assert found.centres[0] == naive.HALF
    assert found.centres[-1] == 53 - naive.HALF - 1
    assert np.diff(found.centres).max() <= HOP
    for t, c in enumerate(found.centre_of):
        assert abs(t - found.centres[c]) == np.abs(t - found.centres).min()


def test_a_limb_that_is_wrong_does_not_move_its_own_neighbours() -> None:
    clean, other = texture(60, 8), texture(80, 9)
    q = clean.quaternions.copy()
    q[:, LIMB == 1] = texture(60, 10).quaternions[:, LIMB == 1]
    wrong = MotionTexture(clean.joints, q, clean.travel, clean.turning, 0, 1.0)
    before, after = match(clean, [other], LIMB), match(wrong, [other], LIMB)
    np.testing.assert_array_equal(before.found[:, 1], after.found[:, 1])
    assert np.any(before.found[:, 0] != after.found[:, 0])
    assert np.any(before.found[:, -1] != after.found[:, -1])


def test_the_takes_that_resemble_most_come_first() -> None:
    mine = texture(60, 11)
    copy = MotionTexture(mine.joints, mine.quaternions[5:], mine.travel, mine.turning, 0, 1.0)
    found = match(mine, [texture(20, 12), copy, texture(100, 13)], LIMB)
    counts = np.bincount(np.searchsorted(found.starts, found.found[found.found >= 0], "right") - 2)
    order = nearest_takes(found)
    assert sorted(order) == [0, 1, 2]
    assert all(counts[a] >= counts[b] for a, b in pairwise(order))


def test_one_pose_against_all_limb_by_limb() -> None:
    target, pose = texture(150, 14), texture(1, 15).quaternions[0]
    out = np.full((3, 150), np.nan, dtype=np.float32)
    kernels.limb_row(pose, target.planes, LIMB, out)
    every = naive.saturating(pose.astype(float), target.quaternions.astype(float))
    for one in range(3):
        np.testing.assert_allclose(out[one], every[:, one == LIMB].sum(axis=1), atol=1e-5)


def test_residuals_are_those_of_the_definition() -> None:
    parts = [texture(40, 16), texture(45, 17)]
    source, corpus = parts[0].quaternions.astype(float), corpus_of(parts)
    found = match(parts[0], parts[1:], LIMB)
    for places, distances in (
        (found.found, found.distance),
        (found.own_found, found.own_distance),
    ):
        out = np.empty((40, 6, kernels.RESIDUALS), dtype=np.float32)
        kernels.residuals(
            parts[0].quaternions, found.planes, LIMB, found.centre_of, found.centres,
            places, distances, out,
        )  # fmt: skip
        for t in range(40):
            c = int(found.centre_of[t])
            for k in range(6):
                mine = places[c, LIMB[k]]
                there = mine[mine >= 0].tolist()
                row = out[t, k]
                assert row[8] == len(there)
                if not there:
                    assert np.all(np.isnan(row[:8]))
                    continue
                shift = t - int(found.centres[c])
                expected = naive.residual(source, corpus, t, k, there, shift)
                np.testing.assert_allclose(row[[0, 1, 2, 3, 6, 7]], expected, atol=0.05)
                near = distances[c, LIMB[k]]
                assert row[4] == near[0]
                assert row[5] == near[len(there) - 1]
