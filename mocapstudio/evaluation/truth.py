"""What is known to be wrong in a take, and where it departs from the clean one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.model import Kind
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError, SkeletonMismatchError
from mocapstudio.motion.facing import (
    ROOT_HEADING,
    ROOT_POSITION,
    ROOT_ROWS,
    hips_world,
    split_heading,
)
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

Mask = NDArray[np.bool_]
Array = NDArray[np.float64]

ERRONEOUS_DEGREES = 10.0
"""A joint or the heading is erroneous where it departs from the clean take by more than this."""
ERRONEOUS_CENTIMETRES = 2.0
"""The root's position is erroneous beyond this; the smallest injected root error is 3 cm."""
SHORT_KINDS = frozenset({Kind.POP, Kind.JITTER})
"""Kinds that count by their span where they stay below the thresholds."""


@dataclass(frozen=True)
class Truth:
    """One error of known place and shape.

    Parameters
    ----------
    kind
        What was done.
    joints
        Names of the rows that depart: joints, or root rows.
    start, end
        Half-open span at the take's own rate, ramps included.
    params
        Plain numbers and strings from which, with `seed`, `injection.apply` repeats the error.
    seed
        Of the random shape.
    """

    kind: Kind
    joints: tuple[str, ...]
    start: int
    end: int
    params: Mapping[str, Any] = field(default_factory=dict)
    seed: int = 0

    def to_json(self) -> dict[str, Any]:
        """Plain objects for JSON."""
        return {
            "kind": self.kind.value,
            "joints": list(self.joints),
            "start": self.start,
            "end": self.end,
            "params": dict(self.params),
            "seed": self.seed,
        }

    @staticmethod
    def from_json(record: Mapping[str, Any]) -> Truth:
        """Build a truth from what `to_json` gave, or from a hand-made label.

        A label made by hand needs ``joint`` or ``joints``, ``start`` and ``end``; ``kind`` is
        ``"offset"`` where it is not told.

        Raises
        ------
        MocapError
            If something is missing or of the wrong kind.
        """
        try:
            names = record["joints"] if "joints" in record else [record["joint"]]
            start, end = int(record["start"]), int(record["end"])
            kind = Kind(record.get("kind", Kind.OFFSET))
        except (KeyError, TypeError, ValueError) as cause:
            raise MocapError(f"not a label of an error: {cause}") from cause
        if not 0 <= start < end:
            raise MocapError(f"a label's span [{start}, {end}) is empty or starts below 0")
        return Truth(
            kind,
            tuple(map(str, names)),
            start,
            end,
            dict(record.get("params", {})),
            int(record.get("seed", 0)),
        )


def analysed_rows(skeleton: Skeleton) -> tuple[str, ...]:
    """Names of the rows that are scored: the body's joints, then the root rows."""
    return (*(skeleton.names[j] for j in topology(skeleton).body_joints()), *ROOT_ROWS)


def departure(
    clean: Take,
    dirty: Take,
    rows: Sequence[str] | None = None,
    start: int = 0,
    end: int | None = None,
) -> Array:
    """How far each row of `dirty` is from `clean`, frame by frame.

    The hips are compared with their heading removed, which has a row of its own.

    Returns
    -------
    (F, R) float64: degrees for joints and root heading, centimetres for root position.

    Raises
    ------
    SkeletonMismatchError
        If joints or the number of frames differ.
    """
    if clean.skeleton.names != dirty.skeleton.names or clean.frames != dirty.frames:
        raise SkeletonMismatchError("clean and dirty take differ in joints or number of frames")
    rows = analysed_rows(clean.skeleton) if rows is None else rows
    span = slice(start, end)
    hips = topology(clean.skeleton).hips
    heading, tilt = split_heading(clean, start, end)
    other_heading, other_tilt = split_heading(dirty, start, end)
    columns = []
    for row in rows:
        if row == ROOT_POSITION:
            column = 100.0 * np.linalg.norm(
                hips_world(clean, start, end)[0] - hips_world(dirty, start, end)[0], axis=-1
            )
        elif row == ROOT_HEADING:
            turned = np.mod(other_heading - heading + np.pi, 2 * np.pi) - np.pi
            column = np.degrees(np.abs(turned))
        elif clean.skeleton.index[row] == hips:
            column = np.degrees(rot.angle(tilt, other_tilt))
        else:
            joint = clean.skeleton.index[row]
            a, b = clean.rotations[span, joint], dirty.rotations[span, joint]
            column = np.degrees(rot.angle(a, b))
        columns.append(column)
    return np.stack(columns, axis=1)


def limits(rows: Sequence[str]) -> Array:
    """(R,) the departure beyond which each row counts as erroneous, in the row's own unit."""
    return np.array(
        [ERRONEOUS_CENTIMETRES if r == ROOT_POSITION else ERRONEOUS_DEGREES for r in rows]
    )


def erroneous(
    clean: Take, dirty: Take, truths: Sequence[Truth] = (), rows: Sequence[str] | None = None
) -> Mask:
    """(F, R) truth mask at the take's own rate.

    A joint-frame is erroneous where it departs from the clean take by more than 10°, the root
    heading by more than 10°, the root position by more than 2 cm. Pops and jitter that never
    reach that count by their span.
    """
    rows = analysed_rows(clean.skeleton) if rows is None else rows
    mask = departure(clean, dirty, rows) > limits(rows)
    column = {row: i for i, row in enumerate(rows)}
    for truth in truths:
        at = [column[j] for j in truth.joints if j in column]
        if truth.kind in SHORT_KINDS and not mask[truth.start : truth.end, at].any():
            mask[truth.start : truth.end, at] = True
    return mask


def labelled(frames: int, rows: Sequence[str], truths: Sequence[Truth]) -> Mask:
    """(F, R) truth mask from labels made by hand, where there is no clean take.

    Raises
    ------
    MocapError
        If a label names a row that is not there, or lies outside the take.
    """
    column = {row: i for i, row in enumerate(rows)}
    mask = np.zeros((frames, len(rows)), dtype=bool)
    for truth in truths:
        for joint in truth.joints:
            if joint not in column:
                raise MocapError(f"a label names {joint!r}, which is no analysed row")
            if truth.end > frames:
                raise MocapError(f"a label ends at {truth.end}, beyond the take's {frames} frames")
            mask[truth.start : truth.end, column[joint]] = True
    return mask
