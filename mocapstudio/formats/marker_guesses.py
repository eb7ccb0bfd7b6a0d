"""Guesses about what a file of markers leaves open: unit and up axis. Named as guesses."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.options import UNITS, Up

Array = NDArray[np.float64]

_BODY_METRES = 1.6
_LOOKED_AT = 60
_HIGH = re.compile(
    r"head|hd\d?$|skull|neck|^c7|t2$|clav|shoulder|sho\d?$|acrom|^[lr]acr$|nose|eyes?$"
    r"|(^|[lr_. ])ears?$",
    re.IGNORECASE,
)
_LOW = re.compile(r"foot|feet|toe|heel|hee$|ank|mt\d|met\d|calc|malleol|mal$", re.IGNORECASE)


def guess_marker_unit(positions: Array) -> tuple[float, str]:
    """Metres per unit of markers of a body, and the reason as a phrase.

    Parameters
    ----------
    positions
        (F, M, 3) in units of the file, NaN where missing.
    """
    some = _some(positions)
    sizes = [float(np.ptp(seen, axis=0).max()) for seen in some if len(seen) > 1]
    size = float(np.median(sizes)) if sizes else 0.0
    if size <= 0:
        return UNITS["mm"], "usual for markers"
    unit = min(
        (UNITS[u] for u in ("m", "cm", "mm")), key=lambda u: abs(np.log(u * size / _BODY_METRES))
    )
    return unit, f"a body of {size * unit:.2f} m"


def guess_marker_up(positions: Array, labels: tuple[str, ...], usual: Up = "y") -> tuple[Up, str]:
    """Which axis points from markers named after feet to those named after head and shoulders.

    Parameters
    ----------
    positions
        (F, M, 3), NaN where missing.
    labels
        One a marker.
    usual
        What to say where the labels tell nothing.
    """
    names = [label.rpartition(":")[2] for label in labels]
    high = [i for i, name in enumerate(names) if _HIGH.search(name) and not _LOW.search(name)]
    low = [i for i, name in enumerate(names) if _LOW.search(name)]
    places = np.unique(np.linspace(0, len(positions) - 1, _LOOKED_AT).astype(int))
    rises = [
        np.nanmean(p[high], axis=0) - np.nanmean(p[low], axis=0)
        for p in positions[places]
        if np.isfinite(p[high]).all(axis=1).any() and np.isfinite(p[low]).all(axis=1).any()
    ]
    if not rises:
        return usual, "usual; no labels of head and feet to tell by"
    rise = np.array(rises)
    mean = (rise / np.maximum(np.linalg.norm(rise, axis=1, keepdims=True), 1e-12)).mean(axis=0)
    axes: tuple[Up, ...] = ("x", "y", "z")
    up = axes[int(np.argmax(mean))]
    if mean.max() < 0.5 or mean.max() < 1.2 * np.sort(np.abs(mean))[1]:
        return usual, "usual; the head is not above the feet"
    return up, "the head is above the feet"


def _some(positions: Array) -> list[Array]:
    places = np.unique(np.linspace(0, len(positions) - 1, _LOOKED_AT).astype(int))
    return [p[np.isfinite(p).all(axis=1)] for p in positions[places]]
