"""The scale of the digression map, with the threshold to be dragged."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QImage, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QWidget

from mocapstudio.gui import theme as themes
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.axes import small_font
from mocapstudio.gui.plots.time_plot import RIGHT_GUTTER

_LEFT = 14
_WIDTH = 12
_NEAR = 7.0
LOWEST, HIGHEST = 0.01, 0.99


class ColourBar(QWidget):
    """Colours from 0 to 1 and the threshold; drag it up or down."""

    threshold_moved = Signal(float, bool)
    """Where the threshold was dragged to, and whether the button was released."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setFixedWidth(RIGHT_GUTTER)
        self.setMouseTracking(True)
        self.setToolTip("Digression 0 to 1. Drag the mark to set the threshold for flags.")
        self._threshold = 0.5
        self._top, self._height = 0, 1
        self._dragging = False

    @property
    def threshold(self) -> float:
        """The threshold as drawn."""
        return self._threshold

    def set_threshold(self, threshold: float) -> None:
        """Draw the threshold elsewhere."""
        if threshold != self._threshold:
            self._threshold = threshold
            self.update()

    def set_extent(self, top: int, height: int) -> None:
        """Say where the bar begins and how high it is, pixels."""
        if (top, height) != (self._top, self._height):
            self._top, self._height = top, max(height, 1)
            self.update()

    def y_of(self, value: float) -> float:
        """Height of a value of the map, pixels."""
        return self._top + (1.0 - value) * self._height

    def value_at(self, y: float) -> float:
        """Value of the map at a height, kept within what a threshold may be."""
        return min(max(1.0 - (y - self._top) / self._height, LOWEST), HIGHEST)

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw scale and threshold."""
        look = themes.current()
        p = QPainter(self)
        p.fillRect(self.rect(), QColor(look.panel))
        column = np.ascontiguousarray(colours.lookup_table(look, self._threshold)[::-1, None])
        image = QImage(column.data, 1, len(column), 4, QImage.Format.Format_RGB32)
        bar = QRectF(_LEFT, self._top, _WIDTH, self._height)
        p.drawImage(bar, image)
        p.setPen(QPen(QColor(look.border), 1))
        p.drawRect(bar.adjusted(-0.5, -0.5, 0.5, 0.5))
        p.setFont(small_font())
        mark = self.y_of(self._threshold)
        for value, text in ((0.0, "0"), (0.5, "0.5"), (1.0, "1")):
            y = min(max(self.y_of(value), self._top + 5), self._top + self._height - 5)
            if abs(y - mark) >= 14:
                self._write(p, y, text, look.faint)
        p.setRenderHint(QPainter.RenderHint.Antialiasing)
        p.setPen(QPen(QColor(look.field), 3))
        p.drawLine(QPointF(_LEFT - 2, mark), QPointF(_LEFT + _WIDTH + 2, mark))
        p.setPen(QPen(QColor(look.text), 1.5))
        p.drawLine(QPointF(_LEFT - 3, mark), QPointF(_LEFT + _WIDTH + 3, mark))
        p.setPen(Qt.PenStyle.NoPen)
        p.setBrush(QColor(look.text))
        tip = _LEFT - 2.0
        p.drawPolygon(
            QPolygonF([QPointF(tip, mark), QPointF(tip - 8, mark - 5), QPointF(tip - 8, mark + 5)])
        )
        y = min(max(mark, self._top + 5), self._top + self._height - 5)
        self._write(p, y, f"{self._threshold:.2f}", look.text)
        p.end()

    def _write(self, p: QPainter, y: float, text: str, colour: str) -> None:
        p.setPen(QColor(colour))
        room = QRectF(_LEFT + _WIDTH + 7, y - 8, self.width() - _LEFT - _WIDTH - 8, 16)
        p.drawText(room, int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter), text)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take hold of the threshold."""
        if event.button() == Qt.MouseButton.LeftButton:
            self._dragging = True
            self._move(event.position().y(), False)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Drag the threshold."""
        y = event.position().y()
        near = self._dragging or abs(y - self.y_of(self._threshold)) <= _NEAR
        self.setCursor(Qt.CursorShape.SizeVerCursor if near else Qt.CursorShape.ArrowCursor)
        if self._dragging:
            self._move(y, False)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Let go of the threshold."""
        if self._dragging and event.button() == Qt.MouseButton.LeftButton:
            self._dragging = False
            self._move(event.position().y(), True)

    def _move(self, y: float, done: bool) -> None:
        self.set_threshold(round(self.value_at(y), 3))
        self.threshold_moved.emit(self._threshold, done)
