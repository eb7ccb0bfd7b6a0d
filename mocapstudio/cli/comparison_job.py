"""Comparing sources with one reference, and what is told of it."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mocapstudio import formats
from mocapstudio.cli import progress
from mocapstudio.cli.take_files import Workload
from mocapstudio.comparison import kata, segments
from mocapstudio.comparison.labels import Labels, labels_of, read_labels
from mocapstudio.comparison.masking import Flagged, mask_of
from mocapstudio.comparison.parameters import ComparisonParameters
from mocapstudio.motion.errors import FileError, MocapError

if TYPE_CHECKING:
    from mocapstudio.comparison.model import Comparison, Segment
    from mocapstudio.comparison.segments import CarriedSegment
    from mocapstudio.formats import Recording

_SHOWN_PROBLEMS = 3


def read_recordings(work: Workload, path: Path) -> list[Recording]:
    """Read the recordings of a file, of joints or of markers.

    Raises
    ------
    FileError
        If the file cannot be read.
    """
    found, report = formats.read_any(path, work.options.reading())
    for problem in [one for one in report.problems if not one.guess][:_SHOWN_PROBLEMS]:
        place = "-" if problem.line is None else problem.line
        print(f"warning: {path}: {place}: {problem.what}; {problem.done}", file=sys.stderr)
    return list(found)


class Compared:
    """One source that was compared."""

    def __init__(
        self,
        path: Path,
        source: Recording,
        comparison: Comparison,
        carried: Sequence[CarriedSegment],
    ) -> None:
        self.path, self.source = path, source
        self.comparison, self.carried = comparison, carried
        self.label_error: dict[str, float] | None = None

    def as_json(self) -> dict[str, Any]:
        """Return what the JSON says of the source."""
        found = self.comparison
        return {
            "path": str(self.path),
            "name": found.source,
            "fps": float(found.source_rate),
            "path_pairs": found.path.tolist(),
            "misalignment": found.misalignment.tolist(),
            "misalignment_relative": found.misalignment_relative.tolist(),
            "timing": found.timing.tolist(),
            "pose_difference": found.pose_difference.astype(float).tolist(),
            "dissimilarity": found.dissimilarity,
            "doubt": found.doubt,
            "rows": list(found.rows),
            "segments": [_segment_as_json(one) for one in self.carried],
            "label_error": self.label_error,
            "warnings": list(found.warnings),
        }


def _segment_as_json(one: CarriedSegment) -> dict[str, Any]:
    return {
        "name": one.reference.name,
        "reference": {"start": one.reference.start, "end": one.reference.end},
        "start": one.source.start,
        "end": one.source.end,
        "delay": one.delay,
        "delay_relative": one.delay_relative,
        "reference_duration": one.reference_duration,
        "duration": one.source_duration,
        "pose_difference": one.pose_difference,
    }


class ComparisonJob:
    """Compares sources with one reference."""

    def __init__(
        self,
        work: Workload,
        path: Path,
        chosen: ComparisonParameters,
        names: Mapping[str, str],
        labels: Path | None,
        flags: Mapping[str, Sequence[Flagged]],
    ) -> None:
        self.path, self.chosen, self.names = path, chosen, names
        self.reference = read_recordings(work, path)[0]
        self.flags = flags
        self._masked: set[str] = set()
        self.mask = self._mask(self.reference, path)
        self.given = self._given(labels)
        self.labels = self._segments(labels)
        self.done: list[Compared] = []

    def run(self, source: Recording, path: Path) -> Compared:
        """Compare one source; its warnings go to standard error."""
        work = kata.compare(
            self.reference,
            source,
            self.chosen,
            reference_unreliable=self.mask,
            source_unreliable=self._mask(source, path),
            names=self.names,
        )
        try:
            comparison = progress.run(work, source.name)
        except MocapError as error:
            raise FileError(path, str(error)) from error
        for warning in comparison.warnings:
            print(f"warning: {path}: -: {warning}", file=sys.stderr)
        carried = segments.carried(self.labels.segments, comparison)
        done = Compared(path, source, comparison, carried)
        theirs = labels_of(path.name, self.given) or labels_of(source.name, self.given)
        if theirs is not None:
            found = [one.source for one in carried]
            done.label_error = _error(found, theirs.at_rate(source.rate))
        self.done.append(done)
        return done

    def as_json(self) -> dict[str, Any]:
        """Return what the JSON says of all."""
        ranking = sorted(self.done, key=lambda one: one.comparison.dissimilarity)
        known = _error(segments.suggested(self.reference), self.labels) if self.given else None
        return {
            "parameters": asdict(self.chosen),
            "reference": {
                "path": str(self.path),
                "name": self.reference.name,
                "fps": float(self.reference.rate),
                "segments": self.labels.to_json()["segments"],
                "suggestion_error": known,
            },
            "sources": [one.as_json() for one in self.done],
            "ranking": [str(one.path) for one in ranking],
        }

    def _mask(self, recording: Recording, path: Path) -> NDArray[np.bool_] | None:
        flagged = self.flags.get(path.stem, ())
        self._masked.add(path.stem)
        if not flagged:
            return None
        try:
            return mask_of(recording, flagged, self.chosen.features)
        except MocapError as error:
            raise FileError(path, f"is not what was flagged: {error}") from error

    def unused_flags(self) -> list[str]:
        """Names of takes of which flags were given and that were not compared."""
        return sorted(set(self.flags) - self._masked)

    def _given(self, path: Path | None) -> list[Labels]:
        return [] if path is None else read_labels(path)

    def _segments(self, path: Path | None) -> Labels:
        rate = self.reference.rate
        if path is None:
            return Labels(self.reference.name, rate, segments.suggested(self.reference))
        found = labels_of(self.path.name, self.given)
        found = found or labels_of(self.reference.name, self.given)
        if found is None:
            raise FileError(path, f"holds no labels of {self.reference.name}")
        found = found.at_rate(rate)
        if found.segments and found.segments[-1].end > self.reference.frames:
            raise FileError(
                path,
                f"segment {found.segments[-1].name} ends at frame {found.segments[-1].end} of"
                f" {self.reference.frames}",
            )
        return found


def _error(found: Sequence[Segment], given: Labels) -> dict[str, float] | None:
    """Seconds from boundaries set by hand to the nearest found; None where there are none."""
    errors = segments.boundary_errors(found, given.segments, float(given.rate))
    if not len(errors) or not np.isfinite(errors).all():
        return None
    return {"median": float(np.median(errors)), "largest": float(errors.max())}
