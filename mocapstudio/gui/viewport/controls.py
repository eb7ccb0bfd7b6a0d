"""Mouse in the 3-D view: a turntable, and clicks on joints. VTK sees none of it."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QEvent, QObject, QPointF, Qt, Signal
from PySide6.QtGui import QMouseEvent, QNativeGestureEvent, QWheelEvent
from PySide6.QtWidgets import QWidget

from mocapstudio.gui.viewport.camera import Turntable

_ORBIT = 0.0075
_DRAG = 4.0
_NOTCH = 120.0
_CLOSER = 0.86
_DRAG_ZOOM = 0.006


class Controls(QObject):
    """An event filter that turns the mouse into camera moves, clicks and hovering.

    Left drag (or Alt and left drag) orbits, middle drag or Shift and left drag pans, right drag
    and the wheel zoom. What does not travel four pixels is a click.

    Parameters
    ----------
    canvas
        The widget to watch.
    camera
        The camera to move.
    """

    moved = Signal()
    """The camera was moved by hand."""

    clicked = Signal(QPointF, bool)
    """Pixels of the widget, and whether Shift was held."""

    double_clicked = Signal(QPointF)
    """Pixels of the widget."""

    hovered = Signal(QPointF)
    """Pixels of the widget; the mouse moved with no button held."""

    def __init__(self, canvas: QWidget, camera: Turntable) -> None:
        super().__init__(canvas)
        self._canvas, self._camera = canvas, camera
        self._button: Qt.MouseButton | None = None
        self._pressed, self._last = QPointF(), QPointF()
        self._dragging = False
        self._handlers: dict[QEvent.Type, Callable[..., None]] = {
            QEvent.Type.MouseButtonPress: self._press,
            QEvent.Type.MouseButtonRelease: self._release,
            QEvent.Type.MouseButtonDblClick: self._double,
            QEvent.Type.MouseMove: self._move,
            QEvent.Type.Wheel: self._wheel,
            QEvent.Type.NativeGesture: self._pinch,
        }
        canvas.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Keep the mouse from VTK, and keys too: those belong to the desk."""
        handler = self._handlers.get(event.type())
        if handler is not None:
            handler(event)
            return True
        if event.type() in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease):
            event.ignore()
            return True
        return event.type() in (QEvent.Type.Enter, QEvent.Type.Leave)

    def _press(self, event: QMouseEvent) -> None:
        if self._button is not None:
            return
        self._button = event.button()
        self._pressed = self._last = event.position()
        self._dragging = False

    def _move(self, event: QMouseEvent) -> None:
        here = event.position()
        if self._button is None:
            self.hovered.emit(here)
            return
        way = here - self._pressed
        if not self._dragging and abs(way.x()) + abs(way.y()) < _DRAG:
            return
        self._dragging = True
        step, self._last = here - self._last, here
        self._drag(step.x(), step.y(), event.modifiers())
        self.moved.emit()

    def _drag(self, right: float, down: float, modifiers: Qt.KeyboardModifier) -> None:
        shifted = bool(modifiers & Qt.KeyboardModifier.ShiftModifier)
        if self._button == Qt.MouseButton.MiddleButton or (
            self._button == Qt.MouseButton.LeftButton and shifted
        ):
            self._camera.pan(right, -down, self._canvas.height())
        elif self._button == Qt.MouseButton.RightButton:
            self._camera.zoom(1.0 + _DRAG_ZOOM * down, self._at(self._pressed), self._size())
        else:
            self._camera.orbit(_ORBIT * right, -_ORBIT * down)

    def _release(self, event: QMouseEvent) -> None:
        if event.button() != self._button:
            return
        self._button = None
        if not self._dragging and event.button() == Qt.MouseButton.LeftButton:
            extend = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
            self.clicked.emit(event.position(), extend)

    def _double(self, event: QMouseEvent) -> None:
        # Its release must not count as one more click.
        self._button, self._dragging = event.button(), True
        self._pressed = self._last = event.position()
        if event.button() == Qt.MouseButton.LeftButton:
            self.double_clicked.emit(event.position())

    def _wheel(self, event: QWheelEvent) -> None:
        notches = event.angleDelta().y() / _NOTCH
        if notches:
            self._camera.zoom(_CLOSER**notches, self._at(event.position()), self._size())
            self.moved.emit()
        event.accept()

    def _pinch(self, event: QNativeGestureEvent) -> None:
        if event.gestureType() == Qt.NativeGestureType.ZoomNativeGesture:
            factor = 1.0 / max(1.0 + event.value(), 0.1)
            self._camera.zoom(factor, self._at(event.position()), self._size())
            self.moved.emit()

    def _size(self) -> tuple[int, int]:
        return self._canvas.width(), self._canvas.height()

    @staticmethod
    def _at(place: QPointF) -> tuple[float, float]:
        return place.x(), place.y()
