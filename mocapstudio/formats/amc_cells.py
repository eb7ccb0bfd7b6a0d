"""From changed samples of a take to the values of an AMC."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.amc_dof import nearest_angles
from mocapstudio.formats.amc_read import AmcRecord
from mocapstudio.formats.amc_take import Layout, motion
from mocapstudio.formats.amc_text import Cells
from mocapstudio.formats.bvh_read import in_metres, turn_inside
from mocapstudio.formats.changes import Changes
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.runs import runs
from mocapstudio.motion.take import Source, Take

Array = NDArray[np.float64]

# Blending two poses of a joint with two axes leaves them by a little; more is another motion.
_MOST_OFF = np.radians(2.0)
_STILL = 1e-6


def as_read(source: Source) -> Take:
    """The take as it was when it was read."""
    record: AmcRecord = source.record
    rotations, translations = motion(record.layout, record.values)
    return Take(
        source.path.stem,
        in_metres(record.layout.skeleton, source.unit),
        rotations,
        turn_inside(rotations, translations, source),
        Fraction(1),
        translated=record.layout.translated,
        source=source,
    )


def frame_cells(take: Take, source: Source, changed: Changes) -> Cells:
    """Values of the changed samples.

    Angles are continued from the frame before each run of changed frames. Where a bone has fewer
    than three axes the nearest angles are taken.

    Raises
    ------
    MocapError
        If the nearest angles are farther than 2° from the rotation, or a position has no channel.
    """
    record: AmcRecord = source.record
    cells: Cells = {}
    for j in np.flatnonzero(changed.rotations.any(axis=0)):
        for start, end in runs(changed.rotations[:, j]):
            _rotations(take, source, int(j), start, end, cells)
    for t in np.flatnonzero(changed.translations.any(axis=0)):
        frames = np.flatnonzero(changed.translations[:, t])
        _translations(take, source, record.layout, int(t), frames, cells)
    return cells


def _rotations(take: Take, source: Source, j: int, start: int, end: int, cells: Cells) -> None:
    record: AmcRecord = source.record
    bone, axis = record.layout.bones[j], record.layout.axes[j]
    q = take.rotations[start:end, j]
    if j == 0:
        q = rot.multiply(rot.conjugate(source.to_inside), q)
    own = rot.multiply(rot.multiply(rot.conjugate(axis), q), axis)
    places = {channel[1].upper(): c for c, channel in enumerate(bone.dof) if channel[0] == "r"}
    order = "".join(letter for letter in reversed(bone.order) if letter in places)
    columns = [places[letter] for letter in order]
    values = record.values.get(bone.name, np.empty((take.frames, 0)))
    before = start - 1 if start else min(end, take.frames - 1)
    angles, off = nearest_angles(order, own, values[before, columns] * record.layout.to_radians)
    worst = int(np.argmax(off))
    if off[worst] > _MOST_OFF:
        axes = f"its axes {order}" if order else "no axis"
        raise MocapError(
            f"{take.name}: bone {bone.name} has {axes} for the rotation at frame {start + worst}"
            f" ({np.degrees(off[worst]):.1f}° off); BVH can hold it"
        )
    for frame, row in zip(range(start, end), angles / record.layout.to_radians, strict=True):
        cells.setdefault((frame, bone.name), {}).update(zip(columns, map(float, row), strict=True))


def _translations(
    take: Take, source: Source, layout: Layout, t: int, frames: NDArray[np.int64], cells: Cells
) -> None:
    j = take.translated[t]
    bone = layout.bones[j]
    moved = take.translations[frames, t] / source.unit
    if j == 0:
        moved = rot.rotate(rot.conjugate(source.to_inside), moved)
    moved = moved - layout.skeleton.offsets[j]
    if j:
        moved = rot.rotate(rot.conjugate(layout.axes[j]), moved)
    for a, letter in enumerate("xyz"):
        if f"t{letter}" in bone.dof:
            place = bone.dof.index(f"t{letter}")
            for frame, value in zip(frames, moved[:, a], strict=True):
                cells.setdefault((int(frame), bone.name), {})[place] = float(value)
        elif np.abs(moved[:, a]).max() > _STILL:
            raise MocapError(f"{take.name}: bone {bone.name} has no position channel t{letter}")
