"""What the JSON of `clean` and `export` says of the changes in a take."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from mocapstudio.review.model import Edit


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
    changes = [_change(edit, row) for edit in edits if not edit.muted for row in edit.rows]
    changes.sort(key=lambda change: (change["start"], change["joint"], -change["end"]))
    told: list[dict[str, Any]] = []
    for change in changes:
        if not any(_covers(other, change) for other in told):
            told.append(change)
    return {"path": str(path), "output": str(output), "changes": told}


def _covers(one: dict[str, Any], other: dict[str, Any]) -> bool:
    same = all(one[name] == other[name] for name in ("joint", "method", "donor"))
    return same and one["start"] <= other["start"] and other["end"] <= one["end"]


def _change(edit: Edit, row: str) -> dict[str, Any]:
    donor = edit.donor
    return {
        "joint": row,
        "start": edit.start,
        "end": edit.end,
        "method": edit.method,
        "donor": donor and {"take": donor.take, "start": donor.start, "end": donor.end},
    }
