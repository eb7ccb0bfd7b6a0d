"""Poses of many frames at once, and how markers move when joints turn or bones grow."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.solving.attachment import Attachment
from mocapstudio.motion.solving.template import Template
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Pose:
    """K frames of a body.

    Attributes
    ----------
    place
        (K, 3) metres: the hips in the world.
    turns
        (K, J, 3, 3) local rotations.
    """

    place: Array
    turns: Array

    def __getitem__(self, frames: slice | NDArray[np.int64]) -> Pose:
        return Pose(self.place[frames], self.turns[frames])


@dataclass(frozen=True, eq=False)
class Body:
    """A template with markers on it and lengths of its own.

    Attributes
    ----------
    template
        The skeleton and how it turns.
    attachment
        M markers.
    scales
        (J,) length of each joint's offset over the template's.
    """

    template: Template
    attachment: Attachment
    scales: Array

    @cached_property
    def offsets(self) -> Array:
        """(J, 3) metres."""
        return np.asarray(self.template.skeleton.offsets * self.scales[:, None])

    @cached_property
    def carries(self) -> Mask:
        """(M, J) True where a joint carries a marker, itself or by a joint below."""
        parents = self.template.skeleton.parents
        result = np.zeros((len(self.attachment.joints), len(parents)), bool)
        for row, joint in enumerate(self.attachment.joints):
            while joint >= 0:
                result[row, joint] = True
                joint = parents[joint]
        return result

    @cached_property
    def freedoms(self) -> NDArray[np.int64]:
        """(D,) the joint of each turn that markers can tell about."""
        above = topology(self.template.skeleton).above_hips
        return np.array(
            [
                joint
                for joint, axes in enumerate(self.template.axes)
                for _ in axes
                if joint not in above and self.carries[:, joint].any()
            ],
            dtype=np.int64,
        )

    def axes(self, pose: Pose) -> Array:
        """(K, D, 3) the axes of these turns in the parents' frames: of a saddle the outer moves."""
        result = np.empty((len(pose.place), len(self.freedoms), 3))
        for joint, span in self.spans.items():
            own = self.template.axes[joint]
            result[:, span] = own
            if len(own) == 2:
                outer = self.template.turned(joint, pose.turns[:, joint])[0]
                result[:, span.stop - 1] = outer @ own[1]
        return result

    @cached_property
    def spans(self) -> dict[int, slice]:
        """Where among the turns each joint's own stand."""
        joints, starts, counts = np.unique(self.freedoms, return_index=True, return_counts=True)
        return {
            int(joint): slice(int(start), int(start + count))
            for joint, start, count in zip(joints, starts, counts, strict=True)
        }

    @cached_property
    def standing(self) -> Array:
        """(J, 3, 3) local rotations of the standing pose."""
        return rot.to_matrix(self.template.standing)

    @cached_property
    def usual(self) -> Array:
        """(J, 3, 3) local rotations near which joints are held where markers leave them open."""
        return rot.to_matrix(self.template.usual)

    def with_offsets(self, offsets: Array, scales: Array) -> Body:
        """Move markers on their joints to `offsets` (M, 3) and give bones other lengths.

        `scales` (J,) are shares of the template's bones.
        """
        attachment = replace(self.attachment, offsets=offsets)
        return Body(self.template, attachment, scales)

    def joints(self, pose: Pose) -> tuple[Array, Array]:
        """Positions (K, J, 3) and world rotations (K, J, 3, 3)."""
        hips = self.template.hips
        above = topology(self.template.skeleton).above_hips
        positions = np.zeros((len(pose.place), len(self.scales), 3))
        world = np.empty_like(pose.turns)
        for joint, parent in enumerate(self.template.skeleton.parents):
            if parent < 0:
                world[:, joint] = pose.turns[:, joint]
                positions[:, joint] = self.offsets[joint]
            else:
                world[:, joint] = world[:, parent] @ pose.turns[:, joint]
                positions[:, joint] = positions[:, parent] + world[:, parent] @ self.offsets[joint]
            if joint == hips:
                positions[:, joint] = pose.place
            elif joint in above:
                positions[:, joint] = self.template.skeleton.rest_positions[joint]
        return positions, world

    def markers(self, positions: Array, world: Array) -> Array:
        """(K, M, 3) metres: where the markers are."""
        joints = self.attachment.joints
        turned = np.einsum("kmab,mb->kma", world[:, joints], self.attachment.offsets)
        return np.asarray(positions[:, joints] + turned)

    def parents_world(self, world: Array) -> Array:
        """(K, J, 3, 3) world rotations of the joints' parents; the identity for the root's."""
        parents = self.template.skeleton.parents
        result = world[:, np.maximum(parents, 0)]
        result[:, parents < 0] = np.eye(3)
        return np.asarray(result)

    def by_turns(self, axes: Array, positions: Array, world: Array, markers: Array) -> Array:
        """(K, 3 M, 3 + D) derivative of the markers by the hips' place and by turns about axes."""
        joints = self.freedoms
        frames, count = markers.shape[:2]
        turning = np.einsum("kdab,kdb->kda", self.parents_world(world)[:, joints], axes)
        # turning x (marker - joint), the part without the marker once for all markers.
        result = np.empty((frames, count, 3, 3 + len(joints)))
        result[..., :3] = np.eye(3)
        arms = markers[:, :, :, None] - np.swapaxes(positions[:, joints], 1, 2)[:, None]
        ax, ay, az = (turning[:, None, :, i] for i in range(3))
        result[:, :, 0, 3:] = ay * arms[:, :, 2] - az * arms[:, :, 1]
        result[:, :, 1, 3:] = az * arms[:, :, 0] - ax * arms[:, :, 2]
        result[:, :, 2, 3:] = ax * arms[:, :, 1] - ay * arms[:, :, 0]
        result[..., 3:] *= self.carries[:, joints][None, :, None]
        return result.reshape(frames, 3 * count, -1)

    def moved(self, pose: Pose, steps: Array) -> Pose:
        """Return the pose (K frames) after steps (K, 3 + D), metres and radians."""
        axes, angles = self.axes(pose), steps[:, 3:, None]
        turns = pose.turns.copy()
        for joint, span in self.spans.items():
            vectors = axes[:, span] * angles[:, span]
            # Of a saddle first the inner axis turns, then the outer: so it stays one.
            parts = vectors[:, ::-1] if vectors.shape[1] == 2 else vectors.sum(1, keepdims=True)
            for part in np.swapaxes(parts, 0, 1):
                turns[:, joint] = rot.to_matrix(rot.from_rotation_vector(part)) @ turns[:, joint]
        return Pose(pose.place + steps[:, :3], turns)
