"""Likely causes of flagged spans."""

from __future__ import annotations

import numpy as np
import pytest
from made_takes import walking

from mocapstudio.cleaning import own_rate
from mocapstudio.cleaning.kinds import likely_kind
from mocapstudio.cleaning.model import DigressionMap, Kind
from mocapstudio.cleaning.own_rate import OwnRate
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.motion.take import Take
from mocapstudio.similarity.texture import body_motion

TAKE = walking(8.0, 60)
JOINTS = TAKE.skeleton.names
ROWS = (*JOINTS, *ROOT_ROWS)


def spoiled(kind: Kind, joint: str, start: int, end: int) -> Take:
    """A take with a textbook error of one kind."""
    n, column = end - start, JOINTS.index(joint)
    rotations = TAKE.rotations.copy()
    inside, time = rotations[start:end, column], np.arange(n) / 60
    axis = np.array([0.6, 0.0, 0.8])
    sizes = {
        Kind.POP: np.full(n, 35.0),
        Kind.SPIKE: 40.0 * np.sin(np.pi * (np.arange(n) + 1) / (n + 1)),
        Kind.OFFSET: np.full(n, 40.0),
        Kind.FLIP: np.full(n, 170.0),
        Kind.DRIFT: 45.0 * (np.arange(n) / n) ** 2,
        Kind.JITTER: 6.0 * np.sin(2 * np.pi * 20 * time),
        Kind.NOISE: 40.0 * np.sin(2 * np.pi * 6 * time),
    }
    if kind is Kind.FREEZE:
        rotations[start:end, column] = inside[0]
    elif kind is Kind.GAP:
        rotations[start:end, column] = rot.slerp(inside[0], inside[-1], np.linspace(0, 1, n))
    else:
        turn = rot.from_rotation_vector(np.deg2rad(sizes[kind])[:, None] * axis)
        rotations[start:end, column] = rot.multiply(inside, turn)
    return TAKE.with_motion(rotations)


@pytest.mark.parametrize(
    ("kind", "frames"),
    [
        (Kind.POP, 1), (Kind.POP, 2), (Kind.SPIKE, 10), (Kind.OFFSET, 60), (Kind.FLIP, 40),
        (Kind.DRIFT, 90), (Kind.FREEZE, 40), (Kind.GAP, 40), (Kind.JITTER, 60), (Kind.NOISE, 80),
    ],
)  # fmt: skip
def test_a_textbook_error_is_called_by_its_name(kind: Kind, frames: int) -> None:
    joint, start = "LeftUpLeg", 203
    bad = spoiled(kind, joint, start, start + frames)
    column = JOINTS.index(joint)
    away = np.rad2deg(rot.angle(bad.rotations, TAKE.rotations)).astype(np.float32)
    residuals = np.hstack([away, np.zeros((TAKE.frames, 2), np.float32)])
    digression = DigressionMap(ROWS, residuals / 180, residuals)
    rates = own_rate.of_motion(body_motion(bad, JOINTS))
    assert likely_kind(bad, digression, rates, column, start, start + frames) is kind


@pytest.mark.parametrize("frames", [1, 2, 3, 5])
@pytest.mark.parametrize("row", range(len(ROWS)))
def test_every_span_has_a_likely_cause(row: int, frames: int) -> None:
    zeros = np.zeros((TAKE.frames, len(ROWS)), dtype=np.float32)
    digression, rates = DigressionMap(ROWS, zeros, zeros), OwnRate(zeros, zeros)
    for start in (0, 200, TAKE.frames - frames):
        assert likely_kind(TAKE, digression, rates, row, start, start + frames) in Kind
