"""Writing a cleaned take, with its provenance beside it."""

from __future__ import annotations

import json
from pathlib import Path

from mocapstudio import formats
from mocapstudio.formats import WriteOptions
from mocapstudio.formats.atomic import write_whole
from mocapstudio.review.document import Document
from mocapstudio.review.provenance import provenance


def provenance_path(path: Path) -> Path:
    """Where the provenance of an exported take lies."""
    return path.with_name(f"{path.stem}.provenance.json")


def export(document: Document, performer: str, path: Path | str, trim: bool = False) -> None:
    """Write a performer's result: its source, in which nothing but the unmuted edits has changed.

    Parameters
    ----------
    path
        The file; its suffix tells the format. ``NAME.provenance.json`` is written beside it.
    trim
        Write only the frames of the trim.

    Raises
    ------
    FileError
        If a file cannot be written, or is an input of the sitting: a take of its scene or
        context, or the session itself.
    MocapError
        If there is no such performer, or the format cannot hold the motion.
    """
    path = Path(path)
    inputs = inputs_of(document)
    result, declared = document.result(performer), document.declared(performer)
    formats.write(result, path, declared=declared, options=WriteOptions(trim=trim), inputs=inputs)
    text = json.dumps(provenance(document, performer, path), indent=1, ensure_ascii=False)
    write_whole(provenance_path(path), [text.encode(), b"\n"], inputs=inputs)


def inputs_of(document: Document) -> list[Path]:
    """Return the files that an export must not write over: takes, context, session."""
    state = document.state
    takes: list[formats.Recording] = [one.take for one in state.everyone]
    for analysis in state.analyses.values():
        takes += analysis.context
    takes += document.context_takes
    files = {take.source.path for take in takes if take.source is not None}
    files |= {path for path in map(Path, state.context) if path.is_file()}
    return sorted(files | ({state.path} if state.path is not None else set()))
