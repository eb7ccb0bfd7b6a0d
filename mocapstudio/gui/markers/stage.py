"""The viewport of the workspace: markers and the lines between them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QAction, QShowEvent
from PySide6.QtWidgets import QGridLayout, QToolTip, QWidget

from mocapstudio.gui import theme, wording
from mocapstudio.gui.markers.bridge import MarkersBridge, MarkersShown
from mocapstudio.gui.stage.actors import MarkerActor
from mocapstudio.gui.stage.marker_bones import guess_bones
from mocapstudio.gui.stage.scene import Pose
from mocapstudio.gui.stage.skeleton_view import SkeletonView
from mocapstudio.gui.viewport import picking
from mocapstudio.gui.viewport.camera import Turntable
from mocapstudio.gui.viewport.overlay import Bar
from mocapstudio.gui.viewport.palette import palette, rgb
from mocapstudio.gui.viewport.solids import FINE
from mocapstudio.motion.markers import MarkerTake

_ROOM = 1.35
_TRAIL_STEPS = 16
_TRAIL = 0.5


class MarkersStage(QWidget):
    """Shows the markers at the current frame, and chooses one by a click.

    What is missing is drawn small and faint on its way, what was filled in the colour of results.

    Parameters
    ----------
    bridge
        What is shown and chosen.
    buttons
        What stands in the corner.
    """

    def __init__(self, bridge: MarkersBridge, buttons: Sequence[QAction | None]) -> None:
        super().__init__()
        self.setObjectName("markers-stage")
        self._bridge = bridge
        self._palette = palette(theme.current())
        self._actor: MarkerActor | None = None
        self._bones: tuple[tuple[int, int], ...] = ()
        self._source: MarkerTake | None = None
        self._frame_again = True
        self._anchor: NDArray[np.float64] | None = None
        self.camera = Turntable()
        self.view = SkeletonView(self.camera, lambda _view: self._prepare())
        self.view.setObjectName("markers-viewport")
        self._lay_out(buttons)
        self.view.moved.connect(self.view.stir)
        self.view.clicked.connect(self._click)
        self.view.hovered.connect(self._hover)
        bridge.changed.connect(self._follow)
        bridge.desk.ui_changed.connect(lambda _old, _new: self.view.stir())

    def frame_all(self) -> None:
        """Bring all markers into sight again."""
        self._frame_again = True
        self.view.stir()

    def pixel_of(self, label: str) -> QPointF | None:
        """Where a marker is in the picture now, or None where it is not in sight."""
        actor, shown = self._actor, self._bridge.shown
        if actor is None:
            return None
        at = actor.points(shown.frame)[actor.names.index(label)]
        pixels, _ = self.camera.project(np.asarray(at)[None], self.view.size_in_pixels)
        x, y = pixels[0]
        return None if np.isnan(x) else QPointF(float(x), float(y))

    def _lay_out(self, buttons: Sequence[QAction | None]) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.addWidget(self.view, 0, 0)
        self._bar = Bar(self, buttons)
        corner = QWidget()
        inner = QGridLayout(corner)
        inner.setContentsMargins(0, 8, 8, 0)
        inner.addWidget(self._bar)
        top, right = Qt.AlignmentFlag.AlignTop, Qt.AlignmentFlag.AlignRight
        grid.addWidget(corner, 0, 0, top | right)

    # -- what is shown

    def _follow(self, old: MarkersShown, new: MarkersShown) -> None:
        if old.result is not new.result:
            self._cast()
        self._go_along(new)
        self._tell(new)
        self.view.stir()

    def _cast(self) -> None:
        shown = self._bridge.shown
        if not self.isVisible() or shown.result is None or shown.source is None:
            return
        if shown.source is not self._source:
            self._source = shown.source
            self._bones = shown.source.bones or guess_bones(shown.source.positions)
            self._frame_again = True
        self._actor = actor = MarkerActor(replace(shown.result, bones=self._bones))
        if self.view.scene is not None:
            self.view.scene.cast([actor.figure(FINE)], self._palette)
            ground = actor.followed[:: max(1, actor.frames // 64)]
            self.view.scene.lay_floor(ground, actor.level, actor.size, self._palette)
            lines = [("filled", rgb(self._palette.theme.result)), ("missing", self._palette.faint)]
            self.view.tell(lines, f"{self.view.scene.step:g} m")

    def _tell(self, shown: MarkersShown) -> None:
        take = shown.result
        if take is not None:
            number = wording.number(take, shown.frame)
            time = wording.seconds(take, shown.frame)
            self.view.caption.tell(shown.performer, f"frame {number} · {time}")
            self.view.spare(self._bar.sizeHint().width() + 24)

    def _go_along(self, shown: MarkersShown) -> None:
        if self._actor is None:
            return
        anchor = self._actor.followed[min(shown.frame, self._actor.frames - 1)]
        if self._bridge.desk.ui.follow and self._anchor is not None:
            self.camera.focal = self.camera.focal + (anchor - self._anchor)
        self._anchor = anchor

    def _introduce(self, actor: MarkerActor, frame: int) -> None:
        self._frame_again = False
        points = actor.points(frame).astype(float)
        self.camera.look("three-quarter", actor.heading(frame))
        width, height = self.view.size_in_pixels
        ground = points * (1, 0, 1) + (0, actor.level, 0)
        self.camera.frame(np.concatenate([points, ground]), width / height, _ROOM)
        self._anchor = actor.followed[frame]
        self.camera.focal = np.array([self._anchor[0], self.camera.focal[1], self._anchor[2]])

    def _prepare(self) -> None:
        scene, actor, shown = self.view.scene, self._actor, self._bridge.shown
        if scene is None:
            return
        if actor is not None and shown.result is not None:
            if self._frame_again:
                self._introduce(actor, shown.frame)
            pixel = self.camera.metres_per_pixel(self.view.size_in_pixels[1])
            scene.show([self._pose(actor, shown)], self.camera, pixel)
        scene.aim(self.camera)

    def _pose(self, actor: MarkerActor, shown: MarkersShown) -> Pose:
        take, frame = actor.take, shown.frame
        colours = np.tile(np.array(self._palette.body, np.uint8), (len(actor.names), 1))
        colours[take.missing[frame]] = self._palette.faint
        if take.filled is not None:
            colours[take.filled[frame] & ~take.missing[frame]] = rgb(self._palette.theme.result)
        ring = trail = None
        if shown.marker is not None:
            ring = take.index[shown.marker]
            steps = np.arange(-_TRAIL_STEPS, _TRAIL_STEPS + 1) * _TRAIL * float(take.rate)
            at = np.clip(np.rint(frame + steps / _TRAIL_STEPS), 0, take.frames - 1).astype(int)
            trail = np.stack([actor.points(int(k))[ring] for k in at])
        return Pose(
            points=actor.points(frame),
            colours=colours,
            swell=actor.swell(frame),
            ring=ring,
            trail=trail,
            size=actor.size,
        )

    # -- mouse

    def _marker_at(self, at: QPointF) -> str | None:
        if self._actor is None:
            return None
        points = self._actor.points(self._bridge.shown.frame)
        size = self.view.size_in_pixels
        found = picking.joint_at(self.camera, points, (at.x(), at.y()), size)
        return None if found is None else self._actor.names[found]

    def _click(self, at: QPointF) -> None:
        name = self._marker_at(at)
        if name is not None:
            self._bridge.choose(name)

    def _hover(self, at: QPointF) -> None:
        name, canvas = self._marker_at(at), self.view.canvas
        if canvas is None:
            return
        if name is None:
            QToolTip.hideText()
            canvas.unsetCursor()
            return
        canvas.setCursor(Qt.CursorShape.PointingHandCursor)
        QToolTip.showText(canvas.mapToGlobal(at.toPoint()), name, canvas)

    # -- Qt

    def showEvent(self, event: QShowEvent) -> None:
        """Catch up with what happened while out of sight."""
        super().showEvent(event)
        self._cast()
        self._tell(self._bridge.shown)
        self.view.stir()

    def changeEvent(self, event: QEvent) -> None:
        """Take on another theme."""
        super().changeEvent(event)
        restyled = event.type() in (QEvent.Type.PaletteChange, QEvent.Type.StyleChange)
        if restyled and theme.current() is not self._palette.theme:
            self._palette = palette(theme.current())
            self.view.caption.restyle()
            self._bar.restyle()
            self._cast()
            self.view.stir()
