"""Protected spans: which samples nothing may change."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take
from mocapstudio.review.model import Edit, Protected, Sitting
from mocapstudio.review.rows import rows_of, samples_of


class ProtectedError(MocapError):
    """A change that would reach into a protected span; it names row and frames."""


def check_edits(take: Take, performer: str, before: Sitting, after: Sitting) -> None:
    """Refuse a step that adds, removes, mutes or unmutes an edit on protected samples.

    Raises
    ------
    ProtectedError
        Naming the first row and the frames concerned, 0-based, end exclusive.
    """
    spans = [p for p in after.protected if p.performer == performer]
    if not spans:
        return
    old = {id(e) for e in before.edits if not e.muted}
    new = {id(e) for e in after.edits if not e.muted}
    for edit in (*before.edits, *after.edits):
        if edit.performer == performer and (id(edit) in old) != (id(edit) in new):
            _check_edit(take, edit, spans)


def _check_edit(take: Take, edit: Edit, spans: Iterable[Protected]) -> None:
    for span in spans:
        start, end = max(edit.start, span.start), min(edit.end, span.end)
        if start >= end:
            continue
        closed = frozenset[object]().union(*(samples_of(take, row) for row in span.joints))
        for row in edit.rows:
            if not span.joints or samples_of(take, row) & closed:
                raise ProtectedError(f"{row} is protected in frames {start} to {end}")


def check_marker_edits(performer: str, before: Sitting, after: Sitting) -> None:
    """Refuse a step that adds, removes, mutes or unmutes an edit on protected markers.

    Raises
    ------
    ProtectedError
        Naming the first marker and the frames concerned, 0-based, end exclusive.
    """
    spans = [p for p in after.protected if p.performer == performer]
    if not spans:
        return
    old = {id(e) for e in before.marker_edits if not e.muted}
    new = {id(e) for e in after.marker_edits if not e.muted}
    for edit in (*before.marker_edits, *after.marker_edits):
        if edit.performer != performer or (id(edit) in old) == (id(edit) in new):
            continue
        for span in spans:
            start, end = max(edit.start, span.start), min(edit.end, span.end)
            closed = [one for one in edit.markers if not span.joints or one in span.joints]
            if start < end and closed:
                raise ProtectedError(f"{closed[0]} is protected in frames {start} to {end}")


def unprotected(
    take: Take | MarkerTake,
    protected: tuple[Protected, ...],
    performer: str,
    rows: frozenset[str],
    start: int,
    end: int,
) -> tuple[Protected, ...]:
    """Take rows × [start, end) of one performer out of the protected spans; no rows means all."""
    kept: list[Protected] = []
    for one in protected:
        left, right = max(one.start, start), min(one.end, end)
        touched = not rows or not one.joints or bool(rows & one.joints)
        if one.performer != performer or left >= right or not touched:
            kept.append(one)
            continue
        if one.start < left:
            kept.append(replace(one, end=left))
        every = take.labels if isinstance(take, MarkerTake) else rows_of(take)
        still = (one.joints or frozenset(every)) - rows if rows else frozenset[str]()
        if still:
            kept.append(replace(one, joints=still, start=left, end=right))
        if right < one.end:
            kept.append(replace(one, start=right))
    return tuple(kept)
