"""Bones and balls lie where the skeleton's joints are, whatever the skeleton."""

from __future__ import annotations

import numpy as np
import pytest
from plot_scene import skeleton as humanoid
from plot_scene import walking

from mocapstudio.formats import read
from mocapstudio.gui.viewport.shaping import build_figure, stature
from mocapstudio.gui.viewport.solids import COARSE, FINE, sphere
from mocapstudio.gui.viewport.world import WorldMotion
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.topology import topology

FOLDERS = (
    "cmu_salsa_pairs_bvh",
    "cmu_locomotion_bvh",
    "bandai_2_normal_bvh_CCBYNC4",
    "karate_rmocap_GPL3",
    "rokoko_animated_drawings_bvh_MIT",
)


@pytest.fixture(params=FOLDERS)
def motion(request, data):
    return WorldMotion(read(sorted((data / request.param).glob("*.bvh"))[0])[0][0])


@pytest.mark.parametrize("detail", [FINE, COARSE])
def test_corners_hug_their_bones_and_normals_are_unit(motion, detail):
    skeleton = motion.take.skeleton
    figure = build_figure(skeleton, motion.points(0), detail)
    points = motion.points(motion.take.frames // 2)
    corners, normals = figure.pose(points)
    assert corners.shape == normals.shape == (figure.corners, 3)
    assert np.linalg.norm(normals, axis=1) == pytest.approx(1, abs=1e-4)
    assert figure.triangles.min() == 0
    assert figure.triangles.max() == figure.corners - 1
    balls = len(figure.balls) * len(sphere(detail.sphere)[0])
    places = figure.places(points)
    bones = corners[balls:].reshape(len(figure.starts), -1, detail.sides, 3)
    # Seen from outside, triangles turn counter-clockwise: the others are not drawn.
    a, b, c = (corners[figure.triangles[:, k]] for k in range(3))
    facing = np.sum(np.cross(b - a, c - a) * normals[figure.triangles].sum(axis=1), axis=1)
    assert (facing >= -1e-9).all()
    # The mean of each ring lies on the bone's line, each corner at the ring's radius from it.
    along = places[figure.ends] - places[figure.starts]
    middle = places[figure.starts][:, None] + figure.ring_place[..., None] * along[:, None]
    assert bones.mean(axis=2) == pytest.approx(middle, abs=1e-4)
    apart = np.linalg.norm(bones - middle[:, :, None], axis=3)
    assert apart == pytest.approx(np.broadcast_to(figure.rings[..., None], apart.shape), abs=1e-4)


def test_every_joint_of_the_body_is_drawn_and_nothing_above_the_hips(motion):
    skeleton = motion.take.skeleton
    points = motion.points(0)
    figure = build_figure(skeleton, points, FINE)
    above = topology(skeleton).above_hips
    assert not above & set(figure.balls.tolist())
    assert not above & set(figure.starts.tolist())
    shown = points[figure.balls]
    for joint in set(range(len(skeleton))) - above:
        apart = np.linalg.norm(shown - points[joint], axis=1).min()
        assert apart < 1e-3 * stature(skeleton, points)


def test_the_size_of_a_performer_does_not_depend_on_the_pose(motion):
    skeleton = motion.take.skeleton
    sizes = [stature(skeleton, motion.points(f)) for f in range(0, motion.take.frames, 50)]
    assert np.ptp(sizes) < 0.02 * sizes[0]


def test_people_are_of_the_height_of_people():
    points = WorldMotion(walking(4)).points(0)
    assert 1.3 < stature(humanoid(), points) < 2.1


def test_bones_without_length_are_left_out():
    bones = Skeleton(
        names=("a", "b", "c"),
        parents=np.array([-1, 0, 1]),
        offsets=np.array([[0, 1.0, 0], [0, 0, 0], [0, 1.0, 0]]),
        end_parents=np.array([2]),
        end_offsets=np.zeros((1, 3)),
    )
    points = np.array([[0, 1, 0], [0, 1, 0], [0, 2, 0], [0, 2, 0]], np.float32)
    figure = build_figure(bones, points, FINE)
    assert list(zip(figure.starts, figure.ends, strict=True)) == [(1, 2)]
    corners, normals = figure.pose(np.zeros((4, 3), np.float32))
    assert np.isfinite(corners).all()
    assert np.isfinite(normals).all()


def test_swell_hides_what_it_shrinks_to_nothing():
    motion = WorldMotion(walking(4))
    figure = build_figure(motion.take.skeleton, motion.points(0), COARSE)
    points = motion.points(1)
    swell = np.zeros(len(points), np.float32)
    corners, _ = figure.pose(points, swell=swell)
    triangles = corners[figure.triangles]
    sides = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    assert np.abs(sides).max() < 1e-9
    hand = motion.take.skeleton.index["LeftHand"]
    swell[hand] = 1
    shown, _ = figure.pose(points, swell=swell)
    far = np.linalg.norm(shown - corners, axis=1) > 1e-6
    near = np.linalg.norm(shown[far] - points[hand], axis=1)
    assert far.any()
    assert near.max() < 0.4


def test_a_bone_takes_its_colour_from_the_joint_that_turns_it():
    motion = WorldMotion(walking(4))
    skeleton = motion.take.skeleton
    figure = build_figure(skeleton, motion.points(0), FINE)
    colours = np.full((len(motion.points(0)), 3), 100, np.uint8)
    colours[skeleton.index["LeftForeArm"]] = 200
    painted = figure.colour(colours)
    balls = len(figure.balls) * len(sphere(FINE.sphere)[0])
    rings = painted[balls:].reshape(len(figure.starts), -1, FINE.sides, 3)[:, :, 0, 0]
    bone = list(figure.starts).index(skeleton.index["LeftForeArm"])
    assert rings[bone, 0] == 200
    assert rings[bone, -1] == 100
    assert (np.diff(rings[bone].astype(int)) <= 0).all()


def test_a_head_with_eyes_is_one_bone_in_the_colour_of_the_head(data):
    path = data / "cmu_salsa_pairs_bvh" / "60_10_scaled.bvh"
    motion = WorldMotion(read(path)[0][0])
    skeleton, points = motion.take.skeleton, motion.points(0)
    figure = build_figure(skeleton, points, FINE)
    head, eye = skeleton.index["head"], skeleton.index["leftEye"]
    assert eye not in figure.ends
    (skull,) = np.flatnonzero(figure.starts == head)
    between = points[[eye, skeleton.index["rightEye"]]].mean(axis=0)
    assert figure.places(points)[figure.ends[skull]] == pytest.approx(between)
    colours = np.zeros((len(points), 3), np.uint8)
    colours[head] = 150
    balls = len(figure.balls) * len(sphere(FINE.sphere)[0])
    rings = figure.colour(colours)[balls:].reshape(len(figure.starts), -1, 3)
    assert (rings[skull] == 150).all()


@pytest.mark.parametrize("folder", ["bandai_2_normal_bvh_CCBYNC4", "cmu_locomotion_bvh"])
def test_every_head_is_wider_than_the_neck_and_beyond_it(data, folder):
    motion = WorldMotion(read(sorted((data / folder).glob("*.bvh"))[0])[0][0])
    skeleton, points = motion.take.skeleton, motion.points(0)
    figure = build_figure(skeleton, points, FINE)
    widest = int(np.argmax(figure.rings.max(axis=1)))
    crown = figure.pose(points)[0][:, 1].max()
    assert (
        "head"
        in skeleton.names[figure.starts[widest]].lower()
        + skeleton.names[min(figure.ends[widest], len(skeleton) - 1)].lower()
    )
    assert crown > points[:, 1].max() + 0.01
