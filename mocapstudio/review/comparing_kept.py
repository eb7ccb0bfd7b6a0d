"""What the session file keeps of a comparison."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from mocapstudio.comparison.model import Segment
from mocapstudio.comparison.parameters import ComparisonParameters
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take


@dataclass(frozen=True)
class KeptComparison:
    """A comparison without what comes of comparing; recordings are told apart by identity.

    Parameters
    ----------
    reference
        The performance compared to, or None.
    sources
        Id and performance of each source, in their order.
    parameters
        How they are compared.
    segments
        Named parts of the reference.
    labels, unsaved
        The file the segments were last read from or written to, and whether they are others now.
    chosen, row, segment
        Selected source, joint or marker, and segment.
    frame, source_frame, shown
        Where the play heads are, and the visible stretch.
    absent
        Records of what was not found when the session was opened; they are saved as they were.
    """

    reference: Take | MarkerTake | None = None
    sources: tuple[tuple[str, Take | MarkerTake], ...] = ()
    parameters: ComparisonParameters = field(default_factory=ComparisonParameters)
    segments: tuple[Segment, ...] = ()
    labels: Path | None = None
    unsaved: bool = False
    chosen: str = ""
    row: str | None = None
    segment: int | None = None
    frame: int = 0
    source_frame: int = 0
    shown: tuple[float, float] = (-0.5, 0.5)
    absent: object = None

    @property
    def lasting(self) -> tuple[object, ...]:
        """What is worth saving: not where one looks."""
        return (
            self.reference, self.sources, self.parameters, self.segments, self.labels,
            self.unsaved, self.absent,
        )  # fmt: skip
