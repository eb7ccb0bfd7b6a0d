from __future__ import annotations

import hashlib
from pathlib import Path

import pytest
from bvh_text import bvh, walk

from mocapstudio import formats
from mocapstudio.motion.errors import FileError


def test_the_source_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "kata.bvh"
    path.write_text(bvh(walk()))
    (take,), report = formats.read(str(path))
    assert take.name == "kata"
    assert (report.path, report.format) == (path, "bvh")
    assert take.source is not None
    assert take.source.path == path
    assert take.source.digest == hashlib.sha256(path.read_bytes()).hexdigest()


@pytest.mark.parametrize("name", ["kata.BVH", "kata.txt", "kata"])
def test_the_content_tells_where_the_suffix_does_not(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    path.write_text(bvh(walk()))
    assert formats.read(path)[0][0].frames == 30


def test_unknown_formats_are_told_what_is_known(tmp_path: Path) -> None:
    path = tmp_path / "scene.max"
    path.write_bytes(b"\xd0\xcf\x11\xe0 neither text nor motion")
    with pytest.raises(FileError, match=r"'\.max'.*\.bvh"):
        formats.read(path)
