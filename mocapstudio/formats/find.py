"""Which files a list of paths stands for."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from mocapstudio.formats.registry import is_take, readable_suffixes
from mocapstudio.motion.errors import FileError


def find_takes(paths: Iterable[Path | str]) -> list[Path]:
    """Expand folders (recursively) into the takes in them; files stay as they are.

    Folders are listed by name, hidden files left out, repeated files named once.

    Raises
    ------
    FileError
        If a path does not exist, or a folder holds no take.
    """
    found: dict[Path, Path] = {}
    for path in map(Path, paths):
        if path.is_dir():
            inside = _in_folder(path)
            if not inside:
                raise FileError(path, f"no take in this folder ({', '.join(readable_suffixes())})")
        elif path.exists():
            inside = [path]
        else:
            raise FileError(path, "no such file or folder")
        for one in inside:
            found.setdefault(one.resolve(), one)
    return list(found.values())


def _in_folder(folder: Path) -> list[Path]:
    return sorted(
        path
        for path in folder.rglob("*")
        if not any(part.startswith(".") for part in path.relative_to(folder).parts)
        and path.is_file()
        and is_take(path)
    )
