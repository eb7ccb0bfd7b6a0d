"""The frozen state of the document that every view is shown."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from mocapstudio.cleaning.model import Proposal
from mocapstudio.cleaning.parameters import DetectionParameters
from mocapstudio.motion.take import Take
from mocapstudio.review.comparing_kept import KeptComparison
from mocapstudio.review.manner import AS_THEY_ARE, Manner
from mocapstudio.review.marker_model import MarkerPerformer
from mocapstudio.review.model import Performer, QueueItem, Scene, Selection, Sitting

if TYPE_CHECKING:
    from mocapstudio.cleaning.analysis import Analysis


def _empty() -> Mapping[str, Any]:
    return MappingProxyType({})


@dataclass(frozen=True)
class SessionProblem:
    """Something the user should know about a session that was opened.

    Parameters
    ----------
    path
        The file it is about.
    what
        What is wrong or was recovered, as a phrase without a full stop.
    performer
        Id of the performer concerned, or None.
    """

    path: Path
    what: str
    performer: str | None = None


@dataclass(frozen=True, eq=False)
class DocumentState:
    """All that views show. Frames are 0-based frames of the active take.

    Parameters
    ----------
    scene
        Takes that share one clock and space.
    markers
        Marker takes of the sitting.
    active
        Id of the performer under review, or "".
    frame
        Current frame of the active take.
    selection
        Joints × span of one performer, at most one flag.
    parameters
        Of detection, as set for the next analysis.
    context
        Paths of the context as shown.
    analyses
        Latest analysis by performer id.
    queue
        Of the active performer: worst first, verdicts merged.
    sitting
        The undoable part: edits, decisions, protected spans, trims.
    choices, proposals
        By flag id of the active performer: neighbour chosen (None: the engine's own choice) and
        the replacement offered.
    manner
        How files are read.
    comparison
        What is compared beside the review.
    keep_ends
        Whether proposals leave hands and feet where they were.
    path
        The session file, or None while unsaved.
    dirty
        True while there is something to save.
    can_undo, can_redo
        Label of the step, or None.
    problems
        What was wrong when the session was opened.
    """

    scene: Scene = field(default_factory=Scene)
    markers: tuple[MarkerPerformer, ...] = ()
    active: str = ""
    frame: int = 0
    selection: Selection = field(default_factory=Selection)
    parameters: DetectionParameters = field(default_factory=DetectionParameters)
    context: tuple[Path | str, ...] = ()
    analyses: Mapping[str, Analysis] = field(default_factory=_empty)
    queue: tuple[QueueItem, ...] = ()
    sitting: Sitting = field(default_factory=Sitting)
    choices: Mapping[str, int | None] = field(default_factory=_empty)
    proposals: Mapping[str, Proposal] = field(default_factory=_empty)
    manner: Manner = AS_THEY_ARE
    comparison: KeptComparison = field(default_factory=KeptComparison)
    keep_ends: bool = False
    path: Path | None = None
    dirty: bool = False
    can_undo: str | None = None
    can_redo: str | None = None
    problems: tuple[SessionProblem, ...] = ()

    @property
    def threshold(self) -> float:
        """Value of the digression map above which flags are raised."""
        return self.parameters.threshold

    @property
    def mode(self) -> str:
        """Which digression map is made: ``"calibrated"`` or ``"paper"``."""
        return self.parameters.mode

    @property
    def performer(self) -> Performer | None:
        """The performer under review, or None in an empty scene."""
        return self.scene.performer(self.active) if self.active else None

    @property
    def everyone(self) -> tuple[Performer | MarkerPerformer, ...]:
        """The performers of the scene, then the marker takes."""
        return (*self.scene.performers, *self.markers)

    @property
    def take(self) -> Take | None:
        """The source take under review, or None in an empty scene."""
        performer = self.performer
        return None if performer is None else performer.take

    @property
    def analysis(self) -> Analysis | None:
        """Latest analysis of the active performer, or None."""
        return self.analyses.get(self.active)

    def item(self, flag_id: str | None) -> QueueItem | None:
        """Return the line of the queue with that flag id, or None."""
        return next((item for item in self.queue if item.flag.id == flag_id), None)

    @property
    def selected(self) -> QueueItem | None:
        """The line of the queue that is selected, or None."""
        return self.item(self.selection.flag)


def differing(old: DocumentState, new: DocumentState) -> frozenset[str]:
    """Names of the fields in which two states differ.

    What holds arrays is compared by identity, so this is cheap.
    """
    return frozenset(
        one.name
        for one in fields(DocumentState)
        if not _alike(getattr(old, one.name), getattr(new, one.name))
    )


def _alike(a: object, b: object) -> bool:
    if a is b:
        return True
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        return a.keys() == b.keys() and all(
            value is b[key] or (not hasattr(value, "__dict__") and value == b[key])
            for key, value in a.items()
        )
    return type(a) is type(b) and bool(a == b)
