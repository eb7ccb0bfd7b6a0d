"""Joining a replacement to what stays, and smoothing the seams."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import savgol_coeffs, savgol_filter

from mocapstudio.cleaning.blending import savitzky_golay, smooth_seams
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
