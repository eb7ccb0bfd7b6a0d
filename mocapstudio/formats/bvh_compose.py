"""BVH written anew, for takes that have no BVH text behind them or want another layout."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.euler import nearest_euler
from mocapstudio.formats.frame_time import frame_time
from mocapstudio.formats.guesses import turn_to_y_up
from mocapstudio.formats.options import UNITS, WriteOptions
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]

_USUAL_ORDER = "ZXY"
_DECIMALS = 6


@dataclass(frozen=True, eq=False)
class _Plan:
    take: Take
    unit: float
    to_inside: Array
    orders: tuple[str, ...]
    moves: tuple[bool, ...]


def composed(take: Take, options: WriteOptions) -> Iterator[bytes]:
    """Bytes of a BVH file with the take's skeleton and motion.

    Unit, up axis and Euler orders are those of the options, else of the take's BVH source, else
    centimetres, Y up and ZXY. Joints without a tip get an end site at their own place, without
    which many programs leave them out.
    """
    plan = _plan(take, options)
    depth_first = _depth_first(take)
    yield "\n".join(_hierarchy(plan)).encode() + b"\n"
    start, end = take.span if options.trim else (0, take.frames)
    yield f"MOTION\nFrames: {end - start}\nFrame Time: {frame_time(take.rate)}\n".encode()
    table = _table(plan, depth_first, start, end)
    row_format = " ".join([f"%.{_DECIMALS}f"] * table.shape[1]) + "\n"
    for row in table:
        yield (row_format % tuple(row)).encode()


def _plan(take: Take, options: WriteOptions) -> _Plan:
    source = take.source if take.source is not None and take.source.format == "bvh" else None
    unit = options.unit or (source.unit if source else UNITS["cm"])
    to_inside = source.to_inside if source else rot.IDENTITY
    if options.up is not None:
        to_inside = turn_to_y_up(options.up)
    orders = [options.order or _USUAL_ORDER] * len(take.skeleton)
    joints = source.record.layout.hierarchy.joints if source else []
    if options.order is None and len(joints) == len(orders):
        orders = [j.order if len(set(j.order)) == 3 else _USUAL_ORDER for j in joints]
    six = options.channels == 6
    moves = tuple(six or j in take.translated for j in range(len(take.skeleton)))
    return _Plan(take, unit, to_inside, tuple(orders), moves)


def _depth_first(take: Take) -> list[int]:
    order, stack = [], [0]
    while stack:
        joint = stack.pop()
        order.append(joint)
        stack += reversed(take.skeleton.children[joint])
    return order


def _hierarchy(plan: _Plan) -> Iterator[str]:
    skeleton = plan.take.skeleton
    tips: dict[int, list[Array]] = {}
    for parent, offset in zip(skeleton.end_parents, skeleton.end_offsets, strict=True):
        tips.setdefault(int(parent), []).append(offset)
    yield "HIERARCHY"
    # A stack instead of recursion: a chain of joints may be longer than Python's.
    stack: list[tuple[int, int, bool]] = [(0, 0, False)]
    while stack:
        joint, depth, closing = stack.pop()
        indent = "\t" * depth
        if closing:
            yield indent + "}"
            continue
        yield f"{indent}{'JOINT' if depth else 'ROOT'} {skeleton.names[joint]}"
        yield indent + "{"
        yield f"{indent}\tOFFSET {_three(skeleton.offsets[joint] / plan.unit)}"
        yield f"{indent}\tCHANNELS {_channels(plan, joint)}"
        below = skeleton.children[joint]
        for tip in tips.get(joint, [] if below else [np.zeros(3)]):
            yield from (f"{indent}\tEnd Site", indent + "\t{")
            yield f"{indent}\t\tOFFSET {_three(tip / plan.unit)}"
            yield indent + "\t}"
        stack.append((joint, depth, True))
        stack += [(child, depth + 1, False) for child in reversed(below)]


def _three(vector: Array) -> str:
    return " ".join(f"{value:.{_DECIMALS}f}" for value in vector)


def _channels(plan: _Plan, joint: int) -> str:
    rotations = " ".join(f"{letter}rotation" for letter in plan.orders[joint])
    if not plan.moves[joint]:
        return f"3 {rotations}"
    return f"6 Xposition Yposition Zposition {rotations}"


def _table(plan: _Plan, joints: list[int], start: int, end: int) -> Array:
    take = plan.take
    back = rot.conjugate(plan.to_inside)
    at = {joint: t for t, joint in enumerate(take.translated)}
    angles = _angles(plan, start, end)
    columns: list[Array] = []
    for joint in joints:
        if plan.moves[joint]:
            if joint in at:
                place = take.translations[start:end, at[joint]]
            else:
                place = np.tile(take.skeleton.offsets[joint], (end - start, 1))
            columns.append((rot.rotate(back, place) if joint == 0 else place) / plan.unit)
        columns.append(np.degrees(angles[:, joint]))
    # Adding zero turns -0.0 into 0.0.
    return np.asarray(np.round(np.concatenate(columns, axis=1), _DECIMALS) + 0.0, dtype=np.float64)


def _angles(plan: _Plan, start: int, end: int) -> Array:
    q = plan.take.rotations[start:end].copy()
    q[:, 0] = rot.multiply(rot.conjugate(plan.to_inside), q[:, 0])
    angles = np.empty((*q.shape[:2], 3))
    for order in set(plan.orders):
        of_order = [j for j, one in enumerate(plan.orders) if one == order]
        angles[:, of_order] = nearest_euler(order, q[:, of_order], np.zeros((len(of_order), 3)))
    return angles
