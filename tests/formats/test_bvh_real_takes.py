"""Every BVH of the data folder against its folder's README and an independent reader."""

from __future__ import annotations

import re
from fractions import Fraction
from pathlib import Path

import naive_bvh
import numpy as np
import pytest

from mocapstudio import formats
from mocapstudio.motion.facing import carrier
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take

CMU = 0.0254 / 0.45
UNITS = {
    "bandai_1_styles_bvh_CCBYNC4": 0.01,
    "bandai_2_normal_bvh_CCBYNC4": 0.01,
    "cmu_dance_bvh": CMU,
    "cmu_locomotion_bvh": CMU,
    "cmu_same_take_3_formats": CMU,
    "cmu_salsa_pairs_bvh": 1.0,
    "karate_rmocap_GPL3": 0.01,
}
FILE_UNITS = {"jesse_dance.bvh": 0.01, "wave_hello.bvh": 0.04, "dab.bvh": 0.04}
_TABLE = re.compile(r"^\| (\S+\.bvh) \| (\d+) \| ([\d.]+) \| (\d+) joints \|$", re.MULTILINE)


@pytest.fixture(scope="module")
def takes(data: Path) -> dict[Path, tuple[Take, formats.ImportReport]]:
    """Every take of the data folder, read once."""
    found = {}
    for path in sorted(data.rglob("*.bvh")):
        (take,), report = formats.read(path)
        found[path] = take, report
    return found


Takes = dict[Path, tuple[Take, formats.ImportReport]]


def stated_in_readmes(data: Path) -> dict[Path, tuple[int, float, int]]:
    stated = {}
    for readme in sorted(data.glob("*/README.md")):
        for name, frames, fps, joints in _TABLE.findall(readme.read_text()):
            stated[readme.parent / name] = (int(frames), float(fps), int(joints))
    for folder in ("bandai_1_styles_bvh_CCBYNC4", "bandai_2_normal_bvh_CCBYNC4"):
        for path in sorted((data / folder).glob("*.bvh")):
            header = re.search(r"Frames:\s*(\d+)", path.read_text())
            assert header
            stated[path] = (int(header[1]), 30.0, 22)
    return stated


def test_frames_rate_and_joints_are_those_of_the_readmes(data: Path, takes: Takes) -> None:
    stated = stated_in_readmes(data)
    assert len(stated) > 240
    for path, (frames, fps, joints) in stated.items():
        take, _ = takes[path]
        assert (take.frames, len(take.skeleton)) == (frames, joints), path
        assert round(float(take.rate), 2) == fps, path


def test_the_rate_is_an_exact_fraction(takes: Takes) -> None:
    rates = {path.name: take.rate for path, (take, _) in takes.items()}
    assert rates["wave_hello.bvh"] == Fraction(120_000, 1001)
    others = {rate for name, rate in rates.items() if name != "wave_hello.bvh"}
    assert others == {Fraction(30), Fraction(100), Fraction(120)}


def test_units_are_guessed_right_and_named_as_guesses(takes: Takes) -> None:
    for path, (take, report) in takes.items():
        assert take.source is not None
        unit = FILE_UNITS.get(path.name) or UNITS[path.parent.name]
        assert take.source.unit == pytest.approx(unit, rel=1e-4), path
        guess = next(problem for problem in report.problems if problem.override == "unit")
        assert guess.guess
        assert guess.done.startswith("guessed")


def test_z_up_takes_stand_upright(takes: Takes) -> None:
    for path, (take, report) in takes.items():
        positions, _ = take_pose(take)
        height = np.median(np.ptp(positions[..., 1], axis=1))
        assert 1.0 < height < 2.2, path
        z_up = any("guessed Z up" in problem.done for problem in report.problems)
        assert z_up == (path.name in ("dab.bvh", "wave_hello.bvh")), path


