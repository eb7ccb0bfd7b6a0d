"""Writing a file whole or not at all."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterable
from pathlib import Path

from mocapstudio.motion.errors import FileError


def write_whole(path: Path | str, pieces: Iterable[bytes], *, inputs: Iterable[Path] = ()) -> None:
    """Write bytes to a temporary file beside `path` and move it into place.

    Parameters
    ----------
    path
        The file to write; a link is followed.
    pieces
        Its content, in order.
    inputs
        Files that must not be overwritten.

    Raises
    ------
    FileError
        If `path` is one of the inputs or cannot be written; nothing is left behind then.
    """
    path = Path(path)
    try:
        target = path.resolve()
    except (OSError, ValueError, RuntimeError) as bad:
        # A null byte in the name, or links in a circle.
        raise FileError(path, f"cannot be written: {bad}") from bad
    if any(_same(target, one) for one in inputs):
        raise FileError(path, "is an input of this export and is not overwritten")
    # Hidden and without a known suffix, so that no folder listing takes it for a take.
    temporary = target.parent / f".{target.name[:100]}.{secrets.token_hex(4)}.part"
    made = False
    try:
        if target.is_dir():
            raise FileError(path, "is a folder")
        with temporary.open("xb") as file:
            made = True
            for piece in pieces:
                file.write(piece)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(target)
        made = False
    except (OSError, ValueError) as bad:
        cause = getattr(bad, "strerror", None) or str(bad)
        raise FileError(path, f"cannot be written: {cause.lower()}") from bad
    finally:
        if made:
            temporary.unlink(missing_ok=True)


def _same(target: Path, other: Path) -> bool:
    try:
        return target.samefile(other)
    except OSError:
        return target == other.resolve()
