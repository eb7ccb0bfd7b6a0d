"""The session file: one sitting, saved and opened.

A zip archive with two entries:

``session.json``
    ``format`` (``"mocapstudio session"``), ``version`` (1), ``save`` (id of this save),
    ``program`` (version that wrote it), ``saved`` (UTC);
    ``takes``: a `take_record.TakeRecord` each: id, name, path relative to the session file
    (slashes) and absolute, SHA-256 of the file, how it was read, what it must hold, offset in
    seconds; marker takes have ``labels`` in the place of ``joints``;
    ``sitting``: ``edits``, ``decisions``, ``protected``, ``trims`` as in `wire`, ``contacts`` and
    ``points`` as in `contact_wire`, ``marker_edits`` as in `marker_wire`;
    ``context``: paths, relative and absolute; ``parameters`` of detection; ``manner`` in which
    files are read;
    ``active``, ``frame``, ``joints``, ``span``, ``flag``: what was looked at;
    ``flags`` and ``choices`` by performer, so that the queue shows before the next analysis;
    ``comparison``: takes, parameters, segments and selection as in `comparing_wire`.
``samples.npz``
    ``edits/ID/rotations`` (frames, joints, 4) and ``edits/ID/translations`` (frames, 3), float64,
    metres; ``marker_edits/ID/positions`` (frames, markers, 3), with NaN where a marker stays
    missing; ``takes/ID/…`` for takes that have no file of their own.

Frames are 0-based at the take's own rate, spans half-open. Fields that are unknown are ignored; a
file with a higher ``version`` is refused. Takes themselves are never written to.

While a session is open, a lock file (``NAME.lock``) and a journal (``NAME.journal``) lie beside it:
see `lock` and `journal`. `load` replays a journal that a crash left behind.
"""

from __future__ import annotations

import dataclasses
from datetime import UTC, datetime
from pathlib import Path

from mocapstudio import __version__
from mocapstudio.formats.atomic import write_whole
from mocapstudio.motion.errors import FileError
from mocapstudio.review import journal_records, lock, session_record
from mocapstudio.review.comparing_wire import COMPARED, pack_comparison
from mocapstudio.review.core import new_id
from mocapstudio.review.document import Document
from mocapstudio.review.manner import pack_manner
from mocapstudio.review.opening import Opening, journal_path
from mocapstudio.review.records import Arrays
from mocapstudio.review.references import Relocate
from mocapstudio.review.session_record import FORMAT, VERSION, PathRecord, SessionRecord
from mocapstudio.review.take_record import absolute, moved, refer, relative_to
from mocapstudio.review.wire import pack, pack_flag

SUFFIX = ".mocapstudio"


def save(document: Document, path: Path | str) -> None:
    """Write a document to a session file; its journal is folded in.

    The file is replaced as a whole, or left as it was.

    Raises
    ------
    FileError
        If the file cannot be written, or is one of the session's takes.
    """
    path = absolute(path)
    record, arrays = _recorded(document, path.parent)
    state = document.state
    sources = [p.take.source for p in state.everyone]
    inputs = [source.path for source in sources if source is not None]
    write_whole(path, [session_record.to_bytes(record, arrays)], inputs=inputs)
    document.mark_saved(path, record.save)
    document.recorder.saved(document)


def load(path: Path | str, relocate: Relocate | None = None, author: str | None = None) -> Document:
    """Open a session file, with what a crash left in the journal beside it.

    A journal that this very process writes is no such: opening its session again goes back to the
    last save.

    What is wrong with single takes (missing, changed) or was recovered stands in
    `DocumentState.problems`; what was decided about a missing take is kept.

    Parameters
    ----------
    relocate
        Asked for each missing take; returns the file, or the folder that holds it now, or None.
    author
        Who decides from now on; by default the name of the user who is logged in.

    Raises
    ------
    FileError
        If the file cannot be read, is damaged, or comes from a newer version.
    """
    path = absolute(path)
    record, arrays = session_record.read(path)
    opening = Opening(record, arrays, path, relocate)
    journal = journal_path(path)
    other = lock.holder(path)
    if other is not None:
        opening.tell(path, f"is open elsewhere: {other}")
    elif journal.exists() and not lock.is_open_here(path):
        try:
            opening.replay(journal_records.read(journal))
        except FileError as error:
            opening.tell(journal, error.cause)
    return opening.document(author)


def _recorded(document: Document, folder: Path) -> tuple[SessionRecord, Arrays]:
    state, arrays = document.state, Arrays()
    performers = state.scene.performers
    ids = [p.id for p in performers] + [absent.id for absent in document.absent]
    span = state.selection.span
    record = SessionRecord(
        FORMAT,
        VERSION,
        save=new_id(),
        program=__version__,
        saved=datetime.now(UTC).isoformat(timespec="seconds").replace("+00:00", "Z"),
        takes=(
            *(refer(p, folder, arrays) for p in state.everyone),
            *(moved(absent, folder) for absent in document.absent),
        ),
        sitting=pack(state.sitting, arrays),
        context=tuple(_path_record(Path(p), folder) for p in state.context),
        parameters=dataclasses.asdict(state.parameters),
        manner=pack_manner(state.manner),
        active=state.active,
        frame=state.frame,
        joints=tuple(sorted(state.selection.joints)),
        span=span and (int(span[0]), int(span[1])),
        flag=state.selection.flag,
        flags={one: tuple(map(pack_flag, document.flags(one))) for one in ids},
        choices={one: dict(document.choices(one)) for one in ids},
        comparison=pack_comparison(
            state.comparison, folder, arrays, lambda _take: f"{COMPARED}{new_id()}"
        ),
    )
    return record, arrays


def _path_record(path: Path, folder: Path) -> PathRecord:
    path = absolute(path)
    return PathRecord(str(path), relative_to(path, folder))
