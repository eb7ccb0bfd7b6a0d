"""Where the files of `resources/` lie: icons, styles, skeleton maps, pictures."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from mocapstudio.motion.errors import FileError


@cache
def _root() -> Path:
    package = Path(__file__).resolve().parent
    # A wheel carries the folder inside the package, a checkout keeps it beside.
    for folder in (package / "resources", package.parent / "resources"):
        if folder.is_dir():
            return folder
    raise FileError(package / "resources", "the installation is incomplete: no such folder")


def resource(*parts: str) -> Path:
    """Return the path of a file or folder that the program ships.

    Parameters
    ----------
    *parts
        Path below `resources/`, such as ``resource("icons", "mocapstudio.svg")``.

    Raises
    ------
    FileError
        If nothing of that name is shipped.
    """
    path = _root().joinpath(*parts)
    if not path.exists():
        raise FileError(path, "the installation is incomplete: no such resource")
    return path
