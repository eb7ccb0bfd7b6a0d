"""C3D written from its source's bytes: only the cells of changed samples are replaced."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.c3d_layout import Layout, rate
from mocapstudio.formats.c3d_numbers import Numbers
from mocapstudio.formats.c3d_parameters import BLOCK, Parameter, Parameters
from mocapstudio.formats.c3d_points import read_points
from mocapstudio.formats.c3d_read import C3dRecord
from mocapstudio.formats.marker_changes import check_declared, marker_changes
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Source

Array = NDArray[np.float64]

_MOST_STEPS = 32767
_FULL = 0xFFFF
_INTEGER = 2


def patched(take: MarkerTake, declared: Sequence[Declared], *, trim: bool) -> Iterator[bytes]:
    """Bytes of the source with the changed samples of `take` in their cells.

    A changed sample has no camera, and no residual either unless the take tells it from those that
    were filled: by that the format marks what was not measured. A sample that was taken away is
    marked as invalid. All other bytes are the source's own: points that are no markers, analogue
    samples, parameters. Only where something was filled and the source says of no sample that it
    was measured, the others are marked so, by the least residual.

    Parameters
    ----------
    take
        A take whose source is C3D.
    declared
        Which samples may differ from the source, by label.
    trim
        Leave out the frames outside `MarkerTake.trim`.

    Raises
    ------
    MocapError
        If anything else differs, or a place is beyond what the file's integers reach.
    """
    source = take.source
    assert source is not None
    record: C3dRecord = source.record
    changed = marker_changes(take, record.labels, as_read(source))
    check_declared(take, changed, declared)
    layout = record.layout
    data = bytearray(record.data)
    end = layout.start + layout.frames * layout.stride
    rows = np.frombuffer(memoryview(data)[layout.start : end], dtype=np.uint8)
    rows = rows.reshape(layout.frames, layout.stride)
    _put(take, source, changed, rows)
    _tell_filled(take, record, changed, rows)
    del rows
    _put_rate(data, record.parameters, take.rate)
    if not (trim and take.trim is not None and take.trim != (0, layout.frames)):
        yield bytes(data)
        return
    first, last = take.trim
    _put_span(data, record, first, last)
    yield bytes(data[: layout.start])
    kept = data[layout.start + first * layout.stride : layout.start + last * layout.stride]
    yield bytes(kept)
    yield bytes(-len(kept) % BLOCK)


def as_read(source: Source) -> Array:
    """(F, M, 3) metres: the markers as they were when they were read."""
    record: C3dRecord = source.record
    points = read_points(record.data, record.layout)
    return points.positions(record.points, record.units, source.to_inside)


def _put(
    take: MarkerTake, source: Source, changed: NDArray[np.bool_], rows: NDArray[np.uint8]
) -> None:
    record: C3dRecord = source.record
    layout = record.layout
    for m in np.flatnonzero(changed.any(axis=0)):
        frames = np.flatnonzero(changed[:, m])
        place = take.positions[frames, m]
        xyz = rot.rotate(rot.conjugate(source.to_inside), place) / record.units[m]
        measured = None if take.filled is None else ~take.filled[frames, m]
        cells = _cells(xyz, measured, layout, f"{take.name}: marker {take.labels[m]}")
        at = int(record.points[m]) * 4 * layout.width
        rows[frames, at : at + 4 * layout.width] = cells


def _tell_filled(
    take: MarkerTake, record: C3dRecord, changed: NDArray[np.bool_], rows: NDArray[np.uint8]
) -> None:
    """Say of other samples that they were measured, where the file does not say so of any."""
    if take.filled is None or not (added := changed & take.filled).any():
        return
    points, layout = read_points(record.data, record.layout), record.layout
    there = ~points.missing
    told = (points.measured & there).sum(axis=0) * 2 > there.sum(axis=0)
    untold = record.points[added.any(axis=0) & ~told[record.points]]
    if not len(untold):
        return
    if not points.measured.any():
        # Else the others would look like points that were computed.
        untold = np.arange(layout.points)
    numbers = layout.numbers
    least = numbers.floats_bytes(np.ones(1, np.float32)) if layout.real else None
    word = numbers.words_bytes(np.ones(1, np.int16)) if least is None else least
    mark = np.frombuffer(word, dtype=np.uint8)
    own = {int(point): m for m, point in enumerate(record.points)}
    for point in untold.tolist():
        measured = there[:, point].copy()
        if point in own:
            measured &= ~take.filled[:, own[point]] & ~changed[:, own[point]]
        at = (4 * point + 3) * layout.width
        rows[np.flatnonzero(measured), at : at + layout.width] = mark


def _cells(
    xyz: Array, measured: NDArray[np.bool_] | None, layout: Layout, where: str
) -> NDArray[np.uint8]:
    """(N, bytes) of samples in the file's units and axes."""
    gone = np.asarray(np.isnan(xyz).any(axis=1))
    four = np.zeros((len(xyz), 4))
    four[:, :3] = xyz
    if measured is not None:
        four[measured, 3] = 1.0
    four[gone] = (0.0, 0.0, 0.0, -1.0)
    if layout.real:
        raw = layout.numbers.floats_bytes(four.astype(np.float32))
    else:
        steps = four.copy()
        steps[:, :3] = np.round(four[:, :3] / layout.scale)
        if np.abs(steps).max(initial=0.0) > _MOST_STEPS:
            reach = _MOST_STEPS * layout.scale
            raise MocapError(
                f"{where} moves beyond the {reach:g} units that the file's numbers hold"
            )
        raw = layout.numbers.words_bytes(steps.astype(np.int16))
    return np.frombuffer(raw, dtype=np.uint8).reshape(len(xyz), 4 * layout.width)


def _put_rate(data: bytearray, parameters: Parameters, wanted: Fraction) -> None:
    if rate(bytes(data[:BLOCK]), parameters, []) == wanted:
        return
    data[20:24] = parameters.layout.floats_bytes(np.array([float(wanted)], dtype=np.float32))
    own = parameters.get("POINT", "RATE")
    if own is not None:
        _put_number(data, parameters.layout, own, float(wanted))


def _put_span(data: bytearray, record: C3dRecord, start: int, end: int) -> None:
    """State another first frame and another number of frames."""
    numbers, parameters = record.parameters.layout, record.parameters
    first = record.layout.first_frame + start
    last = record.layout.first_frame + end - 1
    header = np.array([min(first, _FULL), min(last, _FULL)], dtype=np.uint16).view(np.int16)
    data[6:10] = numbers.words_bytes(header)
    for group, name, value in (
        ("POINT", "FRAMES", end - start),
        ("POINT", "LONG_FRAMES", end - start),
        ("TRIAL", "ACTUAL_START_FIELD", first),
        ("TRIAL", "ACTUAL_END_FIELD", last),
    ):
        one = parameters.get(group, name)
        if one is not None:
            _put_number(data, numbers, one, value)


def _put_number(data: bytearray, numbers: Numbers, one: Parameter, value: float) -> None:
    """Put a number into a parameter: a float, a word, or two words, the low one first."""
    room = 0 if one.numbers is None else len(one.numbers)
    if room == 0:
        return
    if one.kind != _INTEGER:
        raw = numbers.floats_bytes(np.array([value], dtype=np.float32))
    else:
        whole = int(value)
        words = [whole & _FULL, whole >> 16] if room > 1 else [min(whole, _FULL)]
        raw = numbers.words_bytes(np.array(words, dtype=np.uint16).view(np.int16))
    data[one.at : one.at + len(raw)] = raw
