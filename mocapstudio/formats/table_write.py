"""Tables of positions or joint angles: from a take to a file's bytes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.euler import nearest_euler
from mocapstudio.formats.euler_order import euler_order
from mocapstudio.formats.options import WriteOptions
from mocapstudio.formats.table_layout import Layout, lay_out
from mocapstudio.formats.table_patch import patched
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]
Block = tuple[list[str], Array, int]
"""Names of columns, their values (F, C), digits after the point."""

_USUAL_ORDER = "ZXY"
_ANGLE_DECIMALS = 6
_TIME_DECIMALS = 6


def write_table(form: str, delimiter: str) -> Callable[..., Iterator[bytes]]:
    """Return the writer of a skeleton's takes as tables with this delimiter.

    It writes where the joints are in the world, or, with ``table="angles"``, the root's position
    and every joint's Euler angles in degrees, in the order of its channels in the take's file,
    else ZXY. Both begin with frame number and time; names state units.
    """

    def write(take: Take, declared: Sequence[Declared], options: WriteOptions) -> Iterator[bytes]:
        layout = lay_out(take, options, form, "m")
        blocks = _angles(take, layout, options) if options.table == "angles" else None
        return _composed(
            take.first_frame, take.rate, layout, blocks or [_joints(take, layout)], delimiter
        )

    return write


def write_marker_table(form: str, delimiter: str) -> Callable[..., Iterator[bytes]]:
    """Return the writer of marker takes as tables, from the source's text where there is one.

    Raises
    ------
    MocapError
        If a sample changed without being declared, or angles are asked for.
    """

    def write(
        take: MarkerTake, declared: Sequence[Declared], options: WriteOptions
    ) -> Iterator[bytes]:
        if options.table == "angles":
            raise MocapError(f"{take.name}: markers have no angles")
        source = take.source
        kept = source is not None and source.format == form and source.record is not None
        if kept and not options.relayout and not options.trim:
            return patched(take, declared)
        layout = lay_out(take, options, form, "m")
        positions = take.positions[layout.start : layout.end]
        block = _positions(take.labels, positions, layout)
        return _composed(take.first_frame, take.rate, layout, [block], delimiter)

    return write


def _joints(take: Take, layout: Layout) -> Block:
    positions, _ = take_pose(take, layout.start, layout.end)
    return _positions(take.skeleton.names, positions, layout)


def _positions(names: Sequence[str], positions: Array, layout: Layout) -> Block:
    columns = [f"{name} {axis} ({layout.unit_name})" for name in names for axis in "XYZ"]
    return columns, layout.outside(positions).reshape(len(positions), -1), layout.decimals


def _angles(take: Take, layout: Layout, options: WriteOptions) -> list[Block]:
    start, end = layout.start, layout.end
    names = take.skeleton.names
    blocks = [_positions(names[:1], take.translations[start:end, :1], layout)]
    for t, joint in enumerate(take.translated[1:], 1):
        moved = take.translations[start:end, t] / layout.unit
        values: Array = np.asarray(np.round(moved, layout.decimals) + 0.0)
        columns = [f"{names[joint]} {axis}translation ({layout.unit_name})" for axis in "XYZ"]
        blocks.append((columns, values, layout.decimals))
    for joint, name in enumerate(names):
        order = options.order or euler_order(take, joint) or _USUAL_ORDER
        q = take.rotations[start:end, joint]
        if joint == 0:
            q = rot.multiply(rot.conjugate(layout.to_inside), q)
        degrees = np.degrees(nearest_euler(order, q, np.zeros(3)))
        columns = [f"{name} {axis}rotation (deg)" for axis in order]
        degrees = np.asarray(np.round(degrees, _ANGLE_DECIMALS) + 0.0)
        blocks.append((columns, degrees, _ANGLE_DECIMALS))
    return blocks


def _composed(
    first_frame: int, rate: Fraction, layout: Layout, blocks: Sequence[Block], delimiter: str
) -> Iterator[bytes]:
    names = [name for columns, _, _ in blocks for name in columns]
    cells = [f"%.{digits}f" for columns, _, digits in blocks for _ in columns]
    yield (
        delimiter.join(_quoted(n, delimiter) for n in ["Frame", "Time (s)", *names]) + "\n"
    ).encode()
    row_format = delimiter.join(["%d", f"%.{_TIME_DECIMALS}f", *cells]) + "\n"
    table = np.concatenate([values for _, values, _ in blocks], axis=1)
    for i, row in enumerate(table, layout.start):
        text = row_format % (first_frame + i, i / float(rate), *row)
        yield text.replace("nan", "").encode()


def _quoted(name: str, delimiter: str) -> str:
    name = " ".join(name.replace('"', "'").split())
    return f'"{name}"' if delimiter in name else name
