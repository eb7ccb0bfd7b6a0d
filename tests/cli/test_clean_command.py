"""The contract of `mocapstudio clean`: repairs are written, and nothing else has changed."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import numpy as np

from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION

CHANGE_KEYS = {"joint", "start", "end", "method", "donor"}


def values_of(path: Path) -> list[list[str]]:
    lines = path.read_text().splitlines()
    at = next(at for at, line in enumerate(lines) if line.startswith("Frame Time"))
    return [line.split() for line in lines[at + 1 :]]


def head_of(path: Path) -> list[str]:
    lines = path.read_text().splitlines()
    return lines[: len(lines) - len(values_of(path))]


def digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def test_error_is_repaired_and_nothing_else_changes(
    mocapstudio, broken: Path, tmp_path: Path, figure
) -> None:
    before = digest(broken)
    out = tmp_path / "clean.bvh"
    done = mocapstudio("clean", "--quick", broken, "-o", out, "--json", "-")
    assert done.returncode == 0, done.stderr
    [take] = json.loads(done.stdout)["takes"]
    assert set(take) == {"path", "output", "changes"}
    assert (take["path"], take["output"]) == (str(broken), str(out))
    assert digest(broken) == before
    assert head_of(out) == head_of(broken)

    one = figure()
    allowed = np.zeros(one.values.shape, bool)
    for change in take["changes"]:
        assert set(change) == CHANGE_KEYS
        joint = change["joint"]
        columns = {ROOT_POSITION: slice(0, 3), ROOT_HEADING: one.columns("Hips")}.get(joint)
        allowed[change["start"] : change["end"], columns or one.columns(joint)] = True
        if change["donor"] is not None:
            assert set(change["donor"]) == {"take", "start", "end"}
    source, result = values_of(broken), values_of(out)
    differs = np.array(source) != np.array(result)
    assert differs.any()
    assert not (differs & ~allowed).any()

    truth = one.values[200:215, one.columns("LeftForeArm")]
    repaired = np.array(result, dtype=float)[200:215, one.columns("LeftForeArm")]
    assert np.abs(repaired - truth).mean() < 10.0


def test_provenance_lies_beside(mocapstudio, broken: Path, tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    assert mocapstudio("clean", "--quick", broken, "-o", tmp_path / "out").returncode == 0
    written = sorted((tmp_path / "out").iterdir())
    assert written[0].name == "broken.bvh"
    [provenance] = written[1:]
    story = json.loads(provenance.read_text())
    assert digest(broken) in json.dumps(story)


def test_several_takes_go_into_a_folder(mocapstudio, broken, tmp_path: Path, figure) -> None:
    other = figure(seed=3).write(tmp_path / "other.bvh")
    out = tmp_path / "out" / "deep"
    done = mocapstudio("clean", "--quick", broken, other, "-o", out, "--json", "-")
    assert done.returncode == 0, done.stderr
    outputs = [take["output"] for take in json.loads(done.stdout)["takes"]]
    assert outputs == [str(out / "broken.bvh"), str(out / "other.bvh")]
    assert sorted(path.name for path in out.glob("*.bvh")) == ["broken.bvh", "other.bvh"]


def test_an_input_is_never_overwritten(mocapstudio, broken, tmp_path: Path, figure) -> None:
    context = figure(seed=3).write(tmp_path / "context.bvh")
    link = tmp_path / "link.bvh"
    link.symlink_to(broken)
    before = digest(broken), digest(context)
    for target in (broken, link, context, tmp_path):
        done = mocapstudio(
            "clean", "--quick", broken, "--context", context, "-o", target, "--json", "-"
        )
        assert done.returncode == 2, target
        [line] = done.stderr.splitlines()
        assert "input" in line
    assert (digest(broken), digest(context)) == before
    assert sorted(tmp_path.iterdir()) == [broken, context, link]


def test_two_takes_of_one_name(mocapstudio, broken: Path, tmp_path: Path, figure) -> None:
    (tmp_path / "second").mkdir()
    second = figure(seed=4).write(tmp_path / "second" / "broken.bvh")
    done = mocapstudio("clean", "--quick", broken, second, "-o", tmp_path / "out", "--json", "-")
    assert done.returncode == 2
    assert [take["path"] for take in json.loads(done.stdout)["takes"]] == [str(broken)]
    [line] = done.stderr.splitlines()
    assert line.startswith(f"error: {second}: -: ")


def test_one_bad_take_among_several(mocapstudio, broken: Path, tmp_path: Path) -> None:
    bad = tmp_path / "bad.bvh"
    bad.write_text("no motion")
    done = mocapstudio(
        "clean", "--quick", bad, broken, "-o", tmp_path / "out", "--json", tmp_path / "j"
    )
    assert done.returncode == 2
    [take] = json.loads((tmp_path / "j").read_text())["takes"]
    assert Path(take["output"]).is_file()
    assert not (tmp_path / "out" / "bad.bvh").exists()


def test_real_take(mocapstudio, data: Path, tmp_path: Path) -> None:
    source = data / "cmu_salsa_pairs_bvh" / "60_10_scaled.bvh"
    out = tmp_path / "clean.bvh"
    done = mocapstudio("clean", "--quick", source, "-o", out, "--json", "-")
    assert done.returncode == 0, done.stderr
    [take] = json.loads(done.stdout)["takes"]
    spans = [(change["start"], change["end"]) for change in take["changes"]]
    rows = zip(values_of(source), values_of(out), strict=True)
    changed = [frame for frame, (a, b) in enumerate(rows) if a != b]
    assert changed
    assert all(any(start <= frame < end for start, end in spans) for frame in changed)
