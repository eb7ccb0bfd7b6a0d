"""`mocapstudio export`: what was decided in a session, without the desk."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mocapstudio.cli.output import JsonPath, check_writable, write_json

if TYPE_CHECKING:
    from mocapstudio.review.document import Document
    from mocapstudio.review.marker_model import MarkerPerformer
    from mocapstudio.review.model import Performer

SessionPath = Annotated[Path, typer.Argument(metavar="SESSION", help="A saved session.")]


def export(
    session: SessionPath,
    out: Annotated[
        Path,
        typer.Option(
            "-o", "--out", metavar="OUT", help="File to write; a folder for several performers."
        ),
    ],
    trim: Annotated[bool, typer.Option("--trim", help="Write only the trimmed frames.")] = False,
    json_path: JsonPath = None,
) -> None:
    """Write the takes of a session with what was decided in it.

    Nothing else is changed. Partners are left out unless they were edited.
    """
    from mocapstudio.cli import changes
    from mocapstudio.cli.targets import Targets
    from mocapstudio.review.export import export as write
    from mocapstudio.review.marker_export import export_markers
    from mocapstudio.review.marker_model import MarkerPerformer

    check_writable(json_path)
    document = opened(session)
    performers: list[Performer | MarkerPerformer] = [*_worked_on(document), *document.state.markers]
    paths = [_path(p) for p in performers]
    targets = Targets(out, paths, [session, *paths])
    done: list[dict[str, Any]] = []
    for performer, path in zip(performers, paths, strict=True):
        alone = sum(one == path for one in paths) == 1
        target = targets.of(path, performer.take, alone=alone)
        if isinstance(performer, MarkerPerformer):
            export_markers(document, performer.id, target, trim)
            edited = document.marker_edits(performer.id)
            done.append(changes.of_markers(path, target, edited))
            continue
        write(document, performer.id, target, trim)
        edits = [e for e in document.state.sitting.edits if e.performer == performer.id]
        done.append(changes.as_json(path, target, edits))
    write_json({"takes": done}, json_path)


def opened(session: Path) -> Document:
    """Open a session whose takes are all there and unchanged.

    Raises
    ------
    FileError
        If the session cannot be read, or naming the first take that is missing or has changed.
    """
    from mocapstudio.motion.errors import FileError
    from mocapstudio.review import session_file

    document = session_file.load(session)
    for problem in document.state.problems:
        if problem.performer is not None:
            raise FileError(session, problem.what)
    return document


def _worked_on(document: Document) -> list[Performer]:
    edited = {edit.performer for edit in document.state.sitting.edits}
    return [p for p in document.state.scene.performers if not p.partner or p.id in edited]


def _path(performer: Performer | MarkerPerformer) -> Path:
    take = performer.take
    suffix = ".bvh" if hasattr(take, "skeleton") else ".c3d"
    return Path(f"{take.name}{suffix}") if take.source is None else take.source.path
