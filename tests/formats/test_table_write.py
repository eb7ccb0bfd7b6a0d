"""Joints and markers written as tables: where they are, and the joints' angles."""

from __future__ import annotations

import csv
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from bvh_text import JOINTS, bvh, walk
from marker_text import LABELS, places, trc
from scipy.spatial.transform import Rotation

from mocapstudio import formats
from mocapstudio.formats import Declared, ReadOptions, WriteOptions
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take


@pytest.fixture
def take(tmp_path: Path) -> Take:
    path = tmp_path / "source.bvh"
    path.write_text(bvh(walk(frames=20)))
    return formats.read(path, ReadOptions(unit=0.01, up="y"))[0][0]


def columns(path: Path) -> dict[str, np.ndarray]:
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file, delimiter="\t" if path.suffix == ".tsv" else ","))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


@pytest.mark.parametrize(
    ("suffix", "options", "unit", "up"),
    [
        (".csv", WriteOptions(), "m", "y"),
        (".tsv", WriteOptions(table="positions", unit=0.001, up="z"), "mm", "z"),
    ],
)
def test_positions_of_joints(take: Take, tmp_path: Path, suffix, options, unit, up) -> None:
    path = tmp_path / f"joints{suffix}"
    formats.write(take, path, options=options)
    [again], report = formats.read_any(path, ReadOptions(up=up))
    assert isinstance(again, MarkerTake)
    assert (again.labels, again.rate, report.problems) == (JOINTS, take.rate, ())
    np.testing.assert_allclose(again.positions, take_pose(take)[0], atol=1e-7)
    told = columns(path)
    assert list(told)[:3] == ["Frame", "Time (s)", f"Hips X ({unit})"]
    np.testing.assert_allclose(told["Time (s)"], np.arange(20) / float(take.rate), atol=1e-6)


@pytest.mark.parametrize("order", [None, "XYZ"])
@pytest.mark.parametrize("up", ["y", "z"])
def test_angles_of_joints(take: Take, tmp_path: Path, order: str | None, up) -> None:
    path = tmp_path / "angles.csv"
    formats.write(take, path, options=WriteOptions(table="angles", order=order, up=up))
    told = columns(path)
    for joint, name in enumerate(JOINTS):
        own = [
            word.split()[-2][0] for word in told if word.startswith(f"{name} ") and "rot" in word
        ]
        assert order is None or "".join(own) == order
        degrees = np.stack([told[f"{name} {axis}rotation (deg)"] for axis in own], axis=1)
        turned = Rotation.from_euler("".join(own), degrees, degrees=True)
        expected = Rotation.from_quat(take.rotations[:, joint])
        if joint == 0 and up == "z":
            expected = Rotation.from_euler("x", 90, degrees=True) * expected
        assert (turned.inv() * expected).magnitude().max() < 1e-6
    # Our own reader takes the root's position from it.
    [again], _ = formats.read_any(path, ReadOptions(up=up))
    assert again.labels == ("Hips",)
    np.testing.assert_allclose(again.positions[:, 0], take.translations[:, 0], atol=1e-7)


def test_angles_are_those_of_the_file(take: Take, tmp_path: Path) -> None:
    formats.write(take, tmp_path / "angles.csv", options=WriteOptions(table="angles"))
    told = columns(tmp_path / "angles.csv")
    angles = np.unwrap(told["LeftLeg Xrotation (deg)"], period=360)
    own = np.unwrap(walk(frames=20)[:, 9], period=360)
    np.testing.assert_allclose(angles - angles[0], own - own[0], atol=1e-4)


@pytest.mark.parametrize("suffix", [".csv", ".tsv", ".trc"])
@pytest.mark.parametrize("through", [".csv", ".tsv", ".trc"])
def test_markers_go_from_format_to_format(tmp_path: Path, suffix: str, through: str) -> None:
    broken = places()
    broken[3:6, 2] = np.nan
    source = tmp_path / "source.trc"
    source.write_text(trc(broken, labels=('a "b", c', *LABELS[1:])))
    [take], _ = formats.read_any(source, ReadOptions(up="y"))
    assert isinstance(take, MarkerTake)
    take = replace(take, rate=Fraction(120_000, 1001))
    for number, one in enumerate((through, suffix)):
        path = tmp_path / f"{number}{one}"
        formats.write(take, path, options=WriteOptions(anew=True))
        [again], _ = formats.read_any(path, ReadOptions(up="y"))
        assert isinstance(again, MarkerTake)
        assert (again.rate, again.first_frame) == (take.rate, 1)
        assert again.labels[1:] == LABELS[1:]
        np.testing.assert_allclose(again.positions, take.positions, atol=1e-7)
        take = again


def test_only_declared_cells_change(tmp_path: Path) -> None:
    source, target = tmp_path / "source.csv", tmp_path / "target.csv"
    source.write_text(
        'Time,"A, x",note,"A, y","A, z",B x,B y,B z\n'
        "0.0,1,first,2,3,4,5,6\n0.1,1.5,,2.5,3.5,4.5,5.5,6.5\n0.2,1,last,2,3,,,\n"
    )
    [take], _ = formats.read_any(source, ReadOptions(unit=1.0, up="y"))
    assert isinstance(take, MarkerTake)
    assert take.labels == ("A,", "B")
    positions = take.positions.copy()
    positions[1, 0] = (7, 8, 9)
    positions[2, 1] = (0.25, 0, -1)
    edited = take.with_positions(positions)
    with pytest.raises(MocapError, match="A, at frame 1"):
        formats.write(edited, target, declared=[Declared("B", 0, 3)])
    formats.write(edited, target, declared=[Declared("A,", 1, 2), Declared("B", 2, 3)])
    old, new = source.read_text().splitlines(), target.read_text().splitlines()
    assert new[:2] == old[:2]
    assert new[2] == "0.1,7.000000,,8.000000,9.000000,4.5,5.5,6.5"
    assert new[3] == "0.2,1,last,2,3,0.250000,0.000000,-1.000000"


def test_a_joint_at_the_origin_does_not_read_as_missing(take: Take, tmp_path: Path) -> None:
    still = take.with_motion(translations=np.zeros_like(take.translations))
    formats.write(still, tmp_path / "a.csv")
    [again], _ = formats.read_any(tmp_path / "a.csv")
    assert isinstance(again, MarkerTake)
    assert not again.missing.any()


def test_markers_have_no_angles(tmp_path: Path) -> None:
    source = tmp_path / "source.trc"
    source.write_text(trc(places()))
    [take], _ = formats.read_any(source)
    with pytest.raises(MocapError, match="no angles"):
        formats.write(take, tmp_path / "a.csv", options=WriteOptions(table="angles"))
