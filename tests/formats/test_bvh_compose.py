"""BVH written anew and read again."""

from __future__ import annotations

import itertools
from fractions import Fraction
from pathlib import Path

import naive_bvh
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy.spatial.transform import Rotation

from mocapstudio import formats
from mocapstudio.formats import ReadOptions, WriteOptions
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import ParameterError
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take

ORDERS = ["".join(letters) for letters in itertools.permutations("XYZ")]


def made(frames: int = 25, seed: int = 0, rate: Fraction = Fraction(60)) -> Take:
    """A take made in memory: branching skeleton, joints not listed depth first."""
    generator = np.random.default_rng(seed)
    skeleton = Skeleton(
        names=("Hips", "LeftUpLeg", "RightUpLeg", "Spine", "LeftLeg", "RightLeg", "Head"),
        parents=np.array([-1, 0, 0, 0, 1, 2, 3]),
        offsets=np.array(
            [
                *([0, 0.9, 0], [0.1, 0, 0], [-0.1, 0, 0], [0, 0.2, 0]),
                *([0, -0.42, 0], [0, -0.42, 0], [0, 0.4, 0]),
            ]
        ),
        end_parents=np.array([4, 5]),
        end_offsets=np.array([[0, -0.4, 0], [0, -0.4, 0]]),
    )
    time = np.linspace(0, 3, frames)[:, None, None]
    vectors = np.sin(time * generator.uniform(0.5, 3, (1, 7, 3)) + generator.uniform(0, 6, (7, 3)))
    rotations = rot.continuous(rot.from_rotation_vector(2.0 * vectors))
    translations = np.cumsum(generator.normal(scale=0.01, size=(frames, 1, 3)), axis=0)
    return Take("made", skeleton, rotations, translations, rate)


def same(take: Take, other: Take) -> None:
    back = [other.skeleton.index[name] for name in take.skeleton.names]
    ours = Rotation.from_quat(take.rotations.reshape(-1, 4))
    theirs = Rotation.from_quat(other.rotations[:, back].reshape(-1, 4))
    assert np.degrees((ours.inv() * theirs).magnitude().max()) < 1e-5
    np.testing.assert_allclose(other.translations, take.translations, atol=1e-6)
    np.testing.assert_allclose(other.skeleton.offsets[back], take.skeleton.offsets, atol=1e-6)
    assert other.rate == take.rate


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("channels", [3, 6])
def test_round_trip(tmp_path: Path, order: str, channels) -> None:
    take = made()
    path = tmp_path / "out.bvh"
    formats.write(take, path, options=WriteOptions(order=order, channels=channels))
    (again,), report = formats.read(path)
    same(take, again)
    assert all(problem.guess for problem in report.problems)
    lines = [line.split() for line in path.read_text().splitlines() if "CHANNELS" in line]
    assert [len(words) - 2 for words in lines] == [6] + [channels] * 6
    assert all([w[0] for w in words[-3:]] == list(order) for words in lines)


@pytest.mark.parametrize("up", ["x", "y", "z"])
@pytest.mark.parametrize("unit", [1.0, 0.01, 0.0254])
def test_unit_and_up_axis(tmp_path: Path, up, unit: float) -> None:
    take = made()
    path = tmp_path / "out.bvh"
    formats.write(take, path, options=WriteOptions(unit=unit, up=up))
    (again,), _ = formats.read(path, ReadOptions(unit=unit, up=up))
    same(take, again)
    # What stands in the file has its world's height along the axis that was asked for.
    naive = naive_bvh.read(path).positions() * unit
    order = [naive.shape[2] - 3 + "xyz".index(up)]
    names = [joint.name for joint in naive_bvh.read(path).joints]
    ours = take_pose(take)[0][:, [take.skeleton.index[n] for n in names]]
    np.testing.assert_allclose(naive[..., order[0]], ours[..., 1], atol=1e-5)


def test_a_memory_take_is_written_in_centimetres(tmp_path: Path) -> None:
    formats.write(made(), tmp_path / "out.bvh")
    assert formats.read(tmp_path / "out.bvh")[0][0].source.unit == 0.01


