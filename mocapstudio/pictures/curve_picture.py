"""The motion of one row over time, before and after, as a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION, hips_world, split_heading
from mocapstudio.motion.take import Take
from mocapstudio.pictures.style import DARK, Palette, Picture, dress, new_figure, to_png

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

_CONTEXT_SECONDS = 1.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 70, 20, 56, 48
"""Margins in pixels."""


def curve_picture(
    before: Take,
    after: Take,
    row: str,
    span: tuple[int, int],
    *,
    title: str = "",
    size: tuple[int, int] = (1280, 560),
    palette: Palette = DARK,
) -> Picture:
    """Draw a joint's rotation, or a root row, around a span.

    Parameters
    ----------
    before, after
        The take as it is, and as changed; both of the same frames.
    row
        Joint (rotation vector in degrees, against the first frame shown), `root position`
        (centimetres, against the first frame shown) or `root heading` (degrees).
    span
        Half-open span of frames that is in question; it is shaded, a second on either side shown.
    size
        Pixels, width and height.
    """
    around = round(_CONTEXT_SECONDS * float(before.rate))
    start, end = max(0, span[0] - around), min(before.frames, span[1] + around)
    old, new, names, unit = _curves(before, after, row, start, end)
    seconds = np.arange(start, end) / float(before.rate)
    figure = new_figure(size, palette)
    panes = _panes(figure, size, len(names), palette)
    for i, (axes, name) in enumerate(zip(panes, names, strict=True)):
        axes.axvspan(
            before.seconds(span[0]), before.seconds(span[1]), color=palette.open, alpha=0.12, lw=0
        )
        axes.plot(seconds, old[:, i], color=palette.wrong, linewidth=1.6, label="before")
        axes.plot(seconds, new[:, i], color=palette.proposal, linewidth=1.9, label="after")
        axes.set_xlim(seconds[0], seconds[-1])
        axes.margins(y=0.12)
        axes.set_ylabel(f"{name}  {unit}", color=palette.muted, fontsize=9)
        axes.grid(visible=True, color=palette.border, linewidth=0.5)
        axes.set_axisbelow(True)
    for axes in panes[:-1]:
        axes.set_xticklabels([])
    panes[-1].set_xlabel("seconds", color=palette.muted, fontsize=10)
    _headline(figure, size, title or row, palette)
    return Picture(to_png(figure))


def _panes(figure: Figure, size: tuple[int, int], count: int, palette: Palette) -> list[Axes]:
    """Return axes one below the other, which leave room for the headline."""
    width, height = size
    pane = (height - _TOP - _BOTTOM) / count
    panes = []
    for i in range(count):
        below = _BOTTOM + pane * (count - 1 - i)
        axes = figure.add_axes(
            (
                _LEFT / width,
                (below + 5) / height,
                (width - _LEFT - _RIGHT) / width,
                (pane - 10) / height,
            )
        )
        dress(axes, palette)
        panes.append(axes)
    return panes


def _headline(figure: Figure, size: tuple[int, int], title: str, palette: Palette) -> None:
    width, line = size[0], 1 - 34 / size[1]
    figure.text(_LEFT / width, line, title, color=palette.text, fontsize=13)
    for text, colour, place in (("before", palette.wrong, 80), ("after", palette.proposal, _RIGHT)):
        figure.text(1 - place / width, line, text, color=colour, fontsize=11, ha="right")


def _curves(
    before: Take, after: Take, row: str, start: int, end: int
) -> tuple[Array, Array, tuple[str, ...], str]:
    """(n, C) values before and after, the names of the C curves, and their unit."""
    if row == ROOT_POSITION:
        first = hips_world(before, start, start + 1)[0]
        old, new = (100 * (hips_world(take, start, end)[0] - first) for take in (before, after))
        return old, new, ("x", "y", "z"), "cm"
    if row == ROOT_HEADING:
        both = [np.rad2deg(split_heading(take, start, end)[0])[:, None] for take in (before, after)]
        return both[0], both[1], ("heading",), "°"
    joint = before.skeleton.index[row]
    against = rot.conjugate(before.rotations[start, joint])
    old, new = (
        np.rad2deg(rot.to_rotation_vector(rot.multiply(against, take.rotations[start:end, joint])))
        for take in (before, after)
    )
    return old, new, ("x", "y", "z"), "°"
