"""Contacts of one foot that stand on a floor together, made to agree.

Each would stand best where its own point was on average; but bones hold heel, ball and toe
together. Places are chosen for all of them at once, so that the foot keeps its own direction, and
what the bones decide anyway is not asked for twice.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.anatomy import extremities
from mocapstudio.cleaning.contacts.model import Floor
from mocapstudio.cleaning.ik.targets import Hold, on_floor
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]

_TOGETHER = 100.0
"""A frame in which two points stand together counts this much for the way between them, against 1
for where each of them was."""
_ALONG = 0.05
"""Share of a hold that remains along the line to a point that stands longer."""
_APART = 0.005
"""Metres: points of one foot nearer than this are one point."""
_PASSING = 0.025
"""Seconds at most from the end of one contact to the start of the next that take turns."""
_SAME_FLOOR = 0.01
"""Metres: heights of one floor, measured at two points, differ by less."""
_STEEP = 0.3
"""A foot this far from level, as a share of its length, is not brought down flat."""
_TURNED, _SHARE = np.cos(np.deg2rad(35.0)), 10.0
"""A foot turns where this percentage of frames is farther from its usual direction."""


@dataclass(frozen=True, eq=False)
class _Pair:
    """Two holds of one foot that overlap in time, or follow each other; `first` stands longer.

    Attributes
    ----------
    first, second
        Their places in the list.
    frames
        (k,) frames of the take in which both stand; none where the foot only passes from the one
        to the other.
    ways
        (k, 3) metres from the second point to the first, or (1, 3) as it passes.
    facing
        (k, 3) the same direction as it would be if the foot alone carried it.
    """

    first: int
    second: int
    frames: NDArray[np.int64]
    ways: Array
    facing: Array


def agreed(take: Take, laid: Sequence[Hold]) -> tuple[Hold, ...]:
    """Choose where floors are stood on for all contacts together.

    The shorter of two contacts is not held along the line to the longer one: to hold both in every
    direction would twist the foot for a millimetre. While the foot turns on the longer one, as
    dancers do, the shorter cannot stand at all and is let go.

    Parameters
    ----------
    take
        F frames.
    laid
        As `targets.holds` returns them.
    """
    world = take_pose(take)[1]
    pairs = [
        pair
        for a, b in combinations(range(len(laid)), 2)
        if (pair := _pair(take, world, laid, a, b))
    ]
    # The longest contact has the first say.
    pairs.sort(key=lambda pair: -len(laid[pair.first].frames))
    turning = [_turns(pair) for pair in pairs]
    still = [p for p, turns in zip(pairs, turning, strict=True) if not turns]
    placed = _in_reach(_placed(laid, still), [pair for pair in still if len(pair.frames)])
    free = {
        i: np.broadcast_to(np.eye(3), (len(hold.frames), 3, 3)).copy()
        for i, hold in enumerate(placed)
        if isinstance(hold.contact.target, Floor)
    }
    waiting = {i: np.ones(len(held), dtype=bool) for i, held in free.items()}
    for pair, turns in zip(pairs, turning, strict=True):
        at = pair.frames - placed[pair.second].contact.start
        at = at[waiting[pair.second][at]]
        way = placed[pair.first].target[0] - placed[pair.second].target[0]
        line = np.outer(way, way) / max(float(way @ way), _APART**2)
        free[pair.second][at] = 0.0 if turns else np.eye(3) - (1.0 - _ALONG) * line
        waiting[pair.second][at] = False
    return tuple(replace(h, projection=free.get(i, h.projection)) for i, h in enumerate(placed))


def _pair(take: Take, world: Array, laid: Sequence[Hold], a: int, b: int) -> _Pair | None:
    if _rank(laid[b]) > _rank(laid[a]):
        a, b = b, a
    first, second = laid[a], laid[b]
    up = take.skeleton.parents
    near = first.joint in (second.joint, up[second.joint]) or up[first.joint] == second.joint
    start = max(first.contact.start, second.contact.start)
    frames = np.arange(start, min(first.contact.end, second.contact.end))
    above = topology(take.skeleton).above_hips
    if first.joint in above or not near or not isinstance(second.contact.target, Floor):
        return None
    if len(frames) == 0:
        return _passing(take, laid, a, b)
    ways = first.place[frames - first.contact.start] - second.place[frames - second.contact.start]
    if np.linalg.norm(ways, axis=1).min() <= _APART:
        return None
    foot = world[frames, _foot(take, first.joint, second.joint)]
    carried = np.median(rot.rotate(rot.conjugate(foot), ways), axis=0)
    return _Pair(a, b, frames, ways, rot.rotate(foot, carried))


def _passing(take: Take, laid: Sequence[Hold], a: int, b: int) -> _Pair | None:
    """Pair two holds of which one begins where the other ends, or the foot would jump there."""
    first, second = laid[a], laid[b]
    one, other = first.contact, second.contact
    gap = max(one.start, other.start) - min(one.end, other.end)
    if gap > _PASSING * float(take.rate):
        return None
    first_ends = one.end <= other.start
    way = first.place[-1 if first_ends else 0] - second.place[0 if first_ends else -1]
    if one.point == other.point or np.linalg.norm(way) <= _APART:
        return None
    return _Pair(a, b, np.arange(0), way[None], way[None])


def _foot(take: Take, first: int, second: int) -> int:
    """Index of the ankle above two joints: toes flip in bad takes where no foot turns."""
    limb = topology(take.skeleton).limb_of(first).name
    ends = [*extremities(take.skeleton, "leg"), *extremities(take.skeleton, "arm")]
    return next((end.joint for end in ends if end.limb == limb), min(first, second))


def _rank(hold: Hold) -> tuple[bool, int]:
    """What was placed by hand stands before what stands anywhere on a floor, then the longer."""
    return not isinstance(hold.contact.target, Floor), len(hold.frames)


def _turns(pair: _Pair) -> bool:
    """Tell whether the foot turns on the floor while both points touch it."""
    flat = pair.facing[:, [0, 2]]
    lengths = np.linalg.norm(flat, axis=1)
    clear = lengths > _APART
    if clear.sum() < 2:
        return False
    directions = flat[clear] / lengths[clear, None]
    usual = np.median(directions, axis=0)
    usual /= max(float(np.linalg.norm(usual)), 1e-9)
    return bool(np.percentile(directions @ usual, _SHARE) < _TURNED)


def _placed(laid: Sequence[Hold], pairs: Sequence[_Pair]) -> list[Hold]:
    """Least squares: each near where it was, both of a pair as far apart as they were."""
    if not laid:
        return []
    weights = np.array([float(len(h.frames)) for h in laid])
    system = np.diag(weights)
    right = weights[:, None] * np.array([h.target[0] for h in laid])
    for pair in pairs:
        strength = _TOGETHER * len(pair.ways)
        apart = strength * _standing_way(laid, pair)
        a, b = pair.first, pair.second
        system[[a, b], [a, b]] += strength
        system[[a, b], [b, a]] -= strength
        right[a] += apart
        right[b] -= apart
    chosen = [isinstance(hold.contact.target, Floor) for hold in laid]
    for i, hold in enumerate(laid):
        if not chosen[i]:
            # What a person placed is no matter of choice.
            system[i] = 0.0
            system[i, i], right[i] = 1.0, hold.target[0]
    spots = np.linalg.solve(system, right)
    return [
        replace(h, target=np.broadcast_to(on_floor(h.contact, spot), h.place.shape)) if free else h
        for h, spot, free in zip(laid, spots, chosen, strict=True)
    ]


def _in_reach(placed: Sequence[Hold], pairs: Sequence[_Pair]) -> list[Hold]:
    """Bring each point as far from the one that stands longer as bones hold them apart.

    Floors that were measured a millimetre apart would otherwise pull a steep foot down the moment
    that its other point is free.
    """
    result = list(placed)
    settled: set[int] = set()
    for pair in pairs:
        second = result[pair.second]
        if pair.second in settled or not isinstance(second.contact.target, Floor):
            continue
        settled.add(pair.second)
        first = result[pair.first].target[0]
        way = second.target[0] - first
        length = float(np.median(np.linalg.norm(pair.ways, axis=1)))
        off = length - float(np.linalg.norm(way))
        if abs(off) < _SAME_FLOOR:
            spot = second.target[0] + way * off / max(length - off, _APART)
            target = np.broadcast_to(spot, second.target.shape)
            result[pair.second] = replace(second, target=target)
    return result


def _standing_way(laid: Sequence[Hold], pair: _Pair) -> Array:
    """(3,) metres between two points once both stand on their floors: as long as the bones are."""
    way = np.median(pair.ways, axis=0)
    length = float(np.median(np.linalg.norm(pair.ways, axis=1)))
    rise = float(laid[pair.first].target[0, 1] - laid[pair.second].target[0, 1])
    flat = way * [1.0, 0.0, 1.0]
    across = float(np.linalg.norm(flat))
    if across < _STEEP * length or abs(rise) > length:
        return way
    return np.asarray(flat * np.sqrt(length**2 - rise**2) / across + [0.0, rise, 0.0])
