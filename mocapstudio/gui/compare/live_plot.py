"""What grows while frames arrive: a plot of its own over the seconds of the action."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from mocapstudio.gui import theme as themes
from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.compare.live_bridge import LiveBridge, LiveShown
from mocapstudio.gui.compare.live_words import phase_words
from mocapstudio.gui.plots.axes import small_font
from mocapstudio.gui.plots.ticks import time_ticks

LEFT, RIGHT = 46.0, 16.0
_BOTTOM = 18.0
_EVERY_MS = 80
_GROWTH = 1.25
_TITLE = int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
_CENTRE = int(Qt.AlignmentFlag.AlignCenter)

Array = NDArray[np.float64]


class LivePlot(QWidget):
    """Draws the course of the action a dozen times a second at most.

    A click asks for what was there, which can be answered while nothing runs.

    Parameters
    ----------
    bridge, live
        Where state comes from.
    title
        What it shows.
    """

    asked = Signal(float)
    """Second of the action that the user wants to see."""

    def __init__(self, bridge: CompareBridge, live: LiveBridge, title: str) -> None:
        super().__init__()
        self._bridge, self._live, self._title = bridge, live, title
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        # Figures and heads move at every frame; pictures that grow need not.
        self._later = QTimer(self)
        self._later.setSingleShot(True)
        self._later.setInterval(_EVERY_MS)
        self._later.timeout.connect(self.update)
        live.changed.connect(self._follow)

    def _follow(self, _old: LiveShown, _new: LiveShown) -> None:
        if self.isVisible() and not self._later.isActive():
            self._later.start()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Ask for a second of the action."""
        self._ask(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Go on asking along the way."""
        self._ask(event)

    def _ask(self, event: QMouseEvent) -> None:
        if event.buttons() & Qt.MouseButton.LeftButton:
            area = self.area
            share = (event.position().x() - area.left()) / area.width()
            self.asked.emit(min(max(share, 0.0), 1.0) * self.seconds_wide)

    # -- geometry

    @property
    def area(self) -> QRectF:
        """The plot without its axes, pixels."""
        width, height = self.width() - LEFT - RIGHT, self.height() - self._top - _BOTTOM
        return QRectF(LEFT, self._top, max(width, 1.0), max(height, 1.0))

    @property
    def _top(self) -> float:
        return 24.0

    @property
    def _rate(self) -> float:
        alignment = self._live.shown.alignment
        return 1.0 if alignment is None else alignment.aligner.reference.rate

    @property
    def seconds_wide(self) -> float:
        """Seconds of the action that fit: the reference's length, more where she takes longer."""
        history = self._live.shown.history
        if history is None:
            return 1.0
        wide = history.reference_frames / self._rate * 1.1
        while history.frames / self._rate > wide:
            wide *= _GROWTH
        return wide

    def x_of(self, seconds: float) -> float:
        """Pixel of a second of the action."""
        area = self.area
        return area.left() + seconds / self.seconds_wide * area.width()

    def seconds_of_columns(self) -> Array:
        """(C,) seconds of the action at which the history's columns end."""
        history = self._live.shown.history
        if history is None:
            return np.zeros(0)
        ends = np.minimum((np.arange(history.columns) + 1) * history.stride, history.frames)
        seconds: Array = (ends - 1) / self._rate
        return seconds

    # -- drawing

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw ground, what is the plot's own, and the time axis."""
        look = themes.current()
        p = QPainter(self)
        p.fillRect(self.rect(), QColor(look.panel))
        p.fillRect(self.area, QColor(look.field))
        p.setFont(small_font(11))
        p.setPen(QColor(look.muted))
        p.drawText(QRectF(LEFT, 4, self.area.width(), 16), _TITLE, self._title)
        history = self._live.shown.history
        if history is not None:
            self.draw(p)
            self._draw_time(p)
        if history is None or not history.frames:
            p.setFont(small_font(11))
            p.setPen(QColor(look.faint))
            p.drawText(self.area, _CENTRE, phase_words(self._live.shown).lower())
        if self._live.shown.looked is not None:
            x = self.x_of(self._live.shown.looked)
            p.setPen(QPen(QColor(look.playhead), 1, Qt.PenStyle.DashLine))
            p.drawLine(QPointF(x, self.area.top()), QPointF(x, self.area.bottom()))
        p.end()

    def draw(self, p: QPainter) -> None:
        """Draw what is to be seen."""
        raise NotImplementedError

    def _draw_time(self, p: QPainter) -> None:
        area = self.area
        p.setFont(small_font(10))
        p.setPen(QColor(themes.current().faint))
        most = max(2, int(area.width() / 70))
        for tick in time_ticks(0.0, self.seconds_wide, 1.0, most):
            if tick.label:
                x = self.x_of(tick.frame)
                p.drawLine(QPointF(x, area.bottom()), QPointF(x, area.bottom() + 3))
                left = min(max(x - 30, 0.0), self.width() - 60.0)
                p.drawText(QRectF(left, area.bottom() + 3, 60, 13), _CENTRE, tick.label)
