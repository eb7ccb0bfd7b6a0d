"""Curves of a comparison that several pictures draw: pose difference and misalignment by timing."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison.model import Comparison
from mocapstudio.pictures.style import DARK, LIGHT, Palette, dress

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SIGNS = (-1, 0, 1)
_WORDS = ("delayed", "on time", "hastened")
_TIMING = {
    DARK: ("#f2684f", "#f0cd53", "#57a5f7"),
    LIGHT: ("#d0402a", "#c99a00", "#2070d0"),
}
_APART = 112
"""Pixels from one word of the key to the next."""


def timing_colours(palette: Palette) -> tuple[str, str, str]:
    """Colours of delayed, on time and hastened."""
    return _TIMING[LIGHT if palette == LIGHT else DARK]


def colours_of(comparison: Comparison, palette: Palette) -> NDArray[np.str_]:
    """(S,) colour of the timing of each source frame."""
    return np.asarray(np.array(timing_colours(palette))[comparison.timing.astype(int) + 1])


def columns(frames: int, most: int) -> NDArray[np.int64]:
    """First frame of each column of pixels, of which there are at most `most`."""
    count = min(max(most, 1), frames)
    return np.arange(count) * frames // count


def draw_difference(
    axes: Axes, comparison: Comparison, seconds: NDArray[np.float64], palette: Palette
) -> float:
    """Fill the pose difference, coloured by timing.

    Parameters
    ----------
    seconds
        (S,) where the source's frames lie on the horizontal axis, ascending.

    Returns
    -------
    The largest value drawn.
    """
    dress(axes, palette)
    starts = columns(len(seconds), int(axes.get_window_extent().width))
    values = np.add.reduceat(comparison.pose_difference, starts)
    values = values / np.diff(np.append(starts, len(seconds)))
    timing, at = comparison.timing[starts], seconds[starts]
    for sign, colour in zip(_SIGNS, timing_colours(palette), strict=True):
        here = timing == sign
        # A run is drawn up to the next column, so that no gap shows where the colour changes.
        here = here | np.concatenate([[False], here[:-1]])
        axes.fill_between(at, values, where=list(here), color=colour, linewidth=0)
    highest = float(values.max())
    axes.set_ylim(0, max(highest * 1.08, 1e-3))
    axes.locator_params(axis="y", nbins=4)
    return highest


def draw_misalignment(
    axes: Axes, comparison: Comparison, seconds: NDArray[np.float64], palette: Palette
) -> float:
    """Draw how far the source is ahead of the reference or behind it, coloured by timing.

    Parameters
    ----------
    seconds
        (S,) where the source's frames lie on the horizontal axis, ascending.

    Returns
    -------
    The largest misalignment drawn, in seconds, either way.
    """
    from matplotlib.collections import LineCollection

    dress(axes, palette)
    gap = comparison.misalignment if comparison.true_speed else comparison.misalignment_relative
    axes.axhline(0.0, color=palette.border, linewidth=1.0)
    points = np.stack([seconds, gap], axis=1)
    pieces = np.stack([points[:-1], points[1:]], axis=1)
    colours = list(colours_of(comparison, palette)[:-1])
    axes.add_collection(LineCollection(list(pieces), colors=colours, linewidths=2.0))
    most = float(np.abs(gap).max())
    reach = max(most * 1.12, 0.05)
    axes.set_ylim(-reach, reach)
    for y, word in ((0.96, "ahead"), (0.04, "behind")):
        axes.text(
            0.005, y, word, transform=axes.transAxes, ha="left", va="top" if y > 0.5 else "bottom",
            color=palette.muted, fontsize=9,
        )  # fmt: skip
    return most


def draw_timing_key(
    figure: Figure, timing: NDArray[np.int8], at: tuple[float, float], palette: Palette
) -> None:
    """Say what the colours mean, and what share of frames each has.

    Parameters
    ----------
    at
        Where it begins, in shares of the figure.
    """
    width, x = figure.get_window_extent().width, at[0]
    for sign, word, colour in zip(_SIGNS, _WORDS, timing_colours(palette), strict=True):
        figure.text(x, at[1], "■", color=colour, fontsize=11)
        text = f"{word} {np.mean(timing == sign):.0%}"
        figure.text(x + 16 / width, at[1], text, color=palette.muted, fontsize=9)
        x += _APART / width
