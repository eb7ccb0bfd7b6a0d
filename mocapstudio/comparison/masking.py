"""What is flagged in a recording, as a mask of what a comparison is to leave out."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison.parameters import ROTATIONS
from mocapstudio.formats.json_file import read_json
from mocapstudio.motion.errors import FileError, MocapError
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology


@dataclass(frozen=True)
class Flagged:
    """Joints or markers that are not to be trusted for some frames.

    Parameters
    ----------
    joints
        As the recording names them; the rows of the root, which count for nothing here, may be
        among them.
    start, end
        Half-open span of the recording's own frames.
    """

    joints: tuple[str, ...]
    start: int
    end: int


def mask_of(
    recording: Take | MarkerTake, flagged: Iterable[Flagged], features: str
) -> NDArray[np.bool_]:
    """(frames, joints or markers) True where a recording is flagged.

    Where positions are compared, a joint that is turned wrongly moves the rest of its limb: that
    is left out with it.

    Parameters
    ----------
    features
        Of `ComparisonParameters`.

    Raises
    ------
    MocapError
        If the recording has no such joint or frames.
    """
    markers = isinstance(recording, MarkerTake)
    names = recording.labels if isinstance(recording, MarkerTake) else recording.skeleton.names
    index = {name: i for i, name in enumerate(names)}
    below = {} if markers or features == ROTATIONS else _below(recording)
    mask = np.zeros((recording.frames, len(names)), bool)
    for one in flagged:
        if one.end > recording.frames:
            raise MocapError(
                f"{recording.name} has {recording.frames} frames, and a flag ends at {one.end}"
            )
        for name in set(one.joints) - set(ROOT_ROWS):
            if name not in index:
                raise MocapError(f"{recording.name} has no joint or marker {name}")
            joint = index[name]
            mask[one.start : one.end, below.get(joint, [joint])] = True
    return mask


def _below(take: Take | MarkerTake) -> dict[int, list[int]]:
    """Joints of the same limb that a joint moves, itself among them."""
    assert isinstance(take, Take)
    found: dict[int, list[int]] = {}
    for limb in topology(take.skeleton).limbs:
        for joint in limb.joints:
            moved = (j for j in limb.joints if joint in take.skeleton.ancestors(j))
            found[joint] = [joint, *moved]
    return found


def read_flags(path: Path) -> Mapping[str, tuple[Flagged, ...]]:
    """Read what `mocapstudio detect --json` found, by the stem of each take's file.

    Raises
    ------
    FileError
        If the file cannot be read, is no JSON, or does not hold flags.
    """
    content = read_json(path, "flags")
    try:
        takes = content["takes"]
        return {Path(str(one["path"])).stem: tuple(map(_flagged, one["flags"])) for one in takes}
    except (KeyError, TypeError, ValueError) as cause:
        raise FileError(path, "does not hold flags as detect --json writes them") from cause


def _flagged(one: Mapping[str, Any]) -> Flagged:
    joints = tuple(map(str, one.get("joints") or [one["joint"]]))
    start, end = one["start"], one["end"]
    if not (type(start) is type(end) is int and 0 <= start < end):
        raise ValueError(f"{start} to {end} is no span of frames")
    return Flagged(joints, start, end)
