"""Colours of the 3-D view: the theme's, and what is mixed from them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QColor

from mocapstudio.gui.plots.colours import lookup_table
from mocapstudio.gui.theme import Theme

Colour = tuple[int, int, int]

# Below half the threshold a joint is neutral; from there to the threshold it warms up.
_QUIET = 0.5
_VIVID = 0.72


@dataclass(frozen=True)
class Palette:
    """What each thing in the scene is coloured with, 0..255."""

    theme: Theme
    top: Colour
    bottom: Colour
    floor: Colour
    shadow: Colour
    body: Colour
    unmapped: Colour
    original: Colour
    proposal: Colour
    neighbour: Colour
    partner: Colour
    accent: Colour
    faint: Colour
    coming: Colour


def palette(theme: Theme) -> Palette:
    """Mix the scene's colours from a theme."""
    ground = rgb(theme.viewport_bottom)
    dark = theme.name == "dark"
    return Palette(
        theme=theme,
        top=rgb(theme.viewport_top),
        bottom=ground,
        floor=rgb(theme.floor),
        shadow=mix(ground, (0, 0, 0), 0.42 if dark else 0.13),
        body=rgb(theme.body),
        unmapped=mix(rgb(theme.body), ground, 0.35),
        original=mix(rgb(theme.original), ground, 0.55),
        proposal=rgb(theme.proposal),
        neighbour=rgb(theme.neighbour),
        partner=rgb(theme.partner),
        accent=rgb(theme.accent),
        faint=mix(ground, rgb(theme.text), 0.22),
        coming=rgb(theme.deferred),
    )


def rgb(name: str) -> Colour:
    """Return ``#rrggbb`` as three bytes."""
    colour = QColor(name)
    return colour.red(), colour.green(), colour.blue()


def mix(a: Colour, b: Colour, share: float) -> Colour:
    """Colour between `a` (share 0) and `b` (share 1)."""
    red, green, blue = (round(x + (y - x) * share) for x, y in zip(a, b, strict=True))
    return red, green, blue


def tint(colours: Palette, values: NDArray[np.floating], threshold: float) -> NDArray[np.uint8]:
    """(N, 3): colours of joints with these digressions, as the map colours them.

    Parameters
    ----------
    values
        (N,) digression 0..1; NaN where a joint is not analysed.
    threshold
        From which a joint is flagged. Well below it joints are neutral.
    """
    table = lookup_table(colours.theme, threshold)
    known = np.nan_to_num(values, nan=0.0)
    # Up to the threshold the map's colours are those of quiet: take the first loud one instead.
    # Its palest ones, at the top, are too near to a body in full light.
    shown = np.clip(known, threshold, threshold + _VIVID * (1 - threshold))
    packed = table[np.ceil(shown * 255).astype(int)]
    loud = np.stack([packed >> 16 & 255, packed >> 8 & 255, packed & 255], axis=-1)
    share = np.clip((known / max(threshold, 1e-6) - _QUIET) / (1 - _QUIET), 0, 1)[:, None] ** 2
    calm = np.where(np.isnan(values)[:, None], colours.unmapped, colours.body)
    mixed: NDArray[np.uint8] = np.round(calm * (1 - share) + loud * share).astype(np.uint8)
    return mixed
