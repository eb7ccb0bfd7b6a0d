"""Topology and facing of every BVH dialect among the real takes."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest

from mocapstudio import formats
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import body_frame, split_heading
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import side_of, topology

DIALECTS = [
    "bandai_1_styles_bvh_CCBYNC4",
    "bandai_2_normal_bvh_CCBYNC4",
    "cmu_salsa_pairs_bvh",
    "cmu_locomotion_bvh",
    "cmu_dance_bvh",
    "cmu_same_take_3_formats",
    "karate_rmocap_GPL3",
    "rokoko_animated_drawings_bvh_MIT",
]


@lru_cache
def takes(folder: Path) -> tuple[Take, ...]:
    """One take of every skeleton that the folder holds, among its first files."""
    seen: dict[tuple[str, ...], Take] = {}
    for path in sorted(folder.rglob("*.bvh"))[:8]:
        for take in formats.read(path)[0]:
            seen.setdefault(take.skeleton.names, take)
    return tuple(seen.values())


def names(skeleton: Skeleton, joints: frozenset[int] | tuple[int, ...]) -> set[str]:
    return {skeleton.names[j] for j in joints}


@pytest.mark.parametrize("dialect", DIALECTS)
def test_limbs_partition_the_joints_of_a_person(data: Path, dialect: str) -> None:
    found = takes(data / dialect)
    assert found
    for take in found:
        parts, skeleton = topology(take.skeleton), take.skeleton
        assert sorted(j for limb in parts.limbs for j in limb.joints) == list(range(len(skeleton)))
        limbs = {limb.name for limb in parts.limbs}
        assert limbs == {"spine", "head", "left arm", "right arm", "left leg", "right leg"}
        np.testing.assert_array_equal(parts.mirror[parts.mirror], np.arange(len(skeleton)))
        for joint, other in enumerate(parts.mirror):
            sides = [side_of(skeleton.names[joint]), side_of(skeleton.names[other])]
            assert joint == other or sides[0] != sides[1] or sides[0] == ""
        for limb in parts.limbs:
            sides = {side_of(skeleton.names[j]) for j in limb.joints} - {""}
            if limb.name.startswith(("left", "right")):
                assert sides <= {limb.name.split()[0]}
        body = names(skeleton, parts.body_joints())
        assert not any("finger" in n.lower() or "thumb" in n.lower() for n in body)
        assert 15 <= len(body) <= 31


@pytest.mark.parametrize("dialect", DIALECTS)
def test_the_body_frame_stands_up_and_looks_ahead(data: Path, dialect: str) -> None:
    for take in takes(data / dialect):
        frame = body_frame(take.skeleton)
        assert np.linalg.norm(frame) == pytest.approx(1.0)
        heading, tilt = split_heading(take)
        np.testing.assert_allclose(rot.twist_angle(rot.multiply(tilt, frame), 1), 0.0, atol=1e-9)
        # With the heading taken off the left hip is at +X; some time or other the body is upright.
        positions, world = take_pose(take)
        parts = topology(take.skeleton)
        bones = np.linalg.norm(take.skeleton.offsets, axis=1)
        hip = {limb.name: next(j for j in limb.joints if bones[j] > 1e-6) for limb in parts.limbs}
        across = positions[:, hip["left leg"]] - positions[:, hip["right leg"]]
        turned = rot.rotate(rot.about_axis(1, -heading), across)
        assert np.median(turned[:, 0] / np.linalg.norm(across, axis=1)) > 0.8
        above = np.broadcast_to([0.0, 1.0, 0.0], (len(world), 3))
        up = rot.rotate(rot.multiply(world[:, parts.hips], frame), above)
        assert np.quantile(up[:, 1], 0.9) > 0.8
