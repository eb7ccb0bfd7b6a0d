"""What a contact is: an end effector, a span of frames, a target."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

ENDS_KEPT, ON_CONTACTS = "ends kept", "on contacts"
"""What the method of a proposal says further: how a repair was bent."""

Point = Literal["heel", "ball", "toe", "palm"]


@dataclass(frozen=True, eq=False)
class ContactPoint:
    """A point of the body that may touch something.

    Parameters
    ----------
    joint
        Name of the joint that carries it.
    point
        What it is, or None where the skeleton does not tell.
    offset
        (3,) metres in the joint's frame.
    """

    joint: str
    point: Point | None
    offset: NDArray[np.float64]

    @property
    def key(self) -> tuple[str, Point | None]:
        """Joint and point: what identifies it within a performer."""
        return self.joint, self.point


@dataclass(frozen=True)
class Fixed:
    """A target that stays where it is: (x, y, z) metres in the world."""

    position: tuple[float, float, float]


@dataclass(frozen=True)
class Floor:
    """A plane: the point may not leave it, nor slide on it.

    Parameters
    ----------
    height
        Metres above the world's zero, at the target's own place.
    normal
        Unit normal of the plane in the world.
    """

    height: float
    normal: tuple[float, float, float] = (0.0, 1.0, 0.0)


@dataclass(frozen=True)
class Line:
    """A line in the world along which the point may slide: a point of it and its unit direction."""

    position: tuple[float, float, float]
    direction: tuple[float, float, float]


@dataclass(frozen=True)
class Following:
    """Another joint that the point stays with, such as the partner's hand.

    Parameters
    ----------
    performer
        Id of the performer whose joint it is.
    joint
        Name of that joint.
    offset
        (x, y, z) metres in that joint's frame.
    """

    performer: str
    joint: str
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)


Target = Fixed | Floor | Line | Following


@dataclass(frozen=True)
class Contact:
    """One end effector in contact over one span.

    Parameters
    ----------
    id
        Stable within the session.
    joint, point
        Which point of the body (see `ContactPoint`).
    start, end
        Half-open span of the take's own frames.
    target
        What it touches.
    confidence
        0..1; 1 where a person drew it.
    drawn
        True where a person drew or moved it: detecting again never touches it.
    """

    id: str
    joint: str
    point: Point | None
    start: int
    end: int
    target: Target
    confidence: float = 1.0
    drawn: bool = False
