"""One take as BVH, as AMC and as C3D: the same places, after the transforms its folder states."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from test_asf_amc import BONE_ENDS, NAMESAKES

from mocapstudio.formats import ReadOptions, read, read_any
from mocapstudio.formats.c3d_points import read_points
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take

METRES = 0.015
TAKES = ["05_13", "02_01"]


def read_three(data: Path, name: str) -> tuple[Take, Take, MarkerTake]:
    """BVH, AMC and C3D; 56.444 mm a unit in the first two, of which the BVH has a row more."""
    folder = data / "cmu_same_take_3_formats"
    (bvh,), _ = read(folder / f"{name}.bvh", ReadOptions(unit=0.0254 / 0.45))
    (amc,), _ = read(folder / f"{name}.amc")
    (c3d,), _ = read_any(folder / f"{name}.c3d")
    assert isinstance(c3d, MarkerTake)
    assert bvh.frames - 1 == amc.frames == c3d.frames
    assert bvh.rate == amc.rate == c3d.rate == 120
    return bvh, amc, c3d


def to_bvh_axes(places: np.ndarray) -> np.ndarray:
    """C3D's (x, y, z) are BVH's (z, x, y); with Y up that leaves a quarter turn about it."""
    return np.stack([-places[..., 2], places[..., 1], places[..., 0]], axis=-1)


@pytest.mark.parametrize("name", TAKES)
def test_bvh_and_amc_have_the_same_joints(data: Path, name: str) -> None:
    bvh, amc, _ = read_three(data, name)
    of_bvh = take_pose(bvh)[0][1:, [bvh.skeleton.index[n] for n in NAMESAKES.values()]]
    places, world = take_pose(amc)
    of_amc = places[:, [amc.skeleton.index[n] for n in NAMESAKES]]
    # The BVH hangs neck and shoulders on the start of the ASF's thorax instead of on its end: it
    # lacks that bone, which turns with the thorax.
    index = amc.skeleton.index
    thorax = rot.rotate(world[:, index["thorax"]], amc.skeleton.offsets[index["lowerneck"]])
    upper = [index["thorax"] in amc.skeleton.ancestors(index[n]) for n in NAMESAKES]
    assert sum(upper) == 11
    of_amc[:, upper] -= thorax[:, None]
    assert np.linalg.norm(of_bvh - of_amc, axis=-1).max() < 0.001


def test_amc_and_c3d_have_the_same_bone_ends(data: Path) -> None:
    """The C3D of 05_13 holds, beside the markers, where the model's bones end."""
    _, amc, c3d = read_three(data, "05_13")
    assert c3d.source is not None
    record = c3d.source.record
    labels = [label.rpartition(":")[2] for label in record.parameters.texts("POINT", "LABELS")]
    which = [labels.index(label) for label in BONE_ENDS]
    points = read_points(record.data, record.layout)
    units = np.full(len(which), c3d.source.unit)
    of_c3d = to_bvh_axes(points.positions(np.array(which), units, c3d.source.to_inside))
    of_amc = take_pose(amc)[0][:, [amc.skeleton.index[n] for n in BONE_ENDS.values()]]
    assert np.linalg.norm(of_amc - of_c3d, axis=-1).max() < METRES


def test_markers_ride_on_the_bones(data: Path) -> None:
    """Where a marker sits on its bone is fitted in one half of 02_01; it sits there in the other.

    Skin moves on bones, so single samples are farther off, but axes, units or frames that do not
    agree would be off by decimetres.
    """
    _, amc, c3d = read_three(data, "02_01")
    markers = to_bvh_axes(c3d.positions)
    places, world = take_pose(amc)
    half = amc.frames // 2
    own = rot.rotate(rot.conjugate(world)[:, :, None], markers[:, None] - places[:, :, None])
    seat = own[:half].mean(axis=0)
    off = np.linalg.norm(own - seat, axis=-1)
    bone = off[:half].mean(axis=0).argmin(axis=0)
    unseen = np.take_along_axis(off[half:], bone[None, None], axis=1)[:, 0]
    assert np.median(unseen) < METRES
    assert np.quantile(unseen, 0.95) < 2 * METRES
    # A marker stays with its own side and limb.
    seats = {
        c3d.labels[m].rpartition(":")[2]: amc.skeleton.names[bone[m]] for m in range(len(bone))
    }
    assert seats["LTOE"] in ("lfoot", "ltoes")
    assert seats["RHEE"] in ("rfoot", "rtoes")
    assert seats["LKNE"] in ("lfemur", "ltibia")
    assert seats["RUPA"] == "rhumerus"
