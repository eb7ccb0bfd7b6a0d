"""Where results go: JSON to a file or to standard output, arrays to npz files."""

from __future__ import annotations

import io
import json
import os
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Annotated, Any

import typer

from mocapstudio.motion.errors import FileError

STANDARD_OUTPUT = Path("-")

JsonPath = Annotated[
    Path | None,
    typer.Option("--json", metavar="PATH", help="Write the result as JSON; - for standard output."),
]


def check_writable(path: Path | None) -> None:
    """Refuse, before any work is done, a file that could not be written after it.

    Raises
    ------
    FileError
        If the folder is missing or closed to the user, or `path` is a folder.
    """
    if path is None or path == STANDARD_OUTPUT:
        return
    if path.is_dir():
        raise FileError(path, "is a folder, a file is wanted")
    if not path.parent.is_dir():
        raise FileError(path, f"cannot be written: no folder {path.parent}")
    if not os.access(path if path.exists() else path.parent, os.W_OK):
        raise FileError(path, "cannot be written: permission denied")


def write_json(result: Mapping[str, Any], path: Path | None) -> None:
    """Write a result as JSON to a file, to standard output (`-`), or nowhere (None).

    Raises
    ------
    FileError
        If the file cannot be written; an older file of that name is then left as it was.
    """
    if path is None:
        return
    text = json.dumps(result, indent=2, ensure_ascii=False, allow_nan=False, default=_plain)
    if path == STANDARD_OUTPUT:
        sys.stdout.write(text + "\n")
        sys.stdout.flush()
        return
    from mocapstudio.formats.atomic import write_whole

    write_whole(path, [(text + "\n").encode()])


def write_npz(arrays: Mapping[str, Any], path: Path) -> None:
    """Write named arrays to a compressed npz file.

    Raises
    ------
    FileError
        If the file cannot be written; an older file of that name is then left as it was.
    """
    import numpy as np

    from mocapstudio.formats.atomic import write_whole

    save: Callable[..., None] = np.savez_compressed
    buffer = io.BytesIO()
    save(buffer, **arrays)
    write_whole(path, [buffer.getvalue()])


def _plain(value: Any) -> Any:
    """Turn what JSON does not know into what it does: numpy's numbers, fractions, paths."""
    if isinstance(value, Path):
        return str(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    if hasattr(value, "numerator") and hasattr(value, "denominator"):
        return float(value)
    raise TypeError(f"{type(value).__name__} has no place in JSON")
