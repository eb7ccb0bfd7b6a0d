"""BVH written from its source text: only the cells of changed samples are replaced."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.bvh_motion import parse_motion
from mocapstudio.formats.bvh_read import BvhRecord, in_metres, turn_inside
from mocapstudio.formats.bvh_rows import MotionBlock
from mocapstudio.formats.bvh_take import motion
from mocapstudio.formats.changes import Changes, changes, undeclared
from mocapstudio.formats.euler import nearest_euler
from mocapstudio.formats.frame_time import frame_time, stated_rate
from mocapstudio.formats.reading import Reading
from mocapstudio.formats.splicing import Splice, spliced
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.runs import runs
from mocapstudio.motion.take import Source, Take

Array = NDArray[np.float64]
Cells = dict[int, dict[int, float]]

_FEWEST_DECIMALS = 6


def patched(take: Take, declared: Sequence[Declared], *, trim: bool) -> Iterator[bytes]:
    """Bytes of the source with the changed samples of `take` in their cells.

    Euler angles of changed samples are the nearest equivalents of the frame before; all other
    bytes are the source's own.

    Parameters
    ----------
    take
        A take whose source is BVH.
    declared
        Which samples may differ from the source.
    trim
        Leave out the rows outside `Take.trim`.

    Raises
    ------
    MocapError
        If anything else differs, or a joint has no channels for its change.
    """
    source = take.source
    assert source is not None
    record: BvhRecord = source.record
    numbers, original = as_read(take, source)
    changed = changes(take, original)
    beyond = undeclared(take, changed, declared)
    if beyond is not None:
        raise MocapError(f"{take.name}: changed without being declared: {beyond}")
    cells: Cells = {}
    _rotation_cells(take, source, changed, numbers, cells)
    _translation_cells(take, source, changed, cells)
    text = _Text(record)
    splices = [splice for row in sorted(cells) for splice in text.replaced(row, cells[row])]
    splices += _rate_splice(record, take.rate)
    if trim and take.trim is not None:
        cut = text.trimmed(*take.trim)
        splices = [*(s for s in splices if not _inside(s, cut)), *cut]
    return spliced(record.data, sorted(splices))


def as_read(take: Take, source: Source) -> tuple[Array, Take]:
    """Return the numbers (F, C) of the source's rows, and the take as it was when it was read."""
    record: BvhRecord = source.record
    block = record.block
    reading = Reading(source.path, record.data, True, [])
    _, numbers = parse_motion(reading, block.section, block.end, block.columns)
    rotations, translations = motion(record.layout, numbers)
    original = replace(
        take,
        skeleton=replace(in_metres(record.layout.skeleton, source.unit), names=take.skeleton.names)
        if len(take.skeleton) == len(record.layout.skeleton)
        else record.layout.skeleton,
        rotations=rotations,
        translations=turn_inside(rotations, translations, source),
        translated=record.layout.translated,
        trim=None,
    )
    return numbers, original


def _rotation_cells(
    take: Take, source: Source, changed: Changes, numbers: Array, cells: Cells
) -> None:
    layout = source.record.layout
    for j in np.flatnonzero(changed.rotations.any(axis=0)):
        joint = layout.hierarchy.joints[j]
        columns = list(joint.rotations)
        for start, end in runs(changed.rotations[:, j]):
            q = take.rotations[start:end, j]
            if j == 0:
                q = rot.multiply(rot.conjugate(source.to_inside), q)
            # A run at the very start has no frame before it; the one after it tells as well.
            before = start - 1 if start else min(end, len(numbers) - 1)
            previous = numbers[before, columns] * layout.to_radians
            try:
                angles = nearest_euler(joint.order, q, previous) / layout.to_radians
            except MocapError as bad:
                raise MocapError(f"joint {joint.name}: {bad}") from None
            for row, values in zip(range(start, end), angles, strict=True):
                cells.setdefault(row, {}).update(zip(columns, map(float, values), strict=True))


def _translation_cells(take: Take, source: Source, changed: Changes, cells: Cells) -> None:
    layout = source.record.layout
    for t in np.flatnonzero(changed.translations.any(axis=0)):
        j = take.translated[t]
        joint = layout.hierarchy.joints[j]
        rows = np.flatnonzero(changed.translations[:, t])
        moved = take.translations[rows, t] / source.unit
        if j == 0:
            moved = rot.rotate(rot.conjugate(source.to_inside), moved)
        moved = moved - layout.base(j)
        for axis, column in enumerate(joint.positions):
            if column >= 0:
                for row, value in zip(rows, moved[:, axis], strict=True):
                    cells.setdefault(int(row), {})[column] = float(value)
            elif not np.allclose(moved[:, axis], joint.offset[axis], atol=1e-6):
                raise MocapError(f"joint {joint.name} has no {'XYZ'[axis]} position channel")


class _Text:
    """The rows of a motion block as spans of bytes."""

    def __init__(self, record: BvhRecord) -> None:
        self.data, self.block = record.data, record.block

    @cached_property
    def rows(self) -> list[tuple[int, int]]:
        """Bytes from each row's first cell to past its last one."""
        block = self.block
        if not block.regular:
            spans, wide = self.all_cells, block.columns
            firsts = range(0, block.frames * wide, wide)
            return [(spans[i][0], spans[i + wide - 1][1]) for i in firsts]
        found, at = [], block.start
        for line in self.data[block.start : block.end].splitlines(keepends=True):
            if line.strip():
                found.append((at, at + len(line.rstrip())))
            at += len(line)
        return found[: block.frames]

    @cached_property
    def all_cells(self) -> list[tuple[int, int]]:
        block = self.block
        return [m.span() for m in block.cell.finditer(self.data, block.start, block.end)]

    def replaced(self, row: int, values: dict[int, float]) -> list[Splice]:
        """Splices that put values into the cells of a row, by column."""
        spans = [m.span() for m in self.block.cell.finditer(self.data, *self.rows[row])]
        texts = [self.data[a:b] for a, b in spans]
        decimals = max(_FEWEST_DECIMALS, *(_decimals(t, self.block) for t in texts))
        found = []
        for column, value in values.items():
            a, b = spans[column]
            text = f"{value:.{decimals}f}".encode().replace(b".", self.block.decimal)
            # Fused numbers are told apart by their signs alone.
            touching = column > 0 and spans[column - 1][1] == a
            found.append((a, b, b" " + text if touching and value >= 0 else text))
        return found

    def trimmed(self, start: int, end: int) -> list[Splice]:
        """Splices that cut the rows outside [start, end) and state the number that is left."""
        rows = self.rows
        cuts = [(*self.block.frames_span, str(end - start).encode())]
        if start > 0:
            cuts.append((rows[0][0], rows[start][0], b""))
        if end < len(rows):
            cuts.append((rows[end - 1][1], rows[-1][1], b""))
        return cuts


def _decimals(cell: bytes, block: MotionBlock) -> int:
    mantissa = cell.lower().partition(b"e")[0]
    return len(mantissa.partition(block.decimal)[2])


def _rate_splice(record: BvhRecord, rate: Fraction) -> list[Splice]:
    block = record.block
    if stated_rate(block.frame_time)[0] == rate:
        return []
    text = frame_time(rate).encode().replace(b".", block.decimal)
    if block.frame_time:
        return [(*block.frame_time_span, text)]
    newline = b"\r\n" if b"\r\n" in record.data[: block.start] else b"\n"
    return [(*block.frame_time_span, newline + b"Frame Time: " + text)]


def _inside(splice: Splice, cuts: list[Splice]) -> bool:
    return any(a <= splice[0] and splice[1] <= b for a, b, _ in cuts)
