"""Several performances compared with one reference, one row each, the most alike first.

Over the time of the reference, so that rows can be read against one another: pose difference
coloured by timing on the left, misalignment on the right, at scales that all rows share.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mocapstudio.comparison.model import Comparison
from mocapstudio.pictures.comparison_curves import (
    draw_difference,
    draw_misalignment,
    draw_timing_key,
)
from mocapstudio.pictures.style import DARK, Palette, Picture, new_figure, to_png, to_svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LEFT, _MIDDLE, _RIGHT, _TOP, _BOTTOM, _GAP = 290, 84, 28, 92, 56, 18
_DIFFERENCE = 0.58
"""Share of the width that the pose difference takes."""
_ROW = 118
_LONGEST_NAME = 26


def ranking_picture(
    comparisons: Sequence[Comparison],
    *,
    width: int = 1600,
    palette: Palette = DARK,
    svg: bool = False,
) -> Picture:
    """Draw comparisons with one reference below one another, the most alike first.

    Parameters
    ----------
    comparisons
        One or more, of the same reference.
    width
        Pixels; the height follows from the number of rows.
    svg
        Draw as SVG instead of PNG.
    """
    ranked = sorted(comparisons, key=lambda one: one.dissimilarity)
    size = width, _TOP + _BOTTOM + _ROW * len(ranked) + _GAP * (len(ranked) - 1)
    figure = new_figure(size, palette)
    rows = [_axes(figure, size, row) for row in range(len(ranked))]
    highest, furthest = 1e-3, 0.05
    for (left, right), one in zip(rows, ranked, strict=True):
        seconds = one.warp / float(one.reference_rate)
        highest = max(highest, 1.08 * draw_difference(left, one, seconds, palette))
        furthest = max(furthest, 1.12 * draw_misalignment(right, one, seconds, palette))
    for left, right in rows:
        left.set_ylim(0, highest)
        right.set_ylim(-furthest, furthest)
    first = ranked[0]
    end = max((len(first.reference_poses) - 1) / float(first.reference_rate), 1e-6)
    _finish(rows, end, palette)
    for row, one in enumerate(ranked):
        _name(figure, size, row, one, palette)
    _title(figure, size, ranked, palette)
    return Picture(to_svg(figure) if svg else to_png(figure))


def _axes(figure: Figure, size: tuple[int, int], row: int) -> tuple[Axes, Axes]:
    width, height = size
    inner = width - _LEFT - _MIDDLE - _RIGHT
    bottom = height - _TOP - _ROW - row * (_ROW + _GAP)
    wide = _DIFFERENCE * inner
    places = ((_LEFT, wide), (_LEFT + wide + _MIDDLE, inner - wide))
    left, right = (
        figure.add_axes((x / width, bottom / height, w / width, _ROW / height)) for x, w in places
    )
    return left, right


def _finish(rows: Sequence[tuple[Axes, Axes]], end: float, palette: Palette) -> None:
    for at, row in enumerate(rows):
        last = at == len(rows) - 1
        for axes in row:
            axes.set_xlim(0, end)
            axes.tick_params(labelbottom=last, bottom=last)
            if last:
                axes.set_xlabel("seconds of the reference", color=palette.muted, fontsize=10)


def _name(
    figure: Figure, size: tuple[int, int], row: int, one: Comparison, palette: Palette
) -> None:
    width, height = size
    middle = height - _TOP - row * (_ROW + _GAP) - _ROW / 2
    name = one.source if len(one.source) <= _LONGEST_NAME else f"…{one.source[1 - _LONGEST_NAME :]}"
    shares = [f"{np.mean(one.timing == s):.0%} {w}" for s, w in ((-1, "delayed"), (1, "hastened"))]
    lines = (
        (18, f"{row + 1}  {name}", palette.text, "bold"),
        (0, f"dissimilarity {one.dissimilarity:.3f} · doubt {one.doubt:.0%}", palette.muted, None),
        (-17, " · ".join(shares), palette.muted, None),
    )
    for up, text, colour, weight in lines:
        figure.text(
            18 / width, (middle + up) / height, text, color=colour, fontsize=9,
            fontweight=weight or "normal", va="center",
        )  # fmt: skip


def _title(
    figure: Figure, size: tuple[int, int], ranked: Sequence[Comparison], palette: Palette
) -> None:
    width, height = size
    first = ranked[0]
    line, below = 1 - 30 / height, 1 - 76 / height
    many = f"{len(ranked)} performances compared with {first.reference}"
    figure.text(18 / width, line, many, color=palette.text, fontsize=13, fontweight="bold")
    unit = "radians" if first.features == "rotations" else "of the unit box"
    inner = width - _LEFT - _MIDDLE - _RIGHT
    heads = (
        (_LEFT, f"pose difference, {unit}"),
        (_LEFT + _DIFFERENCE * inner + _MIDDLE, "misalignment, seconds"),
    )
    for x, text in heads:
        if not first.true_speed and "misalignment" in text:
            text += " (tempo apart)"
        figure.text(x / width, below, text, color=palette.muted, fontsize=10)
    timing = np.concatenate([one.timing for one in ranked])
    draw_timing_key(figure, timing, (1 - (_RIGHT + 330) / width, line), palette)
