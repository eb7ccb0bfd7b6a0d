"""The widget that VTK draws into: one render for each paint, smooth edges at rest."""

from __future__ import annotations

import atexit
import weakref
from collections.abc import Callable
from functools import partial

import shiboken6
from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QCloseEvent, QHideEvent, QOpenGLContext, QShowEvent
from PySide6.QtWidgets import QWidget
from pyvistaqt import QtInteractor

# A program that ends with a window open takes its OpenGL down before the window hears of it.
_open: weakref.WeakSet[Canvas] = weakref.WeakSet()

_REST = 220
_SMOOTH = 4


class Canvas(QtInteractor):
    """A QtInteractor that asks for its scene just before it paints.

    However often the scene is said to have changed, it is put together once a paint, and never
    while the widget is out of sight.

    Parameters
    ----------
    parent
        Qt's parent.
    prepare
        Called before each paint.
    """

    def __init__(self, parent: QWidget, prepare: Callable[[], None]) -> None:
        self._prepare: Callable[[], None] | None = None
        super().__init__(parent, auto_update=False, multi_samples=0, lighting="none")
        self._prepare = prepare
        # Files dropped here are the desk's affair; pyvista would load them as meshes.
        self.setAcceptDrops(False)
        _open.add(self)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._moving = QTimer(self)
        self._moving.setSingleShot(True)
        self._moving.setInterval(_REST)
        self._moving.timeout.connect(self.settle)

    def stir(self) -> None:
        """Say that the scene changed: it is painted soon, with smooth edges once it rests."""
        if self.ren_win is None:
            return
        if self.ren_win.GetMultiSamples():
            self.ren_win.SetMultiSamples(0)
        self._moving.start()
        self.update()

    def settle(self) -> None:
        """Paint with smooth edges now."""
        if self.ren_win is not None and self.isVisible():
            self.ren_win.SetMultiSamples(_SMOOTH)
            self.update()

    def paintGL(self) -> None:
        """Put the scene together and render it."""
        if self._prepare is not None:
            try:
                self._prepare()
            except Exception as error:
                # Qt would crash if it unwound through its paint; so it is raised right after.
                QTimer.singleShot(0, partial(_raise, error))
        super().paintGL()  # type: ignore[no-untyped-call]

    def hideEvent(self, event: QHideEvent) -> None:
        """Release OpenGL while its context still exists.

        A window that closes hides its children, but tells them nothing more: what VTK would free
        later, it would free in the context of whichever window is then current.
        """
        super().hideEvent(event)
        if not event.spontaneous():
            self.release()

    def release(self) -> None:
        """Give back what OpenGL holds; showing the widget again brings it back."""
        if self._ctx is None or self.ren_win is None:
            return
        if shiboken6.isValid(self._moving):
            self._moving.stop()
        if shiboken6.isValid(self._ctx):
            self._ctx.makeCurrent(self._surface)
        else:
            # The window is being deleted, and its context frees everything by itself. VTK must
            # not free the same numbers in the context of another window.
            _let_go()
        self.ren_win.Finalize()
        self.ren_win.SetReadyForRendering(False)
        _let_go()
        self._forget_context()  # type: ignore[no-untyped-call]

    def showEvent(self, event: QShowEvent) -> None:
        """Begin again in the widget's context after `hideEvent`."""
        super().showEvent(event)
        if self._ctx is None and self.context() is not None and self.ren_win is not None:
            self.makeCurrent()
            self.initializeGL()  # type: ignore[no-untyped-call]
            self.doneCurrent()

    def closeEvent(self, event: QCloseEvent) -> None:
        """Stop what would paint after the window is gone."""
        self._moving.stop()
        self._prepare = None
        super().closeEvent(event)


@atexit.register
def _release_all() -> None:
    for canvas in list(_open):
        if shiboken6.isValid(canvas):
            canvas.release()


def _let_go() -> None:
    current = QOpenGLContext.currentContext()
    if current is not None:
        current.doneCurrent()


def _raise(error: Exception) -> None:
    raise error
