"""How the digression map is painted: cells, what is protected, edited, left out, flagged."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QColor, QImage, QPainter, QPainterPath, QPen

from mocapstudio.cleaning.model import Flag
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.pooling import PooledMap, block_length
from mocapstudio.gui.plots.rows import RowLayout
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.gui.theme import Theme
from mocapstudio.review.model import Edit, Protected, QueueItem, Verdict

BAND_HEIGHT = 7
"""Pixels of the provenance band under the rows."""

BAND_ROOM = BAND_HEIGHT + 4
"""Pixels that the band and the gap above it take."""

_NARROWEST = 3.0
_DASHES = {
    Verdict.OPEN: Qt.PenStyle.SolidLine,
    Verdict.ACCEPTED: Qt.PenStyle.SolidLine,
    Verdict.REJECTED: Qt.PenStyle.DotLine,
    Verdict.DEFERRED: Qt.PenStyle.DashLine,
}

# What is settled steps back, so that what is left to decide stands out.
_SETTLED = (Verdict.ACCEPTED, Verdict.REJECTED)


@dataclass(frozen=True)
class Frame:
    """Where frames and rows lie on the screen.

    Parameters
    ----------
    area
        The plot, pixels.
    time
        The visible frames.
    rows
        The rows, from the area's upper edge down.
    theme
        Colours.
    """

    area: QRectF
    time: TimeRange
    rows: RowLayout
    theme: Theme

    @property
    def per_frame(self) -> float:
        """Pixels a frame."""
        return self.area.width() / self.time.length

    def x(self, frame: float) -> float:
        """Pixel of a frame."""
        return self.area.left() + (frame - self.time.start) * self.per_frame

    def y(self, row: str) -> float:
        """Upper edge of a row."""
        return self.area.top() + float(self.rows.tops[self.rows.index[row]])

    def stretch(self, start: int, end: int, narrowest: float = 1.0) -> tuple[float, float] | None:
        """Left edge and width of a half-open span, or None where it is out of sight."""
        left, right = self.x(start - 0.5), self.x(end - 0.5)
        if right < self.area.left() or left > self.area.right():
            return None
        left, right = max(left, self.area.left() - 8), min(right, self.area.right() + 8)
        spare = max(narrowest - (right - left), 0.0)
        return left - 0.5 * spare, right - left + spare

    def cell(self, row: str, start: int, end: int, narrowest: float = 1.0) -> QRectF | None:
        """Rectangle of a row over a span, or None where it is not shown."""
        across = self.stretch(start, end, narrowest)
        if across is None or row not in self.rows.index:
            return None
        return QRectF(across[0], self.y(row), across[1], self.rows.row_height)

    def band(self) -> QRectF:
        """Rectangle of the provenance band."""
        return QRectF(
            self.area.left(), self.area.bottom() - BAND_HEIGHT, self.area.width(), BAND_HEIGHT
        )


def draw_cells(p: QPainter, at: Frame, pooled: PooledMap, table: NDArray[np.uint32]) -> None:
    """Draw the values of the map: one column a block of frames, each limb in one piece."""
    step = block_length(1.0 / at.per_frame)
    blocks = pooled.blocks(step)
    first = max(int((at.time.start + 0.5) // step), 0)
    last = min(int((at.time.end + 0.5) // step) + 1, blocks.shape[1])
    if last <= first or not at.rows.names:
        return
    pixels = np.ascontiguousarray(table[blocks[:, first:last]])
    left = at.x(first * step - 0.5)
    width = (min(last * step, pooled.frames) - first * step) * at.per_frame
    # The last block of a take may be shorter than the others.
    full = (last - first) * step * at.per_frame
    draw_limbs(p, at, pixels, left, width, full)


def draw_limbs(
    p: QPainter, at: Frame, pixels: NDArray[np.uint32], left: float, shown: float, full: float
) -> None:
    """Draw a picture of all rows, each limb in one piece.

    Parameters
    ----------
    pixels
        (R, N) colours, one a row and block of frames; contiguous.
    left, shown, full
        Where the first block begins, how much of the picture is seen, and how wide all blocks are.
    """
    p.save()
    p.setClipRect(QRectF(left, at.area.top(), shown, at.area.height()).intersected(at.area))
    for group in at.rows.groups:
        one, other = at.rows.index[group.rows[0]], at.rows.index[group.rows[-1]]
        part = pixels[one : other + 1]
        image = QImage(
            part.data, part.shape[1], part.shape[0], part.strides[0], QImage.Format.Format_RGB32
        )
        top, bottom = at.rows.extent(group)
        p.drawImage(QRectF(left, at.area.top() + top, full, bottom - top), image)
    p.restore()


def draw_ground(p: QPainter, at: Frame) -> None:
    """Draw the lane of the provenance band and, where rows are high enough, lines between them."""
    p.fillRect(at.band(), colours.mixed(at.theme.field, at.theme.border, 0.45))


def draw_row_lines(p: QPainter, at: Frame) -> None:
    """Part the rows by a line of the plot's ground, where they are high enough for one."""
    if at.rows.row_height < 6:
        return
    p.setPen(QPen(QColor(at.theme.field), 1))
    for top in at.rows.tops:
        y = at.area.top() + float(top) + at.rows.row_height - 0.5
        p.drawLine(QPointF(at.area.left(), y), QPointF(at.area.right(), y))


