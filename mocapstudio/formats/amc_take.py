"""From Acclaim's bones and channels to a skeleton whose rest pose has no rotations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.asf_read import Asf, Bone
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.skeleton import Skeleton

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Layout:
    """How the values of an AMC move a skeleton.

    Attributes
    ----------
    bones
        One a joint of the skeleton, in its order.
    skeleton
        Joints at the starts of the bones, in the file's unit and axes.
    axes
        (J, 4) each bone's own frame at rest, in the world.
    translated
        The root, and bones with translation channels.
    to_radians
        Radians per unit of the rotation channels.
    """

    bones: tuple[Bone, ...]
    skeleton: Skeleton
    axes: Array
    translated: tuple[int, ...]
    to_radians: float


def lay_out(asf: Asf, *, radians: bool, axes_in_radians: bool) -> Layout:
    """Place joints at the starts of the bones, and tips where bones without children end.

    The directions of bones are given in the world at rest, where no joint is rotated, so a
    joint's offset is its parent's bone.
    """
    bones, parents = asf.bones, np.array(asf.parents, dtype=np.int64)
    vectors = np.array([bone.vector for bone in bones])
    offsets = vectors[np.maximum(parents, 0)]
    offsets[0] = bones[0].base
    tips = np.setdiff1d(np.arange(1, len(bones)), parents).astype(np.int64)
    names = tuple(bone.name for bone in bones)
    turned = np.array([bone.axis for bone in bones])
    frames = np.array(
        [
            _turns(bone.order, "XYZ", axis if axes_in_radians else np.radians(axis))
            for bone, axis in zip(bones, turned, strict=True)
        ]
    )
    axes = tuple(_axes(bone, frame) for bone, frame in zip(bones, frames, strict=True))
    return Layout(
        bones,
        Skeleton(names, parents, offsets, tips, vectors[tips], axes),
        frames,
        tuple(j for j, bone in enumerate(bones) if j == 0 or _moves(bone)),
        1.0 if radians else float(np.pi / 180),
    )


def motion(layout: Layout, values: dict[str, Array]) -> tuple[Array, Array]:
    """Rotations (F, J, 4) and translations (F, T, 3), in units and axes of the file.

    A bone turns within its own frame C, and all frames of the skeleton are the world's at rest,
    so its local rotation is ``C R C^-1`` and its displacement ``C t``.
    """
    frames = len(next(iter(values.values())))
    rotations = np.tile(rot.IDENTITY, (frames, len(layout.bones), 1))
    for j, bone in enumerate(layout.bones):
        letters = "".join(channel[1].upper() for channel in bone.dof if channel[0] == "r")
        if letters:
            columns = [c for c, channel in enumerate(bone.dof) if channel[0] == "r"]
            own = _turns(bone.order, letters, values[bone.name][:, columns] * layout.to_radians)
            axis = layout.axes[j]
            local = rot.multiply(rot.multiply(axis, own), rot.conjugate(axis))
            rotations[:, j] = rot.continuous(local)
    translations = np.empty((frames, len(layout.translated), 3))
    for t, j in enumerate(layout.translated):
        bone = layout.bones[j]
        moved = np.zeros((frames, 3))
        for c, channel in enumerate(bone.dof):
            if channel[0] == "t":
                moved[:, "xyz".index(channel[1])] = values[bone.name][:, c]
        # The root's position is given in the world, a bone's in its own frame.
        if j:
            moved = rot.rotate(layout.axes[j], moved)
        translations[:, t] = layout.skeleton.offsets[j] + moved
    return rotations, translations


def _axes(bone: Bone, frame: Array) -> Array:
    """The (d, 3) axes that a bone turns about, outermost first."""
    turning = [letter for letter in reversed(bone.order) if f"r{letter.lower()}" in bone.dof]
    return np.asarray(rot.to_matrix(frame).T[["XYZ".index(letter) for letter in turning]])


def _moves(bone: Bone) -> bool:
    return any(channel[0] == "t" for channel in bone.dof)


def _turns(order: str, letters: str, angles: Array) -> Array:
    """Quaternion of angles (..., len(letters)), turned in `order`, the first letter first."""
    present = [letter for letter in reversed(order) if letter in letters]
    columns = [letters.index(letter) for letter in present]
    return rot.from_euler("".join(present), angles[..., columns])
