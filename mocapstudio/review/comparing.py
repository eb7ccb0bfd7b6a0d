"""The document of a comparison sitting: the one place where its state changes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from mocapstudio.comparison.model import Comparison
from mocapstudio.comparison.parameters import ComparisonParameters
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.parameters import schemas
from mocapstudio.review.comparing_kept import KeptComparison
from mocapstudio.review.comparing_naming import Naming
from mocapstudio.review.comparing_state import (
    MOST_SOURCES,
    Compared,
    ComparingState,
    Linked,
    Recording,
)
from mocapstudio.review.comparing_steps import Steps, Undoable

__all__ = ["MOST_SOURCES", "Compared", "Comparing", "ComparingState", "Linked", "Recording"]


class Comparing(Naming):
    """One reference and up to eight sources, compared, with two play heads that go together.

    Listeners hear once of each intent that changed the state. An intent that cannot be done raises
    `MocapError` and changes nothing.
    """

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
    def _free_id(name: str, sources: Iterable[Compared]) -> str:
        taken = {one.id for one in sources}
        if name not in taken:
            return name
        number = next(n for n in range(2, 2 + len(taken)) if f"{name} {n}" not in taken)
        return f"{name} {number}"
