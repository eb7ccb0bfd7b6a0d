"""The fitted floor: level, sloping, stepped; a foot held in the air is none."""

from __future__ import annotations

import numpy as np
import pytest

from mocapstudio.cleaning.contacts.floor import FittedFloor, fit_floor

RATE, LEG = 60.0, 0.86
LIFT = 0.15


def walk(ground, steps: int = 12, lag: float = 0.5) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Two feet that step along +x, half a second each; places, hips, (F, 2) in stance."""
    frames = int(steps * RATE * lag)
    time = np.arange(frames) / RATE
    places, stance = np.zeros((frames, 2, 3)), np.zeros((frames, 2), bool)
    for foot in range(2):
        phase = time / (2 * lag) + 0.5 * foot
        cycle, share = np.floor(phase), phase % 1
        swing = np.clip((share - 0.55) / 0.45, 0, 1)
        ease = swing**3 * (10 - 15 * swing + 6 * swing**2)
        x = 0.7 * (cycle + ease - 0.5 * foot)
        here, ahead = ground(0.7 * (cycle - 0.5 * foot)), ground(0.7 * (cycle + 1 - 0.5 * foot))
        y = here + ease * (ahead - here) + LIFT * 16 * (swing * (1 - swing)) ** 2
        places[:, foot] = np.stack([x, y, np.full(frames, 0.1 - 0.2 * foot)], axis=1)
        stance[:, foot] = swing == 0
    hips = places.mean(axis=1) + np.array([0, 0.85, 0])
    return places, hips, stance


def error(floor: FittedFloor, places: np.ndarray, stance: np.ndarray) -> float:
    return float(np.abs(places[..., 1] - floor.under)[stance].max())


def test_level_floor_at_any_height() -> None:
    places, hips, stance = walk(lambda x: 0 * x + 1.3)
    floor = fit_floor(places, RATE, LEG, hips, [0, 1])
    assert error(floor, places, stance) < 0.002
    np.testing.assert_allclose(floor.normal, [0, 1, 0], atol=1e-3)
    assert abs(floor.at(np.array([2.0, 0.0, 0.0])) - 1.3) < 0.005


def test_each_point_has_a_level_of_its_own() -> None:
    places, hips, stance = walk(lambda x: 0 * x)
    places[:, 1, 1] += 0.02
    floor = fit_floor(places, RATE, LEG, hips, [0, 1])
    assert error(floor, places, stance) < 0.002
    assert floor.levels[1] - floor.levels[0] > 0.01


def test_slope_is_told() -> None:
    places, hips, stance = walk(lambda x: 0.07 * x)
    floor = fit_floor(places, RATE, LEG, hips, [0, 1])
    assert error(floor, places, stance) < 0.02
    assert 0.05 < floor.slope[0] < 0.08


@pytest.mark.parametrize("slope", [-0.17, 0.17])
def test_a_steep_ramp_is_no_row_of_steps(slope: float) -> None:
    places, hips, stance = walk(lambda x: slope * x, steps=8, lag=0.3)
    floor = fit_floor(places, RATE, LEG, hips, [0, 1])
    assert error(floor, places, stance) < 0.03
    assert abs(floor.slope[0] - slope) < 0.03


def test_stairs_carry() -> None:
    places, hips, stance = walk(lambda x: 0.18 * np.round(x / 0.35), steps=10)
    floor = fit_floor(places, RATE, LEG, hips, [0, 1])
    # Where a foot stands alone on its step the step is known, first and last steps apart.
    off = np.abs(places[..., 1] - floor.under) * stance
    inner = slice(int(RATE), -int(RATE))
    assert np.percentile(off[inner][stance[inner]], 90) < 0.03


def test_foot_held_in_the_air_is_no_floor() -> None:
    frames = 300
    places = np.zeros((frames, 2, 3))
    places[:, 1, 2] = -0.2
    rise = 0.5 * np.clip(np.minimum(np.arange(frames) - 60, 240 - np.arange(frames)) / 30, 0, 1)
    places[:, 1, 1] = rise
    hips = np.full((frames, 3), [0.0, 0.9, 0.0])
    floor = fit_floor(places, RATE, LEG, hips, [0, 1])
    assert np.abs(floor.under).max() < 0.01
    assert all(rest.place[1] < 0.05 for rest in floor.rests)


def test_without_any_rest_the_lowest_place_counts() -> None:
    t = np.arange(120) / RATE
    places = np.stack([3 * t, 0.5 + 0.2 * np.sin(20 * t), 0 * t], axis=1)[:, None]
    floor = fit_floor(places, RATE, LEG, places[:, 0] + np.array([0, 0.9, 0]), [0])
    assert floor.rests == ()
    assert np.ptp(floor.under) == 0
    assert 0.29 < floor.under[0, 0] < 0.32


def test_who_stands_on_tiptoe_has_no_higher_heels() -> None:
    """One foot flat, the other on its toes for the whole take."""
    frames = 300
    place = np.zeros((frames, 4, 3))
    place[:, :, 2] = [0.0, 0.15, 0.3, 0.4]
    place[:, 2, 1] = 0.18
    place += 0.001 * np.sin(np.arange(frames) / 9)[:, None, None]
    floor = fit_floor(place, RATE, LEG, np.full((frames, 3), [0, 0.9, 0.2]), [0, 0, 1, 1])
    assert np.abs(floor.under[:, [0, 1, 3]]).max() < 0.01
    assert floor.under[:, 2].max() < 0.09
