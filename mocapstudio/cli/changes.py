"""What the JSON of `clean` and `export` says of the changes in a take."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from mocapstudio.review.marker_changes import marker_changes
from mocapstudio.review.marker_model import MarkerEdit
from mocapstudio.review.model import Edit
from mocapstudio.review.provenance import change


def as_json(path: Path, output: Path, edits: Sequence[Edit]) -> dict[str, Any]:
    """Return one entry of ``{"takes": [...]}``: where a take went and what was changed in it.

    A joint that flags share, repaired at once, is told once.

    Parameters
    ----------
    path, output
        The take as read, and as written.
    edits
        Those of its performer, muted ones among them.
    """
    found = [change(edit, row) for edit in edits if not edit.muted for row in edit.rows]
    found.sort(key=lambda one: (one["start"], one["joint"], -one["end"]))
    told: list[dict[str, Any]] = []
    for one in found:
        if not any(_covers(other, one) for other in told):
            told.append(one)
    return {"path": str(path), "output": str(output), "changes": told}


def of_markers(path: Path, output: Path, edits: Sequence[MarkerEdit]) -> dict[str, Any]:
    """Return one entry for a take of markers: each stands as ``joint``.

    Parameters
    ----------
    path, output
        The take as read, and as written.
    edits
        Its edits, muted ones among them.
    """
    told = [
        {"joint": one["marker"], "donor": None}
        | {name: one[name] for name in ("start", "end", "method", "kind", "with")}
        for one in marker_changes(edits)
    ]
    return {"path": str(path), "output": str(output), "changes": told}


def _covers(one: dict[str, Any], other: dict[str, Any]) -> bool:
    same = all(one[name] == other[name] for name in ("joint", "method", "donor"))
    return same and one["start"] <= other["start"] and other["end"] <= one["end"]
