"""The two-state model against enumeration of all courses of states; what it learns."""

from __future__ import annotations

from itertools import product

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from mocapstudio.cleaning.contacts.states import learnt, log_speed, posterior, usual

LEAVE = 1 - np.exp(-1 / (0.15 * 30.0))
"""At 30 Hz a state that lasts 0.15 s on average is left with this probability."""


def naive_posterior(odds: np.ndarray) -> np.ndarray:
    """Sum over every course of states, one by one."""
    total, contact = 0.0, np.zeros(len(odds))
    for course in product((0, 1), repeat=len(odds)):
        weight = 0.5
        for t, state in enumerate(course):
            weight *= np.exp(odds[t]) if state else 1.0
            if t:
                weight *= 1 - LEAVE if state == course[t - 1] else LEAVE
        total += weight
        contact += weight * np.array(course)
    return contact / total


@settings(max_examples=30)
@given(hnp.arrays(float, st.integers(1, 8), elements=st.floats(-6, 6)))
def test_posterior_is_the_sum_over_all_courses(odds: np.ndarray) -> None:
    np.testing.assert_allclose(
        posterior(odds[:, None], 30.0)[:, 0], naive_posterior(odds), atol=1e-9
    )


def test_a_short_doubt_does_not_end_a_contact() -> None:
    odds = np.full((60, 1), 3.0)
    odds[30] = -2.0
    assert posterior(odds, 30.0)[30] > 0.5
    odds[25:35] = -3.0
    assert posterior(odds, 30.0)[30] < 0.5


def test_evidence_does_not_grow_with_the_rate() -> None:
    course = np.concatenate([np.full(10, 1.0), np.full(4, -1.0), np.full(10, 1.0)])
    slow = posterior(course[:, None], 30.0)[:, 0]
    fast = posterior(np.repeat(course, 4)[:, None], 120.0)[:, 0]
    assert np.abs(fast.reshape(-1, 4).mean(axis=1) - slow).max() < 0.12


def test_odds_fall_with_speed_and_height() -> None:
    model = usual("ball")
    speeds = np.geomspace(0.005, 20, 60)
    assert np.all(np.diff(model.log_odds(log_speed(speeds), np.zeros(60))) <= 1e-12)
    heights = np.linspace(0, 1.5, 60)
    odds = model.log_odds(np.full(60, log_speed(np.array(0.05))), heights)
    assert odds[0] > 0 > odds[10]
    assert np.all(odds[20:] < odds[0] - 4)


def test_distributions_are_learnt_from_the_take() -> None:
    """Contacts of a restless performer are faster than usual, and still contacts."""
    rng = np.random.default_rng(0)
    contact = np.arange(1200) % 60 < 35
    speed = np.exp(np.where(contact, np.log(0.3), np.log(4.0)) + 0.3 * rng.normal(size=1200))
    height = np.where(contact, 0.0, 0.1) + 0.004 * rng.normal(size=1200)
    model = learnt(usual("ball"), speed[:, None], height[:, None], 30.0)
    assert abs(model.contact - np.log(0.31)) < 0.35
    assert model.free > np.log(3.0)
    odds = model.log_odds(log_speed(speed[:, None]), height[:, None])
    found = posterior(odds, 30.0)[:, 0] > 0.5
    assert (found == contact).mean() > 0.98
