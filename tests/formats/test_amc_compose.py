"""Takes that no ASF is behind are written as ASF and AMC, and read back in the same places."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from mocapstudio.formats import ReadOptions, WriteOptions, read, write
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import FileError, MocapError
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take

NAMES = ("Hips", "Left Leg", "Left:Shin", "end", "1st rib", "Chest", "chest")
OFFSETS = [
    [0, 1, 0],
    [0.1, 0, 0],
    [0, -0.4, 0],
    [0, -0.4, 0.1],
    [0, 0.2, 0],
    [0, 0.2, 0],
    [0, 0, 0],
]


@pytest.fixture
def take() -> Take:
    generator = np.random.default_rng(4)
    skeleton = Skeleton(
        NAMES,
        np.array([-1, 0, 1, 2, 0, 4, 5]),
        np.array(OFFSETS, float),
        np.array([3, 6]),
        np.array([[0, 0, 0.1], [0, 0.2, 0.0]]),
    )
    turns = np.cumsum(generator.normal(scale=0.2, size=(20, len(NAMES), 3)), axis=0)
    moved = np.cumsum(generator.normal(scale=0.02, size=(20, 2, 3)), axis=0)
    return Take(
        "of joints",
        skeleton,
        rot.continuous(rot.from_rotation_vector(turns)),
        moved + np.array([[0, 1, 0], OFFSETS[5]]),
        Fraction(120000, 1001),
        translated=(0, 5),
    )


@pytest.mark.parametrize("unit", [None, 0.01])
def test_every_joint_is_found_in_its_place(take: Take, tmp_path: Path, unit: float | None) -> None:
    path = tmp_path / "out.amc"
    write(take, path, options=WriteOptions(unit=unit))
    (again,), _ = read(path, ReadOptions(up="y"))
    assert again.rate == take.rate
    assert again.frames == take.frames
    names = again.skeleton.names
    kept = [names.index(n) for n in ("root", "Left_Leg", "Left_Shin", "end_2", "joint_1st_rib")]
    kept += [names.index("Chest"), names.index("chest_2")]
    places, turns = take_pose(again)
    expected, turned = take_pose(take)
    np.testing.assert_allclose(places[:, kept], expected, atol=1e-6)
    assert rot.angle(turns[:, kept], turned).max() < 1e-6
    tips = dict(zip(again.skeleton.end_parents, again.skeleton.end_offsets, strict=True))
    np.testing.assert_allclose(tips[names.index("end_2")], [0, 0, 0.1], atol=1e-9)


def test_what_is_read_back_is_written_back(take: Take, tmp_path: Path) -> None:
    write(take, tmp_path / "out.amc")
    (again,), _ = read(tmp_path / "out.amc")
    (tmp_path / "copy").mkdir()
    write(again, tmp_path / "copy/out.amc")
    for name in ("out.amc", "out.asf"):
        assert (tmp_path / name).read_bytes() == (tmp_path / "copy" / name).read_bytes()


def test_trimmed_takes_are_cut(take: Take, tmp_path: Path) -> None:
    write(replace(take, trim=(5, 12)), tmp_path / "out.amc", options=WriteOptions(trim=True))
    (again,), _ = read(tmp_path / "out.amc", ReadOptions(up="y"))
    assert again.frames == 7
    np.testing.assert_allclose(again.translations[:, 0], take.translations[5:12, 0], atol=1e-6)


def test_another_skeleton_of_that_name_is_kept(take: Take, tmp_path: Path) -> None:
    (tmp_path / "out.asf").write_text("mine")
    with pytest.raises(FileError, match="another skeleton"):
        write(take, tmp_path / "out.amc")
    assert (tmp_path / "out.asf").read_text() == "mine"


@pytest.mark.parametrize("asked", [{"order": "ZXY"}, {"channels": 6}, {"up": "z"}])
def test_other_layouts_are_refused(take: Take, tmp_path: Path, asked: dict[str, object]) -> None:
    with pytest.raises(MocapError, match="Y up"):
        write(take, tmp_path / "out.amc", options=WriteOptions(**asked))  # type: ignore[arg-type]
    assert not list(tmp_path.iterdir())


def test_real_bvh_takes_keep_their_places(data: Path, tmp_path: Path) -> None:
    (bvh,), _ = read(data / "cmu_same_take_3_formats/02_01.bvh")
    write(bvh, tmp_path / "out.amc")
    (amc,), _ = read(tmp_path / "out.amc")
    assert amc.rate == bvh.rate
    index = amc.skeleton.index
    own = [
        index.get("root" if joint == 0 else name) for joint, name in enumerate(bvh.skeleton.names)
    ]
    np.testing.assert_allclose(take_pose(amc)[0][:, own], take_pose(bvh)[0], atol=2e-6)
