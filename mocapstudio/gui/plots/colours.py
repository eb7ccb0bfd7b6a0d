"""Colours of the plots: the map's lookup table, the three axes, the ways an edit was made."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtGui import QColor

from mocapstudio.gui.plots.pooling import LEVELS
from mocapstudio.gui.theme import Theme

# Parts of the theme's perceptual map: all that is quiet shares the low part, all that is above
# the threshold the high one, so the threshold itself is a visible step in lightness.
_QUIET = {"dark": (0.0, 0.36), "light": (0.0, 0.16)}
_LOUD = {"dark": (0.58, 0.98), "light": (0.46, 1.0)}

_AXES = {
    "dark": {"x": "#ff8a5b", "y": "#8fd16a", "z": "#5cb8f0"},
    "light": {"x": "#c2410c", "y": "#4d7c0f", "z": "#0b6bb8"},
}


@lru_cache(maxsize=64)
def lookup_table(theme: Theme, threshold: float) -> NDArray[np.uint32]:
    """(256,) colours as 0xffRRGGBB for digression 0..1, with a step at the threshold."""
    value = np.arange(LEVELS) / (LEVELS - 1)
    quiet, loud = _QUIET[theme.name], _LOUD[theme.name]
    above = value >= threshold - 0.5 / (LEVELS - 1)
    low = quiet[0] + (quiet[1] - quiet[0]) * value / max(threshold, 1e-6)
    high = loud[0] + (loud[1] - loud[0]) * (value - threshold) / max(1.0 - threshold, 1e-6)
    rgb = pg.colormap.get(theme.colormap).map(np.where(above, high, low), mode="byte")[:, :3]
    # Nothing at all should look like nothing at all: the plot's own ground.
    field = QColor(theme.field)
    ground = np.array([field.red(), field.green(), field.blue()])
    share = np.clip(low / (0.35 * quiet[1]), 0.0, 1.0)[:, None]
    rgb = np.where(above[:, None], rgb, ground + (rgb - ground) * share).astype(np.uint32)
    table: NDArray[np.uint32] = 0xFF000000 | rgb[:, 0] << 16 | rgb[:, 1] << 8 | rgb[:, 2]
    return table


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
    return QColor(known.get(name, theme.result))


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
