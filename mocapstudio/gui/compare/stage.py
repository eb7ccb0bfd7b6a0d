"""The 3-D part of the comparison: two synchronised viewports, or one overlay."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QAction, QShowEvent
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QToolTip, QWidget

from mocapstudio.gui import theme
from mocapstudio.gui.compare import colours as kinds
from mocapstudio.gui.compare.bridge import Alignment, CompareBridge, CompareUi
from mocapstudio.gui.compare.guest import Guest
from mocapstudio.gui.compare.naming import short_names
from mocapstudio.gui.compare.troupe import Member, Part, Troupe, figures
from mocapstudio.gui.compare.weight_bars import Weighting
from mocapstudio.gui.compare.weight_rows import WeightRow
from mocapstudio.gui.compare.weights_view import weight_colours
from mocapstudio.gui.stage.actors import JointActor
from mocapstudio.gui.stage.scene import Pose
from mocapstudio.gui.stage.skeleton_view import SkeletonView
from mocapstudio.gui.viewport import picking
from mocapstudio.gui.viewport.camera import Turntable
from mocapstudio.gui.viewport.overlay import Bar
from mocapstudio.gui.viewport.palette import Colour, palette, rgb
from mocapstudio.motion.take import Take
from mocapstudio.review.comparing import ComparingState
from mocapstudio.review.comparing_state import only_view_differs

_ROOM = 1.2
_CAPTION = 46
_GIRTH = {Part.REFERENCE: 1.0, Part.SOURCE: 1.0, Part.OTHER: 0.6}
_TRAIL_STEPS = 16
_TRAIL = 0.5


class StageView(QWidget):
    """Shows reference and sources at the current frames.

    Two viewports stand side by side and share a camera, or all stand in one. A click on a joint
    selects its row. Left drag orbits, middle drag or Shift and left drag pans, the wheel zooms.

    Parameters
    ----------
    bridge
        Where state comes from and intents go.
    buttons
        What stands in the corner.
    """

    def __init__(self, bridge: CompareBridge, buttons: Sequence[QAction | None]) -> None:
        super().__init__()
        self.setObjectName("compare-stage")
        self._bridge = bridge
        self._troupe = Troupe()
        self._palette = palette(theme.current())
        self._members: dict[SkeletonView, tuple[Member, ...]] = {}
        self.camera = Turntable()
        self._anchor: np.ndarray | None = None
        self._guest: Guest | None = None
        self._weights: tuple[WeightRow, ...] = ()
        self._weighting: tuple[object, Weighting] | None = None
        self._frame_again = True
        self.left = SkeletonView(self.camera, self._prepare)
        self.right = SkeletonView(self.camera, self._prepare)
        self.left.setObjectName("compare-reference")
        self.right.setObjectName("compare-source")
        self._lay_out(buttons)
        for view in self.views:
            view.moved.connect(self.stir)
            view.shown.connect(self._refresh)
            view.clicked.connect(lambda at, view=view: self._click(view, at))
            view.hovered.connect(lambda at, view=view: self._hover(view, at))
        bridge.changed.connect(self._show_state)
        bridge.ui_changed.connect(self._show_ui)
        self._show_ui(bridge.ui, bridge.ui)

    @property
    def views(self) -> tuple[SkeletonView, SkeletonView]:
        """Both viewports; the right one is out of sight where one is enough."""
        return self.left, self.right

    def _lay_out(self, buttons: Sequence[QAction | None]) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        both = QWidget()
        row = QHBoxLayout(both)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(2)
        for view in self.views:
            row.addWidget(view, 1)
        grid.addWidget(both, 0, 0)
        self._bar = Bar(self, buttons)
        corner = QWidget()
        inner = QGridLayout(corner)
        inner.setContentsMargins(0, 8, 8, 0)
        inner.addWidget(self._bar)
        top, right = Qt.AlignmentFlag.AlignTop, Qt.AlignmentFlag.AlignRight
        grid.addWidget(corner, 0, 0, top | right)

    # -- what the workspace asks for

    def look(self, view: str) -> None:
        """Look from ``"front"``, ``"side"``, ``"top"`` or ``"three-quarter"``."""
        members = self._troupe.reference(self._bridge.state)
        heading = members[0].actor.heading(members[0].frame(self._bridge.state)) if members else 0.0
        self.camera.look(view, heading)
        self.stir()

    def frame_all(self) -> None:
        """Bring all of the body into sight again."""
        self._frame_again = True
        self.stir()

    def guest_of(self, reference: Take, name: str) -> Guest:
        """Make a guest who borrows the reference's skeleton."""
        host = self._troupe.actor(reference)
        assert isinstance(host, JointActor)
        return Guest(host, name)

    def invite(self, guest: Guest | None) -> None:
        """Show somebody whose frames arrive in the place of the sources, or nobody."""
        self._guest = guest
        self._refresh()

    def show_weights(self, rows: tuple[WeightRow, ...]) -> None:
        """Show on the reference how much its joints count."""
        if rows != self._weights:
            self._weights, self._weighting = rows, None
            self.stir()

    # -- state

    def _show_state(self, old: ComparingState, new: ComparingState) -> None:
        if not only_view_differs(old, new):
            self._troupe.keep(new)
            self._frame_again |= old.reference is not new.reference or not old.sources
            self._cast()
        self._go_along(new)
        self._tell(new)
        self.stir()

    def _show_ui(self, old: CompareUi, new: CompareUi) -> None:
        apart = not new.overlay
        if self.right.isHidden() == apart:
            self.right.setVisible(apart)
        self._refresh()

    def _refresh(self) -> None:
        if self.isVisible():
            self._cast()
            self._go_along(self._bridge.state)
            self._tell(self._bridge.state)
            self.stir()

    def _cast(self) -> None:
        if not self.isVisible():
            return
        state, ui = self._bridge.state, self._bridge.ui
        reference = self._troupe.reference(state)
        sources = self._troupe.sources(state, ui.others)
        if self._guest is not None:
            sources = (self._troupe.invited(self._guest),)
        self._members = {
            self.left: (*reference, *sources) if ui.overlay else reference,
            self.right: () if ui.overlay else sources,
        }
        for view, members in self._members.items():
            if view.scene is None:
                continue
            view.scene.cast(figures(members), self._palette)
            if reference:
                actor = reference[0].actor
                paths = [actor.followed[:: max(1, actor.frames // 64)]]
                paths += [self._path(member) for member in members if member.source is not None]
                ground = np.concatenate(paths)
                view.scene.lay_floor(ground, actor.level, actor.size, self._palette)
            step = f"{view.scene.step:g} m"
            view.tell(self._legend(members), step)

    def _path(self, member: Member) -> np.ndarray:
        placed = self._troupe.place(member, self._bridge.state, self._bridge.ui)
        return placed(member.actor.followed[:: max(1, member.actor.frames // 64)])

    def _legend(self, members: Sequence[Member]) -> list[tuple[str, Colour]]:
        if len(members) < 2:
            return []
        short = short_names([one.id for one in self._bridge.state.sources])
        names = {
            one: "reference" if one.source is None else short[one.source.id] for one in members
        }
        if self._guest is not None:
            names[members[-1]] = self._guest.name
        return [(name, self._colour(one)) for one, name in names.items()]

    def _tell(self, state: ComparingState) -> None:
        reference, source = state.reference, state.source
        words = ""
        if reference is not None:
            number = state.frame + reference.first_frame
            words = f"{reference.seconds(state.frame):.2f} s · frame {number}"
        beside = ""
        if source is not None:
            at = state.source_frame
            beside = f"{source.take.seconds(at):.2f} s · frame {at + source.take.first_frame}"
        name_beside = "" if source is None else source.id
        if self._guest is not None:
            name_beside, now = self._guest.name, self._guest.seconds
            beside = "" if now is None else f"{now:.2f} s"
        if self._bridge.ui.overlay:
            self.left.caption.tell("Overlay", f"reference {words}   source {beside}")
        else:
            name = "" if reference is None else f"{reference.name} (reference)"
            self.left.caption.tell(name, words)
            self.right.caption.tell(name_beside, beside)
        corner = self.left if self._bridge.ui.overlay else self.right
        other = self.right if corner is self.left else self.left
        corner.spare(self._bar.sizeHint().width() + 24)
        other.spare(0)

    # -- camera

    def _go_along(self, state: ComparingState) -> None:
        members = self._members.get(self.left, ())
        if not members:
            self._anchor = None
            return
        anchor = members[0].actor.followed[members[0].frame(state)]
        if self._bridge.ui.follow and self._anchor is not None:
            self.camera.focal = self.camera.focal + (anchor - self._anchor)
        self._anchor = anchor

    def _camera_of(self, view: SkeletonView) -> Turntable:
        """The shared camera, moved along with the source where that has a viewport of its own."""
        members = self._members.get(view, ())
        if view is self.left or not members or self._anchor is None:
            return self.camera
        state, ui = self._bridge.state, self._bridge.ui
        if not ui.follow and ui.alignment is not Alignment.RECORDED:
            return self.camera
        source = members[0]
        placed = self._troupe.place(source, state, ui)
        there = placed(source.actor.followed[source.frame(state)][None])[0]
        return replace(self.camera, focal=self.camera.focal + (there - self._anchor))

    def _introduce(self) -> None:
        members = self._members.get(self.left, ()) or self._members.get(self.right, ())
        if not members:
            return
        self._frame_again = False
        one = members[0]
        frame = one.frame(self._bridge.state)
        points = one.actor.points(frame).astype(float)
        self.camera.look("three-quarter", one.actor.heading(frame))
        width, height = self.left.size_in_pixels
        ground = points * (1, 0, 1) + (0, one.actor.level, 0)
        # Caption and buttons lie over the upper edge: she stands below them.
        free = max(height - _CAPTION, 0.5 * height)
        room = _ROOM * height / free
        self.camera.frame(np.concatenate([points, ground]), width / height, room)
        rise = 0.5 * (height - free) * self.camera.metres_per_pixel(height)
        self._anchor = one.actor.followed[frame]
        middle = self.camera.focal[1] + rise
        self.camera.focal = np.array([self._anchor[0], middle, self._anchor[2]])

    # -- the picture

    def _prepare(self, view: SkeletonView) -> None:
        if view.scene is None:
            return
        if self._frame_again:
            self._introduce()
        members = self._members.get(view, ())
        camera = self._camera_of(view)
        if members:
            pixel = camera.metres_per_pixel(view.size_in_pixels[1])
            view.scene.show([self._pose(one) for one in members], camera, pixel)
        view.scene.aim(camera)

    def _pose(self, member: Member) -> Pose:
        state, ui = self._bridge.state, self._bridge.ui
        frame = member.frame(state)
        placed = self._troupe.place(member, state, ui)
        hot: Colour | None = None
        if ui.differences and member.part is Part.SOURCE:
            hot = rgb(kinds.far(theme.current()).name())
        ring = None
        if state.row is not None and member.part is not Part.OTHER:
            ring = self._troupe.point_of(member, state.row)
        trail = None
        if ring is not None:
            rate = float(member.actor.take.rate)
            steps = np.arange(-_TRAIL_STEPS, _TRAIL_STEPS + 1) * _TRAIL * rate / _TRAIL_STEPS
            at = np.clip(np.rint(frame + steps), 0, member.actor.frames - 1).astype(int)
            trail = placed(np.stack([member.actor.points(int(k))[ring] for k in at]))
        points = placed(member.actor.points(frame))
        colours = self._troupe.colours(member, state, self._colour(member), hot)
        weighting = self._weighting_of(member)
        if weighting is not None:
            colours = weighting.tints(self._palette.body, _weight_colours()[1])
        return Pose(
            points=points,
            colours=colours,
            girth=_GIRTH[member.part],
            swell=member.actor.swell(frame),
            ring=ring,
            trail=trail,
            size=member.actor.size,
            bars=None if weighting is None else weighting.bars(points, _weight_colours()),
        )

    def _weighting_of(self, member: Member) -> Weighting | None:
        if not self._weights or member.part is not Part.REFERENCE:
            return None
        if self._weighting is None or self._weighting[0] is not member.actor:
            assert not isinstance(member.actor, Guest)
            self._weighting = member.actor, Weighting(member.actor, self._weights)
        return self._weighting[1]

    def _colour(self, member: Member) -> Colour:
        if member.part is Part.REFERENCE:
            return self._palette.body
        return rgb(kinds.source(theme.current(), member.number))

    def stir(self) -> None:
        """Say that the picture is another."""
        for view in self.views:
            if view.isVisible():
                view.stir()

    # -- mouse

    def _point_at(self, view: SkeletonView, at: QPointF) -> tuple[Member, int] | None:
        state, ui = self._bridge.state, self._bridge.ui
        camera = self._camera_of(view)
        for member in self._members.get(view, ()):
            if member.part is Part.OTHER:
                continue
            points = member.actor.points(member.frame(state))[: len(member.actor.names)]
            placed = self._troupe.place(member, state, ui)(points)
            found = picking.joint_at(camera, placed, (at.x(), at.y()), view.size_in_pixels)
            if found is not None:
                return member, found
        return None

    def _click(self, view: SkeletonView, at: QPointF) -> None:
        found = self._point_at(view, at)
        if found is not None:
            row = self._troupe.row_of(*found, self._bridge.state)
            self._bridge.sitting.select_row(None if row == self._bridge.state.row else row)

    def _hover(self, view: SkeletonView, at: QPointF) -> None:
        found = self._point_at(view, at)
        if view.canvas is None:
            return
        if found is None:
            QToolTip.hideText()
            view.canvas.unsetCursor()
            return
        member, point = found
        text = member.actor.names[point]
        comparison = None if member.source is None else member.source.comparison
        row = self._troupe.row_of(member, point, self._bridge.state)
        if comparison is not None and row is not None:
            at_frame = min(member.frame(self._bridge.state), len(comparison.joint_difference) - 1)
            value = comparison.joint_difference[at_frame, comparison.rows.index(row)]
            text += f" · {value:.3f} apart (box units)"
        view.canvas.setCursor(Qt.CursorShape.PointingHandCursor)
        QToolTip.showText(view.canvas.mapToGlobal(at.toPoint()), text, view.canvas)

    # -- Qt

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
            for view in self.views:
                view.caption.restyle()
            self._bar.restyle()
            self._refresh()


def _weight_colours() -> tuple[Colour, Colour]:
    lower, upper = weight_colours()
    return rgb(lower.name()), rgb(upper.name())
