"""What all pictures share: colours, type, and the way from a figure to a file."""

from __future__ import annotations

import io
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_DPI = 100


@dataclass(frozen=True)
class Palette:
    """Colours as ``#rrggbb``, told apart by the colour-blind; the desk's themes have them too.

    `quiet` is the map's colour just below the threshold; `loud` is the part of the perceptual map
    `colormap` that is used above it.
    """

    background: str
    field: str
    border: str
    text: str
    muted: str
    floor: str
    body: str
    wrong: str
    proposal: str
    open: str
    truth: str
    quiet: str
    colormap: str
    loud: tuple[float, float]


DARK = Palette(
    background="#15171b",
    field="#121418",
    border="#30353f",
    text="#e4e7ec",
    muted="#99a1ae",
    floor="#363c47",
    body="#cfd4dc",
    wrong="#f0803c",
    proposal="#5cb8f0",
    open="#f2cf4a",
    truth="#2fbf94",
    quiet="#5a1a6b",
    colormap="inferno",
    loud=(0.58, 0.98),
)

LIGHT = Palette(
    background="#f6f7f9",
    field="#ffffff",
    border="#cdd2da",
    text="#1b1f26",
    muted="#59616e",
    floor="#b4bbc6",
    body="#5c6573",
    wrong="#c04f00",
    proposal="#1580c4",
    open="#a37800",
    truth="#00805d",
    quiet="#c3cde3",
    colormap="viridis_r",
    loud=(0.40, 1.0),
)


@dataclass(frozen=True)
class Picture:
    """A finished picture.

    Parameters
    ----------
    png
        The bytes of the file.
    note
        What the user should know about how it was made, or None.
    """

    png: bytes
    note: str | None = None

    def save(self, path: Path) -> None:
        """Write the file whole or not at all.

        Raises
        ------
        FileError
            If it cannot be written.
        """
        # The desk takes its colours from here, long before it writes anything.
        from mocapstudio.formats.atomic import write_whole

        write_whole(path, [self.png])


def new_figure(size: tuple[int, int], palette: Palette) -> Figure:
    """Make an empty figure of `size` pixels that belongs to no window."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(size[0] / _DPI, size[1] / _DPI), dpi=_DPI)
    FigureCanvasAgg(figure)
    figure.set_facecolor(palette.background)
    return figure


def to_png(figure: Figure) -> bytes:
    """Draw a figure into the bytes of a PNG file, at its own size."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", facecolor=figure.get_facecolor())
    return buffer.getvalue()


def to_svg(figure: Figure) -> bytes:
    """Draw a figure into the bytes of an SVG file; text stays text, equal pictures equal files."""
    from matplotlib import rc_context

    buffer = io.BytesIO()
    with rc_context({"svg.fonttype": "none", "svg.hashsalt": "mocapstudio"}):
        figure.savefig(
            buffer, format="svg", facecolor=figure.get_facecolor(), metadata={"Date": None}
        )
    return buffer.getvalue()


def dress(axes: Axes, palette: Palette) -> None:
    """Give axes the palette's colours, without a box."""
    axes.set_facecolor(palette.field)
    for side in axes.spines.values():
        side.set_color(palette.border)
    axes.tick_params(colors=palette.muted, labelsize=9, length=3)


def rgb(colour: str) -> NDArray[np.float64]:
    """(3,) 0..1 of ``#rrggbb``."""
    return np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0


def map_colours(palette: Palette, threshold: float, levels: int = 256) -> NDArray[np.float64]:
    """(levels, 3) colours 0..1 of digression 0..1, with a visible step at the threshold."""
    from matplotlib import colormaps

    value = np.arange(levels) / (levels - 1)
    first, last = palette.loud
    shown = first + (last - first) * (value - threshold) / max(1.0 - threshold, 1e-6)
    above = colormaps[palette.colormap](np.clip(shown, 0.0, 1.0))[:, :3]
    share = np.clip(value / max(threshold, 1e-6), 0.0, 1.0)[:, None]
    field = rgb(palette.field)
    below = field + (rgb(palette.quiet) - field) * share
    return np.where((value >= threshold)[:, None], above, below)
