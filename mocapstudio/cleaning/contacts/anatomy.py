"""Where feet and hands are in a skeleton: ankle, ball and tip; wrist and knuckles."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.topology import Limb, topology

Array = NDArray[np.float64]

_FOOT = re.compile(r"foot|ankle|hoof|paw", re.IGNORECASE)
_HAND = re.compile(r"hand|wrist|palm", re.IGNORECASE)
_THUMB = re.compile(r"thumb", re.IGNORECASE)
_NOWHERE = 1e-4
"""Bones shorter than this share of the limb have no length."""


@dataclass(frozen=True, eq=False)
class Extremity:
    """A foot or a hand at the end of a limb.

    Attributes
    ----------
    limb
        The limb's name.
    joint
        Index of the ankle or wrist.
    outer
        Index of the joint beyond it that has a place of its own (ball of the foot, knuckles), or
        None.
    tip
        (3,) metres: the tip in the frame of `outer`, else of `joint`; None where it has no length.
    length
        Metres: the two long bones of the limb (thigh and shank, upper arm and forearm).
    """

    limb: str
    joint: int
    outer: int | None
    tip: Array | None
    length: float

    def key_joint(self) -> int:
        """Return the outermost joint with a place of its own."""
        return self.joint if self.outer is None else self.outer


@lru_cache(maxsize=64)
def extremities(skeleton: Skeleton, kind: str) -> tuple[Extremity, ...]:
    """Feet (``"leg"``) or hands (``"arm"``) of a skeleton, in the order of its limbs.

    Limbs without any length are passed over.
    """
    limbs = [limb for limb in topology(skeleton).limbs if f" {kind}" in f" {limb.name}"]
    found = (_extremity(skeleton, limb, _FOOT if kind == "leg" else _HAND) for limb in limbs)
    return tuple(one for one in found if one is not None)


def carried_by(skeleton: Skeleton) -> dict[int, int]:
    """Index of the ankle or wrist for every joint of a foot or hand, itself among them."""
    ends = (*extremities(skeleton, "leg"), *extremities(skeleton, "arm"))
    return {joint: end.joint for end in ends for joint in skeleton.descendants(end.joint)}


def leg_length(skeleton: Skeleton) -> float:
    """Metres: thigh and shank, by which everything about contacts is scaled.

    Without legs the longest branch of the skeleton stands in.
    """
    lengths = [foot.length for foot in extremities(skeleton, "leg")]
    if lengths:
        return float(np.median(lengths))
    reach = np.linalg.norm(skeleton.rest_positions - skeleton.rest_positions[0], axis=1).max()
    return float(reach) or 1.0


def _extremity(skeleton: Skeleton, limb: Limb, names: re.Pattern[str]) -> Extremity | None:
    chain = _main_chain(skeleton, limb)
    bones = np.linalg.norm(skeleton.offsets[chain], axis=1)
    if bones[1:].sum() <= 0:
        return None
    at = _by_name(skeleton, chain, names)
    if at is None:
        at = _after_long_bones(bones)
    joint = chain[at]
    shortest = _NOWHERE * float(bones.sum())
    outer = _outer(skeleton, joint, shortest)
    length = float(np.sort(bones[1 : at + 1])[-2:].sum()) if at else float(bones.sum())
    return Extremity(limb.name, joint, outer, _tip(skeleton, joint, outer, shortest), length)


def _main_chain(skeleton: Skeleton, limb: Limb) -> list[int]:
    """Follow the longest way from the limb's first joint outward."""

    def reach(joint: int) -> float:
        below = [float(np.linalg.norm(skeleton.offsets[c])) + reach(c) for c in children(joint)]
        return max(below, default=0.0)

    def children(joint: int) -> list[int]:
        return [c for c in skeleton.children[joint] if not _THUMB.search(skeleton.names[c])]

    chain = [limb.joints[0]]
    while children(chain[-1]):
        chain.append(
            max(children(chain[-1]), key=lambda c: np.linalg.norm(skeleton.offsets[c]) + reach(c))
        )
    return chain


def _by_name(skeleton: Skeleton, chain: list[int], names: re.Pattern[str]) -> int | None:
    # The first bone of a limb is no hand, whatever a prefix common to all joints says.
    return next((i for i, j in enumerate(chain) if i > 1 and names.search(_own(skeleton, j))), None)


def _own(skeleton: Skeleton, joint: int) -> str:
    return skeleton.names[joint].split(":")[-1]


def _after_long_bones(bones: Array) -> int:
    """Index of the joint at the end of the limb's two longest bones."""
    return int(max(np.argsort(bones[1:])[-2:] + 1))


def _outer(skeleton: Skeleton, joint: int, shortest: float) -> int | None:
    """Return the first joint beyond `joint` that does not share its place."""
    place = skeleton.rest_positions
    beyond = [
        j
        for j in skeleton.descendants(joint)[1:]
        if not _THUMB.search(skeleton.names[j])
        and np.linalg.norm(place[j] - place[joint]) > shortest
    ]
    parent_apart = [
        j
        for j in beyond
        if np.linalg.norm(place[int(skeleton.parents[j])] - place[joint]) <= shortest
    ]
    if not parent_apart:
        return None
    # Of several fingers the middle one.
    return parent_apart[len(parent_apart) // 2]


def _tip(skeleton: Skeleton, joint: int, outer: int | None, shortest: float) -> Array | None:
    base = joint if outer is None else outer
    place = skeleton.rest_positions
    inside = skeleton.descendants(base)
    tips = [
        place[int(parent)] + offset - place[base]
        for parent, offset in zip(skeleton.end_parents, skeleton.end_offsets, strict=True)
        if int(parent) in inside and not _THUMB.search(skeleton.names[int(parent)])
    ]
    tips += [place[j] - place[base] for j in inside[1:] if not _THUMB.search(skeleton.names[j])]
    farthest = max(tips, key=lambda tip: float(np.linalg.norm(tip)), default=np.zeros(3))
    return farthest if np.linalg.norm(farthest) > shortest else None
