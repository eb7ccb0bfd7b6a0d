"""Unit and up axis of the points of a C3D file: as stated, as guessed, as the user has it."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.c3d_parameters import Parameters
from mocapstudio.formats.c3d_points import Points
from mocapstudio.formats.guesses import turn_to_inside
from mocapstudio.formats.marker_guesses import guess_marker_unit, guess_marker_up
from mocapstudio.formats.options import UNITS, ReadOptions, Up
from mocapstudio.formats.report import Problem
from mocapstudio.motion import rotations as rot

Array = NDArray[np.float64]

_AXES: Final[dict[str, Up]] = {"X": "x", "Y": "y", "Z": "z"}
_NAMES = {
    "m": "m",
    "meter": "m",
    "meters": "m",
    "metre": "m",
    "metres": "m",
    "cm": "cm",
    "mm": "mm",
    "in": "in",
    "inch": "in",
    "inches": "in",
}
# Largest distance between two markers at one moment, in metres: a hand; the people of a hall.
_LEAST_SIZE, _MOST_SIZE = 0.02, 60.0
_SOME = 200
_APART = 1000.0
# How much larger the body's extent is along the vertical than along the next axis.
_UPRIGHT = 1.3
_SCREEN = re.compile(r"([+-]?)([XYZ])$")


@dataclass(frozen=True, eq=False)
class Space:
    """How points become metres, Y up.

    Attributes
    ----------
    units
        (P,) metres per unit, of each point.
    unit
        The usual one of them.
    to_inside
        Quaternion from the file's axes to ours.
    """

    units: Array
    unit: float
    to_inside: Array


def find_space(
    points: Points,
    markers: dict[int, str],
    parameters: Parameters,
    options: ReadOptions,
    problems: list[Problem],
) -> Space:
    """Tell units and up axis.

    Parameters
    ----------
    points
        All points of the file.
    markers
        Labels of the points that are markers, by index.
    """
    chosen = np.array(list(markers), dtype=int)
    layout = points.layout
    some = np.unique(np.linspace(0, layout.frames - 1, _SOME).astype(int))
    seen = points.coordinates(some, chosen).astype(np.float64)
    # What was filled in tells nothing new: a file means the same before and after.
    filled = points.filled(chosen)
    if filled is not None:
        seen[filled[some]] = np.nan
    units, unit = _units(seen, chosen, layout.points, parameters, options, problems)
    up = _to_inside(
        seen * units[chosen, None], tuple(markers.values()), parameters, options, problems
    )
    return Space(units, unit, up)


def _units(
    seen: Array,
    chosen: NDArray[np.int64],
    points: int,
    parameters: Parameters,
    options: ReadOptions,
    problems: list[Problem],
) -> tuple[Array, float]:
    if options.unit is not None:
        return np.full(points, options.unit), options.unit
    stated = parameters.texts("POINT", "UNITS")
    metres = [UNITS[_NAMES[t.lower()]] if t.lower() in _NAMES else 0.0 for t in stated]
    if points > 1 and len(metres) == points and all(metres):
        if len(set(metres)) > 1:
            what = f"units are mixed: {', '.join(sorted(set(stated)))}"
            problems.append(Problem(None, what, "each point read in its own", "unit"))
        units = np.array(metres)
        return units, float(np.median(units[chosen]))
    factors = _mixed(seen, problems)
    unit = _unit(seen * factors[:, None], next(iter(stated), ""), next(iter(metres), 0.0), problems)
    units = np.full(points, unit)
    units[chosen] *= factors
    return units, unit


def _unit(seen: Array, name: str, stated: float, problems: list[Problem]) -> float:
    size = _size(seen)
    if stated and (size == 0 or _LEAST_SIZE <= size * stated <= _MOST_SIZE):
        return stated
    unit, why = guess_marker_unit(seen)
    what = f"markers {size * stated:.3g} m apart, in {name}" if stated else "no unit stated"
    if name and not stated:
        what = f"{name[:24]!r} is no unit of length"
    done = f"guessed 1 unit = {unit:.4g} m ({why})"
    problems.append(Problem(None, what, done, "unit", guess=True))
    return unit


def _size(seen: Array) -> float:
    """Median distance over which the markers of one moment spread; 0 where they never do."""
    spreads = [
        float(np.ptp(there, axis=0).max())
        for frame in seen
        if len(there := frame[np.isfinite(frame).all(axis=1)]) > 1
    ]
    return float(np.median(spreads)) if spreads else 0.0


def _mixed(seen: Array, problems: list[Problem]) -> Array:
    """(M,) factors that bring markers in metres to the millimetres of the others, or back."""
    factors = np.ones(seen.shape[1])
    reach = _reach(seen)
    known = np.isfinite(reach) & (reach > 0)
    if known.sum() < 2:
        return factors
    usual = float(np.median(reach[known]))
    for odd, factor, how in (
        (known & (reach * 50 < usual), _APART, "smaller"),
        (known & (reach > usual * 50), 1 / _APART, "larger"),
    ):
        scaled = reach[odd] * factor
        if not odd.any() or not ((scaled > usual / 10) & (scaled < usual * 10)).all():
            continue
        factors[odd] = factor
        what = f"{int(odd.sum())} markers are about a thousand times {how} than the others"
        done = "guessed: metres among millimetres; brought to one unit"
        problems.append(Problem(None, what, done, "unit", guess=True))
    return factors


def _reach(seen: Array) -> Array:
    """(M,) median largest coordinate of each marker; NaN where it is never there."""
    largest = np.abs(seen).max(axis=2)
    present = ~np.isnan(largest).all(axis=0)
    found = np.full(seen.shape[1], np.nan)
    found[present] = np.nanmedian(largest[:, present], axis=0)
    return found


def _to_inside(
    seen: Array,
    labels: tuple[str, ...],
    parameters: Parameters,
    options: ReadOptions,
    problems: list[Problem],
) -> Array:
    if options.up is not None:
        return turn_to_inside(options.up, options.forward)
    stated = _SCREEN.match(parameters.text("POINT", "Y_SCREEN").strip().upper())
    if stated is not None:
        up = _AXES[stated[2]]
        # What points down: half a turn about another axis brings it up.
        half = rot.about_axis(0 if up != "x" else 2, np.array(np.pi if stated[1] == "-" else 0.0))
        return rot.multiply(turn_to_inside(up, options.forward), half)
    up, why = guess_marker_up(seen, labels, "z")
    if why.startswith("usual"):
        up, why = _by_spread(seen)
    done = f"guessed {up.upper()} up ({why})"
    problems.append(Problem(None, "no up axis stated", done, "up", guess=True))
    return turn_to_inside(up, options.forward)


def _by_spread(seen: Array) -> tuple[Up, str]:
    extents = [
        np.ptp(there, axis=0)
        for frame in seen
        if len(there := frame[np.isfinite(frame).all(axis=1)]) > 1
    ]
    if extents:
        medians = np.median(np.array(extents), axis=0)
        along = int(np.argmax(medians))
        if medians[along] > _UPRIGHT * np.sort(medians)[1]:
            return _AXES["XYZ"[along]], "the markers spread most along it"
    return "z", "usual"
