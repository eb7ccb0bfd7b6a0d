"""The three linked pictures of a comparison."""

from __future__ import annotations

import io

import numpy as np
import pytest
from made_takes import paced, walking
from matplotlib.image import imread

from mocapstudio.comparison.kata import compare
from mocapstudio.comparison.model import Comparison, Segment
from mocapstudio.comparison.parameters import ComparisonParameters
from mocapstudio.comparison.segments import carried
from mocapstudio.motion.progress import run
from mocapstudio.pictures.comparison_picture import comparison_picture
from mocapstudio.pictures.style import DARK, LIGHT, Palette, rgb

SIZE = (900, 640)


@pytest.fixture(scope="module")
def comparison() -> Comparison:
    take = walking(6.0, variation=0.3)
    source = paced(take, np.concatenate([np.full(40, 1.0), np.full(40, 2.0), np.full(90, 0.5)]))
    return run(compare(take, source, ComparisonParameters(true_speed=True)))


def pixels(comparison: Comparison, palette: Palette = DARK) -> np.ndarray:
    png = comparison_picture(comparison, size=SIZE, palette=palette).png
    return imread(io.BytesIO(png))[..., :3]


def shows(image: np.ndarray, colour: str, least: int) -> bool:
    return bool((np.abs(image - rgb(colour)).max(axis=2) < 0.02).sum() >= least)


@pytest.mark.parametrize(
    ("palette", "colours"),
    [(DARK, ("#f2684f", "#f0cd53", "#57a5f7")), (LIGHT, ("#d0402a", "#c99a00", "#2070d0"))],
    ids=["dark", "light"],
)
def test_delayed_on_time_and_hastened_are_seen(
    comparison: Comparison, palette: Palette, colours: tuple[str, ...]
) -> None:
    image = pixels(comparison, palette)
    assert image.shape == (SIZE[1], SIZE[0], 3)
    assert set(np.unique(comparison.timing)) == {-1, 0, 1}
    for colour in colours:
        assert shows(image, colour, 300)


def test_the_heat_map_shows_places_as_colours(comparison: Comparison) -> None:
    image = pixels(comparison)
    hand = comparison.rows.index("LeftHand")
    for poses in (comparison.source_poses, comparison.reference_poses):
        wanted = poses[len(poses) // 2, hand]
        assert (np.abs(image - wanted).max(axis=2) < 0.05).any()


def test_svg_keeps_text_and_names_segments(comparison: Comparison) -> None:
    segments = carried([Segment("low block", 20, 90), Segment("kick", 90, 140)], comparison)
    text = comparison_picture(comparison, segments, svg=True).png.decode()
    assert text.lstrip().startswith("<?xml")
    for word in ("low block", "kick", "pose difference", "LeftHand", "hastened"):
        assert word in text


def test_one_frame_can_be_drawn(comparison: Comparison) -> None:
    take = walking(1.0)
    one = take.with_motion(take.rotations[:1], take.translations[:1])
    for pair in ((take, one), (one, take), (one, one)):
        assert comparison_picture(run(compare(*pair)), size=SIZE).png.startswith(b"\x89PNG")
