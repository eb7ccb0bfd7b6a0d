"""Things drawn in pixels over or under a plot: cached pictures, shades, the play head."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen, QPixmap, QPolygonF
from PySide6.QtWidgets import QGraphicsItem

from mocapstudio.gui import theme as themes
from mocapstudio.gui.plots import colours

Draw = Callable[[QPainter, QRectF], None]

_GRIP = 5.0


def draw_trim(p: QPainter, area: QRectF, left: float, right: float) -> None:
    """Dim what lies left and right of the trim's edges (pixels), and draw the edges."""
    look = themes.current()
    veil = colours.faded(look.background, 0.72)
    p.setPen(QPen(QColor(look.faint), 1))
    if left > area.left():
        p.fillRect(QRectF(area.topLeft(), QPointF(left, area.bottom())) & area, veil)
        p.drawLine(QPointF(left, area.top()), QPointF(left, area.bottom()))
    if right < area.right():
        p.fillRect(QRectF(QPointF(right, area.top()), area.bottomRight()) & area, veil)
        p.drawLine(QPointF(right, area.top()), QPointF(right, area.bottom()))


class Layer(QGraphicsItem):
    """A drawing over the plot's area, in pixels of the widget.

    Parameters
    ----------
    draw
        Called with a painter, clipped to the area, and the area.
    cached
        Keep what was drawn as a picture until `refresh`; then a moving play head costs one blit
        of its own strip, however much the layer shows.
    """

    def __init__(self, draw: Draw, *, cached: bool = False) -> None:
        super().__init__()
        self._draw = draw
        self._cached = cached
        self._direct = False
        self._area = QRectF()
        self._picture: QPixmap | None = None
        self.setAcceptedMouseButtons(Qt.MouseButton.NoButton)

    def set_area(self, area: QRectF) -> None:
        """Place the layer; what was drawn before is drawn anew."""
        if area != self._area:
            self.prepareGeometryChange()
            self._area = QRectF(area)
        self.refresh()

    def refresh(self) -> None:
        """Draw anew at the next chance."""
        self._picture = None
        self.update()

    def draw_directly(self, on: bool) -> None:
        """Draw without a kept picture for a while, as for a device of another resolution."""
        self._direct = on

    def boundingRect(self) -> QRectF:
        """The plot's area."""
        return self._area

    def paint(self, painter: QPainter, _option: Any, _widget: Any = None) -> None:
        """Draw, or copy what was drawn."""
        if self._area.isEmpty():
            return
        if not self._cached or self._direct:
            painter.setClipRect(self._area)
            self._draw(painter, self._area)
            return
        device = painter.device()
        ratio = device.devicePixelRatio() if device is not None else 1.0
        if self._picture is None or self._picture.devicePixelRatio() != ratio:
            self._picture = self._drawn(ratio)
        painter.drawPixmap(self._area.topLeft(), self._picture)

    def _drawn(self, ratio: float) -> QPixmap:
        picture = QPixmap((self._area.size() * ratio).toSize())
        picture.setDevicePixelRatio(ratio)
        picture.fill(Qt.GlobalColor.transparent)
        painter = QPainter(picture)
        painter.translate(-self._area.topLeft())
        painter.setClipRect(self._area)
        self._draw(painter, self._area)
        painter.end()
        return picture


class PlayHead(QGraphicsItem):
    """A line at the current frame with a grip in the time axis.

    Parameters
    ----------
    grip_on_top
        Whether the time axis lies above the plot.
    """

    def __init__(self, grip_on_top: bool) -> None:
        super().__init__()
        self._grip_on_top = grip_on_top
        self._height = 0.0
        self.setZValue(100)
        self.setAcceptedMouseButtons(Qt.MouseButton.NoButton)

    def set_height(self, height: float) -> None:
        """Say how high the plot is, pixels."""
        if height != self._height:
            self.prepareGeometryChange()
            self._height = height

    def boundingRect(self) -> QRectF:
        """Line and grip."""
        above = _GRIP + 4 if self._grip_on_top else 0.0
        below = 0.0 if self._grip_on_top else _GRIP + 4
        return QRectF(-_GRIP - 1, -above, 2 * _GRIP + 2, self._height + above + below)

    def shape(self) -> QPainterPath:
        """Nothing: the plot itself decides what a click means."""
        return QPainterPath()

    def paint(self, painter: QPainter, _option: Any, _widget: Any = None) -> None:
        """Draw line and grip."""
        colour = QColor(themes.current().playhead)
        painter.setPen(QPen(colour, 1))
        painter.drawLine(QPointF(0, 0), QPointF(0, self._height))
        tip = 1.0 if self._grip_on_top else self._height - 1.0
        away = -(_GRIP + 4) if self._grip_on_top else _GRIP + 4
        grip = QPolygonF(
            [
                QPointF(-_GRIP, tip + away),
                QPointF(_GRIP, tip + away),
                QPointF(_GRIP, tip + 0.4 * away),
                QPointF(0, tip),
                QPointF(-_GRIP, tip + 0.4 * away),
            ]
        )
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour)
        painter.drawPolygon(grip)
