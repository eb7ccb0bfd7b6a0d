"""The contract of `mocapstudio contacts` and of `clean --contacts`."""

from __future__ import annotations

import hashlib
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mocapstudio import formats
from mocapstudio.cleaning.contacts.model import ON_CONTACTS
from mocapstudio.cleaning.contacts.points import contact_points, point_positions
from mocapstudio.evaluation.demo.skeleton import demo_skeleton
from mocapstudio.evaluation.demo.take import demo_motion
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import ROOT_POSITION
from mocapstudio.motion.take import Take

CONTACT_KEYS = {"joint", "point", "start", "end", "target", "confidence"}


@pytest.fixture(scope="module")
def skating(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Five seconds of walking at 30 Hz whose hips sway, so that its feet slide."""
    motion, span = demo_motion(11), slice(600, 900, 2)
    root = motion.root[span].copy()
    root[:, 0] += 0.03 * np.sin(np.arange(len(root)) / 5)
    take = Take("walk", demo_skeleton(), motion.rotations[span], root[:, None], 30)  # type: ignore[arg-type]
    path = tmp_path_factory.mktemp("skate") / "walk.bvh"
    formats.write(take, path)
    return path


def numbers(path: Path) -> np.ndarray:
    lines = path.read_text().splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith("Frame Time"))
    return np.array([line.split() for line in lines[at + 1 :] if line.strip()])


def test_contacts_are_found_and_slide_is_measured(mocapstudio, skating: Path) -> None:
    done = mocapstudio("contacts", skating, "--json", "-")
    assert done.returncode == 0, done.stderr
    record = json.loads(done.stdout)
    take = formats.read(skating)[0][0]
    points = {(p.joint, p.point): p for p in contact_points(take)}
    assert record["contacts"]
    for one in record["contacts"]:
        assert set(one) >= CONTACT_KEYS
        assert 0 <= one["start"] < one["end"] <= take.frames
        assert 0 <= one["confidence"] <= 1
        place = point_positions(take, [points[one["joint"], one["point"]]])[:, 0]
        away = np.linalg.norm(place[one["start"] : one["end"]] - one["target"], axis=1)
        assert away.min() < 0.03
    # The hips sway by up to 0.18 m/s while feet should stand.
    assert 0.05 < record["slide"]["before"] < 0.25
    assert record["slide"]["after"] is None

    table = mocapstudio("contacts", skating)
    assert table.returncode == 0
    assert f"{len(record['contacts'])} contacts, mean slide" in table.stdout


def test_skate_is_removed_and_nothing_undeclared_changes(
    mocapstudio, skating: Path, tmp_path: Path
) -> None:
    before = hashlib.sha256(skating.read_bytes()).hexdigest()
    out, kept = tmp_path / "held.bvh", tmp_path / "contacts.json"
    done = mocapstudio("contacts", skating, "-o", out, "--contacts-out", kept, "--json", "-")
    assert done.returncode == 0, done.stderr
    record = json.loads(done.stdout)
    assert hashlib.sha256(skating.read_bytes()).hexdigest() == before
    assert record["slide"]["after"] < 0.1 * record["slide"]["before"]
    assert json.loads(kept.read_text())["slide"] == record["slide"]
    assert (tmp_path / "held.provenance.json").is_file()

    source, result = numbers(skating), numbers(out)
    allowed = np.zeros(source.shape, bool)
    names = demo_skeleton().names
    for change in record["changes"]:
        j = -1 if change["joint"] == ROOT_POSITION else names.index(change["joint"])
        allowed[change["start"] : change["end"], 3 * j + 3 : 3 * j + 6] = True
    differs = source.astype(float) != result.astype(float)
    assert differs.any()
    assert not (differs & ~allowed).any()

    # The same contacts, read from the file, hardly slide any more in what was written.
    again = mocapstudio("contacts", out, "--contacts", kept, "--json", "-")
    assert again.returncode == 0, again.stderr
    held = json.loads(again.stdout)
    assert held["slide"]["before"] < 0.1 * record["slide"]["before"]
    spans = [(c["joint"], c["point"], c["start"], c["end"]) for c in record["contacts"]]
    assert [(c["joint"], c["point"], c["start"], c["end"]) for c in held["contacts"]] == spans


def test_a_contact_of_ones_own_is_met(mocapstudio, skating: Path, tmp_path: Path) -> None:
    take = formats.read(skating)[0][0]
    palm = next(p for p in contact_points(take) if p.point == "palm")
    place = point_positions(take, [palm])[40, 0] + [0.0, 0.05, 0.0]
    given = {
        "contacts": [
            {"joint": palm.joint, "point": "palm", "start": 38, "end": 43, "target": list(place)}
        ]
    }
    path, out = tmp_path / "own.json", tmp_path / "own.bvh"
    path.write_text(json.dumps(given))
    done = mocapstudio("contacts", skating, "--contacts", path, "-o", out)
    assert done.returncode == 0, done.stderr
    held = formats.read(out)[0][0]
    reached = point_positions(held, [palm])[38:43, 0]
    assert np.linalg.norm(reached - place, axis=1).max() < 1e-3


def test_clean_keeps_contacts(mocapstudio, skating: Path, tmp_path: Path) -> None:
    kept, out = tmp_path / "contacts.json", tmp_path / "clean.bvh"
    assert mocapstudio("contacts", skating, "--contacts-out", kept).returncode == 0
    done = mocapstudio("clean", "--quick", skating, "--contacts", kept, "-o", out, "--json", "-")
    assert done.returncode == 0, done.stderr
    [take] = json.loads(done.stdout)["takes"]
    assert any(change["method"] == "contacts" for change in take["changes"])
    after = mocapstudio("contacts", out, "--contacts", kept, "--json", "-")
    assert json.loads(after.stdout)["slide"]["before"] < 0.02


def test_a_repair_of_clean_is_bent_to_what_the_foot_stands_on(
    mocapstudio, skating: Path, tmp_path: Path
) -> None:
    kept, out = tmp_path / "contacts.json", tmp_path / "clean.bvh"
    done = mocapstudio("contacts", skating, "--contacts-out", kept, "--json", "-")
    found = json.loads(done.stdout)["contacts"]
    stood = max(
        (one for one in found if one["joint"].startswith("Left") and one["start"] > 20),
        key=lambda one: one["end"] - one["start"],
    )
    take = formats.read(skating)[0][0]
    rotations = take.rotations.copy()
    middle = (stood["start"] + stood["end"]) // 2
    wrong = slice(middle - 4, middle + 4), take.skeleton.index["LeftLeg"]
    rotations[wrong] = rot.multiply(rotations[wrong], rot.about_axis(2, np.deg2rad(60.0)))
    spoiled = tmp_path / "spoiled.bvh"
    formats.write(replace(take, rotations=rotations, source=None), spoiled)
    done = mocapstudio("clean", "--quick", spoiled, "--contacts", kept, "-o", out, "--json", "-")
    assert done.returncode == 0, done.stderr
    [record] = json.loads(done.stdout)["takes"]
    methods = {change["method"] for change in record["changes"] if change["joint"] == "LeftLeg"}
    assert any(method.endswith(f", {ON_CONTACTS}") for method in methods), methods
    [provenance] = (one for one in tmp_path.iterdir() if "provenance" in one.name)
    assert all(f'"{method}"' in provenance.read_text() for method in methods)


def test_a_bad_file_of_contacts_is_one_line(mocapstudio, skating: Path, tmp_path: Path) -> None:
    path = tmp_path / "bad.json"
    path.write_text('{"contacts": [\n\n {"joint": "Head", "start": 0, "end": 9999}]}')
    for words in (["contacts", skating], ["clean", skating, "--quick", "-o", tmp_path / "o.bvh"]):
        done = mocapstudio(*words, "--contacts", path)
        assert done.returncode == 2
        assert done.stderr.startswith(f"error: {path}: 3: ")
        assert "frames 0:9999" in done.stderr
        assert len(done.stderr.splitlines()) == 1


def test_inputs_are_never_overwritten(mocapstudio, skating: Path, tmp_path: Path) -> None:
    for words in (["-o", skating], ["--contacts-out", skating]):
        done = mocapstudio("contacts", skating, *words)
        assert done.returncode == 2
        assert "is an input" in done.stderr
    gone = mocapstudio("contacts", tmp_path / "none.bvh")
    assert gone.returncode == 2
    assert gone.stderr.startswith(f"error: {tmp_path / 'none.bvh'}: -: ")
