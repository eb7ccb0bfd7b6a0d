"""The three linked pictures of paper 4: pose difference, misalignment, heat maps with timing lines.

Above one another over the time of the source: how far its pose is from the matched one, coloured
by whether it hastens, delays or keeps time; by how much it is ahead or behind; and the heat maps
of source and reference, where red, green and blue are x, y and z, joined by lines of equal pose.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison.model import Comparison
from mocapstudio.comparison.segments import CarriedSegment
from mocapstudio.pictures.comparison_curves import (
    colours_of,
    columns,
    draw_difference,
    draw_misalignment,
    draw_timing_key,
)
from mocapstudio.pictures.style import DARK, Palette, Picture, dress, new_figure, to_png, to_svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from mocapstudio.comparison.model import Segment

_LEFT, _RIGHT, _TOP, _BOTTOM, _GAP = 176, 24, 72, 52, 22
_SHARES = (1.5, 1.5, 2.4, 0.8, 2.4)
"""Heights of pose difference, misalignment, source map, timing lines, reference map."""

_LINES = 110


@dataclass(frozen=True, eq=False)
class _Times:
    """Where frames lie on the horizontal axis, in seconds."""

    source: NDArray[np.float64]
    reference: NDArray[np.float64]
    matched: NDArray[np.float64]
    span: tuple[float, float]
    labels: tuple[str, str]


def comparison_picture(
    comparison: Comparison,
    segments: Sequence[CarriedSegment] = (),
    *,
    title: str = "",
    size: tuple[int, int] = (1600, 1000),
    palette: Palette = DARK,
    svg: bool = False,
) -> Picture:
    """Draw a comparison.

    Parameters
    ----------
    segments
        Segments to mark on both maps.
    title
        What stands above; the names of both takes where empty.
    size
        Pixels, width and height.
    svg
        Draw as SVG instead of PNG.
    """
    figure = new_figure(size, palette)
    axes = _axes(figure, size)
    times = _times(comparison)
    draw_difference(axes[0], comparison, times.source, palette)
    unit = "radians" if comparison.features == "rotations" else "of the unit box"
    _name(axes[0], "pose difference", unit, palette)
    draw_misalignment(axes[1], comparison, times.source, palette)
    kind = "seconds" if comparison.true_speed else "s, tempo apart"
    _name(axes[1], "misalignment", kind, palette)
    width = size[0] - _LEFT - _RIGHT
    for one, poses, label, at in (
        (axes[2], comparison.source_poses, "source", times.source),
        (axes[4], comparison.reference_poses, "reference", times.reference),
    ):
        _heat_map(one, poses, at, width)
        _name_rows(one, comparison, label, palette, size)
    _timing_lines(axes[3], times, colours_of(comparison, palette), palette)
    _mark_segments(axes, segments, times, palette)
    for one in axes:
        one.set_xlim(*times.span)
    for one in axes[:4]:
        one.tick_params(labelbottom=False, bottom=False)
    axes[4].set_xlabel(times.labels[0], color=palette.muted, fontsize=10)
    _title(figure, comparison, title, palette, size)
    return Picture(to_svg(figure) if svg else to_png(figure))


def _axes(figure: Figure, size: tuple[int, int]) -> list[Axes]:
    width, height = size
    inner = height - _TOP - _BOTTOM - 2 * _GAP
    top, made = float(height - _TOP), []
    for i, share in enumerate(_SHARES):
        tall = inner * share / sum(_SHARES)
        rect = (
            _LEFT / width,
            (top - tall) / height,
            (width - _LEFT - _RIGHT) / width,
            tall / height,
        )
        made.append(figure.add_axes(rect))
        top -= tall + (_GAP if i < 2 else 0)
    return made


def _times(comparison: Comparison) -> _Times:
    rates = float(comparison.reference_rate), float(comparison.source_rate)
    source = np.arange(len(comparison.warp)) / rates[1]
    reference = np.arange(len(comparison.reference_poses)) / rates[0]
    matched = comparison.warp / rates[0]
    if comparison.true_speed:
        longest = max(source[-1], reference[-1], 1e-6)
        return _Times(source, reference, matched, (0.0, float(longest)), ("seconds", "seconds"))
    stretch = max(source[-1], 1e-6) / max(reference[-1], 1e-6)
    label = "seconds of the source; the reference is stretched to equal length"
    span = (0.0, max(float(source[-1]), 1e-6))
    return _Times(source, reference * stretch, matched * stretch, span, (label, ""))


def _heat_map(axes: Axes, poses: NDArray[np.float32], at: NDArray[np.float64], most: int) -> None:
    frames = len(poses)
    starts = columns(frames, most)
    counts = np.diff(np.append(starts, frames))[:, None, None]
    image = np.add.reduceat(poses, starts, axis=0) / counts
    half = max(0.5 * (at[-1] / max(frames - 1, 1)), 1e-3)
    axes.imshow(
        np.clip(image, 0, 1).transpose(1, 0, 2),
        aspect="auto",
        interpolation="nearest",
        extent=(-half, float(at[-1]) + half, poses.shape[1] - 0.5, -0.5),
    )


def _timing_lines(axes: Axes, times: _Times, colours: NDArray[np.str_], palette: Palette) -> None:
    from matplotlib.collections import LineCollection

    dress(axes, palette)
    axes.set_facecolor(palette.background)
    frames = np.unique(np.linspace(0, len(times.source) - 1, _LINES).astype(int))
    lines = [[(times.source[n], 1.0), (times.matched[n], 0.0)] for n in frames]
    axes.add_collection(LineCollection(lines, colors=list(colours[frames]), linewidths=0.9))
    axes.set_ylim(0, 1)
    axes.set_yticks([])
    axes.set_xticks([])
    for side in axes.spines.values():
        side.set_visible(False)


def _name(axes: Axes, what: str, unit: str, palette: Palette) -> None:
    x = -41 / axes.get_window_extent().width
    axes.text(
        x, 0.5, what, transform=axes.transAxes, ha="right", va="bottom",
        color=palette.text, fontsize=10.5, fontweight="bold",
    )  # fmt: skip
    axes.text(
        x, 0.48, unit, transform=axes.transAxes, ha="right", va="top",
        color=palette.muted, fontsize=9,
    )  # fmt: skip


def _name_rows(
    axes: Axes, comparison: Comparison, what: str, palette: Palette, size: tuple[int, int]
) -> None:
    dress(axes, palette)
    axes.set_facecolor(palette.background)
    count = len(comparison.rows)
    names = [row.split(":")[-1] for row in comparison.rows]
    tall = axes.get_position().height * size[1]
    letters = float(np.clip(0.6 * tall / count, 0.0, 8.5))
    inner = size[0] - _LEFT - _RIGHT
    if letters >= 4.5:
        axes.set_yticks(range(count), names, fontsize=letters)
        axes.tick_params(axis="y", length=0, pad=4)
    else:
        axes.set_yticks([])
    limbs = list(dict.fromkeys(comparison.limbs))
    for limb in limbs:
        inside = [i for i, one in enumerate(comparison.limbs) if one == limb]
        if inside[0]:
            axes.axhline(inside[0] - 0.5, color=palette.background, linewidth=1.4)
        axes.text(
            -(_LEFT - 52) / inner, 1 - (float(np.mean(inside)) + 0.5) / count, limb,
            transform=axes.transAxes, color=palette.muted, fontsize=8.5, va="center", ha="center",
        )  # fmt: skip
    axes.text(
        -(_LEFT - 10) / inner, 0.5, what, transform=axes.transAxes, color=palette.text,
        fontsize=10.5, fontweight="bold", rotation=90, va="center", ha="center",
    )  # fmt: skip


def _mark_segments(
    axes: Sequence[Axes], segments: Sequence[CarriedSegment], times: _Times, palette: Palette
) -> None:
    room = axes[2].get_window_extent().width / max(times.span[1], 1e-9)
    for one in segments:
        _edges((axes[0], axes[1], axes[2]), one.source, times.source, palette)
        _edges((axes[4],), one.reference, times.reference, palette)
        start, end = (_at(times.source, f) for f in (one.source.start, one.source.end))
        if (end - start) * room > 6.2 * len(one.source.name):
            axes[0].text(
                (start + end) / 2, 1.03, one.source.name, transform=axes[0].get_xaxis_transform(),
                color=palette.muted, fontsize=8, ha="center", va="bottom",
            )  # fmt: skip


def _edges(
    axes: Sequence[Axes], segment: Segment, at: NDArray[np.float64], palette: Palette
) -> None:
    for frame in (segment.start, segment.end):
        for one in axes:
            one.axvline(_at(at, frame), color=palette.text, linewidth=0.6, alpha=0.3)


def _at(times: NDArray[np.float64], frame: int) -> float:
    return float(times[min(frame, len(times) - 1)])


def _title(
    figure: Figure, comparison: Comparison, title: str, palette: Palette, size: tuple[int, int]
) -> None:
    width, height = size
    line = 1 - 26 / height
    name = title or f"{comparison.source} compared with {comparison.reference}"
    figure.text(_LEFT / width, line, name, color=palette.text, fontsize=13, fontweight="bold")
    about = f"dissimilarity {comparison.dissimilarity:.3f}"
    about += f" · doubt {comparison.doubt:.0%}"
    figure.text(1 - _RIGHT / width, line, about, color=palette.muted, fontsize=10, ha="right")
    draw_timing_key(
        figure, comparison.timing, (1 - (_RIGHT + 330) / width, line - 22 / height), palette
    )
