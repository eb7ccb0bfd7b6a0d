"""The axes of the plots: time with frame numbers, and plain values."""

from __future__ import annotations

from functools import cache
from typing import Any

import pyqtgraph as pg
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen
from PySide6.QtWidgets import QGraphicsItem

from mocapstudio.gui import theme as themes
from mocapstudio.gui.plots.ticks import time_ticks, value_ticks

TIME_AXIS_HEIGHT = 19
_LABEL_ROOM = 122.0
_HALF_LINE = 6.0


@cache
def small_font(pixels: int = 11) -> QFont:
    """Return the type of figures in plots."""
    font = themes.numbers_font()
    font.setPixelSize(pixels)
    return font


def _keep_picture(axis: pg.AxisItem) -> None:
    # The grip of the play head passes over the axis at every frame.
    axis.setCacheMode(QGraphicsItem.CacheMode.DeviceCoordinateCache)


def _plot_area(axis: pg.AxisItem) -> QRectF:
    view = axis.linkedView()
    return QRectF(axis.mapRectFromItem(view, view.rect()))


class TimeAxis(pg.AxisItem):  # type: ignore[misc]
    """Seconds, and beside each the frame number that the file itself gives.

    Parameters
    ----------
    orientation
        ``"top"`` or ``"bottom"``.
    """

    def __init__(self, orientation: str) -> None:
        super().__init__(orientation, showValues=False)
        self._rate = 1.0
        self._first_frame = 0
        self.setHeight(TIME_AXIS_HEIGHT)
        _keep_picture(self)

    def set_clock(self, rate: float, first_frame: int) -> None:
        """Say how many frames a second there are, and the file's number of frame 0."""
        if (rate, first_frame) != (self._rate, self._first_frame):
            self._rate, self._first_frame = rate, first_frame
            self.update()

    def paint(self, p: QPainter, _option: Any, _widget: Any) -> None:
        """Draw marks and labels."""
        look = themes.current()
        box = self.rect()
        view = _plot_area(self)
        start, end = self.range
        per_frame = view.width() / max(end - start, 1e-9)
        bottom = self.orientation == "bottom"
        edge = box.top() if bottom else box.bottom()
        inward = 1.0 if bottom else -1.0
        font, small = small_font(), small_font(10)
        metrics = QFontMetricsF(font)
        baseline = box.center().y() + 0.5 * metrics.capHeight() + 1.5 * inward
        p.setPen(QPen(QColor(look.border), 1))
        p.drawLine(QPointF(view.left(), edge), QPointF(view.right(), edge))
        for tick in time_ticks(start, end, self._rate, int(view.width() / _LABEL_ROOM)):
            x = view.left() + (tick.frame - start) * per_frame
            length = 6.0 if tick.label else 3.0
            p.setPen(QPen(QColor(look.faint if tick.label else look.border), 1))
            p.drawLine(QPointF(x, edge), QPointF(x, edge + inward * length))
            width = metrics.horizontalAdvance(tick.label)
            if not tick.label or x + width + 44 > box.right():
                continue
            p.setFont(font)
            p.setPen(QColor(look.muted))
            p.drawText(QPointF(x + 8, baseline), tick.label)
            p.setFont(small)
            p.setPen(QColor(look.faint))
            number = str(self._first_frame + round(tick.frame))
            p.drawText(QPointF(x + 8 + width + 6, baseline), number)


class ValueAxis(pg.AxisItem):  # type: ignore[misc]
    """Round values on the left, with the unit at the topmost."""

    def __init__(self, width: int) -> None:
        super().__init__("left", showValues=False)
        self._unit = ""
        self.setWidth(width)
        _keep_picture(self)

    def set_unit(self, unit: str) -> None:
        """Say what is measured in."""
        if unit != self._unit:
            self._unit = unit
            self.update()

    def marks(self) -> list[tuple[float, str]]:
        """Values with their text, as many as the height has room for."""
        low, high = self.range
        return value_ticks(low, high, int(max(3, self.rect().height() // 24)))

    def paint(self, p: QPainter, _option: Any, _widget: Any) -> None:
        """Draw marks and labels."""
        look = themes.current()
        box = self.rect()
        view = _plot_area(self)
        low, high = self.range
        p.setFont(small_font())
        p.setPen(QPen(QColor(look.border), 1))
        p.drawLine(QPointF(box.right(), view.top()), QPointF(box.right(), view.bottom()))
        scale = view.height() / max(high - low, 1e-12)
        margin = _HALF_LINE / scale
        marks = [m for m in self.marks() if low + margin <= m[0] <= high - margin]
        for i, (value, label) in enumerate(marks):
            y = view.bottom() - (value - low) * scale
            p.setPen(QPen(QColor(look.border), 1))
            p.drawLine(QPointF(box.right() - 4, y), QPointF(box.right(), y))
            text = f"{label} {self._unit}" if i == len(marks) - 1 else label
            p.setPen(QColor(look.muted))
            room = QRectF(box.left(), y - 8, box.width() - 8, 16)
            p.drawText(room, int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter), text)
