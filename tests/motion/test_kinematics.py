"""Forward kinematics against a recursion that follows the definition."""

from __future__ import annotations

import numpy as np
import pytest
from made_takes import chain, horse, person, walking
from scipy.spatial.transform import Rotation

from mocapstudio.motion.kinematics import end_positions, global_pose, take_pose
from mocapstudio.motion.skeleton import Skeleton


def place(
    skeleton: Skeleton,
    rotations: np.ndarray,
    translations: dict[int, np.ndarray],
    joint: int,
) -> tuple[np.ndarray, Rotation]:
    """Position and world rotation of one joint in one frame, parent by parent."""
    offset = translations.get(joint, skeleton.offsets[joint])
    own = Rotation.from_quat(rotations[joint])
    parent = int(skeleton.parents[joint])
    if parent < 0:
        return offset, own
    position, world = place(skeleton, rotations, translations, parent)
    return position + world.apply(offset), world * own


@pytest.mark.parametrize("skeleton", [person(fingers=True), horse(), chain(), chain(1)])
@pytest.mark.parametrize("more", [(), (-1,)])
def test_every_joint_is_where_its_parents_put_it(skeleton: Skeleton, more: tuple[int, ...]) -> None:
    rng = np.random.default_rng(0)
    frames, joints = 4, len(skeleton)
    translated = tuple(dict.fromkeys([0, *(j % joints for j in more)]))
    rotations = Rotation.random(frames * joints, rng=1).as_quat().reshape(frames, joints, 4)
    translations = rng.normal(size=(frames, len(translated), 3))
    positions, world = global_pose(skeleton, rotations, translations, translated)
    tips = end_positions(skeleton, positions, world)
    for frame in range(frames):
        local = dict(zip(translated, translations[frame], strict=True))
        for joint in range(joints):
            position, turned = place(skeleton, rotations[frame], local, joint)
            np.testing.assert_allclose(positions[frame, joint], position, atol=1e-12)
            matrix = Rotation.from_quat(world[frame, joint]).as_matrix()
            np.testing.assert_allclose(matrix, turned.as_matrix(), atol=1e-12)
        for tip, parent in enumerate(skeleton.end_parents):
            position, turned = place(skeleton, rotations[frame], local, int(parent))
            expected = position + turned.apply(skeleton.end_offsets[tip])
            np.testing.assert_allclose(tips[frame, tip], expected, atol=1e-12)


def test_bones_keep_their_lengths() -> None:
    take = walking(1.0)
    positions, _ = take_pose(take)
    lengths = np.linalg.norm(take.skeleton.offsets, axis=1)
    for joint in range(1, len(take.skeleton)):
        bone = positions[:, joint] - positions[:, take.skeleton.parents[joint]]
        np.testing.assert_allclose(np.linalg.norm(bone, axis=1), lengths[joint], atol=1e-12)


def test_a_span_of_a_take_is_a_piece_of_the_whole() -> None:
    take = walking(1.0)
    whole, part = take_pose(take), take_pose(take, 7, 12)
    for all_of_it, piece in zip(whole, part, strict=True):
        np.testing.assert_array_equal(piece, all_of_it[7:12])


def test_the_rest_pose_has_no_rotations() -> None:
    skeleton = person()
    still = np.broadcast_to([0.0, 0.0, 0.0, 1.0], (1, len(skeleton), 4))
    positions, _ = global_pose(skeleton, still, np.zeros((1, 1, 3)))
    np.testing.assert_allclose(positions[0], skeleton.rest_positions, atol=1e-15)
