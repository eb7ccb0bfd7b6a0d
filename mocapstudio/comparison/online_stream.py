"""Streams of poses as JSON lines: ``{"time", "joints": {name: [x, y, z, w]}, "root": [x, y, z]}``.

Rotations are local, as in a take; the root's place serves to draw her, since paper 3 aligns by
rotations alone.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from mocapstudio.comparison.online_features import F32, JointRotations
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import FileError, MocapError, SkeletonMismatchError

STANDARD_INPUT = Path("standard input")


@dataclass(frozen=True, eq=False)
class StreamFrame:
    """One line of a stream.

    Parameters
    ----------
    line
        1-based.
    time
        Seconds on the stream's clock, or None.
    joints
        (4,) unit quaternion (x, y, z, w) of each joint that was sent.
    root
        Where the root is in the world, metres, or None where it was not sent.
    """

    line: int
    time: float | None
    joints: Mapping[str, np.ndarray[Any, np.dtype[np.float64]]]
    root: tuple[float, float, float] | None = None


def read_frames(
    lines: Iterable[str], path: Path = STANDARD_INPUT
) -> Iterator[StreamFrame | FileError]:
    """Read a stream line by line; blank lines are skipped.

    Yields
    ------
    The frame, or what is wrong with the line: a live stream is not given up for one bad line.
    """
    for number, text in enumerate(lines, 1):
        if text.strip():
            yield read_frame(number, text, path)


def read_frame(
    number: int, text: str | bytes, path: Path = STANDARD_INPUT
) -> StreamFrame | FileError:
    """Read a line of a stream, the `number`-th of it; returns what is wrong with a bad one."""
    try:
        # Left to itself, json would guess at other encodings.
        words = text.decode("utf-8") if isinstance(text, bytes) else text
        return _frame(number, json.loads(words))
    except json.JSONDecodeError as cause:
        return FileError(path, f"is not JSON: {cause.msg}", line=number)
    except UnicodeDecodeError:
        return FileError(path, "is not UTF-8 text", line=number)
    except RecursionError:
        return FileError(path, "is nested too deeply", line=number)
    except MocapError as cause:
        return FileError(path, str(cause), line=number)


def pose_of(frame: StreamFrame, features: JointRotations) -> F32:
    """(D, 4) pose of a frame as `JointRotations.of` gives it; NaN for joints that are missing."""
    pose = np.full((len(features.names), 4), np.nan, np.float32)
    for row, name in enumerate(features.names):
        rotation = frame.joints.get(name)
        if rotation is None:
            continue
        if row == features.root:
            for above in features.above:
                rotation = rot.multiply(frame.joints.get(above, rot.IDENTITY), rotation)
        pose[row] = rotation
    return pose


class StreamPoses:
    """Makes poses of the frames of one stream.

    Parameters
    ----------
    features
        What is compared.
    names
        Joints of the stream, and what they are called in the reference.
    """

    def __init__(self, features: JointRotations, names: Mapping[str, str] | None = None) -> None:
        self._features, self._names = features, names or {}
        self._checked = False

    def of(self, frame: StreamFrame) -> tuple[StreamFrame, F32]:
        """Return a frame in the reference's names, and its pose; see `pose_of`.

        Raises
        ------
        SkeletonMismatchError
            If the first frame with joints is of another skeleton.
        """
        joints = {self._names.get(name, name): value for name, value in frame.joints.items()}
        frame = replace(frame, joints=joints)
        if frame.joints and not self._checked:
            check_names(frame, self._features)
            self._checked = True
        return frame, pose_of(frame, self._features)


def check_names(frame: StreamFrame, features: JointRotations) -> None:
    """Refuse a stream of another skeleton, by its first frame with joints.

    Raises
    ------
    SkeletonMismatchError
        If half of the reference's joints or more are not sent.
    """
    missing = [name for name in features.names if name not in frame.joints]
    if 2 * len(missing) >= len(features.names):
        raise SkeletonMismatchError(
            f"{STANDARD_INPUT}: {frame.line}: another skeleton: {len(missing)} of"
            f" {len(features.names)} joints of the reference are not sent, such as {missing[0]}"
        )


def _frame(number: int, content: Any) -> StreamFrame:
    if not isinstance(content, dict):
        raise MocapError("an object with time, joints and root is wanted")
    joints = content.get("joints") or {}
    if not isinstance(joints, dict):
        raise MocapError("joints must be an object of names")
    time = content.get("time")
    if time is not None and not _is_number(time):
        raise MocapError("time must be a number of seconds")
    found = {name: _rotation(name, value) for name, value in joints.items() if value is not None}
    root = content.get("root")
    if root is not None and not (
        isinstance(root, list) and len(root) == 3 and all(map(_is_number, root))
    ):
        raise MocapError("root must be three numbers, x, y and z")
    place = None if root is None else (float(root[0]), float(root[1]), float(root[2]))
    return StreamFrame(number, None if time is None else float(time), found, place)


def _rotation(name: str, value: Any) -> np.ndarray[Any, np.dtype[np.float64]]:
    if not isinstance(value, list) or len(value) != 4 or not all(map(_is_number, value)):
        raise MocapError(f"{name} must be four numbers, x, y, z and w")
    rotation = np.array(value, dtype=np.float64)
    length = float(np.linalg.norm(rotation))
    if not (0 < length < math.inf):
        raise MocapError(f"{name} is no rotation: its length is {length:g}")
    return np.asarray(rotation / length)


def _is_number(value: Any) -> bool:
    known = isinstance(value, int | float) and not isinstance(value, bool)
    return known and abs(value) < 1e300
