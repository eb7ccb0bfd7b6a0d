"""The digression map as a picture: rows by limb, seconds, flags outlined, the threshold."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.topology import topology
from mocapstudio.pictures.style import (
    DARK,
    Palette,
    Picture,
    dress,
    map_colours,
    new_figure,
    to_png,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LEFT, _RIGHT, _TOP, _BOTTOM = 190, 124, 64, 56
_ROOT = "root"


def map_picture(
    analysis: Analysis,
    *,
    known: Sequence[Declared] = (),
    title: str = "",
    size: tuple[int, int] = (1600, 760),
    palette: Palette = DARK,
) -> Picture:
    """Draw the digression map of an analysis with its flags outlined.

    Parameters
    ----------
    analysis
        Map and flags; time runs over the take's trimmed span.
    known
        Rows x spans to mark above the map, such as errors known beforehand.
    title
        What stands above; the take's name where empty.
    size
        Pixels, width and height.
    """
    width, height = size
    figure = new_figure(size, palette)
    inner = (width - _LEFT - _RIGHT, height - _TOP - _BOTTOM)
    axes = figure.add_axes((_LEFT / width, _BOTTOM / height, inner[0] / width, inner[1] / height))
    groups = grouped_rows(analysis.take.skeleton, analysis.map.rows)
    order = [row for _, rows in groups for row in rows]
    start, end = analysis.take.span
    columns = [analysis.map.rows.index(row) for row in order]
    values = pooled(analysis.map.values[start:end, columns].T, max(1, inner[0]))
    span = (analysis.take.seconds(start), analysis.take.seconds(end))
    colours = map_colours(palette, analysis.parameters.threshold)
    image = colours[np.round(values * (len(colours) - 1)).astype(int)]
    axes.imshow(
        image,
        aspect="auto",
        interpolation="nearest",
        extent=(span[0], span[1], len(order) - 0.5, -0.5),
    )
    dress(axes, palette)
    _outline(axes, analysis, order, (span[1] - span[0]) / inner[0], palette)
    _mark_known(axes, analysis, known, palette)
    _name_rows(axes, groups, palette, inner)
    axes.set_xlim(*span)
    axes.set_xlabel("seconds", color=palette.muted, fontsize=10)
    _title(figure, analysis, title, known, palette)
    _colour_bar(figure, size, inner, analysis.parameters.threshold, palette)
    return Picture(to_png(figure))


def grouped_rows(
    skeleton: Skeleton, rows: Sequence[str]
) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """Rows of a map by limb, in the order of display; the root rows come first."""
    wanted = set(rows)
    groups = [(_ROOT, tuple(row for row in rows if row not in skeleton.index))]
    for limb in topology(skeleton).limbs:
        inside = (skeleton.names[joint] for joint in limb.joints)
        groups.append((limb.name, tuple(name for name in inside if name in wanted)))
    return tuple((name, inside) for name, inside in groups if inside)


def pooled(values: NDArray[np.float32], most: int) -> NDArray[np.float32]:
    """Shrink (R, F) to at most `most` columns, each the highest value of its frames."""
    frames = values.shape[1]
    if frames <= most:
        return values
    starts = np.arange(most) * frames // most
    return np.maximum.reduceat(values, starts, axis=1)


def _outline(
    axes: Axes, analysis: Analysis, order: Sequence[str], pixel: float, palette: Palette
) -> None:
    from matplotlib.collections import PatchCollection
    from matplotlib.patches import Rectangle

    at = {row: i for i, row in enumerate(order)}
    boxes = []
    for flag in analysis.flags:
        start, end = analysis.take.seconds(flag.start), analysis.take.seconds(flag.end)
        # A rim of ground sets the outline off, and lets a flag of one frame be seen.
        rim = 3 * pixel
        corner = (start - rim, at[flag.joint] - 0.48)
        boxes.append(Rectangle(corner, end - start + 2 * rim, 0.96))
    axes.add_collection(
        PatchCollection(boxes, facecolor="none", edgecolor=palette.open, linewidth=1.0)
    )


def _mark_known(
    axes: Axes, analysis: Analysis, known: Sequence[Declared], palette: Palette
) -> None:
    spans = sorted({(one.start, one.end) for one in known})
    middles = [analysis.take.seconds((start + end) / 2) for start, end in spans]
    axes.plot(
        middles,
        np.full(len(middles), 1.012),
        transform=axes.get_xaxis_transform(),
        linestyle="none",
        marker="v",
        markersize=6,
        color=palette.truth,
        clip_on=False,
    )


def _name_rows(
    axes: Axes,
    groups: Sequence[tuple[str, tuple[str, ...]]],
    palette: Palette,
    inner: tuple[int, int],
) -> None:
    names = [row for _, rows in groups for row in rows]
    size = float(np.clip(0.62 * inner[1] / len(names), 5.0, 9.5))
    axes.set_yticks(range(len(names)), names, fontsize=size)
    axes.tick_params(axis="y", length=0, pad=5)
    first = 0
    for name, rows in groups:
        if first:
            axes.axhline(first - 0.5, color=palette.border, linewidth=1.2)
        axes.text(
            -(_LEFT - 14) / inner[0],
            1 - (first + len(rows) / 2) / len(names),
            name,
            transform=axes.transAxes,
            color=palette.text,
            fontsize=size + 0.5,
            fontweight="bold",
            va="center",
            rotation=90 if len(rows) > 2 else 0,
        )
        first += len(rows)


def _title(
    figure: Figure, analysis: Analysis, title: str, known: Sequence[Declared], palette: Palette
) -> None:
    width, height = figure.get_size_inches() * figure.dpi
    left, line = _LEFT / width, 1 - 30 / height
    figure.text(
        left, line, title or analysis.take.name, color=palette.text, fontsize=13, fontweight="bold"
    )
    count = len(analysis.flags)
    about = f"digression map · {count} flag{'s' * (count != 1)}"
    if analysis.context:
        about += f" · {len(analysis.context)} takes as context"
    if known:
        about += f" · ▼ {len({(k.start, k.end) for k in known})} known errors"
    right = 1 - _RIGHT / width
    figure.text(right, line, about, color=palette.muted, fontsize=10, ha="right")


def _colour_bar(
    figure: Figure,
    size: tuple[int, int],
    inner: tuple[int, int],
    threshold: float,
    palette: Palette,
) -> None:
    width, height = size
    left = (width - _RIGHT + 26) / width
    bar = figure.add_axes((left, _BOTTOM / height, 14 / width, inner[1] / height))
    colours = map_colours(palette, threshold)
    bar.imshow(colours[::-1, None, :], aspect="auto", extent=(0, 1, 0, 1))
    dress(bar, palette)
    bar.set_xticks([])
    bar.yaxis.tick_right()
    bar.set_yticks([0, threshold, 1], ["0", f"{threshold:.2f}\nthreshold", "1"])
    bar.axhline(threshold, color=palette.text, linewidth=1.2)
