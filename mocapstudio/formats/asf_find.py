"""Which ASF is the skeleton of an AMC."""

from __future__ import annotations

from pathlib import Path

from mocapstudio.motion.errors import FileError


def find_skeleton(path: Path) -> Path:
    """Find the ASF beside an AMC.

    It has the same stem, else the stem's part before ``_`` (``05.asf`` for ``05_13.amc``), else
    it is the only one of the folder.

    Raises
    ------
    FileError
        If there is none, or several that it might be.
    """
    try:
        beside = sorted(p for p in path.parent.iterdir() if p.suffix.lower() == ".asf")
    except OSError as bad:
        raise FileError(path.parent, (bad.strerror or str(bad)).lower()) from bad
    stem = path.stem.lower()
    same = [p for p in beside if p.stem.lower() == stem]
    subject = [p for p in beside if p.stem.lower() == stem.partition("_")[0]]
    candidates = same or subject or beside
    if not candidates:
        raise FileError(path, "no skeleton: there is no .asf beside it")
    if len(candidates) > 1:
        names = ", ".join(p.name for p in candidates)
        raise FileError(path, f"several skeletons might be its own, name one of: {names}")
    return candidates[0]
