"""The rigid parts of a body that markers sit on, as joints of a skeleton in a standing pose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.topology import Limb, Topology, topology

Array = NDArray[np.float64]

_CHAINS = {
    "arm": ("clavicle", "upper arm", "forearm", "hand"),
    "leg": ("hip", "thigh", "shank", "foot"),
}
_CALLED = {"hand": "wrist", "foot": "ankle"}
_ABOVE = {"upper arm": "forearm", "thigh": "shank"}
_SIDEWAYS = 0.5
"""Cosine from which on a hinge counts as sideways."""
_MARGIN = 0.05
"""Share of a bone beyond a joint in it, from where on a marker is carried by that joint."""
_POINT = 1e-4
"""Metres below which two joints are in one place."""


@dataclass(frozen=True, eq=False)
class Segment:
    """A part of the body.

    Attributes
    ----------
    joint
        The joint that carries it.
    further
        Joints in the same bone, from `joint` on, with the share of the bone where each begins.
    start
        (3,) metres: where its sites are counted from, in the standing pose.
    bone
        (3,) metres: from there to the next joint; zero where there is none.
    front, outer
        (3,) unit vectors at right angles to the bone: to the front (the thumb's side of an arm),
        and away from the middle of the body with the limb hanging down. For trunk and feet the
        body's own forward and sideways. Above an elbow or a knee sideways is along its hinge.
    up
        (3,) unit vector.
    """

    joint: int
    start: Array
    bone: Array
    front: Array
    outer: Array
    up: Array
    further: tuple[tuple[int, float], ...] = ()

    def joint_at(self, along: float) -> int:
        """The joint that carries what sits at a share of the bone."""
        begun = [joint for joint, share in self.further if share + _MARGIN < along]
        return begun[-1] if begun else self.joint


def segments(
    skeleton: Skeleton, positions: Array, hinges: Mapping[int, Array]
) -> dict[str, Segment]:
    """Return the parts that can be told, by name: ``"pelvis"``, ``"left upper arm"``, ….

    Parameters
    ----------
    skeleton
        J joints.
    positions
        (J, 3) metres: a standing pose, Y up.
    hinges
        Axes (3,) in the world of that pose of joints that turn about one only.
    """
    parts = topology(skeleton)
    chains = {
        limb.name: _chain(skeleton, limb, parts)
        for limb in parts.limbs
        if limb.name in {f"{side} {kind}" for side in ("left", "right") for kind in _CHAINS}
    }
    axes = _axes(positions, chains)
    found: dict[str, Segment] = {}
    for name, chain in chains.items():
        side = name.split()[0]
        for part, joint in chain.items():
            segment = _limb_segment(skeleton, positions, joint, chain, part, side, axes)
            hinge = hinges.get(chain.get(_ABOVE.get(part, ""), -1))
            found[f"{side} {part}"] = segment if hinge is None else _aligned(segment, hinge)
    found |= _trunk(skeleton, parts, positions, chains, axes)
    return found


def _axes(positions: Array, chains: dict[str, dict[str, int]]) -> Array:
    left = np.array([1.0, 0.0, 0.0])
    legs = [chains.get(f"{side} leg", {}).get("thigh") for side in ("left", "right")]
    if legs[0] is not None and legs[1] is not None:
        across = (positions[legs[0]] - positions[legs[1]]) * [1.0, 0.0, 1.0]
        if np.linalg.norm(across) > _POINT:
            left = across / np.linalg.norm(across)
    up = np.array([0.0, 1.0, 0.0])
    return np.stack([left, up, np.cross(left, up)], axis=1)


def _chain(skeleton: Skeleton, limb: Limb, parts: Topology) -> dict[str, int]:
    """Parts of a limb, by the shape of its chain of joints."""
    names = _CHAINS[limb.name.split()[1]]
    joints = [j for j in limb.joints if j not in parts.details] or list(limb.joints)
    chain = [joints[0]]
    for joint in joints[1:]:
        if skeleton.parents[joint] == chain[-1]:
            chain.append(joint)
    if len(chain) < 3:
        return {}
    bones = np.linalg.norm(skeleton.offsets[chain], axis=1)
    # Elbow (knee) is where the limb is longest on both sides: one bone above, the rest below.
    below = [_reach(skeleton, joint) for joint in chain]
    middle = max(range(1, len(chain)), key=lambda at: min(float(bones[at]), below[at]))
    end = _end_of(skeleton, chain, middle, names[3])
    places = {names[1]: middle - 1, names[2]: middle}
    if end < len(chain):
        places[names[3]] = end
    if middle > 1:
        places = {names[0]: middle - 2, **places}
    return {name: chain[at] for name, at in places.items()}


def _reach(skeleton: Skeleton, joint: int) -> float:
    """Metres of bones from a joint to the farthest tip below it."""
    tips = np.flatnonzero(skeleton.end_parents == joint)
    ends = [float(np.linalg.norm(skeleton.end_offsets[tip])) for tip in tips]
    bones = [
        float(np.linalg.norm(skeleton.offsets[child])) + _reach(skeleton, child)
        for child in skeleton.children[joint]
    ]
    return max([0.0, *ends, *bones])


def _end_of(skeleton: Skeleton, chain: list[int], middle: int, name: str) -> int:
    """Where in a chain hand or foot is: below the elbow other joints may come, for the twist."""
    below = range(middle + 1, len(chain))
    for word in (name, _CALLED[name]):
        called = [at for at in below if word in skeleton.names[chain[at]].lower()]
        if called:
            return called[0]
    return middle + 1


def _limb_segment(
    skeleton: Skeleton,
    positions: Array,
    joint: int,
    chain: dict[str, int],
    part: str,
    side: str,
    axes: Array,
) -> Segment:
    left, up, forward = axes.T
    outwards = left if side == "left" else -left
    order = list(chain.values())
    at = order.index(joint)
    start = positions[joint]
    bone = positions[order[at + 1]] - start if at + 1 < len(order) else np.zeros(3)
    if part in {"foot", "clavicle", "hip"}:
        return Segment(joint, start, bone, forward, outwards, up)
    if part == "hand":
        # Sites of a hand are metres along the forearm: few skeletons know how long a hand is.
        along = start - positions[order[at - 1]]
        bone = along / max(float(np.linalg.norm(along)), _POINT)
    direction = bone / max(float(np.linalg.norm(bone)), _POINT)
    front = forward - direction * (direction @ forward)
    front /= max(float(np.linalg.norm(front)), _POINT)
    outer = np.cross(front, direction) * (1.0 if side == "left" else -1.0)
    further = _between(skeleton, positions, joint, order[at + 1]) if at + 1 < len(order) else ()
    return Segment(joint, start, bone, front, outer, up, further)


def _aligned(segment: Segment, hinge: Array) -> Segment:
    """Turn a segment's sideways onto the hinge below it, unless that lies far from sideways."""
    direction = segment.bone / max(float(np.linalg.norm(segment.bone)), _POINT)
    across = hinge - direction * (direction @ hinge)
    length = float(np.linalg.norm(across))
    along = float(across @ segment.outer)
    if abs(along) < max(_SIDEWAYS * length, _POINT):
        return segment
    outer = across * np.sign(along) / length
    front = np.cross(outer, direction)
    return replace(segment, outer=outer, front=front * np.sign(front @ segment.front))


def _between(
    skeleton: Skeleton, positions: Array, joint: int, end: int
) -> tuple[tuple[int, float], ...]:
    path = [j for j in skeleton.ancestors(end) if j > joint and joint in skeleton.ancestors(j)]
    whole = max(float(np.linalg.norm(positions[end] - positions[joint])), _POINT)
    return tuple(
        (j, float(np.linalg.norm(positions[j] - positions[joint])) / whole) for j in path[::-1]
    )


def _trunk(
    skeleton: Skeleton,
    parts: Topology,
    positions: Array,
    chains: dict[str, dict[str, int]],
    axes: Array,
) -> dict[str, Segment]:
    left, up, forward = axes.T

    def trunk(joint: int, start: Array, bone: Array | None = None) -> Segment:
        return Segment(joint, start, np.zeros(3) if bone is None else bone, forward, left, up)

    def middle(kind: str, part: str, otherwise: int) -> Array:
        both = [chains.get(f"{side} {kind}", {}).get(part) for side in ("left", "right")]
        known = [positions[j] for j in both if j is not None]
        return np.asarray(np.mean(known, axis=0) if len(known) == 2 else positions[otherwise])

    found = {"pelvis": trunk(parts.hips, middle("leg", "thigh", parts.hips))}
    spine = [j for limb in parts.limbs if limb.name == "spine" for j in limb.joints]
    above = [j for j in spine if j > parts.hips]
    shoulders = middle("arm", "upper arm", above[-1] if above else parts.hips)
    chest = above[-1] if above else parts.hips
    found["chest"] = trunk(chest, shoulders)
    head = [j for limb in parts.limbs if limb.name == "head" for j in limb.joints]
    head = [j for j in head if j not in parts.details]
    if head:
        found["head"] = trunk(head[-1], positions[head[-1]])
        found["neck"] = trunk(head[0], positions[head[0]])
    for side in ("left", "right"):
        shoulder = chains.get(f"{side} arm", {}).get("upper arm")
        carrier = chains.get(f"{side} arm", {}).get("clavicle", chest)
        if shoulder is not None:
            outwards = left if side == "left" else -left
            found[f"{side} clavicle"] = Segment(
                carrier, positions[shoulder], np.zeros(3), forward, outwards, up
            )
    return found
