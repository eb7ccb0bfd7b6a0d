"""What is written as glTF 2.0 moves as the take does, as told from the bytes by other means."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from made_takes import below_a_reference, walking
from pygltflib import GLTF2
from scipy.spatial.transform import Rotation

from mocapstudio.formats import WriteOptions, read, read_any, write
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import FileError, ParameterError
from mocapstudio.motion.kinematics import end_positions, take_pose
from mocapstudio.motion.take import Take


def accessor(gltf: GLTF2, index: int) -> np.ndarray:
    """The numbers of an accessor, found as the format's specification has it."""
    one = gltf.accessors[index]
    view = gltf.bufferViews[one.bufferView]
    blob = (
        gltf.get_data_from_buffer_uri(gltf.buffers[0].uri)
        if gltf.buffers[0].uri
        else gltf.binary_blob()
    )
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[one.type]
    assert one.componentType == 5126
    values = np.frombuffer(blob, "<f4", one.count * width, view.byteOffset + (one.byteOffset or 0))
    return values.reshape(one.count, width).astype(float)


def world(gltf: GLTF2) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Times, and (F, 4, 4) world matrices of every node by name."""
    (animation,) = gltf.animations
    times = accessor(gltf, animation.samplers[0].input)[:, 0]
    local: dict[int, dict[str, Any]] = {
        i: {
            "translation": np.array(node.translation or [0, 0, 0], float),
            "rotation": np.array([0, 0, 0, 1.0]),
        }
        for i, node in enumerate(gltf.nodes)
    }
    for channel in animation.channels:
        sampler = animation.samplers[channel.sampler]
        assert sampler.interpolation == "LINEAR"
        local[channel.target.node][channel.target.path] = accessor(gltf, sampler.output)
    found: dict[str, np.ndarray] = {}

    def descend(index: int, above: np.ndarray) -> None:
        matrix = np.tile(np.eye(4), (len(times), 1, 1))
        quaternion = np.broadcast_to(local[index]["rotation"], (len(times), 4))
        matrix[:, :3, :3] = Rotation.from_quat(quaternion).as_matrix()
        matrix[:, :3, 3] = local[index]["translation"]
        found[gltf.nodes[index].name] = above @ matrix
        for child in gltf.nodes[index].children or []:
            descend(child, above @ matrix)

    for root in gltf.scenes[gltf.scene].nodes:
        descend(root, np.eye(4))
    return times, found


def takes() -> list[Take]:
    walk = walking(seconds=1.0)
    return [walk, below_a_reference(walk, rot.about_axis(0, np.array(-0.7)))]


@pytest.mark.parametrize("suffix", [".glb", ".gltf"])
@pytest.mark.parametrize("take", takes(), ids=["one root", "two moving joints"])
def test_joints_are_where_the_take_has_them(tmp_path: Path, take: Take, suffix: str) -> None:
    path = tmp_path / f"take{suffix}"
    write(take, path)
    times, found = world(GLTF2().load(str(path)))
    np.testing.assert_allclose(times, np.arange(take.frames) / float(take.rate), atol=1e-6)
    positions, rotations = take_pose(take)
    for j, name in enumerate(take.skeleton.names):
        np.testing.assert_allclose(found[name][:, :3, 3], positions[:, j], atol=1e-5)
    tips = end_positions(take.skeleton, positions, rotations)
    for e, parent in enumerate(take.skeleton.end_parents):
        name = f"{take.skeleton.names[parent]}_end"
        np.testing.assert_allclose(found[name][:, :3, 3], tips[:, e], atol=1e-5)


def test_a_real_take_within_a_ten_thousandth_of_the_body(data: Path, tmp_path: Path) -> None:
    (take,), _ = read(data / "cmu_same_take_3_formats" / "02_01.bvh")
    write(take, tmp_path / "take.glb")
    _, found = world(GLTF2().load(str(tmp_path / "take.glb")))
    positions, _ = take_pose(take)
    written = np.stack([found[name][:, :3, 3] for name in take.skeleton.names], axis=1)
    assert np.linalg.norm(written - positions, axis=-1).max() < 1e-4 * 1.7


def test_the_skin_binds_to_the_rest_pose(tmp_path: Path) -> None:
    take = walking(seconds=0.2)
    write(take, tmp_path / "take.glb")
    gltf = GLTF2().load(str(tmp_path / "take.glb"))
    (skin,) = gltf.skins
    inverse = accessor(gltf, skin.inverseBindMatrices).reshape(-1, 4, 4).transpose(0, 2, 1)
    names = [gltf.nodes[index].name for index in skin.joints]
    for j, name in enumerate(take.skeleton.names):
        at = inverse[names.index(name)] @ [*take.skeleton.rest_positions[j], 1.0]
        np.testing.assert_allclose(at, [0, 0, 0, 1], atol=1e-6)


def test_trim_is_kept_if_asked_for(tmp_path: Path) -> None:
    take = replace(walking(seconds=1.0), trim=(5, 15))
    write(take, tmp_path / "take.glb", options=WriteOptions(trim=True))
    times, found = world(GLTF2().load(str(tmp_path / "take.glb")))
    assert (times[0], len(times)) == (0.0, 10)
    hips = found["Hips"][:, :3, 3]
    np.testing.assert_allclose(hips, take_pose(take)[0][5:15, 0], atol=1e-5)


def test_the_text_says_what_the_format_asks_for(tmp_path: Path) -> None:
    write(walking(seconds=0.2), tmp_path / "take.gltf")
    text = json.loads((tmp_path / "take.gltf").read_text())
    assert text["asset"]["version"] == "2.0"
    assert text["extras"] == {"fps": 30.0}
    # Empty lists are not allowed, and neither is a time without its bounds.
    assert all(node.get("children", [0]) for node in text["nodes"])
    times = text["accessors"][text["animations"][0]["samplers"][0]["input"]]
    np.testing.assert_allclose(times["max"], [5 / 30], rtol=1e-6)
    assert all(view["byteOffset"] % 4 == 0 for view in text["bufferViews"])
    assert "null" not in (tmp_path / "take.gltf").read_text()


@pytest.mark.parametrize("option", [{"unit": 0.01}, {"up": "z"}, {"order": "ZXY"}, {"channels": 6}])
def test_what_gltf_cannot_be_is_refused(tmp_path: Path, option: dict[str, Any]) -> None:
    with pytest.raises(ParameterError, match="glTF"):
        write(walking(seconds=0.2), tmp_path / "take.glb", options=WriteOptions(**option))
    assert not (tmp_path / "take.glb").exists()


def test_gltf_is_not_read(tmp_path: Path) -> None:
    write(walking(seconds=0.2), tmp_path / "take.glb")
    with pytest.raises(FileError, match=r"\.glb is written only"):
        read_any(tmp_path / "take.glb")
    (tmp_path / "take.glb").rename(tmp_path / "take")
    with pytest.raises(FileError, match=r"\.glb is written only"):
        read_any(tmp_path / "take")
