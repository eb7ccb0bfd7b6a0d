"""What the curves of a row can show, computed from a take. No Qt."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import (
    ROOT_HEADING,
    ROOT_POSITION,
    ROOT_ROWS,
    hips_world,
    split_heading,
)
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]

_AXES = ("x", "y", "z")


class Quantity(StrEnum):
    """A quantity that can be drawn over time; the value is its name in the interface."""

    ROTATION = "Rotation vector"
    EULER = "Euler angles"
    POSITION = "World position"
    SPEED = "Speed"
    TURNING = "Turning speed"
    HEADING = "Heading"


JOINT_QUANTITIES = (
    Quantity.ROTATION,
    Quantity.EULER,
    Quantity.POSITION,
    Quantity.SPEED,
    Quantity.TURNING,
)
_UNITS = {
    Quantity.ROTATION: "°",
    Quantity.EULER: "°",
    Quantity.POSITION: "m",
    Quantity.SPEED: "m/s",
    Quantity.TURNING: "°/s",
    Quantity.HEADING: "°",
}


@dataclass(frozen=True, eq=False)
class Curves:
    """One quantity over time.

    Parameters
    ----------
    names
        C names of components: axes, or one word for a magnitude.
    unit
        Unit of the values.
    values
        (F, C), one row a frame, contiguous by component.
    """

    names: tuple[str, ...]
    unit: str
    values: Array


def quantities_of(row: str) -> tuple[Quantity, ...]:
    """Quantities that make sense for a joint or a root row, the usual one first."""
    if row == ROOT_POSITION:
        return (Quantity.POSITION, Quantity.SPEED)
    if row == ROOT_HEADING:
        return (Quantity.HEADING, Quantity.TURNING)
    return JOINT_QUANTITIES


def has_row(take: Take, row: str) -> bool:
    """Tell whether the take has such a joint or root row."""
    return row in ROOT_ROWS or row in take.skeleton.index


def unit_of(quantity: Quantity) -> str:
    """Unit of a quantity, as it is written on an axis."""
    return _UNITS[quantity]


def curves(
    take: Take,
    row: str,
    quantity: Quantity,
    *,
    order: str = "ZXY",
    near: Array | None = None,
) -> Curves:
    """Compute one quantity of one row for every frame of a take.

    Parameters
    ----------
    take
        F frames.
    row
        A joint's name or a root row.
    quantity
        One of `quantities_of(row)`.
    order
        Axes of the Euler angles, outermost first.
    near
        (F, C) values of the same quantity, of another motion: where a rotation has several
        descriptions (turns of 360°, the two triples of Euler angles), the one nearest to these is
        chosen, so that both can be drawn over each other.

    Raises
    ------
    KeyError
        If the take has no such row.
    """
    unit = _UNITS[quantity]
    goal = None if near is None else np.radians(near)
    if quantity is Quantity.HEADING:
        heading = split_heading(take)[0]
        if goal is not None:
            heading = goal[:, 0] + _wrapped(heading - goal[:, 0])
        return _pack(("heading",), unit, np.degrees(heading)[:, None])
    if quantity is Quantity.POSITION:
        return _pack(_AXES, unit, world_position(take, row))
    if quantity is Quantity.SPEED:
        return _pack(("speed",), unit, speed(world_position(take, row), float(take.rate))[:, None])
    if quantity is Quantity.TURNING:
        return _pack(("speed",), unit, _turning(take, row)[:, None])
    q = take.rotations[:, take.skeleton.index[row]]
    if quantity is Quantity.ROTATION:
        return _pack(_AXES, unit, np.degrees(rotation_vectors(q, goal)))
    angles = np.degrees(euler_angles(order, q, goal))
    return _pack(tuple(letter.lower() for letter in order), unit, angles)


def _pack(names: tuple[str, ...], unit: str, values: Array) -> Curves:
    return Curves(names, unit, np.asfortranarray(values))


def rotation_vectors(q: Array, near: Array | None = None) -> Array:
    """(F, 3) radians: rotation vectors that pass 180° without a jump.

    The angle is read off sign-continuous quaternions and so runs to 360°; with `near` (F, 3) the
    description nearest to those vectors is taken at each frame.
    """
    q = rot.continuous(q)
    if q[:, 3].sum() < 0:
        q = -q
    norm = np.linalg.norm(q[:, :3], axis=-1, keepdims=True)
    some = np.where(norm > 1e-12, norm, 1.0)
    angle = 2.0 * np.arctan2(norm, q[:, 3:])
    vectors = q[:, :3] * np.where(norm > 1e-12, angle / some, 2.0)
    if near is None:
        return np.asarray(vectors)
    # The same turn taken the other way round.
    others = q[:, :3] / some * (angle - 2.0 * np.pi)
    apart = np.linalg.norm(vectors - near, axis=-1) - np.linalg.norm(others - near, axis=-1)
    return np.where((apart > 0)[:, None], others, vectors)


def euler_angles(order: str, q: Array, near: Array | None = None) -> Array:
    """(F, 3) radians: intrinsic Euler angles without jumps between their two descriptions.

    ``(a, b, c)`` and ``(a + pi, pi - b, c + pi)`` are the same rotation. Each frame takes the one
    nearest to the frame before, or, with `near` (F, 3), nearest to those angles.
    """
    first = rot.to_euler(order, q)
    second = np.stack([first[:, 0] + np.pi, np.pi - first[:, 1], first[:, 2] + np.pi], axis=-1)
    if near is not None:
        pick = _turns(second - near) < _turns(first - near)
        chosen = np.where(pick[:, None], second, first)
        return np.asarray(near + _wrapped(chosen - near))
    # Both ways to stay cost the same, and so do both ways to change: the choice is a parity.
    stay = _turns(first[1:] - first[:-1])
    change = _turns(second[1:] - first[:-1])
    changed = np.concatenate([[0], np.cumsum(change < stay)]) % 2 == 1
    return np.unwrap(np.where(changed[:, None], second, first), axis=0)


def _wrapped(angles: Array) -> Array:
    return np.asarray((angles + np.pi) % (2 * np.pi) - np.pi)


def _turns(differences: Array) -> Array:
    result: Array = np.abs(_wrapped(differences)).sum(axis=-1)
    return result


def world_position(take: Take, row: str) -> Array:
    """(F, 3) metres: where a joint is, or the hips for a root row; only its own chain is walked."""
    if row in ROOT_ROWS:
        return hips_world(take)[0]
    skeleton = take.skeleton
    joint = skeleton.index[row]
    at = {moved: i for i, moved in enumerate(take.translated)}
    position = np.zeros((take.frames, 3))
    # From the joint up: each parent turns and carries what hangs on it.
    for one in (joint, *skeleton.ancestors(joint)):
        if one != joint:
            position = rot.rotate(take.rotations[:, one], position)
        position = position + (
            take.translations[:, at[one]] if one in at else skeleton.offsets[one]
        )
    return position


def speed(positions: Array, rate: float) -> Array:
    """(F,) metres a second: length of each step from the frame before; the first repeats."""
    return _repeat_first(np.linalg.norm(np.diff(positions, axis=0), axis=-1) * rate, len(positions))


def _turning(take: Take, row: str) -> Array:
    rate = float(take.rate)
    if row == ROOT_HEADING:
        steps = np.abs(np.diff(split_heading(take)[0]))
    else:
        q = take.rotations[:, take.skeleton.index[row]]
        steps = rot.angle(q[1:], q[:-1])
    return _repeat_first(np.degrees(steps) * rate, take.frames)


def _repeat_first(steps: Array, frames: int) -> Array:
    if len(steps) == 0:
        return np.zeros(frames)
    return np.concatenate([steps[:1], steps])
