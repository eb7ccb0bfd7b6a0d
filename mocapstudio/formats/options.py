"""What a user may decide about reading and writing, where a file leaves it open."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Literal

from mocapstudio.motion.errors import ParameterError

Up = Literal["x", "y", "z"]
Forward = Literal["x", "-x", "y", "-y", "z", "-z"]

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "asf": 0.0254 / 0.45}
"""Metres per unit by name; ``asf`` is the 1/0.45 inch of the CMU database."""


_SLOWEST = Fraction(1, 1000)
_LONG_EXPONENT = re.compile(r"e[+-]?\d{4}", re.IGNORECASE)


@dataclass(frozen=True)
class ReadOptions:
    """Overrides for what a file does not state or states wrongly. None leaves it to the reader.

    Parameters
    ----------
    fps
        Frames a second.
    unit
        Metres per unit of the file.
    up
        The file's world axis that points up.
    forward
        The file's world axis that becomes our Z; None turns the world as little as the up axis
        needs.
    angles
        Unit of the file's rotation channels.
    root_offset
        Whether the root's position channels replace its OFFSET or are added to it.
    trim_start
        Trim rows of a synthetic T-pose before the motion.
    lenient
        Read the whole rows that are there where a file states another number of frames.
    skeleton
        The ASF of an AMC, where it is not the one that its name or folder tells.
    """

    fps: Fraction | None = None
    unit: float | None = None
    up: Up | None = None
    forward: Forward | None = None
    angles: Literal["degrees", "radians"] = "degrees"
    root_offset: Literal["replace", "add"] = "replace"
    trim_start: bool = True
    lenient: bool = False
    skeleton: Path | None = None


@dataclass(frozen=True)
class WriteOptions:
    """How a file is laid out. None keeps the source's own way, or the format's usual one.

    Parameters
    ----------
    order
        Euler order of every joint, such as ``"ZXY"`` (outermost first).
    channels
        3: positions for the joints that translate only; 6: positions for every joint.
    unit
        Metres per unit of the file.
    up
        The file's world axis that points up.
    trim
        Write only the frames of `Take.trim`.
    anew
        Do not keep the source's text: for takes that were cut, resampled or retargeted.
    table
        What a table of a skeleton's take holds: where its joints are, or their Euler angles.
    """

    order: str | None = None
    channels: Literal[3, 6] | None = None
    unit: float | None = None
    up: Up | None = None
    trim: bool = False
    anew: bool = False
    table: Literal["positions", "angles"] | None = None

    def __post_init__(self) -> None:
        if self.order is not None and sorted(self.order) != ["X", "Y", "Z"]:
            raise ParameterError(
                f"Euler order {self.order!r}: X, Y and Z in some order needed, such as ZXY"
            )

    @property
    def relayout(self) -> bool:
        """True where the source's text is not kept."""
        asked = (self.order, self.channels, self.unit, self.up, self.table)
        return self.anew or any(choice is not None for choice in asked)


def parse_rate(text: str) -> Fraction:
    """Frames a second from ``"30"``, ``"119.88"`` or ``"120000/1001"``.

    Decimals of the NTSC family become the exact fraction.

    Raises
    ------
    ParameterError
        If the text is no positive number.
    """
    try:
        # A longer exponent would take all memory before it is found to be none.
        rate = Fraction("" if _LONG_EXPONENT.search(text) else text)
    except (ValueError, ZeroDivisionError):
        raise ParameterError(
            f"{text!r} is no frame rate: such as 30, 119.88 or 120000/1001"
        ) from None
    if not _SLOWEST <= rate <= 1_000_000:
        raise ParameterError(f"frame rate {text} is not in 0..1000000")
    nominal = round(rate)
    ntsc = Fraction(nominal * 1000, 1001)
    return ntsc if nominal and rate != nominal and abs(rate - ntsc) < Fraction(1, 100) else rate


def parse_unit(text: str) -> float:
    """Metres per unit from a name (``m``, ``cm``, ``mm``, ``in``, ``asf``) or a number.

    Raises
    ------
    ParameterError
        If the text is neither.
    """
    if text in UNITS:
        return UNITS[text]
    try:
        unit = float(text)
    except ValueError:
        unit = math.nan
    if not (math.isfinite(unit) and unit > 0):
        names = ", ".join(UNITS)
        raise ParameterError(f"{text!r} is no unit: {names}, or metres per unit")
    return unit
