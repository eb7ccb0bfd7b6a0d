"""`mocapstudio convert` to what other programs take, and from AMC with a named skeleton."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from pygltflib import GLTF2

from mocapstudio import formats

ASF = """:version 1.10
:units
  length 0.45
  angle deg
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    name spine
    direction 0 1 0
    length 9
    axis 0 0 0 XYZ
    dof rx
  end
:hierarchy
  begin
    root spine
  end
"""


def test_bvh_becomes_glb(mocapstudio, figure, tmp_path: Path) -> None:
    source = figure(seconds=1).write(tmp_path / "take.bvh")
    done = mocapstudio("convert", source, tmp_path / "take.glb")
    assert done.returncode == 0, done.stderr
    names = {node.name for node in GLTF2().load(str(tmp_path / "take.glb")).nodes}
    assert names >= set(figure().names)


def test_the_skeleton_of_an_amc_is_named(mocapstudio, tmp_path: Path) -> None:
    for name in ("one.asf", "two.asf"):
        (tmp_path / name).write_text(ASF)
    amc = tmp_path / "07_01.amc"
    amc.write_text(
        ":DEGREES\n" + "".join(f"{n}\nroot 0 17 0 0 {n} 0\nspine 5\n" for n in range(1, 5))
    )
    refused = mocapstudio("convert", amc, tmp_path / "take.bvh")
    assert refused.returncode == 2
    assert "name one of: one.asf, two.asf" in refused.stderr
    done = mocapstudio("convert", amc, tmp_path / "take.bvh", "--asf", tmp_path / "two.asf")
    assert done.returncode == 0, done.stderr
    (take,), _ = formats.read(tmp_path / "take.bvh")
    assert take.skeleton.names == ("root", "spine")
    np.testing.assert_array_equal(take.frames, 4)


def test_a_broken_c3d_is_named_by_its_byte(mocapstudio, tmp_path: Path) -> None:
    path = tmp_path / "take.c3d"
    path.write_bytes(b"\x02\x50" + bytes(600))
    refused = mocapstudio("inspect", path)
    assert refused.returncode == 2
    assert (
        refused.stderr.strip()
        == f"error: {path}: byte 515: unknown processor type 0: 84, 85 or 86 needed"
    )
