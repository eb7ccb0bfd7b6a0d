"""Where the files that the desk ships with lie: in the wheel, or beside the package's sources."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import mocapstudio


@cache
def folder() -> Path:
    """Return the folder of icons and styles."""
    package = Path(mocapstudio.__file__).resolve().parent
    inside = package / "resources"
    return inside if inside.is_dir() else package.parent / "resources"


@cache
def text(name: str) -> str:
    """Return the text of a resource, given its path inside the folder."""
    return (folder() / name).read_text(encoding="utf-8")
