"""How a take is laid out as columns of positions: unit, axes, span, digits."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.guesses import turn_to_y_up
from mocapstudio.formats.options import WriteOptions
from mocapstudio.formats.units import METRES, name_of
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import ParameterError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]

# Metres of the last digit.
_RESOLUTION = 1e-8


@dataclass(frozen=True, eq=False)
class Layout:
    """Unit and axes of a file, and which frames go into it.

    Attributes
    ----------
    unit, unit_name
        Metres per unit, and what the unit is called.
    to_inside
        Quaternion that turns the file's axes into ours.
    start, end
        Half-open span of frames.
    decimals
        Digits after the point of a length.
    """

    unit: float
    unit_name: str
    to_inside: Array
    start: int
    end: int
    decimals: int

    def outside(self, positions: Array) -> Array:
        """Turn positions (..., 3) in metres and our axes into the file's, rounded."""
        turned = rot.rotate(rot.conjugate(self.to_inside), positions) / self.unit
        # Adding zero turns -0.0 into 0.0.
        return off_origin(np.round(turned, self.decimals) + 0.0, self.decimals)


def lay_out(take: Take | MarkerTake, options: WriteOptions, form: str, usual: str) -> Layout:
    """Choose what the options ask for, else what a source of the same format has, else the usual.

    Parameters
    ----------
    take
        What is written.
    options
        As the user wants it.
    form
        Short name of the format.
    usual
        Name of the unit where nothing tells another.

    Raises
    ------
    ParameterError
        If the unit has no name that the file could state.
    """
    source = take.source if take.source is not None and take.source.format == form else None
    unit = options.unit or (source.unit if source else None)
    name = usual if unit is None else name_of(unit)
    if name is None and options.unit is None:
        name = usual
    if name is None:
        raise ParameterError(f"a table cannot name a unit of {unit:g} m: mm, cm, m, in or ft")
    to_inside = source.to_inside if source else rot.IDENTITY
    if options.up is not None:
        to_inside = turn_to_y_up(options.up)
    start, end = take.span if options.trim else (0, take.frames)
    metres = METRES[name]
    return Layout(metres, name, to_inside, start, end, math.ceil(math.log10(metres / _RESOLUTION)))


def off_origin(positions: Array, decimals: int) -> Array:
    """Move what is exactly at the origin by the last digit: 0 0 0 would read as missing.

    Parameters
    ----------
    positions
        (..., 3), rounded; changed in place.
    decimals
        Digits after the point.
    """
    positions[(positions == 0).all(axis=-1), 0] = 10.0**-decimals
    return positions
