"""Joining a replacement to what stays, and smoothing the seams."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import savgol_coeffs, savgol_filter

from mocapstudio.cleaning.blending import join_rotations, savitzky_golay, smooth_seams
from mocapstudio.motion import rotations as rot


def spin(frames: int, first: float = 0.0, speed: float = 0.05) -> np.ndarray:
    """(frames, 2, 4): two joints that turn evenly about axes of their own."""
    angles = first + speed * np.arange(frames)
    axes = np.array([[0.6, 0.0, 0.8], [0.0, 1.0, 0.0]])
    return rot.from_rotation_vector(angles[:, None, None] * axes)


@pytest.mark.parametrize("half", [1, 2, 3, 7])
def test_the_smoother_is_scipys(half: int) -> None:
    expected = savgol_coeffs(2 * half + 1, 2, use="dot")
    np.testing.assert_allclose(savitzky_golay(half), expected, atol=1e-12)


def test_what_fits_already_stays_as_it_is() -> None:
    whole = spin(30)
    joined = join_rotations(whole[10:20], whole[8:10], whole[20:22])
    assert rot.angle(joined, whole[10:20]).max() < 1e-6


@given(st.integers(4, 40), st.floats(-2.5, 2.5), st.integers(0, 1000))
def test_a_mismatch_fades_over_the_span(frames: int, off: float, seed: int) -> None:
    axis = np.random.default_rng(seed).normal(size=3)
    turn = rot.from_rotation_vector(off * axis / np.linalg.norm(axis))
    whole = spin(frames + 20)
    inside = rot.multiply(turn, whole[10 : frames + 10])
    joined = join_rotations(inside, whole[8:10], whole[frames + 10 : frames + 12])
    left = rot.angle(joined, whole[10 : frames + 10])
    # A turn of the donor as a whole is taken off; at either end a small share of it remains.
    assert left[[0, -1]].max() <= 2.5 * abs(off) / (frames + 1) + 1e-6
    before = join_rotations(inside, whole[8:10], None)
    assert rot.angle(before, whole[10 : frames + 10]).max() < 1e-6
    after = join_rotations(inside, None, whole[frames + 10 : frames + 12])
    assert rot.angle(after, whole[10 : frames + 10]).max() < 1e-6
    np.testing.assert_array_equal(join_rotations(inside, None, None), inside)


def test_the_seams_alone_are_smoothed() -> None:
    rng = np.random.default_rng(0)
    rough = rot.multiply(spin(40), rot.from_rotation_vector(rng.normal(0, 0.02, (40, 2, 3))))
    before, inside, after = rough[:10], rough[10:30], rough[30:]
    smooth = smooth_seams(inside, before, after, 3)
    np.testing.assert_array_equal(smooth[3:-3], inside[3:-3])
    expected = rot.normalize(savgol_filter(rot.continuous(rough), 7, 2, axis=0))[10:30]
    for part in (slice(0, 3), slice(-3, None)):
        np.testing.assert_allclose(smooth[part], expected[part], atol=1e-12)
        assert np.abs(smooth[part] - inside[part]).max() > 1e-4


@pytest.mark.parametrize(("lead", "tail"), [(0, 5), (5, 0), (0, 0), (1, 1), (2, 7)])
@pytest.mark.parametrize("frames", [1, 2, 5, 9])
def test_at_the_ends_of_a_take_there_is_less_to_smooth(lead: int, tail: int, frames: int) -> None:
    whole = spin(lead + frames + tail)
    before = whole[:lead] if lead else None
    after = whole[lead + frames :] if tail else None
    smooth = smooth_seams(whole[lead : lead + frames], before, after, 2)
    assert smooth.shape == (frames, 2, 4)
    assert rot.angle(smooth, whole[lead : lead + frames]).max() < 1e-2
    np.testing.assert_allclose(np.linalg.norm(smooth, axis=-1), 1.0, atol=1e-9)


def test_signs_do_not_matter() -> None:
    whole = spin(40)
    signs = np.random.default_rng(1).choice([-1.0, 1.0], (20, 2, 1))
    smooth = smooth_seams(signs * whole[10:30], whole[:10], whole[30:], 3)
    np.testing.assert_allclose(smooth, smooth_seams(whole[10:30], whole[:10], whole[30:], 3))
    joined = join_rotations(signs * whole[10:30], whole[8:10], whole[30:32])
    assert rot.angle(joined, whole[10:30]).max() < 1e-6
