"""Dragging a place in the 3-D view: nearest handle, its depth, axis locks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QObject, QPointF, Qt
from PySide6.QtGui import QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QApplication, QWidget

from mocapstudio.gui.viewport.camera import Turntable
from mocapstudio.gui.viewport.picking import joint_at

Array = NDArray[np.float64]

_AXES = {Qt.Key.Key_X: 0, Qt.Key.Key_Y: 1, Qt.Key.Key_Z: 2}


class Handles(Protocol):
    """What can be dragged, and what comes of it."""

    def places(self) -> tuple[Sequence[str], Array]:
        """Names and (N, 3) places of the handles, the most wanted first."""

    def taken(self, name: str, alone: bool) -> bool:
        """A handle was taken hold of, `alone` where Ctrl was held; False refuses it."""

    def dragged(self, name: str, place: Array, lock: int | None, mouse: QPointF) -> None:
        """It was dragged to a place; `lock` is the axis (0..2) along which alone it may go."""

    def dropped(self, name: str) -> None:
        """It was let go."""

    def cancelled(self, name: str) -> None:
        """It was given up: everything as before."""


@dataclass
class _Held:
    name: str
    begin: Array
    pressed: QPointF
    lock: int | None = None
    moved: bool = False
    last: QPointF = field(default_factory=QPointF)


class Dragging(QObject):
    """An event filter before the camera's: a press within 12 px of a handle drags it.

    With Ctrl it goes alone. X, Y and Z lock an axis while the button is held, the same key frees
    it; Esc gives up.

    Parameters
    ----------
    canvas
        The widget to watch.
    camera
        Through which it is seen.
    handles
        What can be dragged.
    stir
        Called when the picture has changed.
    """

    def __init__(
        self, canvas: QWidget, camera: Turntable, handles: Handles, stir: Callable[[], None]
    ) -> None:
        super().__init__(canvas)
        self._canvas, self._camera = canvas, camera
        self._handles, self._stir = handles, stir
        self._held: _Held | None = None
        canvas.installEventFilter(self)

    @property
    def lock(self) -> int | None:
        """Axis along which alone the held place may go."""
        return None if self._held is None else self._held.lock

    @property
    def holding(self) -> str | None:
        """Name of the handle that is held."""
        return None if self._held is None else self._held.name

    def handle_at(self, at: QPointF) -> str | None:
        """Return the name of the handle under the mouse, or None."""
        names, places = self._handles.places()
        if not len(names):
            return None
        found = joint_at(self._camera, places, (at.x(), at.y()), self._size())
        return None if found is None else names[found]

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Take the mouse while a handle is held, and the keys that lock it."""
        kind = event.type()
        if watched is self._canvas and isinstance(event, QMouseEvent):
            if kind == QEvent.Type.MouseButtonPress:
                return self._press(event)
            if kind == QEvent.Type.MouseMove and self._held is not None:
                self._move(event.position())
                return True
            if kind == QEvent.Type.MouseButtonRelease and self._held is not None:
                return self._release(event)
        if self._held is not None and isinstance(event, QKeyEvent):
            return self._key(event)
        return False

    def _press(self, event: QMouseEvent) -> bool:
        alone = event.modifiers() == Qt.KeyboardModifier.ControlModifier
        if event.button() != Qt.MouseButton.LeftButton or (event.modifiers() and not alone):
            return self._held is not None
        name = self.handle_at(event.position())
        if name is None or not self._handles.taken(name, alone):
            return False
        names, places = self._handles.places()
        at = event.position()
        self._held = _Held(name, places[list(names).index(name)].copy(), at, last=at)
        application = QApplication.instance()
        assert application is not None
        # Keys go to whatever has the focus.
        application.installEventFilter(self)
        self._stir()
        return True

    def _move(self, at: QPointF) -> None:
        held = self._held
        assert held is not None
        way = at - held.pressed
        held.moved |= abs(way.x()) + abs(way.y()) >= 3.0
        held.last = at
        if held.moved:
            self._handles.dragged(held.name, self._place(at), held.lock, at)
            self._stir()

    def _place(self, at: QPointF) -> Array:
        """(3,) metres: where the held place is, at its own depth or along the locked axis."""
        held = self._held
        assert held is not None
        height = self._size()[1]
        depth = float((self._camera.position() - held.begin) @ self._camera.basis()[2])
        pixel = self._camera.metres_per_pixel(height) * depth / self._camera.distance
        right, up, _ = self._camera.basis()
        way = at - held.pressed
        free = pixel * (way.x() * right - way.y() * up)
        if held.lock is None:
            return np.asarray(held.begin + free)
        axis = np.zeros(3)
        axis[held.lock] = 1.0
        seen = axis - (axis @ self._camera.basis()[2]) * self._camera.basis()[2]
        # Along an axis that points at the eye the mouse says nothing.
        share = float(free @ seen) / max(float(seen @ seen), 0.02)
        return np.asarray(held.begin + share * axis)

    def _release(self, event: QMouseEvent) -> bool:
        if event.button() != Qt.MouseButton.LeftButton:
            return True
        held = self._end()
        if held.moved:
            self._handles.dropped(held.name)
        else:
            self._handles.cancelled(held.name)
        self._stir()
        return True

    def _key(self, event: QKeyEvent) -> bool:
        key = Qt.Key(event.key())
        if key not in _AXES and key != Qt.Key.Key_Escape:
            return False
        event.accept()
        if event.type() == QEvent.Type.KeyPress and not event.isAutoRepeat():
            assert self._held is not None
            if key == Qt.Key.Key_Escape:
                self._handles.cancelled(self._end().name)
                self._stir()
            else:
                axis = _AXES[key]
                self._held.lock = None if self._held.lock == axis else axis
                self._move(self._held.last)
        return True

    def _end(self) -> _Held:
        held = self._held
        assert held is not None
        self._held = None
        application = QApplication.instance()
        assert application is not None
        application.removeEventFilter(self)
        return held

    def _size(self) -> tuple[int, int]:
        return self._canvas.width(), max(self._canvas.height(), 1)