def test_positions_agree_with_an_independent_reader(data: Path, takes: Takes) -> None:
    bandai = sorted((data / "bandai_1_styles_bvh_CCBYNC4").glob("*.bvh"))[::12]
    others = [p for p in takes if not p.parent.name.startswith("bandai")]
    for path in [*bandai, *others]:
        take, _ = takes[path]
        assert take.source is not None
        up_z = path.name in ("dab.bvh", "wave_hello.bvh")
        naive = naive_bvh.read(path, step=11)
        assert [joint.name for joint in naive.joints] == list(take.skeleton.names)
        expected = naive.positions() * take.source.unit
        if up_z:
            expected = np.stack([expected[..., 0], expected[..., 2], -expected[..., 1]], axis=-1)
        positions, _ = take_pose(take)
        height = np.median(np.ptp(expected[..., 1], axis=1))
        apart = np.abs(positions[::11] - expected).max()
        assert apart < 1e-4 * height, path


def test_quaternions_are_unit_and_continuous(takes: Takes) -> None:
    for path, (take, _) in takes.items():
        assert np.allclose(np.linalg.norm(take.rotations, axis=-1), 1.0, atol=1e-12)
        assert (np.sum(take.rotations[1:] * take.rotations[:-1], axis=-1) >= 0).all(), path


def test_bandai_moves_in_its_hips_only(takes: Takes) -> None:
    for path, (take, _) in takes.items():
        if path.parent.name.startswith("bandai"):
            assert [take.skeleton.names[j] for j in take.translated] == ["joint_Root", "Hips"]
            assert carrier(take) == 1
        else:
            assert take.translated == (0,)


def test_rokokos_root_stands_where_its_channel_says(data: Path) -> None:
    path = data / "rokoko_animated_drawings_bvh_MIT" / "jesse_dance.bvh"
    (take,), report = formats.read(path)
    # The first row of the file, not 94 cm higher.
    np.testing.assert_allclose(take.translations[0, 0], [-0.062023, 0.877332, -1.616986])
    assert any(problem.override == "root_offset" for problem in report.problems)
    (raised,), _ = formats.read(path, formats.ReadOptions(root_offset="add"))
    np.testing.assert_allclose(raised.translations[0, 0, 1], 0.877332 + 0.94)


def test_cmu_t_poses_are_trimmed_and_told(data: Path, takes: Takes) -> None:
    with_t_pose = {path: 1 for path in takes if path.parent.name == "cmu_locomotion_bvh"}
    # One of them starts with two synthetic rows.
    with_t_pose[data / "cmu_locomotion_bvh" / "07_12.bvh"] = 2
    for name in ("05_02", "05_15", "49_06", "49_08"):
        with_t_pose[data / "cmu_dance_bvh" / f"{name}.bvh"] = 1
    for name in ("05_13", "02_01"):
        with_t_pose[data / "cmu_same_take_3_formats" / f"{name}.bvh"] = 1
    for path, (take, report) in takes.items():
        told = any("T-pose" in p.what for p in report.problems)
        assert told == (take.trim is not None), path
        if path.parent.name == "cmu_salsa_pairs_bvh":
            # A filter has spread their jump out of the T-pose, and rings for some rows after it.
            assert take.trim is not None and 4 < take.trim[0] < 20, path
            assert take.trim[1] == take.frames, path
        else:
            expected = (with_t_pose[path], take.frames) if path in with_t_pose else None
            assert take.trim == expected, path


def test_the_same_take_as_amc_has_its_root_at_the_same_place(data: Path) -> None:
    folder = data / "cmu_same_take_3_formats"
    (take,), _ = formats.read(folder / "05_13.bvh")
    lines = (folder / "05_13.amc").read_text().splitlines()
    root = [line.split()[1:4] for line in lines if line.startswith("root ")]
    expected = np.array(root, dtype=float) * CMU
    assert len(expected) == take.frames - 1
    np.testing.assert_allclose(take.translations[1:, 0], expected, atol=5e-3)


def test_unedited_takes_are_written_byte_for_byte(takes: Takes, tmp_path: Path) -> None:
    for path, (take, _) in takes.items():
        formats.write(take, tmp_path / "copy.bvh")
        assert (tmp_path / "copy.bvh").read_bytes() == path.read_bytes(), path
