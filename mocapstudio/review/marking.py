"""Intents about marker takes: each is one undoable step."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any

from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.review import protection
from mocapstudio.review.core import Core, new_id
from mocapstudio.review.decisions import Stamp
from mocapstudio.review.marker_fills import fill_method
from mocapstudio.review.marker_model import (
    Fill,
    MarkerEdit,
    MarkerEditKind,
    MarkerPerformer,
    Parameters,
)
from mocapstudio.review.marker_replay import marker_declared
from mocapstudio.review.model import Protected, Sitting
from mocapstudio.review.rows import check_span, union

_NONE: Parameters = MappingProxyType({})


class Marking(Core):
    """Marker takes of the sitting, and the edits over them."""

    def open_markers(self, take: MarkerTake) -> str:
        """Add a marker take to the sitting and return its performer's id."""
        performer = MarkerPerformer(self._free_id(take.name), take)
        self.recorder.opened(performer)
        self._put(markers=(*self._state.markers, performer))
        return performer.id

    def close_markers(self, performer: str) -> None:
        """Take a marker take out of the sitting and forget all about it, in the history too."""
        gone = self.marker_performer(performer)
        self._forget_markers(performer)
        self.recorder.closed(performer)
        self._put(markers=tuple(one for one in self._state.markers if one is not gone))

    def replace_markers(self, performer: str, take: MarkerTake) -> None:
        """Put another reading of its file in the place of a marker take.

        All about the performer is forgotten, in the history too.
        """
        old = self.marker_performer(performer)
        new = replace(old, take=take)
        self._forget_markers(performer)
        self.recorder.closed(performer)
        self.recorder.opened(new)
        self._put(markers=tuple(new if one is old else one for one in self._state.markers))

    def marker_performer(self, performer: str) -> MarkerPerformer:
        """Return a marker take of the sitting.

        Raises
        ------
        MocapError
            If there is none of that id.
        """
        for one in self._state.markers:
            if one.id == performer:
                return one
        raise MocapError(f"no marker take {performer}")

    def marker_edits(self, performer: str) -> tuple[MarkerEdit, ...]:
        """Edits of one marker take, in the order in which they are done."""
        edits = self._history.present.marker_edits
        return tuple(edit for edit in edits if edit.performer == performer)

    def marker_result(self, performer: str) -> MarkerTake:
        """Return the source with all unmuted edits done; the same object while nothing changes."""
        take = self.marker_performer(performer).take
        return self._marker_results.of(performer, take, self.marker_edits(performer))

    def unfilled(self, performer: str, spans: Sequence[Declared]) -> MarkerTake:
        """Return the result without the fills of some markers × spans: what fills them anew."""
        again = {id(edit) for edit in self._fills_of(performer, spans)}
        left = [edit for edit in self.marker_edits(performer) if id(edit) not in again]
        return self._unfilled.of(performer, self.marker_performer(performer).take, left)

    def marker_declared(self, performer: str) -> tuple[Declared, ...]:
        """Markers × spans that unmuted edits of a marker take may change."""
        self.marker_performer(performer)
        return marker_declared(self.marker_edits(performer))

    def fill_gaps(
        self,
        performer: str,
        fills: Sequence[Fill],
        method: str,
        parameters: Parameters = _NONE,
    ) -> None:
        """Put samples into gaps: one edit a gap, one step together; earlier fills of them give way.

        Parameters
        ----------
        fills
            As `marker_fills.filling` makes them.
        method
            Name of one of `marker_fills.METHODS`.
        parameters
            What else decided, such as the longest gap that was to be filled.

        Raises
        ------
        MocapError
            If a fill does not fit the take, or there is no such method.
        """
        take, stamp = self.marker_performer(performer).take, self._stamp()
        words = fill_method(method).words
        spans = [Declared(one.marker, one.start, one.end) for one in fills]
        added = []
        for one in fills:
            self._check(take, (one.marker,), one.start, one.end)
            if one.positions.shape != (one.end - one.start, 3):
                raise MocapError(f"samples of {one.marker} do not fit their span")
            edit = self._edit_of(
                performer, MarkerEditKind.FILL, (one.marker,), (one.start, one.end), words, stamp
            )
            samples = one.positions.copy()[:, None]
            samples.setflags(write=False)
            added.append(replace(edit, positions=samples, parameters=parameters))
        again = {id(edit) for edit in self._fills_of(performer, spans)}
        sitting = self._history.present
        kept = tuple(edit for edit in sitting.marker_edits if id(edit) not in again)
        label = f"Fill {fills[0].marker}" if len(fills) == 1 else f"Fill {len(fills)} gaps"
        self._commit(label, replace(sitting, marker_edits=(*kept, *added)))

    def exchange_markers(self, performer: str, one: str, other: str, start: int, end: int) -> str:
        """Exchange the labels of two markers over [start, end); returns the edit's id.

        Raises
        ------
        MocapError
            If the take has no such markers or frames, or they are one and the same.
        """
        if one == other:
            raise MocapError(f"{one} cannot be exchanged with itself")
        return self._add(
            f"Exchange {one} and {other}",
            performer,
            MarkerEditKind.EXCHANGE,
            (one, other),
            (start, end),
            "labels exchanged",
        )

    def clear_markers(self, performer: str, markers: Sequence[str], start: int, end: int) -> str:
        """Take samples away that are wrong, which leaves a gap; returns the edit's id.

        Raises
        ------
        MocapError
            If the take has no such markers or frames, or none is named.
        """
        names = tuple(dict.fromkeys(markers))
        if not names:
            raise MocapError("no marker is named")
        label = f"Clear {names[0] if len(names) == 1 else f'{len(names)} markers'}"
        return self._add(label, performer, MarkerEditKind.CLEAR, names, (start, end), "taken away")

    def mute_marker_edit(self, edit_id: str, muted: bool = True) -> None:
        """Switch an edit of a marker take off, or on again."""
        old = self._marker_edit(edit_id)
        if old.muted != muted:
            sitting, new = self._history.present, replace(old, muted=muted)
            edits = tuple(new if edit is old else edit for edit in sitting.marker_edits)
            label = f"{'Mute' if muted else 'Unmute'} edit of {old.markers[0]}"
            self._commit(label, replace(sitting, marker_edits=edits))

    def delete_marker_edits(self, edit_ids: Collection[str]) -> None:
        """Take edits of marker takes back, as one step; those after them stay."""
        gone = {id(self._marker_edit(one)) for one in edit_ids}
        if gone:
            sitting = self._history.present
            kept = tuple(edit for edit in sitting.marker_edits if id(edit) not in gone)
            label = "Take an edit back" if len(gone) == 1 else f"Take {len(gone)} edits back"
            self._commit(label, replace(sitting, marker_edits=kept))

    def protect_markers(
        self, performer: str, markers: Collection[str], start: int, end: int
    ) -> None:
        """Let nothing change markers × [start, end) of a marker take; no markers means all.

        Raises
        ------
        MocapError
            If the take has no such markers or frames.
        """
        rows = frozenset(markers)
        self._check(self.marker_performer(performer).take, sorted(rows), start, end)
        stamp, sitting = self._stamp(), self._history.present
        added = Protected(performer, rows, int(start), int(end), stamp.author, stamp.time)
        if not any(
            replace(p, author=added.author, time=added.time) == added for p in sitting.protected
        ):
            self._commit("Protect", replace(sitting, protected=(*sitting.protected, added)))

    def unprotect_markers(
        self, performer: str, markers: Collection[str], start: int, end: int
    ) -> None:
        """Take markers × [start, end) out of the protected spans; no markers means all."""
        take, rows = self.marker_performer(performer).take, frozenset(markers)
        self._check(take, sorted(rows), start, end)
        sitting = self._history.present
        left = protection.unprotected(take, sitting.protected, performer, rows, start, end)
        self._commit("Unprotect", replace(sitting, protected=left))

    def markers_protected(self, performer: str) -> tuple[Declared, ...]:
        """Protected markers × spans of a marker take."""
        labels = self.marker_performer(performer).take.labels
        return union(
            Declared(label, p.start, p.end)
            for p in self._history.present.protected
            if p.performer == performer
            for label in (p.joints or labels)
        )

    def _commit(self, label: str, sitting: Sitting, **changes: Any) -> None:
        """Go on to another sitting; refuses what would change protected markers."""
        for one in self._state.markers:
            protection.check_marker_edits(one.id, self._history.present, sitting)
        super()._commit(label, sitting, **changes)

    def _add(
        self,
        label: str,
        performer: str,
        kind: MarkerEditKind,
        markers: tuple[str, ...],
        span: tuple[int, int],
        method: str,
    ) -> str:
        self._check(self.marker_performer(performer).take, markers, *span)
        edit = self._edit_of(performer, kind, markers, span, method, self._stamp())
        sitting = self._history.present
        self._commit(label, replace(sitting, marker_edits=(*sitting.marker_edits, edit)))
        return edit.id

    def _edit_of(
        self,
        performer: str,
        kind: MarkerEditKind,
        markers: tuple[str, ...],
        span: tuple[int, int],
        method: str,
        stamp: Stamp,
    ) -> MarkerEdit:
        start, end = int(span[0]), int(span[1])
        return MarkerEdit(
            new_id(), performer, kind, markers, start, end, None, method,
            stamp.group, stamp.author, stamp.time,
        )  # fmt: skip

    def _fills_of(self, performer: str, spans: Sequence[Declared]) -> list[MarkerEdit]:
        return [
            edit
            for edit in self.marker_edits(performer)
            if edit.kind is MarkerEditKind.FILL
            and any(edit.touches(one.row, one.start, one.end) for one in spans)
        ]

    def _check(self, take: MarkerTake, markers: Sequence[str], start: int, end: int) -> None:
        for label in markers:
            if label not in take.index:
                raise MocapError(f"{take.name} has no marker {label}")
        check_span(take, start, end)

    def _marker_edit(self, edit_id: str) -> MarkerEdit:
        for edit in self._history.present.marker_edits:
            if edit.id == edit_id:
                return edit
        raise MocapError(f"no edit {edit_id}")

    def _forget_markers(self, performer: str) -> None:
        self._history = self._history.forget(performer)
        self._marker_results.forget(performer)
        self._unfilled.forget(performer)
