from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mocapstudio.evaluation.cases import Conditions, cases
from mocapstudio.evaluation.corpora import available, entries, join, read_take, split
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.facing import hips_world, split_heading

BVH = """HIERARCHY
ROOT Hips
{{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Spine
  {{
    OFFSET 0 20 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {{
      OFFSET 0 20 0
    }}
  }}
}}
MOTION
Frames: {frames}
Frame Time: 0.0333333
{rows}
"""


def write_bvh(path: Path, frames: int, phase: float) -> None:
    rows = "\n".join(
        f"0 90 {k} 0 0 0 {30 * np.sin(0.2 * k + phase):.4f} 0 0" for k in range(frames)
    )
    path.write_text(BVH.format(frames=frames, rows=rows))


@pytest.fixture
def own(tmp_path: Path) -> Path:
    for k in range(12):
        write_bvh(tmp_path / f"{'kick' if k % 2 else 'bow'}_{k:02d}.bvh", 60 + k, k)
    (tmp_path / "again.bvh").write_bytes((tmp_path / "bow_00.bvh").read_bytes())
    write_bvh(tmp_path / "short.bvh", 5, 0.0)
    return tmp_path


def test_a_content_counts_once(own: Path) -> None:
    assert len(entries(own, "own")) == 13
    assert available(own) == ("own",)


def test_halves_share_nothing_and_hold_every_action(own: Path) -> None:
    everything = entries(own, "own")
    for seed in range(3):
        a, b = (split(everything, part, seed) for part in ("development", "test"))
        assert {e.digest for e in a} | {e.digest for e in b} == {e.digest for e in everything}
        assert not {e.digest for e in a} & {e.digest for e in b}
        assert {"kick", "bow"} <= {e.action for e in a}
        assert {"kick", "bow"} <= {e.action for e in b}
    assert split(everything, "test", 0) != split(everything, "test", 1)


def test_performers_stay_in_one_half(tmp_path: Path) -> None:
    for performer in range(1, 6):
        for k in range(3):
            write_bvh(tmp_path / f"{performer:02d}_{k:02d}.bvh", 40, performer + k)
    everything = entries(tmp_path, "own")
    a, b = (split(everything, part) for part in ("development", "test"))
    assert a and b
    assert not {e.performer for e in a} & {e.performer for e in b}


def test_the_context_never_holds_the_take(own: Path) -> None:
    for part in ("development", "test"):
        for size in ("small", "large"):
            for case in cases(own, "own", size, count=3, split=part):
                assert case.clean.source is not None
                digests = {t.source.digest for t in case.context if t.source}
                assert digests and case.clean.source.digest not in digests


def test_errors_are_dealt_out_evenly(data: Path) -> None:
    six = Conditions(errors_per_minute=6.0)
    made = cases(data, "locomotion", "local", count=9, conditions=six)
    minutes = sum(case.clean.duration for case in made) / 60
    truths = [truth for case in made for truth in case.truths]
    assert abs(len(truths) - 6.0 * minutes) <= 2
    assert len({truth.kind for truth in truths[:14]}) >= 13
    again = cases(data, "locomotion", "local", count=9, conditions=six)
    assert [case.truths for case in again] == [case.truths for case in made]
    untouched = cases(data, "locomotion", "local", conditions=Conditions(errors_per_minute=0.0))
    assert not any(c.truths for c in untouched)


def test_takes_of_another_skeleton_stay_out(own: Path) -> None:
    for k in range(20):
        path = own / f"other_{k:02d}.bvh"
        write_bvh(path, 70 + k, k)
        path.write_text(path.read_text().replace("Spine", "Tail"))
    for seed in range(4):
        made = cases(own, "own", "small", seed, 6)
        names = {t.skeleton.names for case in made for t in (case.clean, *case.context)}
        assert len(names) == 1


def test_what_is_too_short_is_passed_over_and_nothing_left_is_told(tmp_path: Path) -> None:
    write_bvh(tmp_path / "short.bvh", 5, 0.0)
    with pytest.raises(MocapError, match="shorter than a motion-word"):
        read_take(tmp_path / "short.bvh")
    with pytest.raises(MocapError):
        cases(tmp_path, "own", "local")
    with pytest.raises(MocapError, match="no take of the set 'salsa'"):
        entries(tmp_path, "salsa")


def test_joined_takes_go_on_where_the_last_ended(make_take) -> None:
    takes = [make_take(3.0, seed=k) for k in range(3)]
    joined, ignore = join(takes)
    assert joined.frames == sum(t.frames for t in takes)
    at = takes[0].frames
    place, _ = hips_world(joined)
    assert np.allclose(place[at, [0, 2]], place[at - 1, [0, 2]], atol=0.02)
    heading, _ = split_heading(joined)
    assert abs(heading[at] - heading[at - 1]) < 0.02
    assert ignore[at - 10 : at + 10].all()
    assert ignore.sum() == 2 * 20
    inner = slice(at, at + takes[1].frames)
    assert np.allclose(
        rot.angle(joined.rotations[inner, 1:], takes[1].rotations[:, 1:]), 0, atol=1e-6
    )


def test_named_sets_of_real_takes(data: Path) -> None:
    assert {"locomotion", "varied", "salsa"} <= set(available(data))
    assert {e.action for e in entries(data, "locomotion")} == {
        "run", "walk", "walk-turn-left", "walk-turn-right",
    }  # fmt: skip
    assert {e.performer for e in entries(data, "salsa")} == {"60", "61"}
    local = cases(data, "varied", "local", count=2)
    for case in local:
        assert case.clean.duration >= 15
        assert case.context == ()
        assert case.ignore is not None and case.ignore.any()
        assert case.clean.frames == case.dirty.frames == len(case.mask())


def test_a_synthetic_pose_before_the_motion_is_left_out(data: Path) -> None:
    path = data / "cmu_locomotion_bvh" / "07_01.bvh"
    take = read_take(path)
    assert rot.angle(take.rotations[0], take.rotations[1]).max() < np.radians(10)
    assert take.first_frame == 1
