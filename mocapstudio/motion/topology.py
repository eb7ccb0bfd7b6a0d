"""What the joints of a skeleton are for, read off its shape (and its names, where they tell).

Nothing here is specific to people: where a skeleton has no legs or arms that can be told, its
limbs are simply the branches below the hips.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.skeleton import Skeleton

_LEFT = re.compile(r"(^|[^a-z])(left|lft|l)(?=[^a-z]|$)|^left|left$")
_RIGHT = re.compile(r"(^|[^a-z])(right|rgt|r)(?=[^a-z]|$)|^right|right$")
_FACE = re.compile(r"eye|jaw|tongue|brow|hair")
_FINGER = re.compile(r"finger|thumb|index|middle|^mid|ring|pinky|carpal")
_WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|\d+")
_MIRRORED = 0.25


@dataclass(frozen=True, eq=False)
class Limb:
    """A named group of joints that moves together, ordered from the trunk outward."""

    name: str
    joints: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Topology:
    """The parts of one skeleton.

    Attributes
    ----------
    hips
        The joint that carries the body: the first from the root down with several children.
    limbs
        The parts in display order: hips and spine, head, arms, legs, or branches.
    details
        Joints too fine for whole-body comparison: fingers, eyes, face.
    mirror
        (J,) for each joint its partner on the other side, itself where there is none.
    above_hips
        Joints between the skeleton's root and the hips: they move the world, not the body.
    """

    hips: int
    limbs: tuple[Limb, ...]
    details: frozenset[int]
    mirror: NDArray[np.int64]
    above_hips: frozenset[int]

    def limb_of(self, joint: int) -> Limb:
        """Return the limb that holds `joint`."""
        return next(limb for limb in self.limbs if joint in limb.joints)

    def body_joints(self) -> tuple[int, ...]:
        """Joints that are compared: all but details and those above the hips, in order."""
        left_out = self.details | self.above_hips
        return tuple(sorted(j for limb in self.limbs for j in limb.joints if j not in left_out))


@lru_cache(maxsize=64)
def topology(skeleton: Skeleton) -> Topology:
    """Read the parts of a skeleton off its shape, with names to tell left from right."""
    hips = _hips(skeleton)
    mirror = _mirror(skeleton, hips)
    details = frozenset(_details(skeleton, mirror))
    limbs = tuple(_limbs(skeleton, hips, mirror))
    return Topology(hips, limbs, details, mirror, frozenset(skeleton.ancestors(hips)))


def side_of(name: str) -> str:
    """``"left"``, ``"right"`` or ``""``, as a joint's name tells."""
    spaced = _spaced(name)
    if _LEFT.search(spaced):
        return "left"
    return "right" if _RIGHT.search(spaced) else ""


def _spaced(name: str) -> str:
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name.split(":")[-1])
    return spaced.lower()


def _hips(skeleton: Skeleton) -> int:
    joint = 0
    while len(skeleton.children[joint]) == 1:
        joint = skeleton.children[joint][0]
    return joint if skeleton.children[joint] else 0


def _shape(skeleton: Skeleton, joint: int) -> tuple[object, ...]:
    return tuple(sorted((_shape(skeleton, c) for c in skeleton.children[joint]), key=repr))


def _mirror(skeleton: Skeleton, hips: int) -> NDArray[np.int64]:
    """Pair the branches of each trunk joint that are alike but for their side."""
    mirror = np.arange(len(skeleton))

    def pair(a: int, b: int) -> None:
        mirror[a], mirror[b] = b, a
        for alike in (_namesakes, _same_shape):
            for c in skeleton.children[a]:
                free = (d for d in skeleton.children[b] if mirror[d] == d)
                twin = next((d for d in free if alike(skeleton, c, d)), None)
                if mirror[c] == c and twin is not None:
                    pair(c, twin)

    for joint in range(len(skeleton)):
        if mirror[joint] != joint:
            continue
        for alike in (_namesakes, _same_shape):
            for a, b in combinations(skeleton.children[joint], 2):
                free = mirror[a] == a and mirror[b] == b
                if free and alike(skeleton, a, b) and _opposite(skeleton, a, b):
                    pair(a, b)
    return mirror


def _same_shape(skeleton: Skeleton, a: int, b: int) -> bool:
    return _shape(skeleton, a) == _shape(skeleton, b)


