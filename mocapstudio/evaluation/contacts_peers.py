"""Usual ways to find contacts, to be compared with: a threshold of height, of speed, of both.

They look at the same points as ours, in the same units (legs and seconds), with the same shortest
contact, and their thresholds are chosen on the development half.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.anatomy import leg_length
from mocapstudio.cleaning.contacts.model import Contact, ContactPoint, Fixed
from mocapstudio.cleaning.contacts.points import contact_points, point_positions
from mocapstudio.cleaning.contacts.speeds import smoothed
from mocapstudio.evaluation.contacts_cases import ContactCase
from mocapstudio.evaluation.contacts_scoring import Detector, score_contacts
from mocapstudio.motion.runs import runs
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]

_HEIGHTS = (0.01, 0.015, 0.02, 0.03, 0.04, 0.05, 0.07)
_SPEEDS = (0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0)
_SHORTEST = 0.05
_LOWEST = 2.0
"""Percentile of a point's height that counts as the floor."""


def threshold(height: float, speed: float) -> Detector:
    """Contact is below a height (legs above the point's lowest) and a speed (legs a second)."""

    def detect(take: Take) -> Sequence[Contact]:
        points, heights, speeds = _measured(take)
        contact = (heights < height) & (speeds < speed)
        fewest = max(1, round(_SHORTEST * float(take.rate)))
        return [
            Contact("", point.joint, point.point, start, end, Fixed((0.0, 0.0, 0.0)))
            for column, point in enumerate(points)
            for start, end in runs(contact[:, column])
            if end - start >= fewest
        ]

    return detect


def tuned(cases: Sequence[ContactCase]) -> dict[str, Detector]:
    """Choose the thresholds of each peer on cases, by their F1 of all frames."""
    inf = float("inf")
    grids: dict[str, list[tuple[float, float]]] = {
        "height threshold": [(h, inf) for h in _HEIGHTS],
        "speed threshold": [(inf, s) for s in _SPEEDS],
        "both thresholds": [(h, s) for h in _HEIGHTS for s in _SPEEDS],
    }

    def quality(pair: tuple[float, float]) -> float:
        return score_contacts("", threshold(*pair), cases).strict.f1

    return {name: threshold(*max(grid, key=quality)) for name, grid in grids.items()}


@lru_cache(maxsize=64)
def _measured(take: Take) -> tuple[tuple[ContactPoint, ...], Array, Array]:
    points = tuple(point for point in contact_points(take) if point.point != "palm")
    leg, rate = leg_length(take.skeleton), float(take.rate)
    positions = point_positions(take, points)
    low, high = take.span
    floor = np.percentile(positions[low:high, :, 1], _LOWEST, axis=0)
    velocity = np.gradient(smoothed(positions, rate), axis=0) * rate
    speeds = np.linalg.norm(velocity, axis=2) / leg
    return points, (positions[..., 1] - floor) / leg, speeds
