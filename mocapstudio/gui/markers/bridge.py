"""What the Markers workspace shows, and the door to it."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any

from PySide6.QtCore import QObject, Signal

from mocapstudio.gui.document import DocumentBridge
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.review.marker_gaps import Span, TakeGaps, take_gaps
from mocapstudio.review.marker_model import MarkerEdit, MarkerPerformer
from mocapstudio.review.state import DocumentState

NOTHING = TakeGaps(())


@dataclass(frozen=True, eq=False)
class MarkersShown:
    """All that the views of the workspace show.

    Parameters
    ----------
    performer
        Id of the marker take that is shown, or "".
    source, result
        The take as it was read and with its edits, or None.
    edits
        Its edits, in the order in which they are done.
    protected
        Markers × spans that nothing may change.
    gaps
        What is missing of the result.
    frame
        Current frame, 0-based.
    marker
        Label of the chosen marker, or None.
    span
        Half-open span that is chosen, or None.
    playing, loop
        Whether the play head runs, and stays within the span.
    speed
        Share of real time at which it runs.
    longest
        Frames of the longest gap that is filled when all are.
    """

    performer: str = ""
    source: MarkerTake | None = None
    result: MarkerTake | None = None
    edits: tuple[MarkerEdit, ...] = ()
    protected: tuple[Declared, ...] = ()
    gaps: TakeGaps = NOTHING
    frame: int = 0
    marker: str | None = None
    span: Span | None = None
    playing: bool = False
    loop: bool = False
    speed: float = 1.0
    longest: int = 10

    @property
    def chosen_gap(self) -> Span | None:
        """The chosen marker's gap or filled span at the play head, else in the chosen span."""
        if self.marker is None:
            return None
        here = self.gaps.span_at(self.marker, self.frame)
        if here is None and self.span is not None:
            return self.gaps.first_within(self.marker, *self.span)
        return here


class MarkersBridge(QObject):
    """Tells the views of the workspace what is shown; they send intents here and to the document.

    Parameters
    ----------
    desk
        The document's door.
    parent
        Qt's parent.
    """

    changed = Signal(object, object)
    """Emitted with the old and the new `MarkersShown`, only where they differ."""

    def __init__(self, desk: DocumentBridge, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.desk = desk
        self._shown = MarkersShown()
        desk.changed.connect(self._follow)
        self._take_over(self._wanted())

    @property
    def shown(self) -> MarkersShown:
        """The frozen state."""
        return self._shown

    def set(self, **changes: Any) -> None:
        """Change fields of what is shown; equal values are not announced."""
        old, new = self._shown, replace(self._shown, **changes)
        if any(_differs(getattr(old, one.name), getattr(new, one.name)) for one in fields(new)):
            self._shown = new
            self.changed.emit(old, new)

    def show(self, performer: str) -> None:
        """Show another marker take."""
        self._take_over(performer)

    def go(self, frame: int) -> None:
        """Go to a frame; numbers outside are brought to the take's ends."""
        take = self._shown.result
        if take is not None:
            self.set(frame=min(max(int(frame), 0), take.frames - 1))

    def choose(self, marker: str | None, frame: int | None = None) -> None:
        """Choose a marker, go to a frame of it, and choose the gap that is there."""
        shown = self._shown
        at = shown.frame if frame is None else frame
        span = None if marker is None else shown.gaps.span_at(marker, at)
        self.set(marker=marker, span=span, frame=at)

    def next_gap(self, by: int) -> None:
        """Choose the next gap in time, or the one before, around the ends."""
        every, shown = self._shown.gaps.in_time, self._shown
        if not every:
            return
        start = shown.frame if shown.span is None else shown.span[0]
        here = (start, shown.marker or "")
        places = [(one.start, one.marker) for one in every]
        if by > 0:
            at = next((i for i, place in enumerate(places) if place > here), 0)
        else:
            before = [i for i, place in enumerate(places) if place < here]
            at = before[-1] if before else -1
        gap = every[at]
        self.set(marker=gap.marker, frame=gap.start, span=(gap.start, gap.end))

    def _follow(self, old: DocumentState, new: DocumentState) -> None:
        if old.markers is not new.markers or old.sitting is not new.sitting:
            self._take_over(self._wanted())

    def _wanted(self) -> str:
        """Id of the take that is to be shown: the one that is, else the last that was opened."""
        ids = [one.id for one in self.desk.state.markers]
        return self._shown.performer if self._shown.performer in ids else (ids or [""])[-1]

    def _take_over(self, performer: str) -> None:
        there: MarkerPerformer | None = next(
            (one for one in self.desk.state.markers if one.id == performer), None
        )
        if there is None:
            kept = self._shown
            empty = MarkersShown(longest=kept.longest, speed=kept.speed)
            self.set(**{one.name: getattr(empty, one.name) for one in fields(empty)})
            return
        shown, document = self._shown, self.desk.document
        result = document.marker_result(performer)
        changes: dict[str, Any] = {
            "performer": performer,
            "source": there.take,
            "result": result,
            "edits": document.marker_edits(performer),
            "protected": document.markers_protected(performer),
        }
        if result is not shown.result:
            changes["gaps"] = take_gaps(result)
        if there.take is not shown.source:
            gaps = changes.get("gaps", shown.gaps)
            worst = next((one for one in gaps.markers if one.gaps and not one.never_seen), None)
            first = None if worst is None else max(worst.gaps, key=lambda g: g[1] - g[0])
            changes |= {
                "marker": None if worst is None else worst.label,
                "span": first,
                "frame": 0 if first is None else first[0],
                "playing": False,
            }
        self.set(**changes)


def _differs(a: object, b: object) -> bool:
    if a is b:
        return False
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) != len(b) or any(_differs(x, y) for x, y in zip(a, b, strict=True))
    return bool(a != b)
