"""Colours of the plots: the map's lookup table, the three axes, the ways an edit was made."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtGui import QColor

from mocapstudio.gui.plots.pooling import LEVELS
from mocapstudio.gui.theme import Theme

# Above the threshold the loud part of the theme's perceptual map is used; below it the colour
# runs from the plot's own ground to the quiet one, so that the threshold is a visible step in
# lightness and nothing at all looks like nothing at all.
_QUIET = {"dark": "#5a1a6b", "light": "#c3cde3"}
_LOUD = {"dark": (0.58, 0.98), "light": (0.46, 1.0)}

# Apart in lightness too: x and y look alike to many without it.
_AXES = {
    "dark": {"x": "#ff7350", "y": "#c2e36b", "z": "#55aaff"},
    "light": {"x": "#bf360c", "y": "#7c9400", "z": "#0b62b8"},
}


@lru_cache(maxsize=64)
def lookup_table(theme: Theme, threshold: float) -> NDArray[np.uint32]:
    """(256,) colours as 0xffRRGGBB for digression 0..1, with a step at the threshold."""
    value = np.arange(LEVELS) / (LEVELS - 1)
    above = value >= threshold - 0.5 / (LEVELS - 1)
    first, last = _LOUD[theme.name]
    loud = first + (last - first) * (value - threshold) / max(1.0 - threshold, 1e-6)
    shown = pg.colormap.get(theme.colormap).map(np.clip(loud, 0.0, 1.0), mode="byte")[:, :3]
    share = np.clip(value / max(threshold, 1e-6), 0.0, 1.0)[:, None]
    ground, quiet = _rgb(theme.field), _rgb(_QUIET[theme.name])
    rgb = np.where(above[:, None], shown, ground + (quiet - ground) * share).astype(np.uint32)
    packed = 0xFF000000 | rgb[:, 0] << 16 | rgb[:, 1] << 8 | rgb[:, 2]
    return np.asarray(packed, dtype=np.uint32)


def _rgb(colour: str) -> NDArray[np.float64]:
    parsed = QColor(colour)
    return np.array([parsed.red(), parsed.green(), parsed.blue()], dtype=np.float64)


def component(theme: Theme, name: str) -> QColor:
    """Colour of a curve's component: an axis, or the theme's text for a magnitude."""
    return QColor(_AXES[theme.name].get(name, theme.text))


def method(theme: Theme, name: str) -> QColor:
    """Colour of the way an edit was made, for the provenance band."""
    known = {
        "neighbours": theme.accent,
        "interpolation": theme.neighbour,
        "swap": theme.deferred,
    }
    # What was bent besides stands after it.
    return QColor(known.get(name.split(", ")[0], theme.result))


def faded(colour: QColor | str, alpha: float) -> QColor:
    """Return the colour with another opacity, 0..1."""
    result = QColor(colour)
    result.setAlphaF(alpha)
    return result


def mixed(a: QColor | str, b: QColor | str, share: float) -> QColor:
    """Colour between `a` (share 0) and `b` (share 1)."""
    first, second = QColor(a), QColor(b)
    return QColor(
        round(first.red() + (second.red() - first.red()) * share),
        round(first.green() + (second.green() - first.green()) * share),
        round(first.blue() + (second.blue() - first.blue()) * share),
    )
