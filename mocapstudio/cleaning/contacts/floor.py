"""The floor under each point: where points rest, fitted robustly.

A plane of small slope and a height of its own for each point (skin, shoes, calibration) are fitted
to the places where points come to rest. What is left over, such as steps, a stage, or a capture
volume that is not level, is followed from rest to rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.floor_plane import Rest, fit_plane
from mocapstudio.cleaning.contacts.speeds import one_sided, smoothed
from mocapstudio.motion.runs import runs

Array = NDArray[np.float64]

_REST_SPEED, _REST_CLIMB = 0.3, 0.12
"""Shares of the leg a second below which a point rests: in all, and upward or downward."""
_REST_SECONDS = 0.05
_NEAR = 0.07
"""Share of the leg: a rest this near the plane is a rest on the floor."""
_CLEAR = 0.35
"""Share of the leg by which the hips are above a foot that carries."""
_TIPTOE = 0.12
"""Share of the leg by which no part of a foot that lies on something is above another."""
_ALONE_SECONDS = 0.1


@dataclass(frozen=True, eq=False)
class FittedFloor:
    """The fitted floor.

    Attributes
    ----------
    height
        Metres above the world's zero at x = z = 0.
    slope
        (2,) metres a metre along x and z.
    levels
        (P,) metres: what each point's own rests lie above the plane.
    rests
        Those that lie on the floor or on something that carries, in order of time.
    under
        (F, P) metres: the floor's height under each point, levels and steps included.
    """

    height: float
    slope: Array
    levels: Array
    rests: tuple[Rest, ...]
    under: Array

    @property
    def normal(self) -> Array:
        """(3,) unit normal of the plane, upward."""
        up = np.array([-self.slope[0], 1.0, -self.slope[1]])
        return up / float(np.linalg.norm(up))

    def at(self, places: Array) -> Array:
        """Metres above the world's zero: the plane at places (…, 3); levels and steps left out."""
        return np.asarray(self.height + places[..., [0, 2]] @ self.slope)


def fit_floor(
    positions: Array, rate: float, leg: float, hips: Array, limbs: Sequence[int]
) -> FittedFloor:
    """Fit the floor to the rests of the points of feet.

    Parameters
    ----------
    positions
        (F, P, 3) metres: points of feet in the world.
    rate
        Frames a second.
    leg
        Metres: length of the leg, the unit in which everything is judged.
    hips
        (F, 3) metres.
    limbs
        (P,) which foot each point belongs to.

    Returns
    -------
    FittedFloor
        Without any rest it lies level below the lowest places of each point.
    """
    found = _rests(positions, rate, leg)
    if not found:
        levels = np.percentile(positions[..., 1], 2, axis=0)
        return FittedFloor(
            0.0, np.zeros(2), levels, (), np.broadcast_to(levels, positions.shape[:2])
        )
    height, slope, levels = fit_plane(found, positions.shape[1], rate, leg)
    plane = height + positions[..., [0, 2]] @ slope + levels
    rising = np.array([r.place[1] - height - r.across @ slope - levels[r.point] for r in found])
    carried = _carrying(found, positions, rate, leg, hips, limbs)
    kept = [
        (rest, above)
        for rest, above, carries in zip(found, rising, carried, strict=True)
        if abs(above) < _NEAR * leg or carries
    ]
    under = plane + _followed(kept, positions.shape[:2])
    return FittedFloor(height, slope, levels, tuple(rest for rest, _ in kept), under)


def _rests(positions: Array, rate: float, leg: float) -> list[Rest]:
    velocity = one_sided(smoothed(positions, rate), rate)
    still = np.linalg.norm(velocity, axis=2) < _REST_SPEED * leg
    still &= np.abs(velocity[..., 1]) < _REST_CLIMB * leg
    fewest = max(2, round(_REST_SECONDS * rate))
    return sorted(
        (
            Rest(point, a, b, tuple(np.median(positions[a:b, point], axis=0)))
            for point in range(positions.shape[1])
            for a, b in runs(still[:, point])
            if b - a >= fewest
        ),
        key=lambda rest: rest.start,
    )


def _carrying(
    found: Sequence[Rest],
    positions: Array,
    rate: float,
    leg: float,
    hips: Array,
    limbs: Sequence[int],
) -> NDArray[np.bool_]:
    """(R,) True where a foot rests alone, below the hips and below the other feet.

    Such a foot carries the body, at whatever height it is: it stands on a step. A foot held up in
    the air is above the one that carries.
    """
    limb_of = np.asarray(limbs)
    names = sorted(set(limbs))
    resting = np.zeros((len(positions), len(names)), dtype=bool)
    for rest in found:
        resting[rest.start : rest.end, names.index(limb_of[rest.point])] = True
    lowest = np.stack([positions[:, limb_of == n, 1].min(axis=1) for n in names], axis=1)
    result = np.zeros(len(found), dtype=bool)
    for i, rest in enumerate(found):
        mine = names.index(limb_of[rest.point])
        span = slice(rest.start, rest.end)
        others = [n for n in range(len(names)) if n != mine]
        alone = ~resting[span][:, others].any(axis=1)
        alone &= (lowest[span, mine, None] < lowest[span][:, others] + _NEAR * leg).all(axis=1)
        above = positions[span, rest.point, 1]
        # The heel of a foot on tiptoe rests in the air.
        alone &= above < lowest[span, mine] + _TIPTOE * leg
        alone &= hips[span, 1] - above > _CLEAR * leg
        result[i] = bool(others) and alone.sum() >= _ALONE_SECONDS * rate
    return result


def _followed(kept: Sequence[tuple[Rest, float]], shape: tuple[int, ...]) -> Array:
    """(F, P) metres: how far the ground departs from the plane, from rest to rest of a point."""
    under = np.zeros(shape)
    for point in range(shape[1]):
        mine = [(rest, above) for rest, above in kept if rest.point == point]
        if mine:
            at = np.array([t for rest, _ in mine for t in (rest.start, rest.end - 1)])
            above = np.repeat([above for _, above in mine], 2)
            under[:, point] = np.interp(np.arange(shape[0]), at, above)
    return under
