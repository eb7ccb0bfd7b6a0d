from __future__ import annotations

from pathlib import Path

import pytest

from mocapstudio.formats.atomic import write_whole
from mocapstudio.motion.errors import FileError, MocapError


def names_in(folder: Path) -> list[str]:
    return [path.name for path in folder.iterdir()]


def test_writes_and_replaces(tmp_path: Path) -> None:
    path = tmp_path / "out.bvh"
    write_whole(path, [b"one ", b"two"])
    assert path.read_bytes() == b"one two"
    write_whole(path, iter([b"three"]))
    assert path.read_bytes() == b"three"
    assert names_in(tmp_path) == ["out.bvh"]


def test_a_failure_half_way_leaves_the_old_file_alone(tmp_path: Path) -> None:
    path = tmp_path / "out.bvh"
    path.write_bytes(b"old")

    def pieces():
        yield b"new"
        raise MocapError("no more")

    with pytest.raises(MocapError, match="no more"):
        write_whole(path, pieces())
    assert path.read_bytes() == b"old"
    assert names_in(tmp_path) == ["out.bvh"]


@pytest.mark.parametrize("name", ["absent/out.bvh", "", "file/out.bvh", "x" * 300, "nul\0.bvh"])
def test_places_that_cannot_be_written(tmp_path: Path, name: str) -> None:
    (tmp_path / "file").write_text("no folder")
    with pytest.raises(FileError) as caught:
        write_whole(tmp_path / name, [b"text"])
    assert str(tmp_path) in str(caught.value)
    assert names_in(tmp_path) == ["file"]


def test_a_full_device_is_one_line(tmp_path: Path) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("no /dev/full on this system")
    link = tmp_path / "out.bvh"
    link.symlink_to("/dev/full/out.bvh")
    with pytest.raises(FileError, match="cannot be written"):
        write_whole(link, [b"text"])


def test_a_link_is_followed(tmp_path: Path) -> None:
    target = tmp_path / "target.bvh"
    target.write_bytes(b"old")
    link = tmp_path / "link.bvh"
    link.symlink_to(target)
    write_whole(link, [b"new"])
    assert link.is_symlink()
    assert target.read_bytes() == b"new"


def test_new_files_have_the_users_usual_permissions(tmp_path: Path) -> None:
    write_whole(tmp_path / "ours.bvh", [b""])
    (tmp_path / "usual").touch()
    assert (tmp_path / "ours.bvh").stat().st_mode == (tmp_path / "usual").stat().st_mode
