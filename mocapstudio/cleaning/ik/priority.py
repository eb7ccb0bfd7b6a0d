"""Feet before hands: what a hand cannot reach does not pull a foot off what it stands on.

The hips join both. A body leans as far for a hand as its feet allow, so contacts of the legs are
met first and all others as well as they can be then: the weighted form of solving tasks in an order
of priority (Baerlocher and Boulic, *An inverse kinematics architecture enforcing an arbitrary
number of strict priority levels*, The Visual Computer 20, 2004), made strict by `reachable`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.anatomy import extremities
from mocapstudio.cleaning.ik.targets import Hold
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]

_YIELDING = 1.0 / 15.0
"""Weight of a contact that gives way, against 1: a foot goes a 225th as far for it."""
_MET, _MOVED = 1e-3, 2e-4
"""Metres: a hand that is farther off is out of reach; a foot that is farther off was pulled."""


def weights(skeleton: Skeleton, laid: Sequence[Hold]) -> list[float]:
    """Weight of each contact against the strongest: all alike where only legs, or none, touch."""
    standing = _standing(skeleton, laid)
    mixed = any(standing) and not all(standing)
    return [1.0 if stands or not mixed else _YIELDING for stands in standing]


def reachable(
    skeleton: Skeleton, laid: Sequence[Hold], places: Sequence[Array]
) -> tuple[Hold, ...] | None:
    """Bring targets that were not reached to where their points got, if they pull at a foot.

    Parameters
    ----------
    laid
        Contacts of one window.
    places
        (m, 3) metres for each: where its point could be brought.

    Returns
    -------
    tuple of Hold or None
        The contacts that can be met together; None where feet stand as it is.
    """
    standing = _standing(skeleton, laid)
    off = [_off(hold, place) for hold, place in zip(laid, places, strict=True)]
    pulled = any(stands and far > _MOVED for stands, far in zip(standing, off, strict=True))
    short = [not stands and far > _MET for stands, far in zip(standing, off, strict=True)]
    if not pulled or not any(short):
        return None
    return tuple(
        replace(hold, target=place) if far else hold
        for hold, place, far in zip(laid, places, short, strict=True)
    )


def _standing(skeleton: Skeleton, laid: Sequence[Hold]) -> list[bool]:
    """Tell of each contact whether a leg is in it."""
    parts = topology(skeleton)
    legs = {end.limb for end in extremities(skeleton, "leg")}
    return [
        hold.joint not in parts.above_hips and parts.limb_of(hold.joint).name in legs
        for hold in laid
    ]


def _off(hold: Hold, place: Array) -> float:
    """Metres by which a point at `place` (m, 3) misses its target where it is held at most."""
    away = (hold.projection @ (place - hold.target)[..., None])[..., 0]
    return float(np.linalg.norm(away, axis=1).max(initial=0.0))
