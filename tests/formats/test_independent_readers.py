"""Joints and markers are where independent readers have them, on real files of every folder.

The smallest file of each folder by default; all of them with MOCAPSTUDIO_ALL_TAKES=1.
"""

from __future__ import annotations

import os
from pathlib import Path

import ezc3d
import numpy as np
import pytest

from mocapstudio.formats import ReadOptions, read, read_any
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.markers import MarkerTake

EVERYTHING = bool(os.environ.get("MOCAPSTUDIO_ALL_TAKES"))
DATA = Path(__file__).resolve().parents[3] / "shared" / "data"
SMALL = 2_000_000
SHARE = 1e-4
HEIGHT = 1.7


def takes(suffix: str) -> list[Path]:
    found: list[Path] = []
    for folder in sorted(path for path in DATA.glob("*") if path.is_dir()):
        inside = sorted(folder.rglob(f"*{suffix}"), key=lambda path: path.stat().st_size)
        found += inside if EVERYTHING else [p for p in inside[:1] if p.stat().st_size < SMALL]
    return found


def theirs(path: Path, frames: list[int]) -> tuple[list[str], np.ndarray]:
    """Names and (F, J, 3) places of joints by bvhio, in the file's units and axes."""
    bvhio = pytest.importorskip("bvhio")
    root = bvhio.readAsHierarchy(str(path))
    names, places = [], []
    for frame in frames:
        root.loadPose(frame)
        joints = [joint for joint, _, _ in root.layout()]
        names = [joint.Name for joint in joints]
        places.append([list(joint.PositionWorld) for joint in joints])
    return names, np.array(places)


@pytest.mark.parametrize("path", takes(".bvh"), ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_bvh(path: Path) -> None:
    (take,), _ = read(path, ReadOptions(unit=1.0, up="y", trim_start=False))
    frames = sorted({0, 1, take.frames // 3, take.frames // 2, take.frames - 1})
    names, places = theirs(path, frames)
    ours = take_pose(take)[0][frames]
    assert names == list(take.skeleton.names)
    height = np.ptp(take.skeleton.rest_positions, axis=0).max()
    assert np.linalg.norm(ours - places, axis=-1).max() < SHARE * height


@pytest.mark.parametrize("path", takes(".c3d"), ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_c3d(path: Path) -> None:
    try:
        found, _ = read_any(path)
    except FileError:
        # What we refuse they refuse.
        with pytest.raises(OSError, match="format is not standard"):
            ezc3d.c3d(str(path))
        return
    points = ezc3d.c3d(str(path))["data"]["points"][:3].transpose(2, 1, 0)
    for take in found:
        assert isinstance(take, MarkerTake)
        assert take.source is not None
        metres = points[:, take.source.record.points] * take.source.unit
        places = rot.rotate(take.source.to_inside, metres)
        np.testing.assert_array_equal(np.isnan(places).any(axis=2), take.missing)
        assert np.nanmax(np.linalg.norm(places - take.positions, axis=-1)) < SHARE * HEIGHT
