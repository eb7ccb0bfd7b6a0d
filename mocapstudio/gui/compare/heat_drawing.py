"""How the plot of colours is painted: poses, lines between what matches, segments."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QImage, QPainter, QPen

from mocapstudio.comparison.model import Comparison
from mocapstudio.gui import theme as themes
from mocapstudio.gui.compare import colours as kinds
from mocapstudio.gui.compare.heat_layout import Bands
from mocapstudio.gui.compare.layout import Stretch, timing_lines
from mocapstudio.gui.compare.pooling import PooledPoses
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.axes import small_font
from mocapstudio.gui.plots.pooling import block_length
from mocapstudio.gui.plots.rows import RowLayout


@dataclass(frozen=True)
class Scale:
    """Frames of one performance laid over a stretch of pixels."""

    left: float
    width: float
    stretch: Stretch

    @property
    def per_frame(self) -> float:
        """Pixels a frame."""
        return self.width / max(self.stretch.length, 1e-9)

    def x(self, frame: float) -> float:
        """Pixel of a frame."""
        return self.left + (frame - self.stretch.start) * self.per_frame

    def frame(self, x: float) -> float:
        """Frame at a pixel, not rounded."""
        return self.stretch.start + (x - self.left) / self.per_frame


def draw_poses(p: QPainter, band: QRectF, at: Scale, rows: RowLayout, pooled: PooledPoses) -> None:
    """Draw one performance: a column a block of frames, each limb in one piece."""
    step = block_length(1.0 / at.per_frame)
    blocks = pooled.blocks(step)
    first = max(int((at.stretch.start + 0.5) // step), 0)
    last = min(int((at.stretch.end + 0.5) // step) + 1, blocks.shape[1])
    if last <= first or not rows.names:
        return
    pixels = np.ascontiguousarray(blocks[:, first:last])
    left = at.x(first * step - 0.5)
    width = (min(last * step, pooled.frames) - first * step) * at.per_frame
    # The last block of a take may be shorter than the others.
    full = (last - first) * step * at.per_frame
    p.save()
    p.setClipRect(QRectF(left, band.top(), width, band.height()).intersected(band))
    for group in rows.groups:
        one, other = rows.index[group.rows[0]], rows.index[group.rows[-1]]
        part = pixels[one : other + 1]
        image = QImage(
            part.data, part.shape[1], part.shape[0], part.strides[0],
            QImage.Format.Format_ARGB32_Premultiplied,
        )  # fmt: skip
        top, bottom = rows.extent(group)
        p.drawImage(QRectF(left, band.top() + top, full, bottom - top), image)
    p.restore()


def draw_row(p: QPainter, band: QRectF, rows: RowLayout, row: str | None) -> None:
    """Frame the selected row."""
    if row is None or row not in rows.index:
        return
    top = band.top() + float(rows.tops[rows.index[row]])
    p.setPen(QPen(QColor(themes.current().playhead), 1))
    p.setBrush(Qt.BrushStyle.NoBrush)
    p.drawRect(QRectF(band.left(), top - 0.5, band.width(), rows.row_height))


def draw_timing(
    p: QPainter, bands: Bands, source: Scale, reference: Scale, comparison: Comparison
) -> None:
    """Join what matches by lines, coloured by timing."""
    look, band = themes.current(), bands.between
    pairs = timing_lines(comparison, source.stretch.start, source.stretch.end, source.width)
    if not len(pairs):
        return
    timing = comparison.timing[pairs[:, 0]]
    above = source.left + (pairs[:, 0] - source.stretch.start) * source.per_frame
    below = reference.left + (pairs[:, 1] - reference.stretch.start) * reference.per_frame
    p.setRenderHint(QPainter.RenderHint.Antialiasing)
    for kind in (0, 1, -1):
        lines = [
            QLineF(above[k], band.top(), below[k], band.bottom())
            for k in np.flatnonzero(timing == kind)
        ]
        p.setPen(QPen(colours.faded(kinds.timing(look, kind), 0.55 if kind == 0 else 0.9), 1.1))
        p.drawLines(lines)
    p.setRenderHint(QPainter.RenderHint.Antialiasing, False)


def draw_segments(
    p: QPainter,
    lane: QRectF,
    at: Scale,
    spans: Sequence[tuple[str, int, int]],
    selected: int | None,
) -> None:
    """Draw named spans in a lane, with as much of each name as there is room for."""
    look = themes.current()
    p.fillRect(lane, colours.mixed(look.field, look.border, 0.4))
    p.setFont(small_font(10))
    metrics = QFontMetricsF(small_font(10))
    for number, (name, start, end) in enumerate(spans):
        left, right = at.x(start - 0.5), at.x(end - 0.5)
        box = QRectF(left, lane.top() + 1, max(right - left, 2.0), lane.height() - 2)
        box = box.intersected(lane.adjusted(-4, 0, 4, 0))
        if box.isEmpty():
            continue
        chosen = number == selected
        ground = QColor(look.accent if chosen else look.selection)
        p.setPen(QPen(QColor(look.accent), 1))
        p.setBrush(colours.faded(ground, 0.9 if chosen else 0.8))
        p.drawRect(box.adjusted(0.5, 0.5, -0.5, -0.5))
        room = box.intersected(lane).adjusted(4, 0, -3, 0)
        text = metrics.elidedText(name, Qt.TextElideMode.ElideRight, room.width())
        if len(text) > 1:
            p.setPen(QColor(look.accent_text if chosen else look.text))
            flags = int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
            p.drawText(room, flags, text)
    p.setBrush(Qt.BrushStyle.NoBrush)


def draw_edges(
    p: QPainter, bands: Bands, source: Scale, reference: Scale, edges: Sequence[tuple[int, int]]
) -> None:
    """Draw where segments begin and end through both performances."""
    p.setPen(QPen(colours.faded(themes.current().playhead, 0.4), 1))
    for own, other in edges:
        above, below = source.x(own - 0.5), reference.x(other - 0.5)
        top, bottom = bands.source.bottom(), bands.reference.top()
        p.drawLine(QPointF(above, bands.source.top()), QPointF(above, top))
        p.drawLine(QPointF(above, top), QPointF(below, bottom))
        p.drawLine(QPointF(below, bottom), QPointF(below, bands.reference.bottom()))
