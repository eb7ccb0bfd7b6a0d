"""Segments suggested and carried over, takes in the reference's timing."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_takes import person
from scipy.signal import find_peaks

from mocapstudio.comparison.kata import compare
from mocapstudio.comparison.model import Segment
from mocapstudio.comparison.segments import (
    boundary_errors,
    carried,
    peaks,
    source_frames,
    suggested,
)
from mocapstudio.comparison.warped import warped
from mocapstudio.evaluation.kata_warps import Disturbance, WarpedTake, perform_again
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take

RATE = 50
BEATS = ((1.0, 2.2), (2.6, 3.4), (3.9, 5.5), (6.2, 7.0))
"""Seconds in which something is done; between them the body rests."""


@pytest.fixture(scope="module")
def techniques() -> Take:
    rng = np.random.default_rng(4)
    skeleton, frames = person(), 8 * RATE
    angles = np.zeros((frames, len(skeleton), 3))
    for start, end in BEATS:
        first, last = round(start * RATE), round(end * RATE)
        share = np.clip((np.arange(frames) - first) / (last - first), 0, 1)
        smooth = share**3 * (10 - 15 * share + 6 * share**2)
        angles += smooth[:, None, None] * rng.normal(0, 0.5, (1, len(skeleton), 3))
    places = np.tile([0.0, 0.9, 0.0], (frames, 1, 1))
    return Take("kata", skeleton, rot.from_rotation_vector(angles), places, Fraction(RATE))


@pytest.fixture(scope="module")
def again(techniques: Take) -> WarpedTake:
    how = Disturbance(pace=1.4, pauses=0, noise_degrees=1, style_degrees=5)
    return perform_again(techniques, how, 2)


def labelled() -> list[Segment]:
    return [
        Segment(f"technique {n}", round(start * RATE), round(end * RATE))
        for n, (start, end) in enumerate(BEATS, 1)
    ]


@settings(max_examples=60)
@given(st.lists(st.integers(-5, 5), min_size=3, max_size=60), st.sampled_from([0.5, 2.0, 4.0]))
def test_peaks_are_those_of_scipy(values: list[int], prominence: float) -> None:
    level = np.array(values, float)
    _, about = find_peaks(level, prominence=prominence, plateau_size=1)
    expected = list(zip(about["left_edges"], about["right_edges"], strict=True))
    assert peaks(level, prominence, 0) == expected


def test_rests_part_the_techniques(techniques: Take) -> None:
    found = suggested(techniques)
    assert len(found) == len(BEATS)
    for segment, (start, end) in zip(found, BEATS, strict=True):
        assert segment.start / RATE == pytest.approx(start, abs=0.35)
        assert segment.end / RATE == pytest.approx(end, abs=0.35)
    assert boundary_errors(found, labelled(), RATE).max() < 0.35


def test_a_body_at_rest_has_no_segments(techniques: Take) -> None:
    still = np.repeat(techniques.rotations[:1], 100, axis=0)
    take = replace(techniques, rotations=still, translations=techniques.translations[:100])
    assert suggested(take) == ()


def test_segments_are_carried_to_where_they_are_done(techniques: Take, again: WarpedTake) -> None:
    found = run(compare(techniques, again.take))
    for one in carried(labelled(), found):
        truth = np.searchsorted(again.truth, [one.reference.start, one.reference.end])
        # A rest looks the same all the time: its boundaries can be found only so well.
        assert np.abs(np.array([one.source.start, one.source.end]) - truth).max() / RATE < 0.35
        later = one.source.start / RATE - one.reference.start / RATE
        assert one.delay == pytest.approx(later, abs=0.1)
        assert one.source_duration == (one.source.end - one.source.start) / RATE


def test_every_boundary_has_its_place_and_order_is_kept(
    techniques: Take, again: WarpedTake
) -> None:
    found = run(compare(techniques, again.take))
    frames = source_frames(found, np.arange(techniques.frames + 1, dtype=float))
    assert frames[0] >= 0
    assert frames[-1] == again.take.frames
    assert (np.diff(frames) >= 0).all()


def test_no_segment_is_carried_to_nothing(techniques: Take, again: WarpedTake) -> None:
    found = run(compare(techniques, again.take))
    last = techniques.frames
    edges = [Segment("first", 0, 1), Segment("last", last - 1, last), Segment("all", 0, last)]
    for one in carried(edges, found):
        assert 0 <= one.source.start < one.source.end <= again.take.frames


def test_the_warped_source_is_timed_like_the_reference(techniques: Take, again: WarpedTake) -> None:
    found = run(compare(techniques, again.take))
    timed = warped(again.take, found)
    assert isinstance(timed, Take)
    assert (timed.frames, timed.rate) == (techniques.frames, techniques.rate)
    np.testing.assert_allclose(np.linalg.norm(timed.rotations, axis=-1), 1)
    once_more = run(compare(techniques, timed))
    assert np.median(np.abs(once_more.misalignment)) < 0.02
    plain = run(compare(techniques, techniques))
    same = warped(techniques, plain)
    assert isinstance(same, Take)
    np.testing.assert_allclose(np.abs(np.sum(same.rotations * techniques.rotations, -1)), 1)


def test_missing_markers_stay_missing_when_warped(techniques: Take, again: WarpedTake) -> None:
    reference, source = (
        MarkerTake(one.name, one.skeleton.names, take_pose(one)[0], one.rate)
        for one in (techniques, again.take)
    )
    positions = source.positions.copy()
    positions[40:60, 3] = np.nan
    gappy = replace(source, positions=positions)
    found = run(compare(reference, gappy))
    timed = warped(gappy, found)
    assert isinstance(timed, MarkerTake)
    assert timed.frames == reference.frames
    missing = np.flatnonzero(timed.missing[:, 3])
    at = source_frames(found, missing.astype(float))
    assert len(missing) > 5
    assert at.min() > 38
    assert at.max() < 61
    assert not timed.missing[:, 4].any()
