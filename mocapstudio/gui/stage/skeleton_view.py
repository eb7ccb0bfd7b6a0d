"""One viewport of a stage: a canvas with its scene, a caption and a legend."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import QPointF, Qt, Signal
from PySide6.QtGui import QCloseEvent, QResizeEvent, QShowEvent
from PySide6.QtWidgets import QGridLayout, QLabel, QWidget

from mocapstudio.gui.stage.scene import StageScene
from mocapstudio.gui.viewport.camera import Turntable
from mocapstudio.gui.viewport.canvas import Canvas
from mocapstudio.gui.viewport.controls import Controls
from mocapstudio.gui.viewport.opengl import opengl_problem
from mocapstudio.gui.viewport.overlay import Caption, Legend
from mocapstudio.gui.viewport.palette import Colour


class SkeletonView(QWidget):
    """Draws what it is told to just before it paints.

    Parameters
    ----------
    camera
        Shared by all viewports: turning one turns the others.
    prepare
        Called before each paint with this view.
    """

    moved = Signal()
    """The camera was moved by hand."""

    clicked = Signal(QPointF)
    """Pixels of the picture."""

    hovered = Signal(QPointF)
    """Pixels of the picture; the mouse moved with no button held."""

    shown = Signal()
    """It came into sight."""

    def __init__(self, camera: Turntable, prepare: Callable[[SkeletonView], None]) -> None:
        super().__init__()
        self.canvas: Canvas | None = None
        self.scene: StageScene | None = None
        self.caption, self._legend = Caption(self), Legend(self)
        self._spare = 0
        self.setMinimumSize(200, 140)
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        problem = opengl_problem()
        if problem is None:
            self.canvas = Canvas(self, lambda: prepare(self))
            self.scene = StageScene(self.canvas.renderer)
            controls = Controls(self.canvas, camera)
            controls.moved.connect(self.moved)
            controls.clicked.connect(lambda at, _extend: self.clicked.emit(at))
            controls.hovered.connect(self.hovered)
            grid.addWidget(self.canvas, 0, 0)
        else:
            message = QLabel(f"OpenGL is not available: {problem}.")
            message.setProperty("role", "hint")
            message.setAlignment(Qt.AlignmentFlag.AlignCenter)
            message.setWordWrap(True)
            grid.addWidget(message, 0, 0)
        top, left = Qt.AlignmentFlag.AlignTop, Qt.AlignmentFlag.AlignLeft
        grid.addWidget(self.caption, 0, 0, top | left)
        grid.addWidget(self._legend, 0, 0, Qt.AlignmentFlag.AlignBottom | left)
        # They were made before the canvas, which would lie over them.
        self.caption.raise_()
        self._legend.raise_()

    @property
    def size_in_pixels(self) -> tuple[int, int]:
        """Width and height of the picture."""
        return self.width(), max(self.height(), 1)

    def spare(self, pixels: int) -> None:
        """Keep so many pixels right of the caption free for buttons."""
        self._spare = pixels
        self.caption.fit(self.width() - pixels)

    def tell(self, lines: Sequence[tuple[str, Colour]], scale: str) -> None:
        """Show whose colour is which, and the size of the floor's squares."""
        self._legend.tell(lines, scale)

    def stir(self) -> None:
        """Say that the scene changed."""
        if self.canvas is not None:
            self.canvas.stir()

    def settle(self) -> None:
        """Paint with smooth edges now."""
        if self.canvas is not None:
            self.canvas.settle()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the caption clear of the buttons."""
        super().resizeEvent(event)
        self.caption.fit(self.width() - self._spare)

    def showEvent(self, event: QShowEvent) -> None:
        """Catch up with what happened while out of sight."""
        super().showEvent(event)
        self.shown.emit()

    def closeEvent(self, event: QCloseEvent) -> None:
        """Give back what OpenGL holds."""
        if self.canvas is not None:
            self.canvas.close()
        super().closeEvent(event)
