"""What a comparison can be told: bounds, open ends, bands, masks of what is flagged."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from made_takes import turned, walking
from test_kata import dance

from mocapstudio.comparison.kata import compare, retimed
from mocapstudio.comparison.masking import Flagged, mask_of, read_flags
from mocapstudio.comparison.parameters import ROTATIONS, ComparisonParameters
from mocapstudio.motion.errors import FileError, MocapError, ParameterError
from mocapstudio.motion.parameters import schemas
from mocapstudio.motion.progress import run


def test_every_parameter_says_what_it_is() -> None:
    for name, schema in schemas(ComparisonParameters).items():
        assert schema.label, name
        assert schema.help, name
        assert len(schema.choices) == len(schema.names), name


@pytest.mark.parametrize(
    "wrong",
    [
        {"features": "hats"},
        {"tolerance": -0.1},
        {"window": float("nan")},
        {"band": -1.0},
        {"band": 1.0, "end": "source"},
    ],
)
def test_what_cannot_be_is_refused(wrong: dict) -> None:
    with pytest.raises(ParameterError):
        ComparisonParameters(**wrong)


@pytest.mark.parametrize("true_speed", [False, True])
def test_a_part_is_found_in_the_whole(true_speed: bool) -> None:
    take = dance(12.0)
    part = take.with_motion(take.rotations[120:210], take.translations[120:210])
    chosen = ComparisonParameters(begin="reference", end="reference", true_speed=true_speed)
    found = run(compare(take, part, chosen))
    assert found.path[0].tolist() == [120, 0]
    assert found.path[-1].tolist() == [209, 89]
    np.testing.assert_allclose(found.warp, np.arange(120, 210), atol=1.5)
    np.testing.assert_allclose(found.misalignment_relative, 0.0, atol=0.05)
    np.testing.assert_allclose(found.misalignment, 4.0, atol=0.05)
    backwards = run(compare(part, take, replace(chosen, begin="source", end="source")))
    assert backwards.path[0].tolist() == [0, 120]
    assert backwards.path[-1].tolist() == [89, 209]


@pytest.mark.parametrize("masked", [False, True])
def test_a_band_keeps_the_path_near_the_straight_line(masked: bool) -> None:
    take = dance(8.0)
    still = [np.repeat(one[100:101], 60, axis=0) for one in (take.rotations, take.translations)]
    rotations = np.concatenate([take.rotations[:100], still[0], take.rotations[100:]])
    places = np.concatenate([take.translations[:100], still[1], take.translations[100:]])
    paused = take.with_motion(rotations, places)
    mask = np.zeros((paused.frames, len(take.skeleton)), bool)
    mask[20:40, take.skeleton.index["LeftHand"]] = masked
    free = run(compare(take, paused, source_unreliable=mask))
    kept = run(compare(take, paused, ComparisonParameters(band=0.5), source_unreliable=mask))
    line = np.array([paused.frames - 1, take.frames - 1])

    def off(found) -> float:
        """Seconds of the source off the straight line, at most."""
        gaps = found.path[:, 1] - found.path[:, 0] * line[0] / line[1]
        return float(np.abs(gaps).max() / 30)

    assert off(free) > 0.8
    assert off(kept) < 0.6


def test_another_tolerance_needs_no_alignment() -> None:
    take = walking(6.0, 30, variation=0.2)
    slow = replace(take, rate=take.rate / 2)
    found = run(compare(take, slow, ComparisonParameters(true_speed=True)))
    for chosen in (
        ComparisonParameters(true_speed=True, tolerance=0.3, window=1.0),
        ComparisonParameters(true_speed=True, tolerance=0.0, window=0.1),
    ):
        again = run(compare(take, slow, chosen))
        np.testing.assert_array_equal(retimed(found, chosen).timing, again.timing)


def test_a_flag_masks_the_rest_of_its_limb_where_positions_are_compared() -> None:
    take = dance(4.0)
    flagged = [Flagged(("LeftArm", "root position"), 10, 20)]
    names = np.array(take.skeleton.names)
    mask = mask_of(take, flagged, "box")
    assert set(names[mask[15]]) == {"LeftArm", "LeftForeArm", "LeftHand"}
    assert not mask[:10].any()
    assert not mask[20:].any()
    assert set(names[mask_of(take, flagged, ROTATIONS)[15]]) == {"LeftArm"}
    with pytest.raises(MocapError, match="120 frames"):
        mask_of(take, [Flagged(("LeftArm",), 100, 200)], "box")
    with pytest.raises(MocapError, match="Wing"):
        mask_of(take, [Flagged(("Wing",), 0, 5)], "box")


def test_what_is_flagged_is_no_bad_performance() -> None:
    take = dance(8.0)
    bad = turned(take, "LeftArm", 60, 120, 90)
    mask = mask_of(bad, [Flagged(("LeftArm",), 60, 120)], "box")
    blind, seeing = (run(compare(take, bad, source_unreliable=one)) for one in (None, mask))
    assert blind.pose_difference[70:110].min() > 0.05
    assert seeing.pose_difference.max() < 0.02


def flags(path: Path, **changes) -> Path:
    one = {"joint": "LeftArm", "joints": ["LeftArm"], "start": 3, "end": 9} | changes
    path.write_text(json.dumps({"takes": [{"path": "takes/a.bvh", "flags": [one]}]}))
    return path


def test_flags_are_read_as_detect_writes_them(tmp_path: Path) -> None:
    found = read_flags(flags(tmp_path / "flags.json"))
    assert found == {"a": (Flagged(("LeftArm",), 3, 9),)}


@pytest.mark.parametrize("wrong", [{"start": 9}, {"end": 2.5}, {"start": -1}, {"end": None}])
def test_flags_that_are_none_are_refused(tmp_path: Path, wrong: dict) -> None:
    with pytest.raises(FileError, match="detect --json"):
        read_flags(flags(tmp_path / "flags.json", **wrong))


def test_a_band_that_is_in_the_way_is_said() -> None:
    take = dance(8.0)
    held = [np.repeat(one[:1], 90, axis=0) for one in (take.rotations, take.translations)]
    late = take.with_motion(
        np.concatenate([held[0], take.rotations]), np.concatenate([held[1], take.translations])
    )
    found = run(compare(take, late, ComparisonParameters(band=0.3)))
    assert any("edge of the band" in one for one in found.warnings)
    wide = run(compare(take, late, ComparisonParameters(band=4.0)))
    assert not any("band" in one for one in wide.warnings)


def test_a_part_need_not_last_as_long_as_the_whole() -> None:
    take = dance(12.0)
    part = take.with_motion(take.rotations[90:180], take.translations[90:180])
    chosen = ComparisonParameters(begin="reference", end="reference")
    assert not any("times as long" in one for one in run(compare(take, part, chosen)).warnings)
    assert any("times as long" in one for one in run(compare(take, part)).warnings)


def test_progress_never_goes_back() -> None:
    done = [step.done for step in compare(dance(6.0), dance(6.0, seed=1))]
    assert done == sorted(done)
    assert done[-1] <= 1.0
