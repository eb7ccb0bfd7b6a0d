"""Writing a mended marker take, with its provenance beside it."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

from mocapstudio import __version__, formats
from mocapstudio.formats import WriteOptions
from mocapstudio.formats.atomic import write_whole
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.runs import runs
from mocapstudio.review.document import Document
from mocapstudio.review.export import inputs_of, provenance_path
from mocapstudio.review.marker_changes import marker_changes
from mocapstudio.review.provenance import origin, utc_now


def export_markers(
    document: Document, performer: str, path: Path | str, trim: bool = False
) -> None:
    """Write a marker take: its source, in which nothing but the unmuted edits has changed.

    Parameters
    ----------
    path
        The file; its suffix tells the format. ``NAME.provenance.json`` is written beside it.
    trim
        Write only the frames of the trim.

    Raises
    ------
    FileError
        If a file cannot be written, or is an input of the sitting.
    MocapError
        If there is no such marker take, or the format cannot hold it.
    """
    path, inputs = Path(path), inputs_of(document)
    result, declared = document.marker_result(performer), document.marker_declared(performer)
    formats.write(result, path, declared=declared, options=WriteOptions(trim=trim), inputs=inputs)
    found = marker_provenance(document, performer, path)
    text = json.dumps(found, indent=1, ensure_ascii=False)
    write_whole(provenance_path(path), [text.encode(), b"\n"], inputs=inputs)


def filled_spans(take: MarkerTake) -> list[dict[str, Any]]:
    """Return where a take's markers were not measured but filled."""
    if take.filled is None:
        return []
    there = take.filled & ~take.missing
    return [
        {"marker": label, "start": start, "end": end}
        for label, column in zip(take.labels, there.T, strict=True)
        for start, end in runs(column)
    ]


def marker_provenance(document: Document, performer: str, output: Path) -> dict[str, Any]:
    """Return the provenance of an exported marker take, as JSON knows it.

    Parameters
    ----------
    output
        The exported file, already written.
    """
    take, result = document.marker_performer(performer).take, document.marker_result(performer)
    path = document.state.path
    about = {"fps": float(take.rate), "frames": take.frames, "trim": take.trim}
    return {
        "program": "mocapstudio",
        "version": __version__,
        "written": utc_now(),
        "take": origin(take) | about,
        "output": {"path": str(output), "sha256": hashlib.sha256(output.read_bytes()).hexdigest()},
        "session": None if path is None else str(path),
        "changes": marker_changes(document.marker_edits(performer)),
        "filled": filled_spans(result),
        "missing": int(result.missing.sum()),
    }
