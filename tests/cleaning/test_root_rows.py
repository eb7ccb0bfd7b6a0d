"""Residuals of the two root rows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from made_takes import elsewhere, faced, moved, walking

from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.root import heading_departure, height_departure
from mocapstudio.motion.facing import ROOT_POSITION
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take
from mocapstudio.similarity.texture import motion_texture
from mocapstudio.similarity.words import Corpus, WordShape, find_neighbours, trim_count


def heights(take: Take, *context: Take) -> np.ndarray:
    joints = take.skeleton.names
    corpus = Corpus.of([motion_texture(one, joints) for one in (take, *context)])
    shape = WordShape()
    trim = trim_count(len(joints), whole_body=True)
    near = find_neighbours(corpus.textures[0], corpus, 5, trim, shape)
    return height_departure(corpus.textures[0], corpus, near, shape)


def test_height_is_measured_in_centimetres_against_the_neighbours() -> None:
    take = walking(10.0, 24)
    found = heights(moved(take, 100, 104, (0.0, 0.2, 0.0)), walking(10.0, 24, seed=1))
    assert np.abs(found[100:104] - 20.0).max() < 3.0
    assert np.delete(found, np.s_[85:119]).max() < 3.0


@pytest.mark.parametrize("metres", [1.3, -0.4, 0.07])
def test_another_floor_or_body_height_is_no_error(metres: float) -> None:
    take, context = walking(10.0, 24), walking(10.0, 24, seed=1)
    raised = elsewhere(take, 0.0, (0.0, metres, 0.0))
    np.testing.assert_allclose(heights(raised, context), heights(take, context), atol=0.01)
    popped = heights(moved(raised, 100, 104, (0.0, 0.2, 0.0)), context)
    assert np.abs(popped[100:104] - 20.0).max() < 3.0
    analysis = run(detect(raised, [context]))
    assert ROOT_POSITION not in {flag.joint for flag in analysis.flags}


@pytest.mark.parametrize("rate", [24, 30, 120])
@pytest.mark.parametrize("degrees", [60.0, 170.0, -120.0])
def test_heading_departs_by_what_it_was_turned(rate: int, degrees: float) -> None:
    take = walking(10.0, rate)
    start, end = 4 * rate, 4 * rate + rate // 2
    found = heading_departure(faced(take, start, end, degrees))
    assert np.abs(found[start:end] - abs(degrees)).max() < 15.0
    assert np.concatenate([found[:start], found[end:]]).max() < 15.0


def test_a_real_turn_is_no_departure() -> None:
    take = walking(10.0, 30)
    for frame in range(150, 210):  # half a turn in two seconds
        take = faced(take, frame, frame + 1, 3.0 * (frame - 150))
    take = faced(take, 210, 300, 180.0)
    assert heading_departure(take).max() < 40.0


@pytest.mark.parametrize("frames", [2, 5, 20, 71])
def test_short_and_trimmed_takes(frames: int) -> None:
    take = walking(10.0, 30)
    trimmed = replace(take, trim=(50, 50 + frames))
    found = heading_departure(trimmed)
    assert found.shape == (300,)
    assert np.all(found[:50] == 0) and np.all(found[50 + frames :] == 0)
    assert np.all(np.isfinite(found))
    assert found.max() < 20.0
