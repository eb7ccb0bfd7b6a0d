"""The contract of `mocapstudio detect`: other programs script against it."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np

TAKE_KEYS = {"path", "fps", "frames", "joints", "threshold", "flags"}
FLAG_KEYS = {"id", "joint", "joints", "start", "end", "peak", "peak_frame", "score", "kind"}
ROOT_ROWS = {"root position", "root heading"}


def detected(mocapstudio, *words) -> list[dict]:
    """Flags by the quick map, save where a test is about what is learnt."""
    done = mocapstudio("detect", *words, "--quick", "--json", "-")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)["takes"]


def test_json_names_the_error_where_it_is(mocapstudio, broken: Path, figure) -> None:
    [take] = detected(mocapstudio, broken)
    assert set(take) == TAKE_KEYS
    assert take["path"] == str(broken)
    assert (take["fps"], take["frames"]) == (30.0, 480)
    assert take["joints"] == figure().names
    rows = set(take["joints"]) | ROOT_ROWS
    ids = set()
    for flag in take["flags"]:
        assert set(flag) == FLAG_KEYS
        assert flag["joint"] in flag["joints"]
        assert set(flag["joints"]) <= rows
        assert 0 <= flag["start"] <= flag["peak_frame"] < flag["end"] <= take["frames"]
        assert 0.0 <= flag["score"] <= 1.0
        assert take["threshold"] < flag["peak"] <= 1.0
        ids.add(flag["id"])
    assert len(ids) == len(take["flags"])
    worst = max(take["flags"], key=lambda flag: flag["score"])
    found = [flag for flag in take["flags"] if flag["joint"] == "LeftForeArm"]
    assert any(flag["start"] < 215 and flag["end"] > 200 for flag in found)
    assert worst["start"] < 215
    assert worst["end"] > 200


def test_each_joint_of_a_limb_has_a_flag_of_its_own(mocapstudio, tmp_path, figure) -> None:
    one = figure().raise_error("LeftForeArm", 200, 215, 60.0).raise_error("LeftArm", 200, 215, 50.0)
    [take] = detected(mocapstudio, one.write(tmp_path / "limb.bvh"))
    several = [flag for flag in take["flags"] if len(flag["joints"]) > 1]
    assert several
    for flag in several:
        for joint in flag["joints"]:
            assert any(
                other["joint"] == joint
                and other["start"] < flag["end"]
                and flag["start"] < other["end"]
                for other in take["flags"]
            )


def test_map_holds_what_the_flags_were_cut_from(mocapstudio, broken: Path, tmp_path: Path) -> None:
    [take] = detected(mocapstudio, broken, "--map", tmp_path / "map.npz")
    with np.load(tmp_path / "map.npz", allow_pickle=False) as stored:
        digression = stored["digression"]
        rows = [str(name) for name in stored["joints"]]
        assert float(stored["fps"]) == take["fps"]
        assert float(stored["threshold"]) == take["threshold"]
    assert digression.dtype == np.float32
    assert digression.shape == (take["frames"], len(rows))
    assert digression.min() >= 0.0
    assert digression.max() <= 1.0
    assert set(rows) <= set(take["joints"]) | ROOT_ROWS
    for flag in take["flags"]:
        span = digression[flag["start"] : flag["end"], rows.index(flag["joint"])]
        assert span.max() == np.float32(flag["peak"])
        assert digression[flag["peak_frame"], rows.index(flag["joint"])] == span.max()


def test_several_takes_write_maps_into_a_folder(mocapstudio, broken, tmp_path, figure) -> None:
    figure(seed=1).write(tmp_path / "other.bvh")
    takes = detected(mocapstudio, broken, tmp_path / "other.bvh", "--map", tmp_path / "maps")
    assert [Path(take["path"]).name for take in takes] == ["broken.bvh", "other.bvh"]
    assert sorted(path.name for path in (tmp_path / "maps").iterdir()) == [
        "broken.npz",
        "other.npz",
    ]


def test_higher_threshold_flags_no_more(mocapstudio, broken: Path) -> None:
    [low] = detected(mocapstudio, broken, "--threshold", "0.3")
    [high] = detected(mocapstudio, broken, "--threshold", "0.9")
    assert (low["threshold"], high["threshold"]) == (0.3, 0.9)

    def area(take: dict) -> int:
        return sum(flag["end"] - flag["start"] for flag in take["flags"])

    assert area(high) < area(low)


def test_modes_differ(mocapstudio, broken: Path) -> None:
    [paper] = detected(mocapstudio, broken, "--mode", "paper")
    [calibrated] = detected(mocapstudio, broken, "--mode", "calibrated")
    assert len(paper["flags"]) > len(calibrated["flags"])


def test_a_take_is_never_its_own_context(mocapstudio, broken: Path, tmp_path: Path) -> None:
    [alone] = detected(mocapstudio, broken)
    folder = tmp_path / "context" / "deep"
    folder.mkdir(parents=True)
    shutil.copy(broken, folder / "the same under another name.bvh")
    assert detected(mocapstudio, broken, "--context", broken) == [alone]
    assert detected(mocapstudio, broken, "--context", tmp_path / "context") == [alone]


def test_context_is_searched(mocapstudio, tmp_path: Path, figure) -> None:
    """What the take shows once only is flagged, until the context shows it as well."""
    lone = figure().gesture("RightForeArm", 297, 330, 90.0).write(tmp_path / "lone.bvh")
    for seed in range(4):
        again = figure()
        for start in (33, 165, 297, 429):
            again.gesture("RightForeArm", start, start + 33, 90.0 + seed)
        (tmp_path / "context").mkdir(exist_ok=True)
        again.write(tmp_path / "context" / f"{seed}.bvh")

    def flagged(take: dict) -> bool:
        return any(
            flag["joint"] == "RightForeArm" and flag["start"] < 325 and flag["end"] > 305
            for flag in take["flags"]
        )

    [alone] = detected(mocapstudio, lone)
    [together] = detected(mocapstudio, lone, "--context", tmp_path / "context")
    assert flagged(alone)
    assert not flagged(together)


def test_context_may_be_repeated(mocapstudio, broken, tmp_path, figure) -> None:
    first = figure(seed=1).write(tmp_path / "first.bvh")
    second = figure(seed=2).write(tmp_path / "second.bvh")
    [both] = detected(mocapstudio, broken, "--context", first, "--context", second)
    (tmp_path / "both").mkdir()
    for path in (first, second):
        shutil.copy(path, tmp_path / "both")
    assert detected(mocapstudio, broken, "--context", tmp_path / "both") == [both]


def test_joint_map_lets_other_names_serve_as_context(mocapstudio, broken, tmp_path, figure) -> None:
    named = figure(seed=1).write(tmp_path / "named.bvh")
    alien = figure(seed=1, prefix="actor:").write(tmp_path / "alien.bvh")
    names = tmp_path / "names.json"
    names.write_text(json.dumps({f"actor:{name}": name for name in figure().names}))
    refused = mocapstudio("detect", broken, "--quick", "--context", alien, "--json", "-")
    assert refused.returncode == 2
    mapped = detected(mocapstudio, broken, "--context", alien, "--joint-map", names)
    assert mapped == detected(mocapstudio, broken, "--context", named)


def test_what_is_learnt_from_the_context_is_kept(
    mocapstudio, caches, tmp_path: Path, figure
) -> None:
    one = figure(seconds=8).raise_error("LeftForeArm", 100, 115, 60.0).write(tmp_path / "a.bvh")
    for seed in (1, 2):
        (tmp_path / "context").mkdir(exist_ok=True)
        figure(seconds=8, seed=seed).write(tmp_path / "context" / f"{seed}.bvh")

    def kept() -> set[Path]:
        return set(Path(caches["XDG_CACHE_HOME"]).rglob("decisions/*.npz"))

    before = kept()
    words = ("detect", one, "--context", tmp_path / "context", "--json", "-")
    first = mocapstudio(*words)
    assert first.returncode == 0, first.stderr
    [take] = json.loads(first.stdout)["takes"]
    assert {flag["joint"] for flag in take["flags"]} == {"LeftForeArm"}
    learnt = kept() - before
    assert len(learnt) == 1
    assert mocapstudio(*words).stdout == first.stdout
    assert kept() - before == learnt


def test_fps_overrides_the_file(mocapstudio, broken: Path) -> None:
    [take] = detected(mocapstudio, broken, "--fps", "60000/1001")
    assert take["fps"] == 60000 / 1001


def test_without_json_the_flags_are_told(mocapstudio, broken: Path) -> None:
    done = mocapstudio("detect", broken, "--quick")
    assert done.returncode == 0
    assert "LeftForeArm" in done.stdout
    assert done.stderr == ""


def test_joints_without_a_row_are_told(mocapstudio, tmp_path: Path, figure) -> None:
    take = figure(seed=0).write(tmp_path / "take.bvh")
    other = figure(seed=1).write(tmp_path / "other.bvh")
    other.write_text(other.read_text().replace("JOINT Head", "JOINT Skull"))
    done = mocapstudio("detect", take, "--quick", "--context", other)
    assert done.returncode == 0, done.stderr
    assert "not analysed: Head" in done.stdout
    assert "not analysed" not in mocapstudio("detect", take, "--quick").stdout


def test_real_take_with_its_dancer_as_context(mocapstudio, data: Path, tmp_path: Path) -> None:
    folder = data / "cmu_salsa_pairs_bvh"
    context = [word for path in sorted(folder.glob("60_*.bvh")) for word in ("--context", path)]
    [take] = detected(mocapstudio, folder / "60_10_scaled.bvh", *context)
    assert (take["fps"], take["frames"]) == (120.0, 1197)
    assert take["flags"]
    fingers = [joint for joint in take["joints"] if "Index" in joint]
    assert fingers
    assert not {flag["joint"] for flag in take["flags"]} & set(fingers)
