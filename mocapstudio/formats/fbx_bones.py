"""From the matrices of bones, at rest and in time, to a skeleton and its local rotations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.guesses import turn_to_y_up
from mocapstudio.formats.report import Problem
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.skeleton import Skeleton

Array = NDArray[np.float64]

# What single precision leaves of a bone that keeps its length, as a share of the body's size.
_STILL = 1e-4
# How Blender names the bones that it adds for tips.
_TIP = "_end"


@dataclass(frozen=True, eq=False)
class Bones:
    """Bones of one skeleton, Z up.

    Attributes
    ----------
    names
        One a bone.
    parents
        (B,) -1 for roots.
    rest
        (B, 4, 4) in the world, at rest.
    world
        (F, B, 4, 4) in the world.
    """

    names: tuple[str, ...]
    parents: NDArray[np.int64]
    rest: Array
    world: Array

    @property
    def tips(self) -> NDArray[np.bool_]:
        """(B,) True for bones that only mark where their parent ends."""
        childless = ~np.isin(np.arange(len(self.names)), self.parents)
        named = [
            name.endswith(_TIP)
            and name[: -len(_TIP)] == (self.names[parent] if parent >= 0 else "")
            for name, parent in zip(self.names, self.parents, strict=True)
        ]
        return np.asarray(childless & np.array(named, dtype=bool))

    def skeleton(self) -> Skeleton:
        """Joints at the heads of the bones, Y up, in the unit of the matrices."""
        places = rot.rotate(turn_to_y_up("z"), self.rest[:, :3, 3].astype(np.float64))
        above = np.where(self.parents >= 0, self.parents, 0)
        offsets = places - places[above] * (self.parents >= 0)[:, None]
        tips = np.flatnonzero(self.tips)
        joints = np.flatnonzero(~self.tips)
        number = np.full(len(self.names) + 1, -1)
        number[joints] = np.arange(len(joints))
        return Skeleton(
            tuple(self.names[j] for j in joints),
            number[self.parents[joints]],
            offsets[joints],
            number[self.parents[tips]].astype(np.int64),
            offsets[tips],
        )

    def motion(
        self, unit: float, to_inside: Array
    ) -> tuple[Skeleton, Array, Array, tuple[int, ...]]:
        """Skeleton in metres, rotations (F, J, 4), translations (F, T, 3), translated joints.

        A joint's rotation is how its bone is turned from where it is at rest; what the bone's own
        axes are does not matter.

        Parameters
        ----------
        unit
            Metres per unit of the matrices.
        to_inside
            Turns a world with Y up into ours, where it is stated wrongly.
        """
        rest, joints = self.skeleton(), np.flatnonzero(~self.tips)
        upright = turn_to_y_up("z")
        turned = _turns(self.world[:, joints]) @ _turns(self.rest[joints]).swapaxes(-1, -2)
        whole = rot.from_matrix(turned)
        whole = rot.multiply(rot.multiply(upright, whole), rot.conjugate(upright))
        places = rot.rotate(upright, self.world[..., :3, 3][:, joints].astype(np.float64))
        rotations, local = whole.copy(), places.copy()
        for j, parent in enumerate(rest.parents):
            if parent >= 0:
                back = rot.conjugate(whole[:, parent])
                rotations[:, j] = rot.multiply(back, whole[:, j])
                local[:, j] = rot.rotate(back, places[:, j] - places[:, parent])
        rotations[:, 0] = rot.multiply(to_inside, rotations[:, 0])
        local[:, 0] = rot.rotate(to_inside, local[:, 0])
        size = float(np.linalg.norm(rest.offsets[1:], axis=1).sum()) or 1.0
        moving = np.ptp(local, axis=0).max(axis=1) > _STILL * size
        offsets = np.where(moving[:, None], rest.offsets, np.median(local, axis=0))
        offsets[0] = rest.offsets[0]
        translated = (0, *(int(j) for j in np.flatnonzero(moving) if j))
        skeleton = Skeleton(
            rest.names, rest.parents, offsets * unit, rest.end_parents, rest.end_offsets * unit
        )
        return skeleton, rot.continuous(rotations), local[:, list(translated)] * unit, translated


def trees(bones: Bones, problems: list[Problem]) -> list[Bones]:
    """One skeleton a root, parents before their children; single bones are left out."""
    below: dict[int, list[int]] = {}
    for j, parent in enumerate(bones.parents):
        below.setdefault(int(parent), []).append(j)
    roots = below.get(-1, [])
    found = []
    for root in roots:
        inside, stack = list[int](), [root]
        while stack:
            joint = stack.pop()
            inside.append(joint)
            stack += reversed(below.get(joint, []))
        if len(inside) == 1 and len(roots) > 1:
            what = f"bone {bones.names[root]} has neither parent nor children"
            problems.append(Problem(None, what, "left out"))
            continue
        number = {j: i for i, j in enumerate(inside)}
        found.append(
            Bones(
                tuple(bones.names[j] for j in inside),
                np.array([number.get(int(bones.parents[j]), -1) for j in inside], dtype=np.int64),
                bones.rest[inside],
                bones.world[:, inside],
            )
        )
    return found


def _turns(matrices: Array) -> Array:
    """(..., 3, 3) rotations of matrices whose columns may be scaled."""
    columns = matrices[..., :3, :3].astype(np.float64)
    lengths = np.linalg.norm(columns, axis=-2, keepdims=True)
    return np.asarray(columns / np.where(lengths > 0, lengths, 1.0))
