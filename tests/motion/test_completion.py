"""Missing markers are completed, with what stays exact and how far the rest is from the truth."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from mocapstudio import formats
from mocapstudio.motion import completion
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.gap_fills import companions
from mocapstudio.motion.gaps import gaps
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.rigidity import distances, fit_rigid

FILLS = (
    completion.fill_straight,
    completion.fill_spline,
    completion.fill_rigid,
    completion.fill_along_bones,
    completion.fill_from_poses,
    completion.complete,
)
LABELS = ("A", "B", "C", "D", "Elbow", "Wrist")


def made(frames: int = 120) -> MarkerTake:
    """A rigid plate of four markers, and two more in a chain with bones of 0.3 and 0.25 m."""
    time = np.arange(frames) / 60
    turns = Rotation.from_euler(
        "xyz", np.stack([0.6 * np.sin(3 * time), time, 0.4 * np.cos(2 * time)], axis=1)
    )
    plate = np.array([[0.1, 0, 0], [-0.1, 0, 0.02], [0, 0.15, 0], [0, 0.05, 0.12]])
    middle = np.stack([0.5 * time, 1 + 0.1 * np.sin(4 * time), 0.2 * np.cos(time)], axis=1)
    body = np.stack([turns.apply(point) for point in plate], axis=1) + middle[:, None]
    swing = np.stack([np.sin(2 * time), -np.cos(2 * time), 0 * time], axis=1)
    bend = np.stack([np.sin(3 * time), 0 * time, np.cos(3 * time)], axis=1)
    elbow = body[:, 0] + 0.3 * swing
    positions = np.concatenate([body, elbow[:, None], (elbow + 0.25 * bend)[:, None]], axis=1)
    return MarkerTake("made", LABELS, positions, Fraction(60), bones=((0, 4), (4, 5)))


def cut(take: MarkerTake, *holes: tuple[str, int, int]) -> MarkerTake:
    positions = take.positions.copy()
    for label, start, end in holes:
        positions[start:end, take.index[label]] = np.nan
    return replace(take, positions=positions)


WHOLE = made()


def off(done: MarkerTake, label: str, start: int, end: int) -> np.ndarray:
    """Millimetres from the truth."""
    m = WHOLE.index[label]
    return 1000 * np.linalg.norm(
        done.positions[start:end, m] - WHOLE.positions[start:end, m], axis=1
    )


@given(
    label=st.sampled_from(LABELS), start=st.integers(1, 100), length=st.integers(1, 18),
    fill=st.sampled_from(FILLS),
)  # fmt: skip
@settings(max_examples=40)
def test_what_was_measured_stays_and_what_was_filled_is_marked(label, start, length, fill) -> None:
    broken = cut(WHOLE, (label, start, start + length))
    done = fill(broken)
    measured = ~broken.missing
    np.testing.assert_array_equal(done.positions[measured], WHOLE.positions[measured])
    if done is broken:
        return
    np.testing.assert_array_equal(done.filled, broken.missing & ~done.missing)
    assert not done.missing.any()
    # Nothing jumps where the gap begins and ends.
    steps = np.linalg.norm(np.diff(done.positions[:, WHOLE.index[label]], axis=0), axis=1)
    usual = np.linalg.norm(np.diff(WHOLE.positions[:, WHOLE.index[label]], axis=0), axis=1).max()
    assert steps.max() < 3 * usual


def test_only_what_is_asked_for_is_filled() -> None:
    broken = cut(WHOLE, ("A", 10, 20), ("A", 40, 50), ("Wrist", 12, 18))
    for fill in FILLS:
        done = fill(broken, [Declared("A", 12, 15)])
        assert done.filled is not None
        assert [list(np.flatnonzero(row)) for row in done.filled.T if row.any()] == [[12, 13, 14]]
    with pytest.raises(MocapError, match="is no marker"):
        completion.complete(broken, [Declared("Q", 0, 5)])
    assert completion.complete(WHOLE) is WHOLE


def test_filled_marks_add_up() -> None:
    first = completion.fill_spline(cut(WHOLE, ("A", 10, 20)))
    second = completion.fill_spline(cut(first, ("B", 30, 33)))
    assert second.filled is not None
    assert second.filled.sum() == 13


@given(start=st.integers(1, 90), length=st.integers(1, 25), label=st.sampled_from("ABCD"))
@settings(max_examples=20)
def test_on_a_rigid_body_the_place_is_exact(start: int, length: int, label: str) -> None:
    done = completion.fill_rigid(cut(WHOLE, (label, start, start + length)))
    assert off(done, label, start, start + length).max() < 1e-6


def test_a_rigid_body_needs_three_companions_that_are_seen() -> None:
    broken = cut(WHOLE, ("A", 20, 40), ("B", 30, 35))
    done = completion.fill_rigid(broken)
    # While B is gone too, C and D alone leave the turn about their line open.
    assert off(done, "A", 20, 30).max() < 1e-6
    assert done.missing[30:35, 0].all()
    assert completion.fill_rigid(cut(WHOLE, ("Wrist", 20, 30))).missing.any()


def test_rigid_bodies_reach_the_take_s_ends() -> None:
    done = completion.fill_rigid(cut(WHOLE, ("C", 0, 15), ("D", 100, 120)))
    assert max(off(done, "C", 0, 15).max(), off(done, "D", 100, 120).max()) < 1e-6
    assert completion.fill_straight(cut(WHOLE, ("C", 0, 15))).missing.any()


def test_companions_are_those_on_the_same_body() -> None:
    measured = distances(WHOLE)
    assert set(companions(measured, 0)) == {1, 2, 3}
    assert measured.length[0, 4] == pytest.approx(0.3)
    assert measured.spread[0, 4] < 1e-9


@given(start=st.integers(1, 85), length=st.integers(2, 30))
@settings(max_examples=20)
def test_bones_keep_their_length_and_turn_evenly(start: int, length: int) -> None:
    end = start + length
    done = completion.fill_along_bones(cut(WHOLE, ("Wrist", start, end)))
    bone = done.positions[start - 1 : end + 1, 5] - done.positions[start - 1 : end + 1, 4]
    np.testing.assert_allclose(np.linalg.norm(bone, axis=1), 0.25, atol=1e-9)
    steps = np.linalg.norm(np.diff(bone, axis=0), axis=1)
    np.testing.assert_allclose(steps, steps[0], atol=1e-9)
    # The bone turns at an even pace in truth, too: within half a turn it is found exactly.
    assert off(done, "Wrist", start, end).max() < 1e-6


def test_a_chain_is_completed_from_its_fixed_end() -> None:
    broken = cut(WHOLE, ("Elbow", 20, 40), ("Wrist", 20, 40))
    done = completion.fill_along_bones(broken)
    assert max(off(done, "Elbow", 20, 40).max(), off(done, "Wrist", 20, 40).max()) < 1e-6
    assert off(completion.fill_straight(broken), "Wrist", 20, 40).max() > 30


def test_bones_that_nobody_drew_are_found() -> None:
    done = completion.fill_along_bones(replace(cut(WHOLE, ("B", 20, 40)), bones=()))
    straight = completion.fill_straight(cut(WHOLE, ("B", 20, 40)))
    assert off(done, "B", 20, 40).mean() < 0.5 * off(straight, "B", 20, 40).mean()


@given(coefficients=st.lists(st.floats(-1, 1), min_size=9, max_size=9))
@settings(max_examples=20)
def test_a_spline_follows_parabolas(coefficients: list[float]) -> None:
    time = np.arange(60)[:, None] / 60
    a, b, c = np.reshape(coefficients, (3, 3))
    course = a + b * time + c * time**2
    take = MarkerTake("p", ("P",), course[:, None], Fraction(60))
    done = completion.fill_spline(cut(take, ("P", 20, 45)))
    np.testing.assert_allclose(done.positions[:, 0], course, atol=1e-9)


def test_other_markers_tell_where_one_was() -> None:
    generator = np.random.default_rng(4)
    time = np.arange(600) / 60
    # Nine markers that sway with two rhythms, each its own way, while all travel and turn.
    rhythms = np.stack([np.sin(5 * time), np.sin(3.1 * time + 1)], axis=1)
    sway = np.einsum("fr,rmi->fmi", rhythms, generator.uniform(-0.06, 0.06, (2, 9, 3)))
    body = generator.uniform(-0.5, 0.5, (9, 3)) + sway
    turns = Rotation.from_rotvec(np.outer(time, [0, 0.4, 0]))
    positions = np.stack([turns.apply(body[:, m]) for m in range(9)], axis=1)
    positions[..., 0] += 0.3 * time[:, None]
    take = MarkerTake("sway", tuple("PQRSTUVWX"), positions, Fraction(60))
    broken = cut(take, ("S", 300, 390))
    error = [
        np.linalg.norm(fill(broken).positions - positions, axis=2).max()
        for fill in (completion.fill_from_poses, completion.fill_spline)
    ]
    assert error[0] < 0.01 < 0.05 < error[1]


def test_fit_rigid_against_scipy() -> None:
    generator = np.random.default_rng(1)
    template = generator.normal(size=(5, 3))
    turns = Rotation.random(20, random_state=2)
    shifts = generator.normal(size=(20, 3))
    seen = np.stack([turn.apply(template) for turn in turns]) + shifts[:, None]
    seen[3, :2] = np.nan
    seen[4, :3] = np.nan
    found, moved = fit_rigid(template, seen)
    good = np.arange(20) != 4
    np.testing.assert_allclose(found[good], turns.as_matrix()[good], atol=1e-9)
    np.testing.assert_allclose(moved[good], shifts[good], atol=1e-9)
    assert np.isnan(found[4]).all()
    # A plane seen from behind is turned, never mirrored.
    flat = template * [1, 1, 0]
    found, _ = fit_rigid(flat, (flat * [-1, 1, 0])[None])
    assert np.linalg.det(found[0]) == pytest.approx(1)


def test_markers_never_seen_stay_missing() -> None:
    broken = cut(WHOLE, ("D", 0, 120), ("A", 5, 9))
    done = completion.complete(broken)
    assert done.missing[:, 3].all()
    assert not done.missing[:, :3].any()


@pytest.mark.parametrize("seconds", [0.2, 1.0])
@pytest.mark.parametrize(
    "name",
    [
        "gaps_c3d_btk_BSD/ballet_reduced.trc",
        "markerless_opencap_trc_MIT/Squats_0.trc",
        "sync_optical_kinect_imu_MIT/qualisys/trial17.tsv",
    ],
)
def test_real_takes_against_straight_lines(data: Path, name: str, seconds: float) -> None:
    [take], _ = formats.read_any(data / name)
    assert isinstance(take, MarkerTake)
    # Two seconds are enough to tell, three to learn from.
    take = replace(take, positions=take.positions[: int(5 * take.rate)])
    generator = np.random.default_rng(0)
    length = round(seconds * float(take.rate))
    whole = np.flatnonzero(~take.missing.any(axis=0))
    holes = [
        (take.labels[m], s, s + length)
        for m in generator.choice(whole, 12, replace=False)
        for s in [int(generator.integers(1, take.frames - length - 1))]
    ]
    broken = cut(take, *holes)
    gone = broken.missing & ~take.missing

    def mean_error(fill) -> float:
        error = np.linalg.norm(fill(broken).positions - take.positions, axis=2)[gone]
        return float(np.nanmean(error))

    straight = mean_error(completion.fill_straight)
    assert mean_error(completion.complete) < (0.5 if seconds > 0.5 else 0.8) * straight
    assert mean_error(completion.fill_along_bones) < straight


def test_real_gaps_are_completed(data: Path) -> None:
    [take], _ = formats.read_any(data / "sync_optical_kinect_imu_MIT/qualisys/trial17.tsv")
    assert isinstance(take, MarkerTake)
    seen = ~take.missing.all(axis=0)
    assert len(gaps(take)) > 5
    done = completion.complete(take)
    assert not done.missing[:, seen].any()
    assert done.filled is not None
    assert done.filled.sum() == take.missing[:, seen].sum()
