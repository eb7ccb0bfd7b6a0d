"""What the JSON of `clean` and `export` says of the changes in a take."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from mocapstudio.review.model import Edit


def as_json(path: Path, output: Path, edits: Sequence[Edit]) -> dict[str, Any]:
    """Return one entry of ``{"takes": [...]}``: where a take went and what was changed in it.

    Parameters
    ----------
    path, output
        The take as read, and as written.
    edits
        Those of its performer, muted ones among them.
    """
    changes = [_change(edit, row) for edit in edits if not edit.muted for row in edit.rows]
    changes.sort(key=lambda change: (change["start"], change["joint"]))
    return {"path": str(path), "output": str(output), "changes": changes}


def _change(edit: Edit, row: str) -> dict[str, Any]:
    donor = edit.donor
    return {
        "joint": row,
        "start": edit.start,
        "end": edit.end,
        "method": edit.method,
        "donor": donor and {"take": donor.take, "start": donor.start, "end": donor.end},
    }
