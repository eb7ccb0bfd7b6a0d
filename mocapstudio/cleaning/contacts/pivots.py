"""Feet that turn on the floor: one point stays, the others travel around it and are no contacts.

Bones hold heel, ball and toe together. While a foot swivels, to hold more than one of them would
either stop the turn or pull the foot apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from mocapstudio.cleaning.contacts.model import Contact, Floor
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.runs import runs

Array = NDArray[np.float64]

_TURNING = np.deg2rad(40.0)
"""Radians a second at which a foot turns."""
_TURNED = np.deg2rad(35.0)
"""Radians by which it turns in all."""
_SMOOTHING = 0.025
"""Seconds: standard deviation of the Gaussian over headings."""
_SHORTEST = 0.07
"""Seconds that what is left of a contact lasts at least."""
_LEVEL = 0.3
"""Share of its length to which a foot shows its heading from above."""


@dataclass(frozen=True, eq=False)
class Standing:
    """A point of a foot on the floor.

    Parameters
    ----------
    contact
        With a floor.
    place
        (F, 3) metres: the point over all frames of the take.
    ankle
        Index of the joint whose rotation tells where the foot points.
    """

    contact: Contact
    place: Array
    ankle: int


def held_at_pivots(standing: Sequence[Standing], world: Array, rate: float) -> list[Contact]:
    """Leave the frames in which a foot turns to that of its points which travels least.

    Parameters
    ----------
    standing
        In any order.
    world
        (F, J, 4) world rotations of the joints.
    rate
        Frames a second.

    Returns
    -------
    list of Contact
        The same where no foot turns; otherwise parts of them, too short ones left out.
    """
    kept = {i: np.ones(s.contact.end - s.contact.start, bool) for i, s in enumerate(standing)}
    for a, b in combinations(range(len(standing)), 2):
        one, other = standing[a].contact, standing[b].contact
        start, end = max(one.start, other.start), min(one.end, other.end)
        if standing[a].ankle != standing[b].ankle or end - start < 3:
            continue
        turning = _turns(standing[a], standing[b], world, start, end, rate)
        for first, last in turning:
            span = slice(start + first, start + last)
            loser = max((a, b), key=lambda i: _travel(standing[i].place[span]))
            from_start = start - standing[loser].contact.start
            kept[loser][from_start + first : from_start + last] = False
    found = []
    fewest = max(1, round(_SHORTEST * rate))
    for i, s in enumerate(standing):
        if kept[i].all():
            found.append(s.contact)
            continue
        found += [
            _part(s, s.contact.start + first, s.contact.start + last)
            for first, last in runs(kept[i])
            if last - first >= fewest
        ]
    return found


def _turns(
    one: Standing, other: Standing, world: Array, start: int, end: int, rate: float
) -> list[tuple[int, int]]:
    """Spans, counted from `start`, in which the foot that carries both turns by much."""
    ways = (one.place - other.place)[start:end]
    foot = world[start:end, one.ankle]
    carried = rot.rotate(foot, np.median(rot.rotate(rot.conjugate(foot), ways), axis=0))
    flat = carried[:, [0, 2]]
    length = np.linalg.norm(carried, axis=1)
    if np.linalg.norm(flat, axis=1).min() <= _LEVEL * length.max():
        return []
    heading = np.unwrap(np.arctan2(flat[:, 1], flat[:, 0]))
    heading = gaussian_filter1d(heading, _SMOOTHING * rate, mode="nearest")
    fast = np.abs(np.gradient(heading)) * rate > _TURNING
    return [
        (first, last)
        for first, last in runs(fast)
        if abs(heading[last - 1] - heading[first]) > _TURNED
    ]


def _travel(place: Array) -> float:
    """Metres that a point (F, 3) gets away from its middle, on average."""
    return float(np.linalg.norm(place - np.median(place, axis=0), axis=1).mean())


def _part(standing: Standing, start: int, end: int) -> Contact:
    contact, place = standing.contact, standing.place
    assert isinstance(contact.target, Floor)
    name = f"{contact.joint}-{contact.point or 'end'}-{start}"
    height = float(np.median(place[start:end, 1]))
    target = replace(contact.target, height=height)
    return replace(contact, id=name, start=start, end=end, target=target)
