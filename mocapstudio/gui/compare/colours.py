"""Colours of the comparison: early and late, the sources, and how far joints differ."""

from __future__ import annotations

from PySide6.QtGui import QColor

from mocapstudio.gui.theme import Theme

# Okabe and Ito's vermilion, blue and yellow, set lighter or darker for the ground: told apart by
# the colour-blind, and in grey by their lightness.
_TIMING = {
    "dark": {-1: "#f0603a", 0: "#cdb84a", 1: "#4aa8f0"},
    "light": {-1: "#cc4a12", 0: "#b39a1f", 1: "#0068b0"},
}
_SOURCES = {
    "dark": ("#56b4e9", "#e69f00", "#2fbf94", "#cf8fc0", "#f0e442", "#a08fd6", "#f0803c",
             "#9fd36a"),
    "light": ("#1580c4", "#b87a00", "#00805d", "#9c4f86", "#8f8300", "#6a58b8", "#c04f00",
              "#4f8a1c"),
}  # fmt: skip
_FAR = {"dark": "#ff5a36", "light": "#d03a10"}

TIMING_WORDS = {-1: "delayed", 0: "on time", 1: "hastened"}


def timing(theme: Theme, kind: int) -> QColor:
    """Colour of a frame that gains (1, hastened), loses (-1, delayed) or does neither (0)."""
    return QColor(_TIMING[theme.name][int(kind)])


def source(theme: Theme, number: int) -> str:
    """Colour of the source at that position, as ``#rrggbb``."""
    colours = _SOURCES[theme.name]
    return colours[number % len(colours)]


def far(theme: Theme) -> QColor:
    """Colour of a joint that is as far from its match as joints go."""
    return QColor(_FAR[theme.name])
