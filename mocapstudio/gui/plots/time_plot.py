"""A plot over time: shared range, play head, and what the mouse means on it."""

from __future__ import annotations

from enum import Enum, auto

import pyqtgraph as pg
from PySide6.QtCore import QEvent, QPoint, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QCursor, QKeyEvent, QMouseEvent, QPainter, QWheelEvent
from PySide6.QtWidgets import QToolTip

from mocapstudio.gui import theme as themes
from mocapstudio.gui.plots.axes import TimeAxis
from mocapstudio.gui.plots.layers import Layer, PlayHead
from mocapstudio.gui.plots.time_range import TimeRange

LEFT_GUTTER = 184
"""Pixels left of every plot, so that all plots of the desk stand under one another."""

RIGHT_GUTTER = 78
"""Pixels right of every plot."""

_NEAR = 5.0
_STILL = 4.0
_NOTCH = 0.85


class Gesture(Enum):
    """What a pressed mouse button does."""

    NONE = auto()
    HELD = auto()
    SCRUB = auto()
    SWEEP = auto()
    PAN = auto()


class TimePlot(pg.PlotWidget):  # type: ignore[misc]
    """A pyqtgraph plot whose x axis are the frames of a `TimeRange`.

    A click or a drag moves the play head, the wheel zooms about the cursor, the middle button
    pans, Shift (or any drag, where `sweeps` is set) sweeps over a stretch.

    Parameters
    ----------
    time_range
        The visible frames, shared with other plots.
    axis
        ``"top"`` or ``"bottom"``: where the time axis goes.
    left
        An axis for the left side, or None.
    sweeps
        Whether a plain drag inside the plot sweeps instead of moving the play head.
    time_axis
        The time axis, where it is to be another than that of `time_range`.
    """

    scrubbed = Signal(int)
    """The frame that the user moved to."""
    clicked = Signal(QPointF)
    """Where the left button was pressed and released in place, on what `holds` says is there."""
    swept = Signal(QPointF, QPointF, bool)
    """From, to, and whether the button was released."""
    hovered = Signal(object)
    """Where the mouse is (QPointF), or None once it left."""
    focus_wanted = Signal()
    """The user asks to zoom to the selected flag."""

    def __init__(
        self,
        time_range: TimeRange,
        *,
        axis: str,
        left: pg.AxisItem | None = None,
        sweeps: bool = False,
        time_axis: TimeAxis | None = None,
    ) -> None:
        self.time_axis = time_axis or TimeAxis(axis)
        axes = {axis: self.time_axis} | ({"left": left} if left is not None else {})
        super().__init__(plotItem=pg.PlotItem(axisItems=axes, enableMenu=False))
        self.time_range = time_range
        self._axis, self._sweeps = axis, sweeps
        self._frame, self._gesture = 0, Gesture.NONE
        self._pressed, self._last = QPointF(), QPointF()
        self._layers: list[Layer] = []
        item = self.plotItem
        item.hideButtons()
        item.layout.setContentsMargins(0, 0, 0, 0)
        item.layout.setSpacing(0)
        for side in ("left", "right", "top", "bottom"):
            item.showAxis(side, side in axes)
        item.vb.setMouseEnabled(False, False)
        item.vb.setDefaultPadding(0)
        item.disableAutoRange()
        self.play_head = PlayHead(axis == "top")
        self.scene().addItem(self.play_head)
        self.viewport().setMouseTracking(True)
        time_range.changed.connect(self._follow_range)
        item.vb.sigResized.connect(lambda *_: self._place())
        self.add_layer(Layer(_draw_ground), -3)
        self.restyle()
        self._follow_range()

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        self.setBackground(themes.current().panel)
        self.refresh_layers()
        self.time_axis.update()
        self.play_head.update()

    # -- geometry

    @property
    def area(self) -> QRectF:
        """The plot without its axes, in pixels of the widget."""
        view = self.plotItem.vb
        return QRectF(view.mapRectToScene(view.rect()))

    def x_of(self, frame: float) -> float:
        """Pixel of a frame."""
        area, shown = self.area, self.time_range
        return area.left() + (frame - shown.start) / shown.length * area.width()

    def frame_at(self, x: float) -> float:
        """Frame at a pixel, not rounded."""
        area, shown = self.area, self.time_range
        return shown.start + (x - area.left()) / max(area.width(), 1.0) * shown.length

    def whole_frame_at(self, x: float) -> int:
        """Frame at a pixel, rounded and kept within the take."""
        return min(max(round(self.frame_at(x)), 0), self.time_range.frames - 1)

    def span_between(self, a: float, b: float) -> tuple[int, int]:
        """Half-open span of the frames whose pixels lie between two pixels."""
        low, high = sorted((self.whole_frame_at(a), self.whole_frame_at(b)))
        return low, high + 1

    def add_layer(self, layer: Layer, z: float) -> Layer:
        """Add a drawing that is placed over the plot's area and redrawn with the range."""
        layer.setZValue(z)
        self._layers.append(layer)
        self.scene().addItem(layer)
        return layer

    def refresh_layers(self) -> None:
        """Draw every layer anew."""
        for layer in self._layers:
            layer.refresh()

    def draw_directly(self, on: bool) -> None:
        """Draw without kept pictures for a while, as for a device of another resolution."""
        for layer in self._layers:
            layer.draw_directly(on)

    def set_frame(self, frame: int) -> None:
        """Move the play head."""
        if frame != self._frame:
            self._frame = frame
            self._place_head()

    def tell(self, at: QPointF | None, words: str) -> None:
        """Show words beside a place of the plot, or nothing."""
        if at is None or not words:
            QToolTip.hideText()
            return
        corner = self.viewport().mapToGlobal(at.toPoint()) + QPoint(10, 6)
        QToolTip.showText(corner, words, self)

    def _follow_range(self) -> None:
        self.plotItem.vb.setXRange(self.time_range.start, self.time_range.end, padding=0)
        self._place()

    def _place(self) -> None:
        area = self.area
        for layer in self._layers:
            layer.set_area(area)
        self.play_head.set_height(area.height())
        self._place_head()

    def _place_head(self) -> None:
        shown = self.time_range
        self.play_head.setVisible(shown.start <= self._frame <= shown.end)
        self.play_head.setPos(round(self.x_of(self._frame)), self.area.top())

    # -- mouse and keys

    def holds(self, _at: QPointF) -> bool:
        """Tell whether a press here waits for its release before the play head moves."""
        return False

    def _gesture_for(self, event: QMouseEvent) -> Gesture:
        at = event.position()
        if event.button() == Qt.MouseButton.MiddleButton:
            return Gesture.PAN
        if event.button() != Qt.MouseButton.LeftButton:
            return Gesture.NONE
        shift = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        inside = self.area.contains(at)
        if inside and (shift or (self._sweeps and not self._near_head(at))):
            return Gesture.SWEEP
        return Gesture.HELD if inside and self.holds(at) else Gesture.SCRUB

    def _near_head(self, at: QPointF) -> bool:
        return self.play_head.isVisible() and abs(at.x() - self.play_head.x()) <= _NEAR

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin a gesture."""
        self._pressed = self._last = event.position()
        self._gesture = self._gesture_for(event)
        if self._gesture is Gesture.SCRUB:
            self._scrub(event.position())
        event.accept()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Go on with a gesture, or hover."""
        at = event.position()
        moved = abs(at.x() - self._pressed.x()) + abs(at.y() - self._pressed.y()) > _STILL
        if self._gesture is Gesture.HELD and moved:
            self._gesture = Gesture.SCRUB
        if self._gesture is Gesture.SCRUB:
            self._scrub(at)
        elif self._gesture is Gesture.SWEEP and moved:
            self.swept.emit(self._pressed, at, False)
        elif self._gesture is Gesture.PAN:
            pixels = at.x() - self._last.x()
            self.time_range.pan(-pixels / max(self.area.width(), 1.0) * self.time_range.length)
        elif self._gesture is Gesture.NONE:
            self._show_cursor(at)
            self.hovered.emit(at)
        self._last = at
        event.accept()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End a gesture."""
        at, gesture = event.position(), self._gesture
        self._gesture = Gesture.NONE
        moved = abs(at.x() - self._pressed.x()) + abs(at.y() - self._pressed.y()) > _STILL
        if gesture is Gesture.HELD:
            self.clicked.emit(at)
        elif gesture is Gesture.SWEEP and moved:
            self.swept.emit(self._pressed, at, True)
        elif gesture is Gesture.SWEEP:
            self._scrub(at)
        event.accept()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Zoom to the selected flag."""
        if event.button() == Qt.MouseButton.LeftButton:
            self.focus_wanted.emit()
        event.accept()

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom about the cursor; sideways or with Shift: pan."""
        turn = event.angleDelta()
        shift = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        sideways = turn.x() if turn.x() else (turn.y() if shift else 0)
        if sideways:
            self.time_range.pan(-sideways / 120 * 0.1 * self.time_range.length)
        elif turn.y():
            about = self.frame_at(event.position().x())
            self.time_range.zoom(_NOTCH ** (turn.y() / 120), about)
        event.accept()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Home shows the whole take, Z zooms to the selected flag; the rest is left to the desk."""
        if event.key() == Qt.Key.Key_Home:
            self.time_range.whole()
        elif event.key() == Qt.Key.Key_Z and not event.modifiers():
            self.focus_wanted.emit()
        else:
            event.ignore()

    def leaveEvent(self, event: QEvent) -> None:
        """Say that the mouse left."""
        self.hovered.emit(None)
        super().leaveEvent(event)

    def _scrub(self, at: QPointF) -> None:
        area = self.area
        x = min(max(at.x(), area.left()), area.right())
        self.scrubbed.emit(self.whole_frame_at(x))

    def _show_cursor(self, at: QPointF) -> None:
        shape = Qt.CursorShape.ArrowCursor
        if self._near_head(at):
            shape = Qt.CursorShape.SizeHorCursor
        elif self.area.contains(at) and self.holds(at):
            shape = Qt.CursorShape.PointingHandCursor
        if self.viewport().cursor().shape() != shape:
            self.viewport().setCursor(QCursor(shape))


def _draw_ground(p: QPainter, area: QRectF) -> None:
    p.fillRect(area, QColor(themes.current().field))
