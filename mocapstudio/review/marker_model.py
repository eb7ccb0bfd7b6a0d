"""The frozen pieces of a sitting that concern marker takes. No Qt."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.markers import MarkerTake

Parameters = Mapping[str, int | float | str]


class MarkerEditKind(StrEnum):
    """What an edit does with its cells."""

    FILL = "fill"
    EXCHANGE = "exchange"
    CLEAR = "clear"


@dataclass(frozen=True, eq=False)
class MarkerPerformer:
    """One marker take of the sitting.

    Parameters
    ----------
    id
        Stable within the session, and no performer's of the scene.
    take
        The immutable source.
    """

    id: str
    take: MarkerTake


@dataclass(frozen=True, eq=False)
class Fill:
    """Replacement samples for one gap of one marker.

    Parameters
    ----------
    marker
        Its label.
    start, end
        Half-open span of frames.
    positions
        (end - start, 3) metres in the world; NaN where the method could not tell.
    """

    marker: str
    start: int
    end: int
    positions: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class MarkerEdit:
    """One change of markers × span, replayed over the immutable source.

    A fill puts its samples where a marker is missing, and nowhere else: whatever is muted before
    it, it never covers a measured sample. An exchange swaps the courses of its two markers, which
    it finds in the take itself, and a clearing takes samples away: neither holds any of its own.

    Parameters
    ----------
    id
        Stable within the session.
    performer
        Whose take.
    kind
        What it does.
    markers
        Labels of the declared markers: of an exchange the two that change places.
    start, end
        Half-open span of frames at the take's own rate.
    positions
        (end - start, markers, 3) metres, of a fill; else None.
    method
        How it was made, in words.
    parameters
        Of the method, by name.
    group
        Edits of one group undo as one.
    author, time
        Who decided, and when (UTC, ISO 8601).
    muted
        True while the edit is switched off.
    """

    id: str
    performer: str
    kind: MarkerEditKind
    markers: tuple[str, ...]
    start: int
    end: int
    positions: NDArray[np.float64] | None
    method: str
    group: str
    author: str
    time: str
    parameters: Parameters = field(default_factory=lambda: MappingProxyType({}))
    muted: bool = False

    def touches(self, marker: str, start: int, end: int) -> bool:
        """Tell whether it may change a marker somewhere in [start, end)."""
        return marker in self.markers and self.start < end and start < self.end
