"""The matrix of pose distances with the warping path and both play heads."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QEvent, QPointF, QRectF, Qt
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
from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.compare.heat_drawing import Scale
from mocapstudio.gui.compare.layout import Stretch
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.axes import small_font
from mocapstudio.gui.plots.ticks import time_ticks
from mocapstudio.gui.widgets.native import NativeView
from mocapstudio.review.comparing import ComparingState
from mocapstudio.review.comparing_matrix import PooledDistances, pooled_distances

_LEFT, _BOTTOM, _TOP, _RIGHT = 44, 30, 8, 10
_NOTCH = 0.85
_SHORTEST = 6.0


class MatrixView(NativeView):
    """Distances of all poses of the reference (down up) and the source (across).

    A click goes to the nearest step of the path, the wheel zooms; it shows the stretch of time
    that the pictures show.

    Parameters
    ----------
    bridge
        Where state comes from and intents go.
    """

    def __init__(self, bridge: CompareBridge) -> None:
        super().__init__()
        self.setObjectName("compare-matrix-view")
        self.setToolTip(
            "Distance of every pose of the source (across) from every pose of the reference (up):\n"
            "dark is alike. The line is the warping path; a click goes to its nearest step."
        )
        self._bridge = bridge
        self._picture: QPixmap | None = None
        self._heads = (0, 0)
        bridge.changed.connect(self._follow)

    # -- geometry

    @property
    def area(self) -> QRectF:
        """The matrix without its axes, pixels."""
        width, height = self.width() - _LEFT - _RIGHT, self.height() - _TOP - _BOTTOM
        return QRectF(_LEFT, _TOP, max(width, 1), max(height, 1))

    def _scales(self) -> tuple[Scale, Scale]:
        """Source frames across; reference frames up, measured from the lower edge."""
        state, area = self._bridge.state, self.area
        linked = state.linked
        start, end = state.shown
        if linked is None:
            nothing = Stretch(-0.5, 0.5)
            return Scale(area.left(), area.width(), nothing), Scale(0.0, area.height(), nothing)
        frames = linked.frames
        start, end = max(start, -0.5), min(end, frames[1] - 0.5)
        first, last = linked.reference_of(start), linked.reference_of(end)
        if start <= -0.5 and end >= frames[1] - 0.5:
            first, last = 0, frames[0] - 1
        room = max(0.0, (_SHORTEST - (last - first)) / 2)
        across = Scale(area.left(), area.width(), Stretch(start, end))
        up = Scale(0.0, area.height(), Stretch(first - 0.5 - room, last + 0.5 + room))
        return across, up

    def place_of(self, reference: float, source: float) -> QPointF:
        """Pixel of a pair of frames."""
        across, up = self._scales()
        return QPointF(across.x(source), self.area.bottom() - up.x(reference))

    # -- state

    def _follow(self, old: ComparingState, new: ComparingState) -> None:
        if not self.isVisible():
            return
        same = old.linked is new.linked and old.shown == new.shown
        if not same or old.segments != new.segments:
            self._picture = None
            self.update()
        elif (new.frame, new.source_frame) != self._heads:
            before, self._heads = self._heads, (new.frame, new.source_frame)
            for frame, source in (before, self._heads):
                at = self.place_of(frame, source)
                self.update(int(at.x()) - 4, 0, 9, self.height())
                self.update(0, int(at.y()) - 4, self.width(), 9)

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
            self._picture = None
            self.update()

    # -- drawing

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw matrix, path and play heads."""
        p = QPainter(self)
        if self._picture is None or self._picture.devicePixelRatio() != self.devicePixelRatio():
            self._picture = self._drawn()
        p.drawPixmap(0, 0, self._picture)
        state = self._bridge.state
        self._heads = state.frame, state.source_frame
        if state.linked is not None:
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
        look = themes.current()
        picture.fill(QColor(look.panel))
        p = QPainter(picture)
        self.draw(p)
        p.end()
        return picture

    def draw(self, p: QPainter) -> None:
        """Draw everything but the play heads."""
        linked, area = self._bridge.state.linked, self.area
        p.fillRect(area, QColor(themes.current().field))
        if linked is None:
            return
        across, up = self._scales()
        edges = (up.stretch.start, up.stretch.end), (across.stretch.start, across.stretch.end)
        pooled = pooled_distances(linked.comparison, *edges, most=max(60, int(area.width())))
        p.save()
        p.setClipRect(area)
        self._draw_distances(p, pooled, across, up)
        self._draw_segments(p)
        self._draw_path(p)
        p.restore()
        self._draw_axes(p, across, up)

    def _draw_distances(
        self, p: QPainter, pooled: PooledDistances, across: Scale, up: Scale
    ) -> None:
        values = pooled.values
        low, high = float(values.min()), float(np.percentile(values, 99))
        levels = np.clip((values - low) / max(high - low, 1e-9) * 255, 0, 255).astype(np.uint8)
        table = (
            pg.colormap.get(themes.current().colormap)
            .map(np.linspace(0, 1, 256), mode="byte")[:, :3]
            .astype(np.uint32)
        )
        if themes.current().name == "light":
            # Dark is alike in both themes.
            table = table[::-1]
        packed = 0xFF000000 | table[:, 0] << 16 | table[:, 1] << 8 | table[:, 2]
        pixels = np.ascontiguousarray(packed.astype(np.uint32)[levels[::-1]])
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

    def _draw_segments(self, p: QPainter) -> None:
        state = self._bridge.state
        assert state.linked is not None
        p.setPen(QPen(colours.faded("#ffffff", 0.35), 1))
        p.setBrush(Qt.BrushStyle.NoBrush)
        for one in state.linked.carried(state.segments):
            begin = self.place_of(one.reference.start - 0.5, one.source.start - 0.5)
            end = self.place_of(one.reference.end - 0.5, one.source.end - 0.5)
            p.drawRect(QRectF(begin, end).normalized())

    def _draw_path(self, p: QPainter) -> None:
        state = self._bridge.state
        assert state.linked is not None
        across, up = self._scales()
        path = state.linked.comparison.path
        seen = (path[:, 1] >= across.stretch.start - 1) & (path[:, 1] <= across.stretch.end + 1)
        pairs = path[seen]
        pairs = pairs[:: max(1, len(pairs) // 2000)]
        bottom = self.area.bottom()
        line = QPolygonF([QPointF(across.x(s), bottom - up.x(r)) for r, s in pairs.tolist()])
        p.setRenderHint(QPainter.RenderHint.Antialiasing)
        p.setPen(QPen(QColor(0, 0, 0, 140), 3.4))
        p.drawPolyline(line)
        p.setPen(QPen(QColor("#ffffff"), 1.5))
        p.drawPolyline(line)
        p.setRenderHint(QPainter.RenderHint.Antialiasing, False)

    def _draw_axes(self, p: QPainter, across: Scale, up: Scale) -> None:
        state, area, look = self._bridge.state, self.area, themes.current()
        assert state.linked is not None
        both = state.linked.comparison
        p.setFont(small_font(10))
        p.setPen(QColor(look.muted))
        centre, right = Qt.AlignmentFlag.AlignHCenter, Qt.AlignmentFlag.AlignRight
        middle = Qt.AlignmentFlag.AlignVCenter
        stretch = across.stretch
        for tick in time_ticks(stretch.start, stretch.end, float(both.source_rate), 5):
            if tick.label:
                room = QRectF(across.x(tick.frame) - 30, area.bottom() + 1, 60, 13)
                p.drawText(room, int(centre | middle), tick.label)
        stretch = up.stretch
        most = max(2, int(area.height() / 46))
        for tick in time_ticks(stretch.start, stretch.end, float(both.reference_rate), most):
            if tick.label:
                room = QRectF(0, area.bottom() - up.x(tick.frame) - 7, _LEFT - 4, 14)
                p.drawText(room, int(right | middle), tick.label)
        p.setPen(QColor(look.faint))
        room = QRectF(area.left(), area.bottom() + 14, area.width(), 14)
        p.drawText(room, int(centre | middle), "→ source    ↑ reference")

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
        linked = self._bridge.state.linked
        if linked is None:
            return
        across, up = self._scales()
        source, reference = across.frame(at.x()), up.frame(self.area.bottom() - at.y())
        self._bridge.sitting.go_both(*linked.nearest(reference, source))

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom about the pointer."""
        turn = event.angleDelta().y()
        across = self._scales()[0]
        if turn and self._bridge.state.linked is not None:
            about = across.frame(event.position().x())
            factor = _NOTCH ** (turn / 120)
            start, end = self._bridge.state.shown
            left = about - (about - start) * factor
            self._bridge.sitting.show(left, left + (end - start) * factor)
        event.accept()
