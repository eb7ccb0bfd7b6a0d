from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from mocapstudio.cli.targets import Targets
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Source, Take


def take(name: str) -> Take:
    none = np.zeros((0, 3))
    skeleton = Skeleton(
        ("hips",), np.array([-1]), np.zeros((1, 3)), np.zeros(0, dtype=np.int64), none
    )
    rest = np.tile([0.0, 0.0, 0.0, 1.0], (2, 1, 1))
    source = Source(Path(name), "made", "")
    return Take(name, skeleton, rest, np.zeros((2, 1, 3)), rate=Fraction(1), source=source)


@pytest.mark.parametrize(
    ("name", "written"),
    [
        ("a.bvh", "a.bvh"),
        ("a.b.BVH", "a.b.BVH"),
        ("05_13.amc", "05_13.amc"),
        ("05_13.c3d", "05_13.bvh"),
        ("a", "a.bvh"),
    ],
)
def test_formats_that_hold_no_joints_become_bvh_in_a_folder(
    tmp_path: Path, name: str, written: str
) -> None:
    path = tmp_path / name
    targets = Targets(tmp_path / "clean", [path], [path])
    assert targets.of(path, take("one"), alone=True) == tmp_path / "clean" / written


def test_what_was_solved_from_markers_becomes_bvh(tmp_path: Path) -> None:
    path = tmp_path / "markers.csv"
    targets = Targets(tmp_path / "clean", [path], [path])
    solved = replace(take("one"), source=None)
    assert targets.of(path, solved, alone=True) == tmp_path / "clean" / "markers.bvh"


def test_two_takes_are_not_written_to_one_file(tmp_path: Path) -> None:
    paths = [tmp_path / "a.bvh", tmp_path / "a.c3d"]
    targets = Targets(tmp_path / "clean", paths, paths)
    targets.of(paths[0], take("a"), alone=True)
    with pytest.raises(FileError, match=r"a\.c3d.*would replace"):
        targets.of(paths[1], take("a"), alone=True)
