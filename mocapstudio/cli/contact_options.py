"""What commands are told about contacts, and which file belongs to which take."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from mocapstudio.motion.errors import FileError

Partner = Annotated[
    list[Path] | None,
    typer.Option(
        "--partner",
        metavar="PATH",
        help="A take of another performer or prop in the same space and time; repeatable.",
    ),
]


def by_take(contacts: Path | None, files: Sequence[Path]) -> dict[Path, Path]:
    """Return the file of contacts of each take: one for one, or from a folder by name.

    Raises
    ------
    FileError
        If one file is given for several takes.
    """
    if contacts is None:
        return {}
    if contacts.is_dir():
        named = {file: contacts / f"{file.stem}.json" for file in files}
        return {file: found for file, found in named.items() if found.is_file()}
    if len(files) > 1:
        raise FileError(contacts, "is one file; several takes need a folder of contacts")
    return dict.fromkeys(files, contacts)
