"""AMC is written back as it was read, but for the values of what was edited."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from mocapstudio.formats import Declared, ReadOptions, WriteOptions, read, write
from mocapstudio.formats.amc_dof import nearest_angles
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import FileError, MocapError
from mocapstudio.motion.take import Take

ASF = """:version 1.10
:units
  length 0.45
  angle deg
:root
  order TX TY TZ RZ RX RY
  axis ZXY
  position 0 1 0
  orientation 10 0 0
:bonedata
  begin
    name spine
    direction 0 1 0
    length 9
    axis 10 20 30 XYZ
    dof rx ry rz
  end
  begin
    name wrist
    direction 1 0 0
    length 4
    axis 0 0 20 XYZ
    dof rz rx
  end
  begin
    name knee
    direction 0 -1 0
    length 7
    axis 0 40 0 XYZ
    dof rx
  end
:hierarchy
  begin
    root spine knee
    spine wrist
  end
"""
HEAD = "# made  \r\n:FULLY-SPECIFIED\r\n:DEGREES\r\n"


def frame(number: int) -> str:
    t = number / 5
    return (
        f"{number}\r\nroot {t:.4f} 17.25  -2 {4 * t:.3f} 20 30 # 33\r\n"
        f"knee  {9.123456 + t:g}\r\n"
        f"spine -1.5e+001 {7 * t:g}\t.25\r\nwrist {t:g} {-3 * t:g}\r\n"
    )


TEXT = HEAD + "".join(frame(n) for n in range(3, 23)) + "# the end\r\n"


@pytest.fixture
def path(tmp_path: Path) -> Path:
    (tmp_path / "07.asf").write_text(ASF)
    file = tmp_path / "07_02.amc"
    file.write_bytes(TEXT.encode())
    return file


def read_one(path: Path, options: ReadOptions | None = None) -> Take:
    (take,), _ = read(path, options)
    return take


def words(data: bytes) -> list[bytes]:
    return re.sub(rb"#[^\r\n]*", b"", data).split()


def edited(take: Take, joint: str, start: int, end: int, turn: np.ndarray) -> Take:
    rotations = take.rotations.copy()
    j = take.skeleton.index[joint]
    rotations[start:end, j] = rot.multiply(rotations[start:end, j], turn)
    return take.with_motion(rotations)


def test_unedited_is_written_back_byte_for_byte(path: Path, tmp_path: Path) -> None:
    write(read_one(path), tmp_path / "out.amc")
    assert (tmp_path / "out.amc").read_bytes() == TEXT.encode()


@pytest.mark.parametrize("name", ["02_01", "05_13"])
def test_real_takes_are_written_back_byte_for_byte(data: Path, tmp_path: Path, name: str) -> None:
    source = data / "cmu_same_take_3_formats" / f"{name}.amc"
    out = tmp_path / f"{name}.amc"
    write(read_one(source), out)
    assert out.read_bytes() == source.read_bytes()
    # Its skeleton comes along, without which nobody could read it.
    asf = f"{name[:2]}.asf"
    assert (tmp_path / asf).read_bytes() == (source.parent / asf).read_bytes()


def test_edits_change_their_own_words_alone(path: Path, tmp_path: Path) -> None:
    take = read_one(path)
    take = edited(take, "spine", 4, 8, rot.from_rotation_vector(np.array([0.3, -0.2, 0.4])))
    rotations, translations = take.rotations.copy(), take.translations.copy()
    rotations[10:12, 0] = rot.multiply(rot.about_axis(1, np.array(0.5)), rotations[10:12, 0])
    translations[15, 0] += (0.1, 0.2, -0.3)
    take = take.with_motion(rotations, translations)
    declared = [Declared("spine", 4, 8), Declared("root heading", 9, 13)]
    declared += [Declared("root position", 15, 16)]
    out = tmp_path / "out.amc"
    write(take, out, declared=declared)
    again = read_one(out)
    np.testing.assert_allclose(rot.angle(again.rotations, take.rotations), 0, atol=1e-6)
    np.testing.assert_allclose(again.translations, take.translations, atol=1e-7)
    before, after = words(TEXT.encode()), words(out.read_bytes())
    assert len(before) == len(after)
    # Words of a frame: its number, then root with 6, knee with 1, spine with 3, wrist with 2.
    changed = [
        divmod(i - 2, 17) for i, (a, b) in enumerate(zip(before, after, strict=True)) if a != b
    ]
    allowed = {(f, c) for f in range(4, 8) for c in (11, 12, 13)}
    allowed |= {(f, c) for f in (10, 11) for c in (5, 6, 7)} | {(15, c) for c in (2, 3, 4)}
    assert set(changed) == allowed
    assert out.read_bytes().count(b"# 33") == 20


def test_changes_that_nobody_declared_are_refused(path: Path, tmp_path: Path) -> None:
    take = edited(read_one(path), "spine", 4, 8, rot.about_axis(0, np.array(0.3)))
    with pytest.raises(MocapError, match="rotation of spine at frame 6"):
        write(take, tmp_path / "out.amc", declared=[Declared("spine", 4, 6)])
    assert not (tmp_path / "out.amc").exists()


def test_a_rotation_that_a_bone_has_no_axis_for_is_refused(path: Path, tmp_path: Path) -> None:
    take = edited(read_one(path), "knee", 4, 8, rot.about_axis(2, np.array(0.3)))
    with pytest.raises(MocapError, match=r"bone knee has its axes X for the rotation.*BVH"):
        write(take, tmp_path / "out.amc", declared=[Declared("knee", 4, 8)])


def test_trim_cuts_whole_frames(path: Path, tmp_path: Path) -> None:
    take = replace(read_one(path), trim=(5, 12))
    out = tmp_path / "out.amc"
    write(take, out, options=WriteOptions(trim=True))
    again = read_one(out)
    assert again.first_frame == 8
    np.testing.assert_array_equal(again.rotations, take.rotations[5:12])
    text = out.read_bytes().decode()
    assert text.startswith(HEAD)
    assert text.endswith("# the end\r\n")


@pytest.mark.parametrize("option", [{"unit": 1.0}, {"up": "z"}, {"order": "XYZ"}, {"anew": True}])
def test_another_layout_is_refused(path: Path, tmp_path: Path, option: dict[str, object]) -> None:
    with pytest.raises(MocapError, match="AMC has the joints, frames, unit and axes of its source"):
        write(read_one(path), tmp_path / "out.amc", options=WriteOptions(**option))  # type: ignore[arg-type]


def test_another_skeleton_beside_is_not_replaced(path: Path, tmp_path: Path) -> None:
    folder = tmp_path / "clean"
    folder.mkdir()
    (folder / "07.asf").write_text("mine")
    with pytest.raises(FileError, match="another skeleton"):
        write(read_one(path), folder / "07_02.amc")
    assert (folder / "07.asf").read_text() == "mine"
    assert not (folder / "07_02.amc").exists()


def test_the_skeleton_can_be_named(path: Path) -> None:
    other = path.with_name("other.asf")
    other.write_text(ASF.replace("length 9", "length 18"))
    path.with_name("07.asf").rename(path.with_name("another.asf"))
    with pytest.raises(FileError, match=r"several skeletons.*another\.asf, other\.asf"):
        read(path)
    tall = read_one(path, ReadOptions(skeleton=other))
    short = read_one(path, ReadOptions(skeleton=path.with_name("another.asf")))
    wrist = tall.skeleton.index["wrist"]
    np.testing.assert_allclose(tall.skeleton.offsets[wrist], 2 * short.skeleton.offsets[wrist])
    # The same motion on another skeleton is another take.
    assert tall.source is not None
    assert short.source is not None
    assert tall.source.digest != short.source.digest


angles = st.floats(-3.0, 3.0)


@settings(max_examples=60)
@given(order=st.sampled_from(["X", "Y", "Z", "XY", "YX", "ZX", "XZ", "YZ", "ZY"]), data=st.data())
def test_what_the_axes_can_express_is_found_again(order: str, data: st.DataObject) -> None:
    given_angles = np.array(data.draw(st.lists(angles, min_size=len(order), max_size=len(order))))
    q = rot.from_euler(order, given_angles[None])
    found, off = nearest_angles(order, q, given_angles + 0.1)
    np.testing.assert_allclose(off, 0, atol=1e-6)
    np.testing.assert_allclose(rot.angle(rot.from_euler(order, found), q), 0, atol=1e-6)


@settings(max_examples=20)
@given(order=st.sampled_from(["Y", "ZX", "XZ", "YX"]), seed=st.integers(0, 10_000))
def test_nothing_nearer_is_found_by_trying(order: str, seed: int) -> None:
    q = Rotation.random(1, random_state=seed).as_quat()
    _, off = nearest_angles(order, q, np.zeros(len(order)))
    steps = np.linspace(-np.pi, np.pi, 121)
    grid = np.stack(np.meshgrid(*[steps] * len(order), indexing="ij"), -1).reshape(-1, len(order))
    best = rot.angle(rot.from_euler(order, grid), q).min()
    assert off[0] <= best + 1e-9
    assert off[0] >= best - np.radians(4)


def test_angles_go_on_from_those_before() -> None:
    turning = np.radians(np.arange(300.0, 420.0, 10.0))[:, None]
    for order in ("Y", "YX"):
        truth = np.concatenate([turning, 0.1 * turning], axis=1)[:, : len(order)]
        found, _ = nearest_angles(order, rot.from_euler(order, truth), truth[0])
        np.testing.assert_allclose(found, truth, atol=1e-9)
