"""Pose difference and misalignment over the source's time, coloured by timing."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen, QPolygonF

from mocapstudio.comparison.model import Comparison
from mocapstudio.gui import theme as themes
from mocapstudio.gui.compare import colours as kinds
from mocapstudio.gui.compare.pooling import Columns, columns
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.axes import ValueAxis
from mocapstudio.gui.plots.layers import Layer
from mocapstudio.gui.plots.pooling import block_length
from mocapstudio.gui.plots.time_plot import TimePlot
from mocapstudio.gui.plots.time_range import TimeRange

AXIS_WIDTH = 46
_PADDING = 0.08
_DOTS_FROM = 7.0


class CurvePlot(TimePlot):
    """One curve over the frames of the chosen source.

    Parameters
    ----------
    time_range
        Visible source frames.
    unit
        Of the values.
    least
        The smallest stretch of values shown, so that nothing much does not fill the plot.
    axis
        ``"top"`` for a time axis above, ``""`` for none.
    """

    def __init__(self, time_range: TimeRange, *, unit: str, least: float, axis: str) -> None:
        self.values_axis = ValueAxis(AXIS_WIDTH)
        super().__init__(time_range, axis=axis or "bottom", left=self.values_axis)
        self.values_axis.set_unit(unit)
        self._least = least
        self._values: NDArray[np.floating] = np.zeros(0)
        self._timing: NDArray[np.int8] = np.zeros(0, np.int8)
        self._beside: NDArray[np.floating] | None = None
        self._under = self.add_layer(Layer(self._draw_lines, cached=True), -2)
        self._curve = self.add_layer(Layer(self._draw_curve, cached=True), 1)
        if not axis:
            self.plotItem.showAxis("bottom", False)
            self.time_axis.setHeight(0)
        time_range.changed.connect(self._fit)

    def show_curve(
        self,
        comparison: Comparison | None,
        values: NDArray[np.floating] | None,
        beside: NDArray[np.floating] | None = None,
    ) -> None:
        """Show a curve of a comparison, and another one thin in front of it.

        Parameters
        ----------
        values, beside
            (S,) a value each source frame.
        """
        empty = comparison is None or values is None
        self._values = np.zeros(0) if empty or values is None else values
        self._timing = np.zeros(0, np.int8) if comparison is None else comparison.timing
        self._beside = beside
        self._fit()
        self._curve.refresh()

    def value(self, frame: int) -> float | None:
        """Value at a source frame, or None where there is none."""
        if not 0 <= frame < len(self._values):
            return None
        return float(self._values[frame])

    def _limits(self, low: float, high: float) -> tuple[float, float]:
        """Stretch of values to be shown for those in sight."""
        raise NotImplementedError

    def _fit(self) -> None:
        first = max(int(np.floor(self.time_range.start)), 0)
        part = self._values[first : max(int(np.ceil(self.time_range.end)) + 1, first)]
        part = part[np.isfinite(part)]
        low, high = (float(part.min()), float(part.max())) if part.size else (0.0, 0.0)
        low, high = self._limits(low, high)
        missing = max(self._least - (high - low), 0.0)
        pad = _PADDING * max(high - low, self._least)
        self.plotItem.vb.setYRange(*self._padded(low, high + missing, pad), padding=0)
        self._under.refresh()

    @staticmethod
    def _padded(low: float, high: float, pad: float) -> tuple[float, float]:
        return low - pad, high + pad

    def _y_of(self, value: NDArray[np.floating], area: QRectF) -> NDArray[np.float64]:
        low, high = self.plotItem.vb.viewRange()[1]
        scaled: NDArray[np.float64] = area.bottom() - (value - low) / max(high - low, 1e-12) * (
            area.height()
        )
        return scaled

    def _pooled(self, values: NDArray[np.floating]) -> Columns:
        per_pixel = self.time_range.length / max(self.area.width(), 1.0)
        step = block_length(per_pixel)
        return columns(values, self._timing, self.time_range.start, self.time_range.end, step)

    def _edges(self, pooled: Columns) -> tuple[NDArray[np.float64], float]:
        """Left edge of each column and the width of one, pixels."""
        left = np.array([self.x_of(float(f) - 0.5) for f in pooled.first])
        per_frame = self.area.width() / self.time_range.length
        return left, pooled.frames * per_frame

    def _draw_lines(self, p: QPainter, area: QRectF) -> None:
        look = themes.current()
        for value, _ in self.values_axis.marks():
            y = float(self._y_of(np.array(value), area))
            p.setPen(QPen(colours.mixed(look.field, look.border, 1.0 if value == 0 else 0.5), 1))
            p.drawLine(QPointF(area.left(), y), QPointF(area.right(), y))

    def _draw_curve(self, p: QPainter, area: QRectF) -> None:
        raise NotImplementedError


class DifferencePlot(CurvePlot):
    """How far the source's pose is from the one it matches: an area coloured by timing."""

    def __init__(self, time_range: TimeRange) -> None:
        super().__init__(time_range, unit="", least=0.05, axis="top")

    def _limits(self, low: float, high: float) -> tuple[float, float]:
        return 0.0, high

    @staticmethod
    def _padded(low: float, high: float, pad: float) -> tuple[float, float]:
        return low, high + pad

    def _draw_curve(self, p: QPainter, area: QRectF) -> None:
        look = themes.current()
        pooled = self._pooled(self._values)
        left, width = self._edges(pooled)
        tops = self._y_of(pooled.high, area)
        edges = np.rint(np.append(left, left[-1:] + width)).astype(int)
        for kind in (0, 1, -1):
            colour = kinds.timing(look, kind)
            for at in np.flatnonzero((pooled.timing == kind) & np.isfinite(tops)):
                start, end = edges[at], edges[at + 1] - (width > 4)
                bar = QRectF(start, tops[at], max(end - start, 1.0), area.bottom() - tops[at])
                p.fillRect(bar, colours.faded(colour, 0.55))
                p.fillRect(QRectF(start, tops[at], bar.width(), 2.0), colour)
        if self._beside is not None:
            self._draw_beside(p, area)

    def _draw_beside(self, p: QPainter, area: QRectF) -> None:
        assert self._beside is not None
        pooled = self._pooled(self._beside)
        left, width = self._edges(pooled)
        y = self._y_of(pooled.high, area)
        line = QPolygonF([QPointF(x + 0.5 * width, v) for x, v in zip(left, y, strict=True)])
        p.setRenderHint(QPainter.RenderHint.Antialiasing)
        p.setPen(QPen(QColor(themes.current().text), 1.2))
        p.drawPolyline(line)


