"""Filling gaps in the background, and the edits that need no work."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import QObject

from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.markers.bridge import MarkersBridge
from mocapstudio.gui.messages import Messages
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.review.marker_fills import METHODS, fill_method, filling
from mocapstudio.review.marker_gaps import GapSpan
from mocapstudio.review.marker_model import Fill, MarkerEdit


class Working(QObject):
    """Does what the commands ask for.

    Parameters
    ----------
    bridge
        What is shown and chosen.
    jobs
        Runs the filling.
    messages
        Is told what came of it.
    parent
        Qt's parent.
    """

    def __init__(
        self, bridge: MarkersBridge, jobs: Jobs, messages: Messages, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._bridge, self._jobs, self._messages = bridge, jobs, messages

    def fill(self, method: str) -> None:
        """Fill the chosen marker's gap at the play head; one that was filled is filled anew."""
        shown = self._bridge.shown
        gap = shown.chosen_gap
        if shown.marker is None or gap is None:
            self._messages.tell("There is no gap of the chosen marker at the play head.")
            return
        span = Declared(shown.marker, *gap)
        performer = shown.performer
        for one in shown.protected:
            if one.row == span.row and one.start < gap[1] and gap[0] < one.end:
                words = f"{one.row} is protected there: Shift+U lifts the protection."
                self._messages.tell(words)
                return

        def unfilled() -> MarkerTake:
            return self._bridge.desk.document.unfilled(performer, (span,))

        self._start(unfilled, method, (span,), f"{shown.marker}, {gap[1] - gap[0]} frames")

    def fill_all(self) -> None:
        """Fill every gap up to the length that is set."""
        shown = self._bridge.shown
        spans = [Declared(one.marker, one.start, one.end) for one in self.short_gaps()]
        if not spans:
            self._messages.tell("What is protected is not filled: no other gap is as short.")
        elif shown.result is not None:
            performer = shown.performer

            def result() -> MarkerTake:
                return self._bridge.desk.document.marker_result(performer)

            words = f"{len(spans)} gaps up to {shown.longest} frames"
            self._start(result, METHODS[0].name, spans, words, {"longest": shown.longest})

    def short_gaps(self) -> Sequence[GapSpan]:
        """Return the gaps that `fill_all` would fill: those that nothing protects."""
        closed = self._bridge.shown.protected
        return [
            one
            for one in self._bridge.shown.gaps.up_to(self._bridge.shown.longest)
            if not any(
                row.row == one.marker and one.start < row.end and row.start < one.end
                for row in closed
            )
        ]

    def clear(self) -> None:
        """Take the chosen marker's samples away in the chosen span, or at the play head."""
        shown = self._bridge.shown
        if shown.marker is not None:
            name, span = shown.marker, self._span()
            document = self._bridge.desk.document
            doing = f"{name} could not be taken away"
            self._try(doing, lambda: document.clear_markers(shown.performer, [name], *span))

    def exchange(self, other: str, start: int, end: int) -> None:
        """Exchange the chosen marker's label with another's over [start, end)."""
        shown = self._bridge.shown
        if shown.marker is not None:
            name, document = shown.marker, self._bridge.desk.document
            doing = f"{name} and {other} could not be exchanged"
            if self._try(
                doing,
                lambda: document.exchange_markers(shown.performer, name, other, start, end),
            ):
                self._messages.tell(f"Exchanged {name} and {other} in {end - start} frames.")

    def mute(self, edits: Sequence[MarkerEdit], muted: bool) -> None:
        """Switch edits off, or on again, as one step."""
        document = self._bridge.desk.document

        def do() -> None:
            with document.group(f"{'Mute' if muted else 'Unmute'} {len(edits)} edits"):
                for edit in edits:
                    document.mute_marker_edit(edit.id, muted)

        self._try("The edit could not be switched", do)

    def delete(self, edits: Sequence[MarkerEdit]) -> None:
        """Take edits back, as one step."""
        ids, document = [edit.id for edit in edits], self._bridge.desk.document
        self._try("The edit could not be taken back", lambda: document.delete_marker_edits(ids))

    def protect(self) -> None:
        """Protect the chosen marker, or all of them, in the chosen span."""
        shown, document = self._bridge.shown, self._bridge.desk.document
        if shown.source is not None and shown.span is not None:
            span, rows = shown.span, self._rows()
            doing = "This could not be protected"
            if self._try(doing, lambda: document.protect_markers(shown.performer, rows, *span)):
                self._messages.tell("Nothing will change there. Shift+U lifts the protection.")

    def unprotect(self) -> None:
        """Lift the protection of the chosen marker in the chosen span, or everywhere."""
        shown, document = self._bridge.shown, self._bridge.desk.document
        if shown.source is not None:
            span, rows = shown.span or (0, shown.source.frames), self._rows()
            doing = "The protection could not be lifted"
            self._try(doing, lambda: document.unprotect_markers(shown.performer, rows, *span))

    def _rows(self) -> tuple[str, ...]:
        marker = self._bridge.shown.marker
        return () if marker is None else (marker,)

    def _span(self) -> tuple[int, int]:
        shown = self._bridge.shown
        return shown.span or (shown.frame, shown.frame + 1)

    def _try(self, doing: str, do: Callable[[], object]) -> bool:
        try:
            do()
        except MocapError as error:
            self._messages.complain(error, doing)
            return False
        return True

    def edits_here(self) -> list[MarkerEdit]:
        """Edits that change the chosen marker in the chosen span, or at the play head."""
        shown = self._bridge.shown
        if shown.marker is None:
            return []
        start, end = self._span()
        return [one for one in shown.edits if one.touches(shown.marker, start, end)]

    def take_back(self) -> None:
        """Delete the last edit of the chosen marker here, whatever came after it elsewhere."""
        here = self.edits_here()
        if here:
            self.delete(here[-1:])

    def _start(
        self,
        current: Callable[[], MarkerTake],
        method: str,
        spans: Sequence[Declared],
        words: str,
        parameters: dict[str, int | float | str] | None = None,
    ) -> None:
        performer, take = self._bridge.shown.performer, current()
        doing = f"{words} could not be filled"

        def done(fills: tuple[Fill, ...]) -> None:
            document = self._bridge.desk.document
            try:
                if current() is not take:
                    self._messages.tell("The take changed meanwhile: nothing was filled.")
                    return
                if fills:
                    document.fill_gaps(performer, fills, method, parameters or {})
            except MocapError as error:
                self._messages.complain(error, doing)
                return
            self._tell(fills, len(spans), method)

        self._jobs.start(
            f"Filling {words}",
            filling(take, method, spans),
            done,
            lambda error: self._messages.complain(error, doing),
            key="markers-fill",
        )

    def _tell(self, fills: Sequence[Fill], wanted: int, method: str) -> None:
        words = fill_method(method).words
        if not fills:
            short = "needs more than is there: try another way"
            self._messages.tell(f"Nothing was filled: “{words}” {short}.")
        elif wanted == 1:
            one = fills[0]
            self._messages.tell(f"Filled {one.marker} in {one.end - one.start} frames by {words}.")
        else:
            self._messages.tell(f"Filled {len(fills)} of {wanted} gaps by {words}.")
