"""The frozen pieces a sitting is made of. No Qt, no behaviour beyond simple questions."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.model import Contact, ContactPoint
from mocapstudio.cleaning.model import Flag, Neighbour
from mocapstudio.motion.take import Take
from mocapstudio.review.marker_model import MarkerEdit


class Verdict(StrEnum):
    """What was decided about a flag."""

    OPEN = "open"
    ACCEPTED = "accepted"
    REJECTED = "rejected"
    DEFERRED = "deferred"


@dataclass(frozen=True, eq=False)
class Performer:
    """One take in the scene.

    Parameters
    ----------
    id
        Stable within the session.
    take
        The immutable source motion.
    offset
        Seconds by which the take starts after the scene's zero.
    partner
        True for a take that is only shown beside the one under review.
    """

    id: str
    take: Take
    offset: float = 0.0
    partner: bool = False


@dataclass(frozen=True, eq=False)
class Scene:
    """Takes that share one clock and space."""

    performers: tuple[Performer, ...] = ()

    def performer(self, performer_id: str) -> Performer:
        """Return the performer with that id; KeyError where there is none."""
        for one in self.performers:
            if one.id == performer_id:
                return one
        raise KeyError(performer_id)


@dataclass(frozen=True)
class Selection:
    """What every view shows as selected: joints x span of one performer, at most one flag.

    Parameters
    ----------
    performer
        Id of the performer, or "" in an empty scene.
    joints
        Names of rows (joints or root rows).
    span
        Half-open span of that performer's frames, or None.
    flag
        Id of the selected flag, or None.
    """

    performer: str = ""
    joints: frozenset[str] = frozenset()
    span: tuple[int, int] | None = None
    flag: str | None = None


@dataclass(frozen=True, eq=False)
class Edit:
    """Replacement samples for joints x span; stored, never recomputed.

    Parameters
    ----------
    id
        Stable within the session.
    performer
        Whose take.
    rows
        The declared rows: joint names and root rows that this edit may change.
    joints, start, end, rotations, translations
        As in `cleaning.model.Proposal`.
    method
        How the samples were made.
    donor
        The neighbour they came from, if any.
    flag
        Id of the flag that was accepted with it, or None for a free edit.
    group
        Edits of one group undo as one.
    author, time
        Who decided, and when (UTC, ISO 8601).
    muted
        True while the edit is switched off.
    """

    id: str
    performer: str
    rows: tuple[str, ...]
    joints: tuple[str, ...]
    start: int
    end: int
    rotations: NDArray[np.float64]
    translations: NDArray[np.float64] | None
    method: str
    donor: Neighbour | None
    flag: str | None
    group: str
    author: str
    time: str
    muted: bool = False


@dataclass(frozen=True)
class Decision:
    """A verdict on a row x span that outlives the analysis that raised the flag."""

    performer: str
    flag: Flag
    verdict: Verdict
    author: str
    time: str
    edit: str | None = None


@dataclass(frozen=True)
class Protected:
    """Rows x span that nothing may change. Empty `joints` means all rows.

    Of a marker take the rows are its markers.
    """

    performer: str
    joints: frozenset[str]
    start: int
    end: int
    author: str
    time: str


@dataclass(frozen=True, eq=False)
class OwnContact:
    """A contact of one performer."""

    performer: str
    contact: Contact


@dataclass(frozen=True, eq=False)
class OwnPoints:
    """Contact points of one performer where they were adjusted; others follow from the take."""

    performer: str
    points: tuple[ContactPoint, ...]


@dataclass(frozen=True)
class QueueItem:
    """One line of the queue: a flag with its verdict.

    `current` is False for a decided flag that the latest analysis no longer raises. `decision` is
    the decision behind the verdict (whose flag may be an earlier one), None while open.
    """

    flag: Flag
    verdict: Verdict
    current: bool = True
    decision: Decision | None = None


@dataclass(frozen=True, eq=False)
class Sitting:
    """The undoable part of the document; what the session file keeps."""

    edits: tuple[Edit, ...] = ()
    decisions: tuple[Decision, ...] = ()
    protected: tuple[Protected, ...] = ()
    trims: tuple[tuple[str, tuple[int, int]], ...] = field(default=())
    contacts: tuple[OwnContact, ...] = ()
    points: tuple[OwnPoints, ...] = ()
    marker_edits: tuple[MarkerEdit, ...] = ()