class MisalignmentPlot(CurvePlot):
    """How many seconds the source is ahead (above zero) or behind (below)."""

    def __init__(self, time_range: TimeRange) -> None:
        super().__init__(time_range, unit="s", least=0.1, axis="")

    def _limits(self, low: float, high: float) -> tuple[float, float]:
        # Seen from near, zero may lie far outside: then what changes matters more.
        if min(abs(low), abs(high)) > 2.0 * max(high - low, self._least):
            return low, high
        return min(low, 0.0), max(high, 0.0)

    def _fit(self) -> None:
        super()._fit()
        low, high = self.plotItem.vb.viewRange()[1]
        missing = max(self._least - (high - low), 0.0)
        if missing > 0 or low == 0.0:
            self.plotItem.vb.setYRange(low - 0.5 * self._least, high, padding=0)

    def _draw_curve(self, p: QPainter, area: QRectF) -> None:
        look = themes.current()
        pooled = self._pooled(self._values)
        left, width = self._edges(pooled)
        middle = left + 0.5 * width
        zero = float(self._y_of(np.array(0.0), area))
        high, low = self._y_of(pooled.high, area), self._y_of(pooled.low, area)
        level = 0.5 * (high + low)
        edges = np.rint(np.append(left, left[-1:] + width)).astype(int)
        for at in np.flatnonzero(np.isfinite(level)):
            colour = kinds.timing(look, pooled.timing[at])
            top, bottom = min(level[at], zero), max(level[at], zero)
            bar = QRectF(edges[at], top, edges[at + 1] - edges[at], bottom - top)
            p.fillRect(bar, colours.faded(colour, 0.2))
        p.setRenderHint(QPainter.RenderHint.Antialiasing)
        for kind in (0, 1, -1):
            path = _runs(middle, level, pooled.timing == kind)
            p.setPen(QPen(kinds.timing(look, kind), 2.0))
            p.setBrush(Qt.BrushStyle.NoBrush)
            p.drawPath(path)
            if width >= _DOTS_FROM:
                p.setPen(Qt.PenStyle.NoPen)
                p.setBrush(kinds.timing(look, kind))
                for at in np.flatnonzero((pooled.timing == kind) & np.isfinite(level)):
                    p.drawEllipse(QPointF(middle[at], level[at]), 2.5, 2.5)


def _runs(
    x: NDArray[np.float64], y: NDArray[np.float64], chosen: NDArray[np.bool_]
) -> QPainterPath:
    """Connect chosen points, each run of them also with the point after it."""
    path = QPainterPath()
    open_ = False
    for at in range(len(x)):
        if not np.isfinite(y[at]):
            open_ = False
            continue
        point = QPointF(x[at], y[at])
        if open_:
            path.lineTo(point)
        open_ = bool(chosen[at])
        if open_:
            path.moveTo(point)
    return path
