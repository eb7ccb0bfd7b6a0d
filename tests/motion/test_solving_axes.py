"""Joints that turn about one or two axes only, as their files tell."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from made_markers import markers_on
from test_solving import bones_apart, dancing, person, standing

from mocapstudio import formats
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.solving import solve
from mocapstudio.motion.solving.segments import segments
from mocapstudio.motion.solving.template import Template, template_of
from mocapstudio.motion.take import Take

ELBOW = {"LeftForeArm": [0, -1.0, 0], "RightForeArm": [0, 1.0, 0]}
KNEE = {"LeftLeg": [1.0, 0, 0], "RightLeg": [1.0, 0, 0]}


def built(take: Take) -> Take:
    """The take with hinges for elbows and knees, and saddles for ankles."""
    named = {name: np.array([axis]) for name, axis in (ELBOW | KNEE).items()}
    named |= {f"{side}Foot": np.array([[1.0, 0, 0], [0, 0, 1.0]]) for side in ("Left", "Right")}
    axes = tuple(named.get(name, np.eye(3)) for name in take.skeleton.names)
    return replace(take, skeleton=replace(take.skeleton, axes=axes))


def product(template: Template, joint: int, turns: np.ndarray) -> np.ndarray:
    whole = np.broadcast_to(rot.to_matrix(template.bases[joint]), turns.shape)
    for part in reversed(template.turned(joint, turns)):
        whole = part @ whole
    return whole


def test_amc_turns_about_the_axes_of_its_asf_only(data: Path) -> None:
    (take,), _ = formats.read(
        data / "cmu_same_take_3_formats/02_01.amc", formats.ReadOptions(fps=Fraction(120))
    )
    template = template_of(standing(take.skeleton))
    count = {name: len(a) for name, a in zip(take.skeleton.names, template.axes, strict=True)}
    assert (count["lhipjoint"], count["ltibia"], count["lfoot"], count["lfemur"]) == (0, 1, 2, 3)
    for joint, axes in enumerate(template.axes):
        if len(axes) < 3:
            turns = rot.to_matrix(take.rotations[:, joint])
            np.testing.assert_allclose(product(template, joint, turns), turns, atol=1e-9)


def test_bvh_turns_about_its_channels(tmp_path: Path) -> None:
    lines = ["HIERARCHY", "ROOT hips", "{", "OFFSET 0 0 0"]
    lines += ["CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"]
    for channels in (
        "2 Zrotation Xrotation",
        "1 Yrotation",
        "0",
        "3 Xrotation Yrotation Xrotation",
    ):
        lines += [f"JOINT j{channels[0]}", "{", "OFFSET 0 1 0", f"CHANNELS {channels}"]
    lines += ["}"] * 5 + ["MOTION", "Frames: 1", "Frame Time: 0.01", " ".join("0" * 12)]
    path = tmp_path / "few.bvh"
    path.write_text("\n".join(lines) + "\n")
    (take,), _ = formats.read(path)
    assert take.skeleton.axes is not None
    z, x, y = np.eye(3)[[2, 0, 1]]
    for joint, axes in enumerate(([z, x], [y], [], np.eye(3)), 1):
        np.testing.assert_array_equal(take.skeleton.axes[joint], np.reshape(axes, (-1, 3)))


@pytest.fixture(scope="module")
def solved_and_truth() -> tuple[Take, Take]:
    truth = dancing(person())
    template = built(standing(truth.skeleton))
    return solve(markers_on(truth).take, template).take, truth


def test_hinges_and_saddles_stay_so(solved_and_truth: tuple[Take, Take]) -> None:
    solved, truth = solved_and_truth
    template = template_of(built(standing(truth.skeleton)))
    for joint, axes in enumerate(template.axes):
        if len(axes) < 3:
            turns = rot.to_matrix(solved.rotations[:, joint])
            np.testing.assert_allclose(product(template, joint, turns), turns, atol=1e-9)


def test_hinges_tell_how_the_bones_above_are_twisted(
    solved_and_truth: tuple[Take, Take],
) -> None:
    solved, truth = solved_and_truth
    apart = np.degrees(rot.angle(take_pose(solved)[1], take_pose(truth)[1]))
    for name in ("LeftArm", "RightArm", "LeftUpLeg", "RightUpLeg"):
        assert np.median(apart[:, truth.skeleton.index[name]]) < 8, name
    assert max(bones_apart(truth, solved).values()) < 10


def test_elbows_and_knees_bend_one_way(data: Path) -> None:
    """Arms folded before the chest leave no bend the other way that markers would not see."""
    (markers,), _ = formats.read_any(data / "cmu_martial_arts_c3d/135_02.c3d")
    (joints,), _ = formats.read(data / "cmu_same_take_3_formats/02_01.amc")
    assert isinstance(markers, MarkerTake)
    part = replace(markers, positions=markers.positions[900:1900:10], filled=None, events=())
    result = solve(part, standing(joints.skeleton))
    template = template_of(standing(joints.skeleton))
    names = {joints.skeleton.names[j] for j in template.bends}
    assert names == {"ltibia", "rtibia", "lradius", "rradius"}
    for joint, (sign, _) in template.bends.items():
        bend = np.degrees(
            sign * template.angle(joint, rot.to_matrix(result.take.rotations[:, joint]))
        )
        assert bend.min() > -20
        assert bend.max() > 60
    assert result.mean < 0.01


def test_limbs_are_told_whatever_comes_after_the_wrist(data: Path) -> None:
    (take,), _ = formats.read(data / "cmu_same_take_3_formats/02_01.bvh")
    names = take.skeleton.names
    parts = segments(take.skeleton, template_of(take).standing_pose[0], {})
    told = [names[parts[f"left {p}"].joint] for p in ("clavicle", "upper arm", "forearm", "hand")]
    assert told == ["LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand"]
