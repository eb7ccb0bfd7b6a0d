"""Distance over time: against sums written from the equations, and its minima."""

from __future__ import annotations

from dataclasses import replace

import naive
import numpy as np
import pytest
from made_takes import turned, walking

from mocapstudio.cleaning import distance_profile as module
from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.distance_profile import distance_profile, measuring
from mocapstudio.cleaning.model import Flag, Kind
from mocapstudio.cleaning.reasons import neighbours
from mocapstudio.motion.progress import run
from mocapstudio.similarity.words import trim_count


def flag(joint: str, start: int, end: int, *others: str) -> Flag:
    joints = (joint, *others)
    return Flag(f"{joint}@{start}", joint, joints, start, end, 0.9, start, 0.9, Kind.OFFSET)


@pytest.fixture(scope="module")
def analysis() -> Analysis:
    """Two seconds with an error against two other recordings, one of another rate."""
    take = turned(walking(2.2, 30, seed=0), "LeftArm", 24, 34, 50)
    return run(detect(take, [walking(2.0, 30, seed=1), walking(1.9, 48, seed=2)]))


@pytest.fixture(scope="module")
def flagged() -> Flag:
    return flag("LeftArm", 24, 32, "LeftForeArm")


def naive_degrees(analysis: Analysis, one: Flag) -> list[np.ndarray]:
    """The curve of every take: pose distances joint by joint, every admissible path."""
    texture, margin = analysis.texture, 5
    start = int(np.floor((one.start - texture.start) / texture.frames_each))
    end = int(np.ceil((one.end - texture.start) / texture.frames_each))
    low, high = max(start - margin, 0), min(end + margin, len(texture))
    longest = int(np.ceil((high - low) * 4 / 3))
    kept = [i for i, name in enumerate(texture.joints) if name not in one.joints]
    curves = []
    for other in analysis.corpus.textures:
        rows = []
        for t in range(low, high):
            inside = start <= t < end
            joints = kept if inside else list(range(len(texture.joints)))
            trim = trim_count(len(kept), True) if inside else 0
            pose = texture.quaternions[t : t + 1, joints].astype(float)
            rows.append(
                naive.pose_distances(pose, other.quaternions[:, joints].astype(float), trim)[0]
            )
        if len(other) < longest:
            continue
        mean, _ = naive.WarpingCosts(np.array(rows), longest).means()
        curves.append(np.rad2deg(2 * np.sqrt(mean / len(kept))))
    return curves


def test_the_curve_is_that_of_the_equations(analysis: Analysis, flagged: Flag) -> None:
    profile = distance_profile(analysis, flagged)
    assert profile is not None
    expected = naive_degrees(analysis, flagged)
    assert [one.index for one in profile.takes] == [0, 1, 2]
    for one, degrees in zip(profile.takes, expected, strict=True):
        assert one.degrees.shape == degrees.shape
        np.testing.assert_allclose(one.degrees, degrees, atol=0.05)


def test_the_minima_are_the_neighbours(analysis: Analysis, flagged: Flag) -> None:
    profile = distance_profile(analysis, flagged)
    assert profile is not None
    near = neighbours(analysis, flagged)
    assert len(near) == len(profile.minima) > 0
    for one, at in zip(near, profile.minima, strict=True):
        part = next(p for p in profile.takes if p.index == one.index)
        place = int(at) - part.first
        assert part.degrees[place] == pytest.approx(one.distance)
        assert not part.barred[place]
        around = part.degrees[max(place - 1, 0) : place + 2]
        free = ~part.barred[max(place - 1, 0) : place + 2]
        assert part.degrees[place] == around[free].min()
    expected = []
    for part in profile.takes:
        usable = np.where(part.barred, 1e30, part.degrees)
        expected += [
            (part.degrees[t], part.first + t)
            for t in naive.minima(usable, [0], len(usable), (0, 0))
        ]
    keep = analysis.parameters.neighbours
    assert [at for _, at in sorted(expected)[:keep]] == profile.minima.tolist()


def test_frames_are_those_of_each_take(analysis: Analysis, flagged: Flag) -> None:
    """At its own place the flagged span is nearest to itself, but barred."""
    profile = distance_profile(analysis, flagged)
    assert profile is not None
    own, _, other = profile.takes
    at = int(np.argmin(np.where(own.barred, own.degrees, np.inf)))
    assert own.degrees[at] == pytest.approx(0.0, abs=0.05)
    assert abs(own.frames[at] - flagged.start) <= analysis.texture.frames_each
    np.testing.assert_allclose(np.diff(other.frames), 2.0)
    assert other.frames[-1] < other.take.frames


def test_a_large_context_is_measured_in_steps_with_the_same_result(
    analysis: Analysis, flagged: Flag, monkeypatch: pytest.MonkeyPatch
) -> None:
    once = distance_profile(analysis, flagged)
    monkeypatch.setattr(module, "_PAIRS_A_STEP", 1)
    # What is kept is kept by flag: another id is measured anew.
    work = measuring(analysis, replace(flagged, id="again"))
    done = [next(work).done for _ in range(3)]
    again = run(work)
    assert done == sorted(done) and done[-1] > 0
    assert once is not None and again is not None
    np.testing.assert_array_equal(once.minima, again.minima)
    np.testing.assert_array_equal(once.barred, again.barred)
    np.testing.assert_allclose(once.degrees, again.degrees, rtol=1e-4)


def test_it_is_measured_once_for_a_flag(analysis: Analysis, flagged: Flag) -> None:
    assert distance_profile(analysis, flagged) is distance_profile(analysis, flagged)


def test_what_is_too_long_or_too_short_has_no_profile(analysis: Analysis) -> None:
    assert distance_profile(analysis, flag("LeftArm", 0, analysis.take.frames)) is None
    short = run(detect(walking(0.12, 30)))
    assert distance_profile(short, flag("LeftArm", 0, 2)) is None
