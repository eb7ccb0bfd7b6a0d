"""The benchmark of online alignment: cases found by label, scores by definition, pictures."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from made_takes import paced, walking

from mocapstudio import formats
from mocapstudio.comparison.labels import Labels, write_labels
from mocapstudio.comparison.model import Segment
from mocapstudio.comparison.weights_examples import LabelledTake
from mocapstudio.comparison.weights_quality import SHARES
from mocapstudio.evaluation.alignment_benchmark import (
    METHODS,
    OFFLINE,
    OURS,
    PLAIN,
    ActionScores,
    mean_scores,
    scoring,
)
from mocapstudio.evaluation.alignment_cases import Action, actions
from mocapstudio.evaluation.alignment_page import share_curves
from mocapstudio.evaluation.alignment_warps import following_warps
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take


def performances(count: int) -> list[LabelledTake]:
    """One walk at several paces, its labels carried along."""
    base = walking(3.0, seed=0)
    found = []
    for i in range(count):
        pace = 1.0 + 0.3 * np.sin(np.arange(base.frames) / 15.0 + i)
        take = replace(paced(base, pace), name=f"walk_{i}")
        truth = np.cumsum(pace)[: take.frames]
        cuts = [0, *(int(np.searchsorted(truth, at)) for at in (25, 50)), take.frames]
        parts = [Segment("abc"[k], cuts[k], cuts[k + 1]) for k in range(3)]
        found.append(LabelledTake(take, Labels(take.name, Fraction(30), tuple(parts))))
    return found


def test_the_same_motion_at_other_paces_is_aligned_by_every_method() -> None:
    scores = run(scoring(Action("walk", tuple(performances(4))), 2, 2, 2, seed=0))
    assert (scores.references, scores.performances) == (2, 4)
    assert set(scores.curves) == set(METHODS)
    for name, curve in scores.curves.items():
        assert curve.shape == (len(SHARES),)
        assert curve.min() > 0.9, name
    assert np.ptp(scores.curves[OFFLINE]) == 0


def test_what_is_to_be_reached_is_read_off_the_curves() -> None:
    flat = {name: np.full(len(SHARES), 0.8) for name in METHODS}
    ours = np.full(len(SHARES), 0.85)
    # Before 40 % the offline alignment may lead by more.
    ours[0], ours[5] = 0.5, 0.77
    one = ActionScores("a", 1, 3, flat | {OURS: ours})
    assert one.behind_offline == pytest.approx(0.03)
    assert one.above_plain == pytest.approx((-0.3, float(ours.mean() - 0.8)))
    other = ActionScores("b", 2, 5, {name: curve + 0.1 for name, curve in one.curves.items()})
    both = mean_scores([one, other])
    np.testing.assert_allclose(both.curves[PLAIN], 0.85)
    assert (both.references, both.performances) == (3, 8)


def test_takes_are_found_by_their_labels(tmp_path: Path) -> None:
    made = performances(3)
    for one in made:
        assert isinstance(one.take, Take)
        formats.write(one.take, tmp_path / f"{one.take.name}.bvh")
    known, lone = tmp_path / "walk.json", tmp_path / "lone.json"
    write_labels([one.labels for one in made], known)
    write_labels(made[0].labels, lone)
    found = actions([tmp_path], [known, lone])
    assert [action.name for action in found] == ["walk"]
    assert [one.take.name for one in found[0].performances] == ["walk_0", "walk_1", "walk_2"]
    assert found[0].performances[1].labels == made[1].labels
    with pytest.raises(MocapError, match="labelled"):
        actions([tmp_path], [lone])


def test_known_warps_are_followed(tmp_path: Path) -> None:
    formats.write(walking(5.0, seed=2), tmp_path / "walk.bvh")
    rows = run(following_warps([tmp_path], seed=0, limit=1))
    assert {row.takes for row in rows} == {1}
    (plain,) = (r for r in rows if (r.disturbance, r.method) == ("pace and pauses", PLAIN))
    assert plain.median <= 0.5
    assert plain.high <= 2.0
    assert plain.near == 1.0


def test_the_picture_shows_every_line_within_its_axes() -> None:
    curves = {PLAIN: np.linspace(0.7, 1.0, 10), OURS: np.linspace(0.9, 0.95, 10)}
    figure = ElementTree.fromstring(share_curves("a < b", SHARES, curves, METHODS))
    svg = figure.find("svg")
    assert svg is not None
    lines = svg.findall("polyline")
    assert len(lines) == 2
    assert len({line.get("stroke") for line in lines}) == 2
    for line in lines:
        points = np.array([pair.split(",") for pair in line.get("points", "").split()], float)
        assert len(points) == len(SHARES)
        assert points[:, 0].min() >= 44
        assert points[:, 0].max() <= 366
        assert points[:, 1].min() >= 29.9
        assert points[:, 1].max() <= 256.1
    texts = [text.text or "" for text in svg.findall("text")]
    assert "a < b" in texts
    assert any(text.startswith(OURS) for text in texts)
