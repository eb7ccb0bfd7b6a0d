"""Distances of the poses that have arrived from all of the reference's, and the path, growing."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPen, QPolygonF

from mocapstudio.comparison.live_history import LiveHistory
from mocapstudio.gui import theme as themes
from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.compare.live_bridge import LiveBridge
from mocapstudio.gui.compare.live_plot import LEFT, LivePlot
from mocapstudio.gui.compare.matrix_plot import colours_of_distances
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.axes import small_font
from mocapstudio.gui.plots.ticks import time_ticks

_RIGHT = int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
_MOST_POINTS = 1500


class LiveMatrix(LivePlot):
    """The reference up, the performer's frames across; dark is alike.

    The white line is the path as it is now: a later frame may still bend it.

    Parameters
    ----------
    bridge, live
        Where state comes from.
    """

    def __init__(self, bridge: CompareBridge, live: LiveBridge) -> None:
        super().__init__(bridge, live, "↑ reference   → performer")
        self.setObjectName("live-matrix")
        self.setMinimumWidth(200)
        self.setToolTip(
            "Distance of each pose that has arrived (across) from every pose of the reference\n"
            "(up): dark is alike. The line is the path as it is now; later frames may bend it."
        )

    def y_of(self, at: float) -> float:
        """Pixel of a reference frame, at the rate of alignment."""
        history, area = self._live.shown.history, self.area
        frames = 1 if history is None else history.reference_frames
        return area.bottom() - (at + 0.5) / frames * area.height()

    def path(self) -> list[QPointF]:
        """Pixels of the path as it is now."""
        shown = self._live.shown
        if shown.alignment is None or shown.history is None or not shown.history.frames:
            return []
        pairs = shown.alignment.aligner.path()
        pairs = pairs[:: max(1, len(pairs) // _MOST_POINTS)]
        rate = self._rate
        return [QPointF(self.x_of(s / rate), self.y_of(r)) for r, s in pairs.tolist()]

    def draw(self, p: QPainter) -> None:
        """Draw distances, path and head."""
        area, shown = self.area, self._live.shown
        assert shown.history is not None
        if shown.history.frames:
            p.save()
            p.setClipRect(area)
            self._draw_distances(p, shown.history)
            self._draw_path(p)
            p.restore()
        self._draw_reference_time(p, shown.history)

    def _draw_distances(self, p: QPainter, history: LiveHistory) -> None:
        values = history.distances
        low = float(values.min())
        high = float(np.percentile(values[:: max(1, len(values) // 200)], 99))
        levels = np.clip((values - low) / max(high - low, 1e-9) * 255, 0, 255).astype(np.uint8)
        pixels = np.ascontiguousarray(colours_of_distances()[levels.T[::-1]])
        image = QImage(
            pixels.data, pixels.shape[1], pixels.shape[0], pixels.strides[0],
            QImage.Format.Format_RGB32,
        )  # fmt: skip
        right = self.x_of(history.columns * history.stride / self._rate)
        top = self.y_of(history.block * values.shape[1] - 0.5)
        place = QRectF(QPointF(self.area.left(), top), QPointF(right, self.area.bottom()))
        p.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        p.drawImage(place, image)

    def _draw_path(self, p: QPainter) -> None:
        line, look = self.path(), themes.current()
        if not line:
            return
        p.setRenderHint(QPainter.RenderHint.Antialiasing)
        p.setPen(QPen(QColor(0, 0, 0, 140), 3.4))
        p.drawPolyline(QPolygonF(line))
        p.setPen(QPen(QColor("#ffffff"), 1.5))
        p.drawPolyline(QPolygonF(line))
        at, area = line[-1], self.area
        p.setPen(QPen(colours.faded(look.playhead, 0.7), 1))
        p.drawLine(QPointF(at.x(), area.top()), QPointF(at.x(), area.bottom()))
        p.drawLine(QPointF(area.left(), at.y()), QPointF(area.right(), at.y()))
        p.setPen(QPen(QColor(look.field), 1))
        p.setBrush(QColor(look.playhead))
        p.drawEllipse(at, 3.5, 3.5)

    def _draw_reference_time(self, p: QPainter, history: LiveHistory) -> None:
        p.setFont(small_font(10))
        p.setPen(QColor(themes.current().faint))
        most = max(2, int(self.area.height() / 40))
        for tick in time_ticks(0.0, history.reference_frames, self._rate, most):
            if tick.label:
                y = self.y_of(tick.frame)
                p.drawText(QRectF(0, y - 7, LEFT - 5, 14), _RIGHT, tick.label)
