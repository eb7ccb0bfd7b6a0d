"""The document of a comparison sitting: the one place where its state changes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

from mocapstudio.comparison.kata import retimed
from mocapstudio.comparison.model import Comparison, Segment
from mocapstudio.comparison.parameters import TIMING_ONLY, ComparisonParameters
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.parameters import schemas
from mocapstudio.review.announcer import Announcer
from mocapstudio.review.comparing_kept import KeptComparison
from mocapstudio.review.comparing_segments import Segments, check, with_segment
from mocapstudio.review.comparing_state import (
    MOST_SOURCES,
    Compared,
    ComparingState,
    Linked,
    Recording,
    differing,
)
from mocapstudio.review.comparing_steps import Steps, Undoable

__all__ = ["MOST_SOURCES", "Compared", "Comparing", "ComparingState", "Linked", "Recording"]


class Comparing:
    """One reference and up to eight sources, compared, with two play heads that go together.

    Listeners hear once of each intent that changed the state. An intent that cannot be done raises
    `MocapError` and changes nothing.
    """

    def __init__(self) -> None:
        self._state = ComparingState()
        self._steps = Steps()
        self._saved: Segments = ()
        self._absent: object = None
        self._announcer: Announcer[ComparingState] = Announcer()

    @property
    def state(self) -> ComparingState:
        """The frozen state as of now."""
        return self._state

    def subscribe(
        self, listener: Callable[[ComparingState, ComparingState], None]
    ) -> Callable[[], None]:
        """Call `listener(old, new)` at every change; returns what ends that."""
        return self._announcer.subscribe(listener)

    # -- who is compared

    def set_reference(self, take: Recording | None) -> None:
        """Compare to another performance; what was compared before is void, segments go."""
        if take is self._state.reference:
            return
        self._begin_segments()
        self._put(
            reference=take,
            sources=tuple(Compared(one.id, one.take) for one in self._state.sources),
            frame=0,
            source_frame=0,
            segment=None,
            labels=None,
        )

    def add_sources(self, takes: Iterable[Recording]) -> tuple[str, ...]:
        """Set performances beside the reference; returns their ids. The first one is chosen.

        Raises
        ------
        MocapError
            If there would be more than `MOST_SOURCES`.
        """
        sources = list(self._state.sources)
        before = len(sources)
        for take in takes:
            sources.append(Compared(self._free_id(take.name, sources), take))
        if len(sources) > MOST_SOURCES:
            raise MocapError(f"{len(sources)} sources; at most {MOST_SOURCES} are compared at once")
        new = tuple(one.id for one in sources[before:])
        if new and self._state.source is None:
            self._put(sources=tuple(sources), **self._choice(sources[before]))
        else:
            self._put(sources=tuple(sources))
        return new

    def remove(self, source: str) -> None:
        """Take a source away; where it was chosen, the next one is."""
        every = self._state.sources
        at = every.index(self._source(source))
        left = (*every[:at], *every[at + 1 :])
        if source != self._state.chosen:
            self._put(sources=left)
        elif left:
            self._put(sources=left, **self._choice(left[min(at, len(left) - 1)]))
        else:
            self._put(sources=left, chosen="", source_frame=0, row=None)

    def swap(self) -> None:
        """Let reference and chosen source change places.

        Raises
        ------
        MocapError
            If one of them is missing.
        """
        reference, source = self._state.reference, self._state.source
        if reference is None or source is None:
            raise MocapError("a reference and a source are needed to change places")
        others = [one for one in self._state.sources if one is not source]
        back = Compared(self._free_id(reference.name, others), reference)
        at = self._state.sources.index(source)
        self._begin_segments()
        sources = tuple(Compared(one.id, one.take) for one in (*others[:at], back, *others[at:]))
        choice = self._choice(sources[at], frame=0)
        self._put(
            reference=source.take, sources=sources, segment=None, labels=None, frame=0, **choice
        )

    def clear(self) -> None:
        """Begin anew, with the parameters as they are."""
        self._begin_segments()
        self._put(
            reference=None, sources=(), chosen="", frame=0, source_frame=0, shown=(-0.5, 0.5),
            row=None, segment=None, labels=None,
        )  # fmt: skip

    def kept(self) -> KeptComparison:
        """Return what the session file keeps."""
        state = self._state
        return KeptComparison(
            reference=state.reference,
            sources=tuple((one.id, one.take) for one in state.sources),
            parameters=state.parameters,
            segments=state.segments,
            labels=state.labels,
            unsaved=state.unsaved,
            chosen=state.chosen,
            row=state.row,
            segment=state.segment,
            frame=state.frame,
            source_frame=state.source_frame,
            shown=state.shown,
            absent=self._absent,
        )

    def restore(self, kept: KeptComparison) -> None:
        """Go on with what a session file had kept; nothing of it can be undone."""
        self._steps = Steps(Undoable(kept.segments, kept.parameters))
        self._saved, self._absent = () if kept.unsaved else kept.segments, kept.absent
        sources = tuple(Compared(one, take) for one, take in kept.sources)
        ids = [one.id for one in sources]
        chosen = kept.chosen if kept.chosen in ids else ids[0] if ids else ""
        take = dict(kept.sources).get(chosen)
        self._put(
            reference=kept.reference, sources=sources, chosen=chosen, row=kept.row,
            segment=kept.segment, labels=kept.labels, shown=kept.shown,
            frame=self._kept(kept.frame, kept.reference),
            source_frame=self._kept(kept.source_frame, take),
        )  # fmt: skip

    def choose(self, source: str) -> None:
        """Show another source; the reference's frame stays, and about what is visible of it."""
        one = self._source(source)
        if source != self._state.chosen:
            self._put(**self._choice(one))

    def set_parameters(self, parameters: ComparisonParameters) -> None:
        """Compare in another way, as a step that can be undone.

        What was compared before is void, unless the alignment stays as it was.
        """
        old, words = self._state.parameters, schemas(ComparisonParameters)
        names = [name for name in words if getattr(old, name) != getattr(parameters, name)]
        label = "Change Parameters" if len(names) != 1 else f"Change {words[names[0]].label}"
        present = replace(self._steps.present, parameters=parameters)
        self._steps = self._steps.push(label, present, joining=True)
        self._put()

    def compare_again(self) -> None:
        """Try once more what failed or was cancelled."""
        tried = (Compared(one.id, one.take) if one.failure else one for one in self._state.sources)
        self._put(sources=tuple(tried))

    def pending(self) -> tuple[Compared, ...]:
        """Sources that are still to be compared."""
        if self._state.reference is None:
            return ()
        return tuple(one for one in self._state.sources if one.linked is None and not one.failure)

    def finish(self, source: Compared, comparison: Comparison) -> bool:
        """Take a result over. False, and nothing changes, where it is stale.

        Parameters
        ----------
        source
            As `pending` gave it when the work began.
        """
        return self._settle(source, replace(source, linked=Linked(comparison)))

    def fail(self, source: Compared, why: str) -> bool:
        """Note why a source cannot be compared. False where that is stale."""
        return self._settle(source, replace(source, failure=why))

    # -- where the play heads are

    def go(self, frame: int) -> None:
        """Go to a frame of the reference; the source follows along the path."""
        at = self._kept(frame, self._state.reference)
        linked = self._state.linked
        self._put(frame=at, source_frame=0 if linked is None else linked.source_of(at))

    def go_source(self, frame: int) -> None:
        """Go to a frame of the chosen source; the reference follows along the path."""
        source = self._state.source
        at = self._kept(frame, None if source is None else source.take)
        linked = self._state.linked
        self._put(source_frame=at, frame=0 if linked is None else linked.reference_of(at))

    def go_both(self, frame: int, source_frame: int) -> None:
        """Go to a frame of each, whether or not the path joins them."""
        source = self._state.source
        self._put(
            frame=self._kept(frame, self._state.reference),
            source_frame=self._kept(source_frame, None if source is None else source.take),
        )

    def show(self, start: float, end: float) -> None:
        """Show another stretch of the pictures, in frames of the chosen source."""
        self._put(shown=(float(start), float(end)))

    def select_row(self, row: str | None) -> None:
        """Select a joint or marker, or none."""
        self._put(row=row)

    # -- segments

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

    # -- within

    def _put(self, **changes: Any) -> None:
        steps, old = self._steps, self._state
        present = steps.present
        if present.parameters != old.parameters:
            changes.setdefault("sources", _under(present.parameters, old))
        new = replace(
            old,
            **changes,
            segments=present.segments,
            parameters=present.parameters,
            can_undo=steps.past[-1][0] if steps.past else None,
            can_redo=steps.future[-1][0] if steps.future else None,
            unsaved=present.segments != self._saved,
        )
        if differing(old, new):
            self._state = new
            self._announcer.announce(old, new)

    def _segment(self, label: str, segments: Segments, selected: int | None) -> None:
        reference = self._state.reference
        if reference is None:
            raise MocapError("there is no reference whose parts could be named")
        present = replace(self._steps.present, segments=check(segments, reference.frames))
        self._steps = self._steps.push(label, present)
        self._put(segment=selected)

    def _begin_segments(self) -> None:
        """Forget the segments, and how to bring them back."""
        self._steps, self._saved = Steps(Undoable(parameters=self._state.parameters)), ()
        self._absent = None

    def _at(self, at: int) -> Segment:
        if not 0 <= at < len(self._state.segments):
            raise MocapError(f"there is no segment {at}")
        return self._state.segments[at]

    def _source(self, source: str) -> Compared:
        found = next((one for one in self._state.sources if one.id == source), None)
        if found is None:
            raise MocapError(f"no source {source}")
        return found

    def _choice(self, one: Compared, frame: int | None = None) -> dict[str, Any]:
        """Fields of a state that shows a source, at the reference's frame."""
        at = self._state.frame if frame is None else frame
        linked, before = one.linked, self._state.linked
        whole = (-0.5, one.take.frames - 0.5)
        shown = whole
        if linked is not None and before is not None and self._state.source is not None:
            start, end = self._state.shown
            zoomed = end - start < self._state.source.take.frames
            if zoomed:
                edges = (linked.source_of(before.reference_of(edge)) for edge in (start, end))
                left, right = edges
                shown = (left - 0.5, max(right, left + 5) + 0.5)
        row = self._state.row
        if linked is not None and row not in linked.comparison.rows:
            row = None
        source_frame = 0 if linked is None else linked.source_of(at)
        return {"chosen": one.id, "source_frame": source_frame, "shown": shown, "row": row}

    def _settle(self, before: Compared, after: Compared) -> bool:
        every = self._state.sources
        if not any(one is before for one in every):
            return False
        sources = tuple(after if one is before else one for one in every)
        if after.id != self._state.chosen or after.linked is None:
            self._put(sources=sources)
        else:
            at = after.linked.source_of(self._state.frame)
            self._put(sources=sources, source_frame=at)
        return True

    @staticmethod
    def _kept(frame: int, take: Recording | None) -> int:
        return 0 if take is None else min(max(int(frame), 0), take.frames - 1)

    @staticmethod
    def _free_id(name: str, sources: Iterable[Compared]) -> str:
        taken = {one.id for one in sources}
        if name not in taken:
            return name
        number = next(n for n in range(2, 2 + len(taken)) if f"{name} {n}" not in taken)
        return f"{name} {number}"


def _under(parameters: ComparisonParameters, old: ComparingState) -> tuple[Compared, ...]:
    """Return the sources as they are under other parameters: timed anew, or not compared yet."""
    before = old.parameters
    same = replace(before, **{name: getattr(parameters, name) for name in TIMING_ONLY})
    if same != parameters:
        return tuple(Compared(one.id, one.take) for one in old.sources)
    return tuple(
        one
        if one.comparison is None
        else replace(one, linked=Linked(retimed(one.comparison, parameters)))
        for one in old.sources
    )
