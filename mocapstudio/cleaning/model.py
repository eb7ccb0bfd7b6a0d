"""What the analysis of a take yields: map, flags, neighbours, proposals.

Rows are named: a row is a joint's name, or one of the two root rows of `motion.facing`. Frames
are 0-based at the take's own rate, spans half-open.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray


class Kind(StrEnum):
    """The likely cause of a flag."""

    SPIKE = "spike"
    OFFSET = "offset"
    FREEZE = "freeze"
    NOISE = "noise"
    GAP = "gap"
    DRIFT = "drift"
    SWAP = "swap"
    FLIP = "flip"
    LIMB = "limb"
    POP = "pop"
    JITTER = "jitter"
    ROOT_POP = "root pop"
    HEIGHT_DRIFT = "height drift"
    HEADING_FLIP = "heading flip"


@dataclass(frozen=True, eq=False)
class DigressionMap:
    """How far each row departs from its neighbours (the MDM of paper 1, section 3.4).

    Parameters
    ----------
    rows
        R names: the analysed joints, then the root rows.
    values
        (F, R) float32 in 0..1, at the take's own rate.
    residuals
        (F, R) float32: what `values` was made from; degrees for joints and root heading,
        centimetres for root position.
    fine
        (F, m) float32 degrees, of the first m rows: departure of the take's own frames from the
        mean texture, from which edges of flags are read; None where it was not measured.
    """

    rows: tuple[str, ...]
    values: NDArray[np.float32]
    residuals: NDArray[np.float32]
    fine: NDArray[np.float32] | None = None


@dataclass(frozen=True)
class Flag:
    """One row, one span of frames, one score.

    Parameters
    ----------
    id
        Stable within one analysis: row and start frame.
    joint
        The flagged row.
    joints
        All rows of the same limb or swap, `joint` among them; each has a flag of its own.
    start, end
        Half-open span at the take's own rate.
    peak, peak_frame
        Highest value of the map in the span, and where.
    score
        0..1, comparable between takes.
    kind
        The likely cause.
    """

    id: str
    joint: str
    joints: tuple[str, ...]
    start: int
    end: int
    peak: float
    peak_frame: int
    score: float
    kind: Kind

    def overlaps(self, start: int, end: int) -> bool:
        """Tell whether the flag shares a frame with [start, end)."""
        return self.start < end and start < self.end


@dataclass(frozen=True)
class Neighbour:
    """One of the K similar words of a flagged span, best first.

    Parameters
    ----------
    take
        Name of the take it was found in.
    start, end
        Half-open span in that take, at that take's rate.
    distance
        Root mean square joint angle to the flagged motion, degrees, over the compared joints.
    index
        Which take of the context: 0 is the analysed take itself.
    """

    take: str
    start: int
    end: int
    distance: float
    index: int


@dataclass(frozen=True, eq=False)
class Proposal:
    """The replacement motion offered for a flag; nothing outside span and joints changes.

    Parameters
    ----------
    joints
        Names of the n joints whose local rotations are replaced.
    start, end
        Half-open span, blending included.
    rotations
        (end - start, n, 4) local rotations.
    translations
        (end - start, 3) metres, local translation of the joint that carries the body, or None.
    method
        How it was made: ``"neighbours"``, ``"interpolation"``, ``"swap"``.
    donor
        The neighbour it was taken from, if any.
    displacement
        How far hands, feet and head outside the joints move at most: metres by joint name.
    """

    joints: tuple[str, ...]
    start: int
    end: int
    rotations: NDArray[np.float64]
    translations: NDArray[np.float64] | None
    method: str
    donor: Neighbour | None = None
    displacement: Mapping[str, float] = field(default_factory=dict)
