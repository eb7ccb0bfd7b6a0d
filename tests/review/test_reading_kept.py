"""How a file was read outlives the session."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace as changed

from mocapstudio import formats
from mocapstudio.formats import ReadOptions
from mocapstudio.motion.errors import FileError
from mocapstudio.review import journal, session_file, session_record
from mocapstudio.review.document import Document
from mocapstudio.review.manner import Manner

BVH = """HIERARCHY
ROOT Hips
{
  OFFSET 3 90 1
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Chest
  {
    OFFSET 0 30 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 20 0
    }
  }
}
MOTION
Frames: 4
Frame Time: 0.0333333
0 90 0 0 0 0 0 0 0
5 90 1 4 5 6 7 8 9
9 91 2 8 10 12 14 16 18
12 90 3 0 5 6 7 8 90
"""


@pytest.mark.parametrize(
    "options",
    [
        ReadOptions(),
        ReadOptions(forward="x"),
        ReadOptions(root_offset="add"),
        ReadOptions(angles="radians", unit=0.01, fps=Fraction(120000, 1001)),
        ReadOptions(up="z", forward="-x", trim_start=False),
    ],
    ids=str,
)
def test_a_take_comes_back_as_it_was_read(tmp_path: Path, options: ReadOptions) -> None:
    file, session = tmp_path / "take.bvh", tmp_path / "s.mocapstudio"
    file.write_text(BVH)
    (take,), _ = formats.read(file, options)
    document = Document("ana")
    name = document.open_take(take)
    session_file.save(document, session)
    loaded = session_file.load(session)
    again = loaded.state.scene.performer(name).take
    assert np.array_equal(again.rotations, take.rotations)
    assert np.array_equal(again.translations, take.translations)
    assert np.array_equal(again.skeleton.offsets, take.skeleton.offsets)
    assert (again.rate, again.trim) == (take.rate, take.trim)
    assert again.source is not None
    assert again.source.options == options


def test_a_skeleton_beside_an_amc_is_found_where_the_folder_has_moved_to(
    tmp_path: Path, data: Path
) -> None:
    folder = tmp_path / "before"
    folder.mkdir()
    source = data / "cmu_asfamc"
    amc = min(source.glob("*.amc"), key=lambda one: one.stat().st_size)
    asf = next(one for one in source.glob("*.asf") if one.stem == amc.stem.split("_")[0])
    (folder / "elsewhere.asf").write_bytes(asf.read_bytes())
    (folder / "take.amc").write_bytes(amc.read_bytes())
    options = ReadOptions(fps=Fraction(120), skeleton=folder / "elsewhere.asf")
    (take,), _ = formats.read(folder / "take.amc", options)
    document = Document("ana")
    name = document.open_take(take)
    session_file.save(document, folder / "s.mocapstudio")
    moved = folder.rename(tmp_path / "after")
    loaded = session_file.load(moved / "s.mocapstudio")
    assert not loaded.state.problems
    again = loaded.state.scene.performer(name).take
    assert np.array_equal(again.rotations, take.rotations)
    assert again.source is not None
    assert again.source.options == replace(options, skeleton=moved / "elsewhere.asf")


def test_the_manner_of_reading_outlives_session_and_crash(tmp_path: Path) -> None:
    (tmp_path / "take.bvh").write_text(BVH)
    (take,), _ = formats.read(tmp_path / "take.bvh")
    document = Document("ana")
    document.open_take(take)
    kept = journal.Journal(document, folder=tmp_path)
    manner = Manner(ReadOptions(unit=0.01), {"a": "b"})
    manner = manner.with_own(tmp_path / "kick.csv", ReadOptions(fps=Fraction(25)))
    document.set_manner(manner)
    kept.close(keep=True)
    assert journal.recover(kept.path).state.manner == manner
    session = tmp_path / "s.mocapstudio"
    session_file.save(document, session)
    loaded = session_file.load(session)
    assert loaded.state.manner == manner
    assert not loaded.state.dirty
    assert loaded.state.manner.of(tmp_path / "kick.csv").fps == 25


def test_a_rate_that_is_none_is_said(tmp_path: Path) -> None:
    (tmp_path / "take.bvh").write_text(BVH)
    (take,), _ = formats.read(tmp_path / "take.bvh", ReadOptions(fps=Fraction(25)))
    document = Document("ana")
    document.open_take(take)
    session = tmp_path / "s.mocapstudio"
    session_file.save(document, session)
    record, arrays = session_record.read(session)
    (one,) = record.takes
    assert one.reading is not None
    odd = changed(one, reading=changed(one.reading, fps="1/0"))
    session.write_bytes(session_record.to_bytes(changed(record, takes=(odd,)), arrays))
    with pytest.raises(FileError, match="no frame rate"):
        session_file.load(session)
    broken = changed(record, manner=changed(record.manner, options=odd.reading))
    session.write_bytes(session_record.to_bytes(broken, arrays))
    loaded = session_file.load(session)
    assert "manner of reading" in loaded.state.problems[0].what
    assert loaded.state.scene.performers[0].take.rate == 25
