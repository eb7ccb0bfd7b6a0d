"""What the edits of a marker take changed, as provenance and JSON tell it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from mocapstudio.review.marker_model import MarkerEdit, MarkerEditKind


def marker_changes(edits: Iterable[MarkerEdit]) -> list[dict[str, Any]]:
    """Return every marker × span that unmuted edits may change, by start, then marker.

    Frames are 0-based at the take's own rate, ends exclusive.
    """
    found = [_change(edit, marker) for edit in edits if not edit.muted for marker in edit.markers]
    return sorted(found, key=lambda one: (one["start"], one["marker"], one["time"]))


def _change(edit: MarkerEdit, marker: str) -> dict[str, Any]:
    others = [one for one in edit.markers if one != marker]
    return {
        "marker": marker,
        "start": edit.start,
        "end": edit.end,
        "kind": edit.kind.value,
        "with": others[0] if edit.kind is MarkerEditKind.EXCHANGE else None,
        "method": edit.method,
        "parameters": dict(edit.parameters),
        "author": edit.author,
        "time": edit.time,
    }