@pytest.mark.parametrize(
    "rate", [24, 25, 30, 50, 60, 100, 120, 240, 480, 1000, 37, 0.5, Fraction(120_000, 1001)]
)
def test_every_rate_is_told_again(tmp_path: Path, rate) -> None:
    take = made(rate=Fraction(rate))
    formats.write(take, tmp_path / "out.bvh")
    assert formats.read(tmp_path / "out.bvh")[0][0].rate == take.rate


def test_leaves_get_end_sites(tmp_path: Path) -> None:
    formats.write(made(), tmp_path / "out.bvh")
    (again,), _ = formats.read(tmp_path / "out.bvh")
    below = again.skeleton.children
    leaves = {name for name, j in again.skeleton.index.items() if not below[j]}
    assert leaves == {again.skeleton.names[j] for j in again.skeleton.end_parents}


def test_angles_are_written_without_jumps(tmp_path: Path) -> None:
    frames = 400
    take = made(frames)
    turns = np.zeros((frames, len(take.skeleton), 3))
    turns[:, 3, 1] = np.linspace(0, 6 * np.pi, frames)
    take = take.with_motion(rotations=rot.continuous(rot.from_rotation_vector(turns)))
    formats.write(take, tmp_path / "out.bvh", options=WriteOptions(order="YXZ"))
    rows = naive_bvh.read(tmp_path / "out.bvh").rows
    assert np.abs(np.diff(rows[:, 3:], axis=0)).max() < 5
    assert rows.max() > 1000


def test_joints_that_translate_keep_their_positions(data: Path, tmp_path: Path) -> None:
    path = data / "bandai_1_styles_bvh_CCBYNC4" / "dataset-1_bow_active_001.bvh"
    (take,), _ = formats.read(path)
    formats.write(take, tmp_path / "out.bvh", options=WriteOptions(channels=3))
    (again,), _ = formats.read(tmp_path / "out.bvh")
    assert again.translated == take.translated
    same(take, again)


def test_real_takes_in_every_order(data: Path, tmp_path: Path) -> None:
    for name in (
        "cmu_salsa_pairs_bvh/60_10_scaled.bvh",
        "rokoko_animated_drawings_bvh_MIT/dab.bvh",
    ):
        (take,), _ = formats.read(data / name)
        for order in ORDERS:
            formats.write(take, tmp_path / "out.bvh", options=WriteOptions(order=order))
            (again,), _ = formats.read(tmp_path / "out.bvh", ReadOptions(unit=take.source.unit))
            same(take, again)


def test_a_chain_longer_than_pythons_stack(tmp_path: Path) -> None:
    joints = 1500
    skeleton = Skeleton(
        tuple(f"joint{j}" for j in range(joints)),
        np.arange(joints) - 1,
        np.full((joints, 3), 0.01),
        np.zeros(0, dtype=np.int64),
        np.zeros((0, 3)),
    )
    rotations = np.tile(rot.IDENTITY, (2, joints, 1))
    take = Take("chain", skeleton, rotations, np.zeros((2, 1, 3)), Fraction(30))
    formats.write(take, tmp_path / "out.bvh")
    (again,), _ = formats.read(tmp_path / "out.bvh", ReadOptions(unit=0.01))
    assert again.skeleton.names == skeleton.names


@settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    vectors=hnp.arrays(float, (6, 7, 3), elements=st.floats(-8, 8)),
    order=st.sampled_from(ORDERS),
)
def test_any_rotation_survives(tmp_path: Path, vectors: np.ndarray, order: str) -> None:
    take = made(6).with_motion(rotations=rot.from_rotation_vector(vectors))
    formats.write(take, tmp_path / "out.bvh", options=WriteOptions(order=order))
    same(take, formats.read(tmp_path / "out.bvh")[0][0])


@pytest.mark.parametrize("order", ["", "XY", "XYX", "ABC", "xyz"])
def test_orders_that_are_none(order: str) -> None:
    with pytest.raises(ParameterError, match="Euler order"):
        WriteOptions(order=order)
