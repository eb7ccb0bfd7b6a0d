from __future__ import annotations

from pathlib import Path

import pytest

from mocapstudio.formats import find_takes
from mocapstudio.motion.errors import FileError


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("b.bvh", "a.BVH", "sub/deep/c.bvh", "notes.txt", ".hidden.bvh", ".git/d.bvh"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    (tmp_path / "folder.bvh").mkdir()
    return tmp_path


def test_folders_are_searched_recursively(folder: Path) -> None:
    names = [path.relative_to(folder).as_posix() for path in find_takes([folder])]
    assert names == ["a.BVH", "b.bvh", "sub/deep/c.bvh"]


def test_files_stay_as_they_are_and_come_once(folder: Path) -> None:
    notes, b = folder / "notes.txt", folder / "b.bvh"
    again = folder / "sub" / ".." / "b.bvh"
    assert find_takes([notes, b, again, b]) == [notes, b]
    assert find_takes([b, folder])[0] == b
    assert len(find_takes([b, folder])) == 3


def test_paths_that_hold_no_take(folder: Path) -> None:
    with pytest.raises(FileError, match="no such file"):
        find_takes([folder / "absent"])
    (folder / "empty").mkdir()
    with pytest.raises(FileError, match=r"no take.*\.bvh"):
        find_takes([folder / "empty"])
