"""Joint maps on the command line: other names for the joints of a context."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from mocapstudio.motion.errors import FileError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take


def read_joint_map(path: Path) -> dict[str, str]:
    """Read a JSON object of joint names: in the context → in the take.

    Raises
    ------
    FileError
        If the file is no such object, or maps two joints to the same one.
    """
    try:
        names = json.loads(path.read_text(encoding="utf-8"))
    except json.JSONDecodeError as error:
        raise FileError(path, f"is no JSON: {error.msg}", line=error.lineno) from error
    except UnicodeDecodeError as error:
        raise FileError(path, "is no UTF-8 text", offset=error.start) from error
    if not isinstance(names, dict) or not all(isinstance(name, str) for name in names.values()):
        raise FileError(path, "is no joint map: a JSON object of names is wanted")
    if len(set(names.values())) < len(names):
        raise FileError(path, "is no joint map: two joints are mapped to one")
    return names


def rename_joints(take: Take, names: Mapping[str, str]) -> Take:
    """Return the take with joints renamed; those that the map does not name keep theirs."""
    renamed = tuple(names.get(name, name) for name in take.skeleton.names)
    if renamed == take.skeleton.names:
        return take
    return replace(take, skeleton=replace(take.skeleton, names=renamed))


def rename_recording(take: Take | MarkerTake, names: Mapping[str, str]) -> Take | MarkerTake:
    """Return a take with its joints, or its markers, renamed."""
    if isinstance(take, Take):
        return rename_joints(take, names)
    renamed = tuple(names.get(label, label) for label in take.labels)
    return take if renamed == take.labels else replace(take, labels=renamed)
