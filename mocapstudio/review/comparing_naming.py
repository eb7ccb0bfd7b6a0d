"""Intents about the named parts of the reference."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from mocapstudio.comparison.model import Segment
from mocapstudio.motion.errors import MocapError
from mocapstudio.review.comparing_core import ComparingCore
from mocapstudio.review.comparing_segments import Segments, check, with_segment


class Naming(ComparingCore):
    """Segments: drawn, named, moved, deleted; every step can be undone."""

    def add_segment(self, start: int, end: int, name: str | None = None) -> None:
        """Name a part of the reference, and select it; what it covers of others goes."""
        new = Segment(name or f"segment {len(self._state.segments) + 1}", start, end)
        segments = with_segment(self._state.segments, new)
        self._segment(f"New Segment {new.name}", segments, segments.index(new))

    def rename_segment(self, at: int, name: str) -> None:
        """Call a segment something else; an empty name changes nothing."""
        old = self._at(at)
        if name.strip():
            new = replace(old, name=name.strip())
            every = self._state.segments
            self._segment(f"Rename {old.name}", (*every[:at], new, *every[at + 1 :]), at)

    def move_segment(self, at: int, start: int, end: int) -> None:
        """Give a segment other edges; what it covers of others goes."""
        new = replace(self._at(at), start=start, end=end)
        every = self._state.segments
        segments = with_segment((*every[:at], *every[at + 1 :]), new)
        self._segment(f"Move {new.name}", segments, segments.index(new))

    def delete_segment(self, at: int) -> None:
        """Delete a segment."""
        old, every = self._at(at), self._state.segments
        self._segment(f"Delete {old.name}", (*every[:at], *every[at + 1 :]), None)

    def set_segments(self, segments: Iterable[Segment], label: str) -> None:
        """Put other segments in the place of all."""
        self._segment(label, tuple(segments), None)

    def select_segment(self, at: int | None) -> None:
        """Select a segment and go to its first frame, or select none."""
        if at is None:
            self._put(segment=None)
        else:
            segment = self._at(at)
            self._put(segment=at)
            self.go(segment.start)

    def mark_saved(self, path: Path) -> None:
        """Note that the segments stand in a file."""
        self._saved = self._steps.present.segments
        self._put(labels=path)

    def undo(self) -> None:
        """Take the last step over segments or parameters back."""
        self._steps = self._steps.undo()
        self._put(segment=None)

    def redo(self) -> None:
        """Do the step again that was undone last."""
        self._steps = self._steps.redo()
        self._put(segment=None)

    def _segment(self, label: str, segments: Segments, selected: int | None) -> None:
        reference = self._state.reference
        if reference is None:
            raise MocapError("there is no reference whose parts could be named")
        present = replace(self._steps.present, segments=check(segments, reference.frames))
        self._steps = self._steps.push(label, present)
        self._put(segment=selected)

    def _at(self, at: int) -> Segment:
        if not 0 <= at < len(self._state.segments):
            raise MocapError(f"there is no segment {at}")
        return self._state.segments[at]