def draw_protected(p: QPainter, at: Frame, spans: Iterable[Protected]) -> None:
    """Hatch what nothing may change."""
    line = QColor(at.theme.protected)
    p.setPen(QPen(line, 1))
    p.setBrush(QBrush(line, Qt.BrushStyle.BDiagPattern))
    for one in spans:
        across = at.stretch(one.start, one.end, _NARROWEST)
        if across is None:
            continue
        for top, bottom in at.rows.runs(one.joints or at.rows.names):
            p.drawRect(QRectF(across[0], at.area.top() + top, across[1], bottom - top - 1))
    p.setBrush(Qt.BrushStyle.NoBrush)


def draw_edits(p: QPainter, at: Frame, edits: Iterable[Edit]) -> None:
    """Mark edited spans: under each edited row, and all together in the provenance band."""
    band = at.band()
    for one in edits:
        colour = colours.method(at.theme, one.method)
        across = at.stretch(one.start, one.end, 2.0)
        if across is None:
            continue
        lane = QRectF(across[0], band.top(), across[1], band.height())
        if one.muted:
            p.setPen(QPen(colour, 1))
            p.drawRect(lane.adjusted(0.5, 0.5, -0.5, -0.5))
            continue
        p.fillRect(lane, colour)
        for row in one.rows:
            cell = at.cell(row, one.start, one.end, 2.0)
            if cell is not None and cell.height() >= 4:
                p.fillRect(QRectF(cell.left(), cell.bottom() - 2, cell.width(), 2), colour)


def flag_cell(at: Frame, flag: Flag) -> QRectF | None:
    """Rectangle of a flag's outline, never too narrow to be seen or hit."""
    cell = at.cell(flag.joint, flag.start, flag.end, _NARROWEST)
    # In thin rows the outline stays off the cells, or nothing of them would be left to see.
    off = 0.5 if at.rows.row_height >= 7 else 1.5
    return None if cell is None else cell.adjusted(-off, -off, off, off - 1.0)


def draw_flags(p: QPainter, at: Frame, queue: Iterable[QueueItem]) -> None:
    """Outline every flag in the colour of its verdict: one path for each verdict."""
    paths: dict[Verdict, QPainterPath] = {}
    gone = QPainterPath()
    for item in queue:
        cell = flag_cell(at, item.flag)
        if cell is not None:
            path = paths.setdefault(item.verdict, QPainterPath()) if item.current else gone
            path.addRect(cell)
    p.setBrush(Qt.BrushStyle.NoBrush)
    _trace(p, gone, QColor(at.theme.faint), at.theme, Qt.PenStyle.DotLine)
    for verdict, path in paths.items():
        if verdict in _SETTLED:
            p.fillPath(path, colours.faded(at.theme.field, 0.5))
        _trace(p, path, QColor(at.theme.verdict(verdict)), at.theme, _DASHES[verdict])


def _trace(
    p: QPainter, path: QPainterPath, colour: QColor, theme: Theme, style: Qt.PenStyle
) -> None:
    # A dark seam keeps the outline apart from cells of a similar colour.
    p.strokePath(path, QPen(colours.faded(theme.field, 0.85), 3))
    p.strokePath(path, QPen(colour, 1, style))


def draw_selected(p: QPainter, at: Frame, item: QueueItem) -> None:
    """Outline the selected flag again, thicker."""
    cell = flag_cell(at, item.flag)
    if cell is None:
        return
    outer = cell.adjusted(-1.5, -1.5, 1.5, 1.5)
    join = Qt.PenJoinStyle.MiterJoin
    seam = QPen(QColor(at.theme.field), 5)
    seam.setJoinStyle(join)
    line = QPen(QColor(at.theme.verdict(item.verdict)), 2)
    line.setJoinStyle(join)
    p.setBrush(Qt.BrushStyle.NoBrush)
    p.setPen(seam)
    p.drawRect(outer)
    p.setPen(line)
    p.drawRect(outer)


def draw_selection(p: QPainter, at: Frame, rows: frozenset[str], span: tuple[int, int]) -> None:
    """Draw selected rows x span that are no flag."""
    across = at.stretch(*span, _NARROWEST)
    if across is None:
        return
    p.setPen(QPen(QColor(at.theme.accent), 1))
    p.setBrush(colours.faded(at.theme.accent, 0.22))
    for top, bottom in at.rows.runs(rows):
        p.drawRect(QRectF(across[0], at.area.top() + top, across[1], bottom - top - 1))
    p.setBrush(Qt.BrushStyle.NoBrush)
