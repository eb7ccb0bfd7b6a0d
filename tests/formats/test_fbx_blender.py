"""FBX through Blender: what is said without it, and there and back where it is installed."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from made_takes import below_a_reference, walking

from mocapstudio.cli.checks.blender import check_blender
from mocapstudio.cli.checks.finding import State
from mocapstudio.formats import ReadOptions, WriteOptions, read, write
from mocapstudio.formats.fbx_blender import VARIABLE, find_blender
from mocapstudio.formats.fbx_bones import Bones, trees
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import FileError, MocapError
from mocapstudio.motion.kinematics import end_positions, take_pose
from mocapstudio.motion.take import Take


@pytest.fixture
def blender() -> None:
    if find_blender() is None:
        pytest.skip(f"no Blender here: neither its program nor bpy, and {VARIABLE} names none")


@pytest.fixture
def nowhere(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mocapstudio.formats.fbx_blender.find_blender", lambda: None)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "take.fbx"
    path.write_bytes(b"Kaydara FBX Binary  \x00\x1a\x00" + bytes(100))
    return path


def matrices(take: Take) -> tuple[np.ndarray, np.ndarray]:
    """World matrices at rest and in time as Blender has them: Z up, each bone with own axes."""
    to_z_up = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])
    positions, rotations = take_pose(take)
    own = rot.to_matrix(
        rot.normalize(np.random.default_rng(2).normal(size=(len(take.skeleton), 4)))
    )
    world = np.tile(np.eye(4), (take.frames, len(take.skeleton), 1, 1))
    world[..., :3, :3] = rot.to_matrix(rotations) @ own
    world[..., :3, 3] = positions
    rest = np.tile(np.eye(4), (len(take.skeleton), 1, 1))
    rest[:, :3, :3] = own
    rest[:, :3, 3] = take.skeleton.rest_positions
    # An armature is often scaled, and its bones with it.
    scale = np.diag([0.01, 0.01, 0.01, 1.0])
    return to_z_up @ rest @ scale, to_z_up @ world @ scale


def test_bones_become_the_take_they_were_made_of() -> None:
    walk = walking(seconds=0.5)
    take = below_a_reference(walk, rot.about_axis(0, np.array(-0.7)))
    rest, world = matrices(take)
    shuffled = np.random.default_rng(1).permutation(len(take.skeleton))
    back = np.argsort(shuffled)
    parents = np.array([back[p] if p >= 0 else -1 for p in take.skeleton.parents[shuffled]])
    names = tuple(take.skeleton.names[j] for j in shuffled)
    (tree,) = trees(Bones(names, parents, rest[shuffled], world[:, shuffled]), [])
    skeleton, rotations, translations, translated = tree.motion(1.0, rot.IDENTITY)
    again = Take("again", skeleton, rotations, translations, take.rate, translated)
    assert set(skeleton.names) == set(take.skeleton.names)
    which = [skeleton.index[name] for name in take.skeleton.names]
    np.testing.assert_allclose(
        skeleton.rest_positions[which], take.skeleton.rest_positions, atol=1e-9
    )
    np.testing.assert_allclose(take_pose(again)[0][:, which], take_pose(take)[0], atol=1e-9)
    np.testing.assert_allclose(rot.angle(again.rotations[:, which], take.rotations), 0, atol=1e-6)
    assert [skeleton.names[j] for j in translated] == ["Reference", "Hips"]


def test_two_roots_are_two_skeletons_and_lone_bones_are_named() -> None:
    eye = np.eye(4)
    bones = Bones(
        ("a", "b", "c", "d", "e"),
        np.array([-1, 0, -1, 2, -1]),
        np.array([eye] * 5),
        np.array([[eye] * 5]),
    )
    problems: list = []
    assert [tree.names for tree in trees(bones, problems)] == [("a", "b"), ("c", "d")]
    assert problems[0].what == "bone e has neither parent nor children"


def test_without_blender_reading_says_how_to_get_it(file: Path, nowhere: None) -> None:
    with pytest.raises(FileError, match=r"take\.fbx: -: FBX goes through Blender.*blender\.org"):
        read(file)


def test_without_blender_writing_says_how_to_get_it(tmp_path: Path, nowhere: None) -> None:
    with pytest.raises(MocapError, match=r"FBX goes through Blender.*blender\.org"):
        write(walking(seconds=0.2), tmp_path / "out.fbx")
    assert not (tmp_path / "out.fbx").exists()


def test_what_is_no_fbx_is_refused_before_blender_starts(file: Path, nowhere: None) -> None:
    file.write_bytes(b"HIERARCHY")
    with pytest.raises(FileError, match="not FBX"):
        read(file)


def test_a_variable_that_names_nothing(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, "/nowhere/blender")
    with pytest.raises(FileError, match="MOCAPSTUDIO_BLENDER names /nowhere/blender"):
        read(file)
    (finding,) = check_blender()
    assert finding.state is State.NOTE
    assert "/nowhere/blender" in finding.found


def test_a_program_that_fails_is_quoted(
    file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    program = tmp_path / "blender"
    program.write_text("#!/bin/sh\necho no such luck >&2\nexit 3\n")
    program.chmod(0o755)
    monkeypatch.setenv(VARIABLE, str(program))
    with pytest.raises(FileError, match="Blender failed: no such luck"):
        read(file)


def test_the_unit_and_axes_are_not_for_us_to_choose(tmp_path: Path) -> None:
    with pytest.raises(MocapError, match="FBX is written with Y up"):
        write(walking(seconds=0.2), tmp_path / "out.fbx", options=WriteOptions(up="z"))


def test_there_and_back(tmp_path: Path, blender: None) -> None:
    take = replace(walking(seconds=1.0, rate=120), rate=Fraction(120000, 1001))
    path = tmp_path / "walk.fbx"
    write(take, path)
    (again,), report = read(path)
    assert report.format == "fbx"
    assert (again.rate, again.frames, again.translated) == (take.rate, take.frames, (0,))
    assert set(again.skeleton.names) == set(take.skeleton.names)
    which = [again.skeleton.index[name] for name in take.skeleton.names]
    np.testing.assert_allclose(again.skeleton.offsets[which], take.skeleton.offsets, atol=1e-5)
    (before, turned), (after, world) = take_pose(take), take_pose(again)
    np.testing.assert_allclose(after[:, which], before, atol=1e-4)
    # Limbs end where they did, whatever their ends are called.
    tips = end_positions(take.skeleton, before, turned)
    ends = end_positions(again.skeleton, after, world)
    for tip in tips.swapaxes(0, 1):
        assert np.abs(ends - tip[:, None]).max(axis=(0, 2)).min() < 1e-4


def test_a_broken_fbx_is_refused(file: Path, blender: None) -> None:
    with pytest.raises(FileError):
        read(file, ReadOptions())