def _namesakes(skeleton: Skeleton, a: int, b: int) -> bool:
    """Tell whether two names differ in their side alone; a prop in one hand changes its shape."""
    one, other = skeleton.names[a], skeleton.names[b]
    if side_of(one) == "right":
        one, other = other, one
    opposite = (side_of(one), side_of(other)) == ("left", "right")
    return opposite and _LEFT.sub("", _spaced(one)) == _RIGHT.sub("", _spaced(other))


def _opposite(skeleton: Skeleton, a: int, b: int) -> bool:
    sides = {side_of(skeleton.names[a]), side_of(skeleton.names[b])}
    if sides == {"left", "right"}:
        return True
    if sides & {"left", "right"}:
        return False
    reach = [_branch_vector(skeleton, j) for j in (a, b)]
    length = np.linalg.norm(reach[0]), np.linalg.norm(reach[1])
    apart = np.linalg.norm(reach[0] - reach[1])
    longest = max(length)
    alike = abs(length[0] - length[1]) <= _MIRRORED * longest
    return bool(longest > 0 and alike and apart > _MIRRORED * longest)


def _branch_vector(skeleton: Skeleton, joint: int) -> NDArray[np.float64]:
    inside = skeleton.descendants(joint)
    base = skeleton.rest_positions[skeleton.parents[joint]]
    result: NDArray[np.float64] = skeleton.rest_positions[inside].mean(axis=0) - base
    return result


def _details(skeleton: Skeleton, mirror: NDArray[np.int64]) -> list[int]:
    found: set[int] = set()
    for joint in range(len(skeleton)):
        words = [w.lower() for w in _WORD.findall(skeleton.names[joint].split(":")[-1])]
        paired = mirror[joint] != joint
        if any(_FACE.search(w) or (paired and _FINGER.search(w)) for w in words):
            found.update(skeleton.descendants(joint))
        # A fan of three or more branches at the end of a limb is a hand.
        if paired and len(skeleton.children[joint]) >= 3:
            found.update(j for c in skeleton.children[joint] for j in skeleton.descendants(c))
    return sorted(found)


def _limbs(skeleton: Skeleton, hips: int, mirror: NDArray[np.int64]) -> list[Limb]:
    trunk: list[int] = []
    for j in range(len(skeleton)):
        if mirror[j] == j and (j == 0 or int(skeleton.parents[j]) in trunk):
            trunk.append(j)
    starts = [j for j in range(len(skeleton)) if j not in trunk and skeleton.parents[j] in trunk]
    tail = _head_chain(skeleton, trunk, starts)
    limbs = [Limb("spine", tuple(j for j in trunk if j not in tail))]
    if tail:
        limbs.append(Limb("head", tuple(skeleton.descendants(tail[0]))))
    names: dict[str, int] = {}
    for start in starts:
        if skeleton.parents[start] in tail:
            continue
        kind = "leg" if skeleton.parents[start] in {hips, *skeleton.ancestors(hips)} else "arm"
        side = side_of(skeleton.names[start]) or _lateral_side(skeleton, start, mirror)
        name = f"{side} {kind}"
        names[name] = names.get(name, 0) + 1
        suffix = f" {names[name]}" if names[name] > 1 else ""
        limbs.append(Limb(name + suffix, tuple(skeleton.descendants(start))))
    order = {"spine": 0, "head": 1}
    return sorted(limbs, key=lambda limb: order.get(limb.name, 2 if "arm" in limb.name else 3))


def _head_chain(skeleton: Skeleton, trunk: list[int], starts: list[int]) -> list[int]:
    """Return trunk joints above the highest pair of long branches: neck and head."""
    shoulders = [int(skeleton.parents[s]) for s in starts if len(skeleton.descendants(s)) >= 3]
    if not shoulders:
        return []
    top = max(shoulders, key=lambda j: len(skeleton.ancestors(j)))
    branches = [j for j in trunk if skeleton.parents[j] == top]
    if not branches:
        return []
    # A tail or a pack beside the neck is no head.
    head = set(skeleton.descendants(max(branches, key=lambda j: len(skeleton.descendants(j)))))
    return [j for j in trunk if j in head]


def _lateral_side(skeleton: Skeleton, start: int, mirror: NDArray[np.int64]) -> str:
    # Facing is unknown without names; +X is the left of a performer who faces +Z.
    mine = _branch_vector(skeleton, start)[0]
    other = _branch_vector(skeleton, int(mirror[start]))[0]
    return "left" if mine >= other else "right"
