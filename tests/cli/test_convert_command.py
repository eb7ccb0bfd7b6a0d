"""The contract of `mocapstudio convert`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mocapstudio import formats
from mocapstudio.motion.kinematics import take_pose


@pytest.fixture
def source(tmp_path: Path, figure) -> Path:
    return figure(seconds=2).write(tmp_path / "in.bvh")


def test_without_options_nothing_changes(mocapstudio, source: Path, tmp_path: Path) -> None:
    assert mocapstudio("convert", source, "out.bvh").returncode == 0
    assert (tmp_path / "out.bvh").read_bytes() == source.read_bytes()


def test_another_rate_leaves_the_numbers_alone(mocapstudio, source: Path, tmp_path: Path) -> None:
    assert mocapstudio("convert", source, "out.bvh", "--fps", "119.88").returncode == 0
    old, new = source.read_text().splitlines(), (tmp_path / "out.bvh").read_text().splitlines()
    different = [(a, b) for a, b in zip(old, new, strict=True) if a != b]
    assert different == [("Frame Time: 0.0333333", "Frame Time: 0.008341666667")]


@pytest.mark.parametrize(
    "words",
    [
        ("--order", "yxz"),
        ("--channels", "6"),
        ("--out-unit", "m", "--out-up", "z"),
        ("--order", "XYZ", "--channels", "3", "--out-unit", "0.0254"),
    ],
)
def test_other_layouts_hold_the_same_motion(mocapstudio, source, tmp_path, words) -> None:
    done = mocapstudio("convert", source, "out.bvh", *words)
    assert done.returncode == 0, done.stderr
    unit = 1.0 if "m" in words else 0.0254 if "0.0254" in words else 0.01
    up = "z" if "z" in words else "y"
    (old,), _ = formats.read(source)
    (new,), _ = formats.read(tmp_path / "out.bvh", formats.ReadOptions(unit=unit, up=up))
    np.testing.assert_allclose(take_pose(new)[0], take_pose(old)[0], atol=1e-5)
    apart = Rotation.from_quat(new.rotations.reshape(-1, 4)).inv() * Rotation.from_quat(
        old.rotations.reshape(-1, 4)
    )
    assert np.degrees(apart.magnitude().max()) < 1e-5


def test_trim(mocapstudio, data: Path, tmp_path: Path) -> None:
    path = data / "cmu_locomotion_bvh" / "07_12.bvh"
    assert mocapstudio("convert", path, "out.bvh", "--trim").returncode == 0
    assert formats.read(tmp_path / "out.bvh")[0][0].frames == 262


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("in.bvh", "in.bvh"), "in.bvh: -: is an input"),
        (("in.bvh", "absent/out.bvh"), "absent/out.bvh: -: cannot be written"),
        (("absent.bvh", "out.bvh"), "absent.bvh: -: no such file"),
        (("in.bvh", "out.xyz"), "out.xyz: -: cannot write"),
        (("in.bvh", "out.bvh", "--order", "XYX"), "Euler order"),
        (("in.bvh", "out.bvh", "--fps", "0"), "frame rate"),
        (("in.bvh", "out.bvh", "--channels", "4"), "channels"),
    ],
)
def test_bad_input(mocapstudio, source: Path, tmp_path: Path, words, says: str) -> None:
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    done = mocapstudio("convert", *words)
    assert done.returncode == 2
    [line] = done.stderr.splitlines()
    assert line.startswith("error: ")
    assert says in line
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_joints_can_be_renamed(mocapstudio, source: Path, tmp_path: Path) -> None:
    (tmp_path / "map.json").write_text('{"LeftShin": "L_Shin"}')
    assert mocapstudio("convert", source, "out.bvh", "--joint-map", "map.json").returncode == 0
    (take,), _ = formats.read(tmp_path / "out.bvh")
    assert "L_Shin" in take.skeleton.names
    assert "LeftShin" not in take.skeleton.names


def test_joints_become_tables(mocapstudio, source: Path, tmp_path: Path) -> None:
    for words in (("positions.csv",), ("angles.tsv", "--table", "angles", "--order", "xyz")):
        done = mocapstudio("convert", source, *words)
        assert done.returncode == 0, done.stderr
    (take,), _ = formats.read(source)
    (table,), _ = formats.read_any(tmp_path / "positions.csv")
    np.testing.assert_allclose(table.positions, take_pose(take)[0], atol=1e-6)
    names = (tmp_path / "angles.tsv").read_text().splitlines()[0].split("\t")
    assert names[5:8] == [f"Hips {axis}rotation (deg)" for axis in "XYZ"]


def test_markers(mocapstudio, tmp_path: Path) -> None:
    rows = [f"{i / 50:.2f},{i},1700,2,,,,{i},20,5" for i in range(5)]
    names = ",".join(f"{label} {axis}" for label in ("Head", "Hips", "Toe") for axis in "XYZ")
    text = "\n".join([f"Time,{names}", *rows]) + "\n"
    (tmp_path / "in.csv").write_text(text)
    (tmp_path / "map.json").write_text('{"Toe": "LTOE"}')
    for words in (
        ("in.csv", "same.csv"),
        ("in.csv", "out.trc", "--fps", "29.97"),
        ("out.trc", "out.tsv", "--joint-map", "map.json", "--out-up", "z"),
    ):
        done = mocapstudio("convert", *words)
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "same.csv").read_text() == text
    (old,), _ = formats.read_any(tmp_path / "in.csv")
    (new,), _ = formats.read_any(tmp_path / "out.tsv", formats.ReadOptions(up="z"))
    assert new.labels == ("Head", "Hips", "LTOE")
    assert float(new.rate) == pytest.approx(30_000 / 1001)
    np.testing.assert_allclose(new.positions, old.positions, atol=1e-7)
    done = mocapstudio("convert", "in.csv", "out.bvh")
    assert done.returncode == 2
    assert done.stderr.startswith("error: out.bvh: -: cannot write markers as '.bvh'; known are")
