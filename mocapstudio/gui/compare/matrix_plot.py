"""A matrix of two motions set against each other, with the path and both play heads."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QImage,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPixmap,
    QPolygonF,
    QResizeEvent,
    QShowEvent,
    QWheelEvent,
)

from mocapstudio.gui import theme as themes
from mocapstudio.gui.compare.heat_drawing import Scale
from mocapstudio.gui.compare.layout import Stretch
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.axes import small_font
from mocapstudio.gui.plots.ticks import time_ticks
from mocapstudio.gui.widgets.native import NativeView
from mocapstudio.review.comparing_matrix import PooledDistances
from mocapstudio.review.matrix_model import Matrix, Picture

_LEFT, _BOTTOM, _TOP, _RIGHT = 44, 30, 8, 10
_NOTCH = 0.85
_SHORTEST = 6.0
_MOST_POINTS = 2000

Box = tuple[float, float, float, float]


class MatrixPlot(NativeView):
    """The reference up, the source across; dark is alike, or cheap.

    A click goes to the nearest step of the path, the wheel zooms about the pointer.

    Parameters
    ----------
    names
        What the motions are called along the axes: across, up.
    """

    picked = Signal(int, int)
    """Emitted with the reference and source frame of the step of the path that was clicked."""

    zoomed = Signal(float, float)
    """Emitted with the left and right edge wanted, in source frames."""

    def __init__(self, names: tuple[str, str] = ("source", "reference")) -> None:
        super().__init__()
        # Its heads move at every frame: what lies behind need not be painted with them.
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self._names = names
        self._matrix: Matrix | None = None
        self._picture_kind = Picture.DISTANCES
        self._shown = (-0.5, 0.5)
        self._boxes: tuple[Box, ...] = ()
        self._heads: tuple[int, int] | None = None
        self._picture: QPixmap | None = None

    # -- what is shown

    def show_matrix(
        self,
        matrix: Matrix | None,
        picture: Picture,
        shown: tuple[float, float],
        boxes: Sequence[Box] = (),
    ) -> None:
        """Show another matrix, or another part of it.

        Parameters
        ----------
        shown
            Left and right edge, in source frames.
        boxes
            Spans to be framed: first and last edge in reference frames, then in source frames.
        """
        told = (matrix, picture, shown, tuple(boxes))
        if told != (self._matrix, self._picture_kind, self._shown, self._boxes):
            self._matrix, self._picture_kind, self._shown, self._boxes = told
            self.redraw()

    def set_heads(self, heads: tuple[int, int] | None) -> None:
        """Move the play heads: reference and source frame, or None for none."""
        if heads == self._heads:
            return
        before, self._heads = self._heads, heads
        if self._matrix is None or before is None or heads is None:
            self.update()
            return
        for frame, source in (before, heads):
            at = self.place_of(frame, source)
            self.update(int(at.x()) - 4, 0, 9, self.height())
            self.update(0, int(at.y()) - 4, self.width(), 9)

    def redraw(self) -> None:
        """Draw everything anew."""
        self._picture = None
        self.update()

    # -- geometry

    @property
    def area(self) -> QRectF:
        """The matrix without its axes, pixels."""
        width, height = self.width() - _LEFT - _RIGHT, self.height() - _TOP - _BOTTOM
        return QRectF(_LEFT, _TOP, max(width, 1), max(height, 1))

    @property
    def scales(self) -> tuple[Scale, Scale]:
        """Source frames across; reference frames up, measured from the lower edge."""
        area = self.area
        if self._matrix is None:
            nothing = Stretch(-0.5, 0.5)
            return Scale(area.left(), area.width(), nothing), Scale(0.0, area.height(), nothing)
        frames = self._matrix.frames
        start, end = max(self._shown[0], -0.5), min(self._shown[1], frames[1] - 0.5)
        first, last = 0.0, frames[0] - 1.0
        if start > -0.5 or end < frames[1] - 0.5:
            first, last = _answers(self._matrix.path, start, end)
        room = max(0.0, (_SHORTEST - (last - first)) / 2)
        across = Scale(area.left(), area.width(), Stretch(start, end))
        up = Scale(0.0, area.height(), Stretch(first - 0.5 - room, last + 0.5 + room))
        return across, up

    def place_of(self, reference: float, source: float) -> QPointF:
        """Pixel of a pair of frames."""
        across, up = self.scales
        return QPointF(across.x(source), self.area.bottom() - up.x(reference))

    # -- drawing

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw matrix, path and play heads."""
        p = QPainter(self)
        if self._picture is None or self._picture.devicePixelRatio() != self.devicePixelRatio():
            self._picture = self._drawn()
        p.drawPixmap(0, 0, self._picture)
        if self._matrix is not None and self._heads is not None:
            at, area = self.place_of(*self._heads), self.area
            p.setClipRect(area)
            p.setPen(QPen(colours.faded(themes.current().playhead, 0.7), 1))
            p.drawLine(QPointF(at.x(), area.top()), QPointF(at.x(), area.bottom()))
            p.drawLine(QPointF(area.left(), at.y()), QPointF(area.right(), at.y()))
            p.setRenderHint(QPainter.RenderHint.Antialiasing)
            p.setPen(QPen(QColor(themes.current().field), 1))
            p.setBrush(QColor(themes.current().playhead))
            p.drawEllipse(at, 3.5, 3.5)
        p.end()

    def _drawn(self) -> QPixmap:
        ratio = self.devicePixelRatio()
        picture = QPixmap(self.size() * ratio)
        picture.setDevicePixelRatio(ratio)
        picture.fill(QColor(themes.current().panel))
        p = QPainter(picture)
        self.draw(p)
        p.end()
        return picture

    def draw(self, p: QPainter) -> None:
        """Draw everything but the play heads."""
        area, matrix = self.area, self._matrix
        p.fillRect(area, QColor(themes.current().field))
        if matrix is None:
            return
        across, up = self.scales
        edges = (up.stretch.start, up.stretch.end), (across.stretch.start, across.stretch.end)
        pooled = matrix.pooled(self._picture_kind, *edges, max(60, int(area.width())))
        p.save()
        p.setClipRect(area)
        self._draw_values(p, pooled, across, up)
        self._draw_boxes(p)
        self._draw_path(p, matrix.path, across, up)
        p.restore()
        self._draw_axes(p, matrix.rates, across, up)

    def _draw_values(self, p: QPainter, pooled: PooledDistances, across: Scale, up: Scale) -> None:
        values = pooled.values
        known = values[np.isfinite(values)]
        if not known.size:
            return
        low, high = float(known.min()), float(np.percentile(known, 99))
        # What no path reaches is as far as can be.
        scaled = np.nan_to_num((values - low) / max(high - low, 1e-9), nan=1.0, posinf=1.0)
        levels = np.clip(scaled * 255, 0, 255).astype(np.uint8)
        pixels = np.ascontiguousarray(colours_of_distances()[levels[::-1]])
        image = QImage(
            pixels.data, pixels.shape[1], pixels.shape[0], pixels.strides[0],
            QImage.Format.Format_RGB32,
        )  # fmt: skip
        (first, step), (begin, width) = pooled.reference, pooled.source
        left = across.x(begin - 0.5)
        right = across.x(begin + width * values.shape[1] - 0.5)
        bottom = self.area.bottom() - up.x(first - 0.5)
        top = self.area.bottom() - up.x(first + step * values.shape[0] - 0.5)
        p.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        p.drawImage(QRectF(QPointF(left, top), QPointF(right, bottom)), image)

    def _draw_boxes(self, p: QPainter) -> None:
        p.setPen(QPen(colours.faded("#ffffff", 0.5), 1))
        p.setBrush(Qt.BrushStyle.NoBrush)
        for first, last, begin, end in self._boxes:
            corners = self.place_of(first, begin), self.place_of(last, end)
            p.drawRect(QRectF(*corners).normalized())

    def _draw_path(self, p: QPainter, path: NDArray[np.integer], across: Scale, up: Scale) -> None:
        seen = (path[:, 1] >= across.stretch.start - 1) & (path[:, 1] <= across.stretch.end + 1)
        pairs = path[seen]
        pairs = pairs[:: max(1, len(pairs) // _MOST_POINTS)]
        bottom = self.area.bottom()
        line = QPolygonF([QPointF(across.x(s), bottom - up.x(r)) for r, s in pairs.tolist()])
        p.setRenderHint(QPainter.RenderHint.Antialiasing)
        p.setPen(QPen(QColor(0, 0, 0, 140), 3.4))
        p.drawPolyline(line)
        p.setPen(QPen(QColor("#ffffff"), 1.5))
        p.drawPolyline(line)
        p.setRenderHint(QPainter.RenderHint.Antialiasing, False)

    def _draw_axes(self, p: QPainter, rates: tuple[float, float], across: Scale, up: Scale) -> None:
        area, look = self.area, themes.current()
        p.setFont(small_font(10))
        p.setPen(QColor(look.muted))
        centre, right = Qt.AlignmentFlag.AlignHCenter, Qt.AlignmentFlag.AlignRight
        middle = Qt.AlignmentFlag.AlignVCenter
        stretch = across.stretch
        for tick in time_ticks(stretch.start, stretch.end, rates[1], 5):
            if tick.label:
                room = QRectF(across.x(tick.frame) - 30, area.bottom() + 1, 60, 13)
                p.drawText(room, int(centre | middle), tick.label)
        stretch = up.stretch
        most = max(2, int(area.height() / 46))
        for tick in time_ticks(stretch.start, stretch.end, rates[0], most):
            if tick.label:
                room = QRectF(0, area.bottom() - up.x(tick.frame) - 7, _LEFT - 4, 14)
                p.drawText(room, int(right | middle), tick.label)
        p.setPen(QColor(look.faint))
        room = QRectF(area.left(), area.bottom() + 14, area.width(), 14)
        p.drawText(room, int(centre | middle), f"→ {self._names[0]}    ↑ {self._names[1]}")

    # -- mouse

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Go to the nearest step of the path."""
        if event.button() == Qt.MouseButton.LeftButton:
            self._go(event.position())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Go along the path with the pointer."""
        if event.buttons() & Qt.MouseButton.LeftButton:
            self._go(event.position())

    def _go(self, at: QPointF) -> None:
        if self._matrix is None or not len(self._matrix.path):
            return
        across, up = self.scales
        wanted = np.array([up.frame(self.area.bottom() - at.y()), across.frame(at.x())])
        path = self._matrix.path
        reference, source = path[int(np.argmin(np.abs(path - wanted).sum(axis=1)))].tolist()
        self.picked.emit(round(reference), round(source))

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom about the pointer."""
        turn = event.angleDelta().y()
        if turn and self._matrix is not None:
            about = self.scales[0].frame(event.position().x())
            factor = _NOTCH ** (turn / 120)
            start, end = self._shown
            left = about - (about - start) * factor
            self.zoomed.emit(left, left + (end - start) * factor)
        event.accept()

    # -- Qt

    def showEvent(self, event: QShowEvent) -> None:
        """Catch up with what happened while out of sight."""
        super().showEvent(event)
        self._picture = None

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Draw anew."""
        super().resizeEvent(event)
        self._picture = None

    def changeEvent(self, event: QEvent) -> None:
        """Follow the theme."""
        super().changeEvent(event)
        if event.type() in (QEvent.Type.StyleChange, QEvent.Type.PaletteChange):
            self.redraw()


def colours_of_distances() -> NDArray[np.uint32]:
    """(256,) packed colours: dark is alike in both themes."""
    look = themes.current()
    table = pg.colormap.get(look.colormap).map(np.linspace(0, 1, 256), mode="byte")[:, :3]
    table = table.astype(np.uint32)
    if look.name == "light":
        table = table[::-1]
    packed = 0xFF000000 | table[:, 0] << 16 | table[:, 1] << 8 | table[:, 2]
    return np.asarray(packed, dtype=np.uint32)


def _answers(path: NDArray[np.integer], start: float, end: float) -> tuple[float, float]:
    """First and last reference frame that the path matches between two edges of the source."""
    inside = path[(path[:, 1] >= start) & (path[:, 1] <= end), 0]
    if not len(inside):
        inside = path[[int(np.argmin(np.abs(path[:, 1] - start)))], 0]
    return float(inside.min()), float(inside.max())
