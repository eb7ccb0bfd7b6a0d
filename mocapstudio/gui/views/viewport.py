"""The 3-D view of the desk: performer, ghosts, partners, floor, trails."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QCloseEvent, QKeyEvent, QResizeEvent, QShowEvent
from PySide6.QtWidgets import QGridLayout, QLabel, QToolTip, QWidget

from mocapstudio.gui import theme, wording
from mocapstudio.gui.document import DocumentBridge, UiState, only_frame_differs
from mocapstudio.gui.viewport.camera import Turntable
from mocapstudio.gui.viewport.canvas import Canvas
from mocapstudio.gui.viewport.controls import Controls
from mocapstudio.gui.viewport.director import Director
from mocapstudio.gui.viewport.neighbours import NeighbourProposals
from mocapstudio.gui.viewport.opengl import opengl_problem
from mocapstudio.gui.viewport.overlay import Bar, Caption, Legend
from mocapstudio.gui.viewport.palette import palette
from mocapstudio.gui.viewport.scene3d import Scene3D
from mocapstudio.gui.viewport.switches import Switches
from mocapstudio.motion.errors import FileError
from mocapstudio.review.state import DocumentState


class Viewport(QWidget):
    """Shows the active performer at the current frame, and selects joints by click.

    Left drag orbits, middle drag or Shift and left drag pans, wheel and right drag zoom; a click
    selects a joint, with Shift one more; a double click frames it. Without OpenGL a message stands
    in its place, and every method still works.

    Parameters
    ----------
    bridge
        To the document.
    parent
        Qt's parent; it must not be a native window of its own, or the picture stays black.
    """

    def __init__(self, bridge: DocumentBridge, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._bridge = bridge
        self.director = Director()
        self._neighbours = NeighbourProposals(self)
        self._neighbours_shown = False
        self._cast_again = self._frame_again = True
        self._palette = palette(theme.current())
        self.switches = Switches(
            self,
            look=self.set_view,
            frame=lambda: self.frame_joint(None),
            follow=self.set_follow,
            ghosts=self.set_ghosts,
            onion=lambda on: bridge.set_ui(onion=on),
            neighbours=self.set_neighbours_shown,
        )
        self._canvas: Canvas | None = None
        self._scene: Scene3D | None = None
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self.setMinimumSize(240, 180)
        self._lay_out()
        bridge.changed.connect(self._show_state)
        bridge.ui_changed.connect(self._show_ui)
        self._neighbours.changed.connect(self._recast)
        self._show_ui(bridge.ui, bridge.ui)

    # What the desk may ask for

    @property
    def camera(self) -> Turntable:
        """Where the scene is seen from."""
        return self.director.camera

    def set_view(self, name: str) -> None:
        """Look from ``"front"``, ``"side"``, ``"top"`` or ``"three-quarter"`` of the performer."""
        self.director.view(name, self._bridge.state.frame)
        self._stir()

    def frame_joint(self, name: str | None = None) -> None:
        """Bring a joint close; None for the selected joints, or the body where there are none."""
        state = self._bridge.state
        if self.director.roles:
            one = None if name is None else (self.director.skeleton.index[name],)
            joints = self.director.selected(state) if one is None else one
            self.director.close_in(joints, state.frame, self._aspect())
            self._stir()

    def set_follow(self, on: bool) -> None:
        """Let the camera go along with the hips, or stay where it is."""
        self._bridge.set_ui(follow=on)

    def set_ghosts(self, on: bool) -> None:
        """Show proposal and original beside the result."""
        self._bridge.set_ui(ghosts=on)

    def set_neighbours_shown(self, on: bool) -> None:
        """Show what each neighbour of the selected flag would make of it."""
        self._neighbours_shown = on
        self.switches.neighbours.setChecked(on)
        self._recast()

    def screenshot(self, path: Path | str) -> None:
        """Write what is seen as a picture file.

        Raises
        ------
        FileError
            If the file cannot be written.
        """
        if self._canvas is not None:
            self._canvas.settle()
        if not self.grab().save(str(path)):
            raise FileError(path, "the picture cannot be written")

    # What the document says

    def _show_state(self, old: DocumentState, new: DocumentState) -> None:
        if not only_frame_differs(old, new):
            before, now = old.scene.performers, new.scene.performers
            self._frame_again |= not any(one in now for one in before)
            self._cast_again = True
        self._refresh()

    def _show_ui(self, old: UiState, new: UiState) -> None:
        self.switches.follow.setChecked(new.follow)
        self.switches.ghosts.setChecked(new.ghosts)
        self.switches.onion.setChecked(new.onion)
        self._cast_again |= (old.ghosts, old.onion) != (new.ghosts, new.onion)
        if new.follow and not old.follow:
            self.director.face(self._bridge.state.frame)
        self._refresh()

    def _recast(self) -> None:
        self._cast_again = True
        self._refresh()

    def _refresh(self) -> None:
        if not self.isVisible():
            return
        state = self._bridge.state
        if self._cast_again:
            self._cast_again = False
            self._cast(state)
        take = state.take
        self._caption.setVisible(take is not None)
        self._legend.setVisible(take is not None)
        if take is not None:
            number, time = wording.number(take, state.frame), wording.seconds(take, state.frame)
            self._caption.tell(take.name, f"frame {number} · {time}")
            self.director.go_along(state.frame, self._bridge.ui.follow)
        self._stir()

    def _cast(self, state: DocumentState) -> None:
        wanted = state.selected if self._neighbours_shown else None
        self._neighbours.ask(state.analysis, None if wanted is None else wanted.flag)
        result = None if state.take is None else self._bridge.document.result(state.active)
        ui = self._bridge.ui
        self.director.cast(
            state, result, ghosts=ui.ghosts, neighbours=self._neighbours.ready, onion=ui.onion
        )
        if self._scene is not None:
            self._scene.cast(self.director.roles, self._palette)
            self._legend.tell(self.director.legend(self._palette), f"{self._scene.step:g} m")

    # The picture

    def _prepare(self) -> None:
        """Put the scene together for one paint."""
        if self._scene is None:
            return
        if self.director.roles:
            state, ui = self._bridge.state, self._bridge.ui
            if self._frame_again:
                self._frame_again = False
                self.director.introduce(state.frame, self._aspect())
            look = self.director.look(state, trails=ui.trails, height=self.height())
            self._scene.place(look, self.camera)
        self._scene.aim(self.camera)

    def _stir(self) -> None:
        if self._canvas is not None:
            self._canvas.stir()

    def _aspect(self) -> float:
        return self.width() / max(self.height(), 1)

    # The mouse

    def _joint_at(self, at: QPointF) -> str | None:
        if self._canvas is None:
            return None
        size = (self._canvas.width(), self._canvas.height())
        return self.director.joint_at(self._bridge.state.frame, (at.x(), at.y()), size)

    def _click(self, at: QPointF, extend: bool) -> None:
        name = self._joint_at(at)
        if name is None:
            return
        joints = self._bridge.state.selection.joints
        self._bridge.document.select(joints=joints ^ {name} if extend else {name})

    def _double_click(self, at: QPointF) -> None:
        self.frame_joint(self._joint_at(at))

    def _hover(self, at: QPointF) -> None:
        name = self._joint_at(at)
        assert self._canvas is not None
        if name is None:
            QToolTip.hideText()
            self._canvas.unsetCursor()
            return
        value = self.director.value(name, self._bridge.state.frame)
        text = name
        if value is not None:
            text += " · not analysed" if np.isnan(value) else f" · {value:.2f}"
        self._canvas.setCursor(Qt.CursorShape.PointingHandCursor)
        QToolTip.showText(self._canvas.mapToGlobal(at.toPoint()), text, self._canvas)

    # Qt

    def _lay_out(self) -> None:
        problem = opengl_problem()
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        top, left = Qt.AlignmentFlag.AlignTop, Qt.AlignmentFlag.AlignLeft
        right, bottom = Qt.AlignmentFlag.AlignRight, Qt.AlignmentFlag.AlignBottom
        if problem is None:
            self._canvas = Canvas(self, self._prepare)
            self._scene = Scene3D(self._canvas.renderer)
            controls = Controls(self._canvas, self.camera)
            controls.moved.connect(self._stir)
            controls.clicked.connect(self._click)
            controls.double_clicked.connect(self._double_click)
            controls.hovered.connect(self._hover)
            grid.addWidget(self._canvas, 0, 0)
        else:
            grid.addWidget(_message(problem), 0, 0)
        self._caption, self._legend = Caption(self), Legend(self)
        parts = self.switches
        self._bar = Bar(
            self,
            [
                *parts.views,
                None,
                parts.frame,
                parts.follow,
                parts.ghosts,
                parts.onion,
                parts.neighbours,
            ],
        )
        grid.addWidget(self._caption, 0, 0, top | left)
        grid.addWidget(self._legend, 0, 0, bottom | left)
        if problem is None:
            corner = QWidget(self)
            inner = QGridLayout(corner)
            inner.setContentsMargins(0, 8, 8, 0)
            inner.addWidget(self._bar)
            grid.addWidget(corner, 0, 0, top | right)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the caption clear of the buttons."""
        super().resizeEvent(event)
        self._caption.fit(self.width() - self._bar.sizeHint().width() - 16)

    def showEvent(self, event: QShowEvent) -> None:
        """Catch up with what happened while out of sight."""
        super().showEvent(event)
        self._refresh()

    def changeEvent(self, event: QEvent) -> None:
        """Take on another theme."""
        super().changeEvent(event)
        restyled = event.type() in (QEvent.Type.PaletteChange, QEvent.Type.StyleChange)
        if restyled and theme.current() is not self._palette.theme:
            self._palette = palette(theme.current())
            self._caption.restyle()
            self._bar.restyle()
            self.switches.recolour()
            self._recast()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Frame the joint on F, where the desk has no such command of its own."""
        if event.key() == Qt.Key.Key_F and not event.modifiers():
            self.frame_joint(None)
        else:
            super().keyPressEvent(event)

    def closeEvent(self, event: QCloseEvent) -> None:
        """Give back what OpenGL holds."""
        if self._canvas is not None:
            self._canvas.close()
        super().closeEvent(event)


def _message(problem: str) -> QLabel:
    label = QLabel(
        f"OpenGL is not available: {problem}.\n\n"
        "Run “mocapstudio doctor” to see what is missing.\n"
        "Everything else of the desk works without it."
    )
    label.setObjectName("viewport-message")
    label.setProperty("role", "hint")
    label.setAlignment(Qt.AlignmentFlag.AlignCenter)
    label.setWordWrap(True)
    return label
