"""The 3-D view of the desk: performer, ghosts, partners, floor, trails."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QCloseEvent, QKeyEvent, QShowEvent
from PySide6.QtWidgets import QGridLayout, QLabel, QToolTip, QWidget

from mocapstudio.gui import theme, wording
from mocapstudio.gui.document import DocumentBridge, UiState
from mocapstudio.gui.viewport import picking
from mocapstudio.gui.viewport.camera import Turntable
from mocapstudio.gui.viewport.canvas import Canvas
from mocapstudio.gui.viewport.cast import Part, Role, Stage
from mocapstudio.gui.viewport.controls import Controls
from mocapstudio.gui.viewport.mapped import JointValues
from mocapstudio.gui.viewport.neighbours import NeighbourProposals
from mocapstudio.gui.viewport.opengl import opengl_problem
from mocapstudio.gui.viewport.overlay import Bar, Caption, Legend
from mocapstudio.gui.viewport.palette import Colour, palette
from mocapstudio.gui.viewport.scene3d import Look, Scene3D
from mocapstudio.gui.viewport.switches import Switches
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.topology import topology
from mocapstudio.review.state import DocumentState

_MOST_TRAILS = 6
# How much of the body shows around a framed joint, as a share of the performer's height.
_CLOSE = 0.16


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
        self.camera = Turntable()
        self._stage = Stage()
        self._neighbours = NeighbourProposals(self)
        self._neighbours_shown = False
        self._roles: tuple[Role, ...] = ()
        self._values: JointValues | None = None
        self._cast_again = self._frame_again = True
        self._anchor: NDArray[np.float64] | None = None
        self._palette = palette(theme.current())
        self.switches = Switches(
            self,
            look=self.set_view,
            frame=lambda: self.frame_joint(None),
            follow=self.set_follow,
            ghosts=self.set_ghosts,
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

    def set_view(self, name: str) -> None:
        """Look from ``"front"``, ``"side"``, ``"top"`` or ``"three-quarter"`` of the performer."""
        heading = self._roles[0].motion.heading(self._bridge.state.frame) if self._roles else 0.0
        self.camera.look(name, heading)
        self._stir()

    def frame_joint(self, name: str | None = None) -> None:
        """Bring a joint close; None for the selected joints, or the body where there are none."""
        if not self._roles:
            return
        skeleton = self._roles[0].motion.take.skeleton
        joints = self._selected() if name is None else (skeleton.index[name],)
        points = self._points()
        if joints:
            room = _CLOSE * self._stature()
            near = points[list(joints)]
            points = np.concatenate([near - room, near + room])
        self.camera.frame(points.astype(float), self._aspect())
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
        before, now = old.scene.performers, new.scene.performers
        if not any(one in now for one in before):
            self._frame_again = True
        self._cast_again |= (
            old.scene is not new.scene
            or old.active != new.active
            or old.sitting is not new.sitting
            or old.analyses is not new.analyses
            or old.proposals != new.proposals
            or old.selection.flag != new.selection.flag
        )
        self._refresh()

    def _show_ui(self, old: UiState, new: UiState) -> None:
        self.switches.follow.setChecked(new.follow)
        self.switches.ghosts.setChecked(new.ghosts)
        self._cast_again |= old.ghosts != new.ghosts
        if new.follow and not old.follow and self._roles:
            self.camera.focal = self._roles[0].motion.followed[self._bridge.state.frame].copy()
            self._anchor = None
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
        if take is None or not self._roles:
            self._stir()
            return
        number = wording.number(take, state.frame)
        self._caption.tell(take.name, f"frame {number} · {wording.seconds(take, state.frame)}")
        self._go_along(state.frame)
        self._stir()

    def _cast(self, state: DocumentState) -> None:
        wanted = state.selected if self._neighbours_shown else None
        self._neighbours.ask(state.analysis, None if wanted is None else wanted.flag)
        if state.take is None:
            self._roles, self._values, self._anchor = (), None, None
        else:
            result = self._bridge.document.result(state.active)
            self._roles = self._stage.cast(
                state, result, ghosts=self._bridge.ui.ghosts, neighbours=self._neighbours.ready
            )
            mapped = None if state.analysis is None else state.analysis.map
            skeleton = result.skeleton
            self._values = None if mapped is None else JointValues(mapped, skeleton)
        if self._scene is not None:
            self._scene.cast(self._roles, self._palette)
            self._legend.tell(self._legend_lines(), f"{self._scene.step:g} m")

    def _legend_lines(self) -> list[tuple[str, Colour]]:
        colours = {
            Part.ORIGINAL: self._palette.original,
            Part.PROPOSAL: self._palette.proposal,
            Part.NEIGHBOUR: self._palette.neighbour,
            Part.PARTNER: self._palette.partner,
        }
        lines = {role.name: colours[role.part] for role in self._roles if role.part in colours}
        return list(lines.items())

    def _go_along(self, frame: int) -> None:
        anchor = self._roles[0].motion.followed[frame]
        if self._bridge.ui.follow and self._anchor is not None:
            self.camera.focal = self.camera.focal + (anchor - self._anchor)
        self._anchor = anchor

    # The picture

    def _prepare(self) -> None:
        """Put the scene together for one paint."""
        if self._scene is None:
            return
        if self._roles:
            state = self._bridge.state
            if self._frame_again:
                self._frame_again = False
                self.camera.look("three-quarter", self._roles[0].motion.heading(state.frame))
                self.camera.frame(self._points().astype(float), self._aspect(), margin=1.35)
            values = None if self._values is None else self._values.at(state.frame)
            selected = self._selected()
            trails = self._bridge.ui.trails and len(selected) <= _MOST_TRAILS
            pixel = self.camera.metres_per_pixel(self.height())
            look = Look(state.frame, values, state.threshold, selected, trails, pixel)
            self._scene.place(look, self.camera)
        self._scene.aim(self.camera)

    def _stir(self) -> None:
        if self._canvas is not None:
            self._canvas.stir()

    def _points(self) -> NDArray[np.float32]:
        return self._roles[0].motion.points(self._bridge.state.frame)

    def _selected(self) -> tuple[int, ...]:
        if not self._roles:
            return ()
        skeleton: Skeleton = self._roles[0].motion.take.skeleton
        hips = topology(skeleton).hips
        names = self._bridge.state.selection.joints
        found = {hips if name in ROOT_ROWS else skeleton.index.get(name, -1) for name in names}
        return tuple(sorted(found - {-1}))

    def _stature(self) -> float:
        return 1.7 if self._scene is None else self._scene.stature

    def _aspect(self) -> float:
        return self.width() / max(self.height(), 1)

    # The mouse

    def _joint_at(self, at: QPointF) -> str | None:
        if not self._roles or self._canvas is None:
            return None
        skeleton = self._roles[0].motion.take.skeleton
        size = (self._canvas.width(), self._canvas.height())
        joints = self._points()[: len(skeleton)]
        found = picking.joint_at(self.camera, joints, (at.x(), at.y()), size)
        return None if found is None else skeleton.names[found]

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
        text = name
        if self._values is not None:
            joint = self._roles[0].motion.take.skeleton.index[name]
            value = float(self._values.at(self._bridge.state.frame)[joint])
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
            [*parts.views, None, parts.frame, parts.follow, parts.ghosts, parts.neighbours],
        )
        grid.addWidget(self._caption, 0, 0, top | left)
        grid.addWidget(self._legend, 0, 0, bottom | left)
        if problem is None:
            corner = QWidget(self)
            inner = QGridLayout(corner)
            inner.setContentsMargins(0, 8, 8, 0)
            inner.addWidget(self._bar)
            grid.addWidget(corner, 0, 0, top | right)

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
