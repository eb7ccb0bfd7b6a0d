"""Distance over time in the takes of the context, laid end to end."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QFontMetricsF,
    QHelpEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
)
from PySide6.QtWidgets import QToolTip, QWidget

from mocapstudio.gui import theme as themes
from mocapstudio.gui.plots import profile_drawing as drawing
from mocapstudio.gui.plots.axes import small_font
from mocapstudio.gui.plots.profile_curve import Mark, marks_of, read_out, top_of
from mocapstudio.gui.plots.ticks import value_ticks
from mocapstudio.gui.plots.time_plot import LEFT_GUTTER, RIGHT_GUTTER

if TYPE_CHECKING:
    from mocapstudio.cleaning.distance_profile import DistanceProfile, TakeDistances

_NAMES = 15
_LEAST_NAME = 34.0


class ContextStrip(QWidget):
    """One curve a take, on the distance axis of the plot above; the time axis is its own.

    It shows nothing that depends on the current frame, so a moving play head costs it nothing.
    """

    chosen = Signal(int)
    """Number of the neighbour whose minimum was clicked."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setMouseTracking(True)
        self.setMinimumHeight(60)
        self._takes: tuple[TakeDistances, ...] = ()
        self._marks: tuple[Mark, ...] = ()
        self._choice: int | None = None
        self._choosable = True
        self._top = 1.0

    def sizeHint(self) -> QSize:
        """As high as needed for names and curves."""
        return QSize(400, 64)

    def show_profile(self, profile: DistanceProfile | None, choosable: bool) -> None:
        """Show the takes of a profile other than the analysed one."""
        self._takes, self._marks, self._choosable = (), (), choosable
        if profile is not None:
            self._takes = tuple(one for one in profile.takes if one.index > 0)
            self._marks = tuple(one for one in marks_of(profile) if one.index > 0)
            self._top = top_of(profile)
        self.update()

    def mark(self, choice: int | None) -> None:
        """Light the neighbour whose motion is the proposal."""
        if choice != self._choice:
            self._choice = choice
            self.update()

    @property
    def area(self) -> QRectF:
        """Where the curves are, pixels."""
        width = max(self.width() - LEFT_GUTTER - RIGHT_GUTTER, 1)
        return QRectF(LEFT_GUTTER, _NAMES, width, max(self.height() - _NAMES - 3, 1))

    def _lanes(self) -> list[tuple[TakeDistances, float, float]]:
        """Each take with its left edge and its pixels a value."""
        area = self.area
        values = sum(len(one.degrees) for one in self._takes)
        scale = area.width() / max(values, 1)
        left, lanes = area.left(), []
        for one in self._takes:
            lanes.append((one, left, scale))
            left += len(one.degrees) * scale
        return lanes

    def place_of(self, mark: Mark) -> QPointF:
        """Pixel of a chosen minimum."""
        for one, left, scale in self._lanes():
            if one.index == mark.index:
                return QPointF(left + (mark.place + 0.5) * scale, self._y(mark.degrees))
        raise KeyError(mark.index)

    def _places(self) -> list[tuple[int, QPointF]]:
        return [(mark.number, self.place_of(mark)) for mark in self._marks]

    def _y(self, degrees: float) -> float:
        area = self.area
        return float(area.bottom() - degrees / self._top * area.height())

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw names, curves and minima."""
        look, area = themes.current(), self.area
        p = QPainter(self)
        p.fillRect(self.rect(), QColor(look.panel))
        p.fillRect(area, QColor(look.field))
        self._draw_axis(p, look)
        metrics = QFontMetricsF(small_font(10))
        for number, (one, left, scale) in enumerate(self._lanes()):
            width = len(one.degrees) * scale
            if number:
                p.setPen(QPen(QColor(look.border), 1))
                p.drawLine(QPointF(left, 2), QPointF(left, area.bottom()))
            if width >= _LEAST_NAME:
                p.setFont(small_font(10))
                p.setPen(QColor(look.muted))
                name = metrics.elidedText(one.take.name, Qt.TextElideMode.ElideRight, width - 8)
                p.drawText(QPointF(left + 4, _NAMES - 4), name)
            x = np.asarray(left + (np.arange(len(one.degrees)) + 0.5) * scale, dtype=np.float64)
            height = one.degrees.astype(np.float64) / self._top * area.height()
            y = np.asarray(area.bottom() - height, dtype=np.float64)
            p.setClipRect(area)
            drawing.draw_curve(p, look, one, x, y)
            p.setClipping(False)
        drawing.draw_marks(p, look, area, self._places(), self._choice)
        p.end()

    def _draw_axis(self, p: QPainter, look: themes.Theme) -> None:
        area = self.area
        levels = value_ticks(0.0, self._top, int(max(2, area.height() // 24)))
        drawing.draw_levels(p, look, area, [self._y(value) for value, _ in levels])
        p.setFont(small_font())
        p.setPen(QColor(look.muted))
        right = int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        for value, text in levels:
            y = self._y(value)
            if area.top() + 5 <= y <= area.bottom() - 5:
                room = QRectF(area.left() - 46, y - 8, 38, 16)
                p.drawText(room, right, f"{text}°" if value == levels[-1][0] else text)
        left = int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        count = len(self._takes)
        words = f"context · {count} takes" if count != 1 else "context · 1 take"
        p.drawText(QRectF(8, area.top() - 2, LEFT_GUTTER - 56, 16), left, words)

    # -- mouse

    def mark_at(self, at: QPointF) -> int | None:
        """Return the number of the neighbour whose minimum lies at a place, or None."""
        return drawing.hit(at, self._places(), self.area)

    def read_out(self, at: QPointF) -> str:
        """Say in words what lies at a place, or "" where nothing does."""
        if not self.area.adjusted(0, -_NAMES, 0, 0).contains(at):
            return ""
        number = self.mark_at(at)
        for mark in self._marks:
            if mark.number == number:
                part = next(one for one in self._takes if one.index == mark.index)
                return read_out(part, mark.place, mark, self._choosable)
        for one, left, scale in self._lanes():
            place = int((at.x() - left) / scale)
            if 0 <= place < len(one.degrees) and at.x() >= left:
                return read_out(one, place, None, self._choosable)
        return ""

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose the neighbour that was clicked."""
        number = self.mark_at(event.position())
        if event.button() == Qt.MouseButton.LeftButton and number is not None:
            self.chosen.emit(number)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Show what can be clicked."""
        hand = self._choosable and self.mark_at(event.position()) is not None
        shape = Qt.CursorShape.PointingHandCursor if hand else Qt.CursorShape.ArrowCursor
        if self.cursor().shape() != shape:
            self.setCursor(shape)
        if QToolTip.isVisible():
            words = self.read_out(event.position())
            QToolTip.showText(event.globalPosition().toPoint(), words, self)

    def event(self, event: QEvent) -> bool:
        """Answer with take, frame and distance where the tool tip is asked for."""
        if isinstance(event, QHelpEvent) and event.type() == QEvent.Type.ToolTip:
            QToolTip.showText(event.globalPos(), self.read_out(QPointF(event.pos())), self)
            return True
        return super().event(event)
