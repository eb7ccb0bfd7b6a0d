"""What a comparison sitting knows at one moment: who is compared, where the play heads are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison.model import Comparison, Segment
from mocapstudio.comparison.parameters import ComparisonParameters
from mocapstudio.comparison.segments import CarriedSegment, carried
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take

Recording = Take | MarkerTake

MOST_SOURCES = 8


class Linked:
    """A comparison's warping path, asked from either side.

    Parameters
    ----------
    comparison
        R reference frames and S source frames, P steps of the path.
    """

    def __init__(self, comparison: Comparison) -> None:
        self.comparison = comparison
        pairs = comparison.path.astype(np.int64)
        self.frames = len(comparison.reference_poses), len(comparison.source_poses)
        steps = np.diff(pairs, axis=0, prepend=pairs[:1])
        rates = float(comparison.reference_rate), float(comparison.source_rate)
        # A step lasts as long as the performer who moves in it; who waits stands still.
        self.seconds: NDArray[np.float64] = np.cumsum((steps / np.array(rates)).max(axis=1))
        self._pairs = pairs

    @property
    def duration(self) -> float:
        """Seconds that a walk along the whole path takes."""
        return float(self.seconds[-1])

    def at(self, seconds: float) -> tuple[int, int]:
        """Reference and source frame so many seconds into the walk along the path."""
        step = int(np.searchsorted(self.seconds, seconds + 1e-9, side="right")) - 1
        reference, source = self._pairs[min(max(step, 0), len(self._pairs) - 1)]
        return int(reference), int(source)

    def seconds_at(self, reference: int, source: int) -> float:
        """Seconds into the walk at the step nearest to a pair of frames."""
        apart = np.abs(self._pairs - np.array([reference, source])).sum(axis=1)
        return float(self.seconds[int(np.argmin(apart))])

    def nearest(self, reference: float, source: float) -> tuple[int, int]:
        """Reference and source frame of the step of the path nearest to a pair."""
        apart = np.abs(self._pairs - np.array([reference, source])).sum(axis=1)
        frame, other = self._pairs[int(np.argmin(apart))]
        return int(frame), int(other)

    def reference_of(self, source: float) -> int:
        """Reference frame that matches a source frame."""
        at = min(max(round(source), 0), self.frames[1] - 1)
        return min(max(round(float(self.comparison.warp[at])), 0), self.frames[0] - 1)

    def source_of(self, reference: float) -> int:
        """Source frame that matches a reference frame: the middle of all that do."""
        return round(float(np.interp(reference, *self._inverse)))

    def carried(self, segments: Sequence[Segment]) -> tuple[CarriedSegment, ...]:
        """Segments of the reference with what answers to each in the source."""
        return carried(segments, self.comparison)

    @cached_property
    def matched(self) -> NDArray[np.int64]:
        """(R,) the source frame that matches each reference frame."""
        at = np.interp(np.arange(self.frames[0]), *self._inverse)
        rounded: NDArray[np.int64] = np.rint(at).astype(np.int64)
        return rounded

    @cached_property
    def _inverse(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        reference, source = self._pairs.T
        count = np.bincount(reference)
        total = np.bincount(reference, weights=source.astype(np.float64))
        known = np.flatnonzero(count)
        return known.astype(np.float64), total[known] / count[known]


@dataclass(frozen=True, eq=False)
class Compared:
    """One source and what came of comparing it.

    Parameters
    ----------
    id
        Its name in this sitting, unique.
    take
        The performance.
    linked
        The comparison with the reference, or None while there is none.
    failure
        Why there is none, or "".
    """

    id: str
    take: Recording
    linked: Linked | None = None
    failure: str = ""

    @property
    def comparison(self) -> Comparison | None:
        """The comparison with the reference, or None while there is none."""
        return None if self.linked is None else self.linked.comparison


@dataclass(frozen=True, eq=False)
class ComparingState:
    """A comparison sitting, frozen.

    Parameters
    ----------
    reference
        The performance compared to, or None.
    sources
        The performances compared, at most `MOST_SOURCES`, in the order they came.
    chosen
        Id of the source that the pictures show, or "".
    frame, source_frame
        Current frames of the reference and of the chosen source.
    shown
        Visible stretch of the pictures, in frames of the chosen source: left and right edge.
    row
        The selected joint or marker, or None.
    parameters
        How performances are compared.
    segments
        Named parts of the reference, in order of time, none overlapping another.
    segment
        Position of the selected segment, or None.
    can_undo, can_redo
        What Undo and Redo would do to segments and parameters, or None.
    labels
        The file the segments were last read from or written to, or None.
    unsaved
        Whether the segments are others than in that file.
    """

    reference: Recording | None = None
    sources: tuple[Compared, ...] = ()
    chosen: str = ""
    frame: int = 0
    source_frame: int = 0
    shown: tuple[float, float] = (-0.5, 0.5)
    row: str | None = None
    parameters: ComparisonParameters = field(default_factory=ComparisonParameters)
    segments: tuple[Segment, ...] = ()
    segment: int | None = None
    can_undo: str | None = None
    can_redo: str | None = None
    labels: Path | None = None
    unsaved: bool = False

    @property
    def source(self) -> Compared | None:
        """The chosen source, or None."""
        return next((one for one in self.sources if one.id == self.chosen), None)

    @property
    def linked(self) -> Linked | None:
        """The chosen source's path, or None while there is none."""
        return None if self.source is None else self.source.linked

    @property
    def comparison(self) -> Comparison | None:
        """The chosen source's comparison, or None while there is none."""
        return None if self.source is None else self.source.comparison

    @property
    def ranking(self) -> tuple[Compared, ...]:
        """All sources, the most alike first; what is not compared yet comes last."""

        def unlike(one: Compared) -> float:
            return np.inf if one.comparison is None else one.comparison.dissimilarity

        return tuple(sorted(self.sources, key=unlike))

    def frame_of(self, source: Compared) -> int:
        """Current frame of any source: the one that matches the reference's."""
        if source.id == self.chosen:
            return self.source_frame
        return 0 if source.linked is None else source.linked.source_of(self.frame)


_HEADS = {"frame", "source_frame"}
_VIEW = _HEADS | {"shown"}
_NAMES = tuple(one.name for one in fields(ComparingState))


def differing(old: ComparingState, new: ComparingState) -> frozenset[str]:
    """Names of the fields in which two states differ; what cannot change in place by identity."""
    return frozenset(
        name
        for name in _NAMES
        if getattr(old, name) is not getattr(new, name)
        and (name in ("reference", "sources") or getattr(old, name) != getattr(new, name))
    )


def only_view_differs(old: ComparingState, new: ComparingState) -> bool:
    """Tell whether two states differ in frames and visible stretch at most, as while zooming."""
    return differing(old, new) <= _VIEW


def only_heads_differ(old: ComparingState, new: ComparingState) -> bool:
    """Tell whether two states differ in the current frames at most, as while playing."""
    return differing(old, new) <= _HEADS
