"""Distance over time: how far the flagged span is from every other place, and its minima."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen, QShowEvent
from PySide6.QtWidgets import (
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from mocapstudio.gui import theme as themes
from mocapstudio.gui.document import DocumentBridge, UiState
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots import profile_drawing as drawing
from mocapstudio.gui.plots.axes import ValueAxis
from mocapstudio.gui.plots.context_strip import ContextStrip
from mocapstudio.gui.plots.curve_panels import PANEL_WIDTH, VALUE_AXIS_WIDTH, ReadOut
from mocapstudio.gui.plots.layers import Layer
from mocapstudio.gui.plots.plot_view import HintedPlotView, in_a_row
from mocapstudio.gui.plots.profile_curve import Mark, marks_of, place_at, read_out, top_of
from mocapstudio.gui.plots.time_plot import TimePlot
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.gui.reasons import Reason, Reasons
from mocapstudio.gui.widgets.parts import ElidedLabel, label
from mocapstudio.motion.facing import ROOT_ROWS

if TYPE_CHECKING:
    from mocapstudio.cleaning.distance_profile import TakeDistances
    from mocapstudio.review.document import DocumentState

_EXPLAINED = (
    "For every place of a take: root mean square joint angle, in degrees, between the flagged span"
    " and the span that begins there, time-warped and without the flagged joints.\n"
    "The numbered minima are the neighbours. Faint: overlaps the flagged span, or is flagged."
)


class ProfilePlot(TimePlot):
    """The analysed take's own part; it knows minima only as places that can be clicked."""

    def __init__(self, time_range: TimeRange, axis: ValueAxis, owner: DistancesView) -> None:
        self._owner = owner
        super().__init__(time_range, axis="bottom", left=axis)

    def holds(self, at: QPointF) -> bool:
        """A minimum waits for the release: a click chooses it."""
        return self._owner.mark_at(at) is not None


class DistancesView(HintedPlotView):
    """Shows the distance profile of the selected flag (paper 1, figure 3).

    Above the take itself on the desk's time axis: a click moves the play head. Below the takes of
    the context end to end. A click on a numbered minimum previews that neighbour.

    Parameters
    ----------
    bridge
        Where state comes from and intents go.
    reasons
        Profile and neighbours of the selected flag.
    time_range
        The visible frames, shared with other plots; one of its own by default.
    """

    def __init__(
        self, bridge: DocumentBridge, reasons: Reasons, time_range: TimeRange | None = None
    ) -> None:
        super().__init__()
        self.setProperty("role", "panel")
        self._bridge, self._reasons = bridge, reasons
        self._shown: DocumentState | None = None
        self._reason: Reason | None = None
        self._own: TakeDistances | None = None
        self._marks: tuple[Mark, ...] = ()
        self._choice: int | None = None
        self._top = 1.0
        self.time_range = time_range if time_range is not None else TimeRange(self)
        self.axis = ValueAxis(VALUE_AXIS_WIDTH)
        self.axis.set_unit("°")
        self.plot = ProfilePlot(self.time_range, self.axis, self)
        self.strip = ContextStrip()
        self.values = ReadOut()
        self.values.setToolTip("Distance of the span that begins at the play head, degrees")
        self._curve = self.plot.add_layer(Layer(self._draw_curve, cached=True), 1)
        self._over = self.plot.add_layer(Layer(self._draw_marks, cached=True), 5)
        self._lay_out()
        self.plot.scrubbed.connect(lambda frame: self._bridge.document.set_frame(frame))
        self.plot.clicked.connect(self._click)
        self.plot.hovered.connect(self._hover)
        self.plot.focus_wanted.connect(self._zoom_to_flag)
        self.strip.chosen.connect(reasons.choose)
        bridge.changed.connect(lambda _old, new: self._follow(new))
        bridge.ui_changed.connect(self._follow_ui)
        reasons.changed.connect(lambda: self._follow(bridge.state))

    def _lay_out(self) -> None:
        panel = QWidget()
        panel.setFixedWidth(PANEL_WIDTH)
        panel.setToolTip(_EXPLAINED)
        words = QVBoxLayout(panel)
        words.setContentsMargins(8, 7, 2, 4)
        words.setSpacing(3)
        self.name = ElidedLabel(Qt.TextElideMode.ElideMiddle)
        self.name.setObjectName("distances-joint")
        self.name.setProperty("role", "title")
        words.addWidget(self.name)
        words.addWidget(label("distance to every place of this take", "faint", wrap=True))
        words.addStretch(1)
        desk = QWidget()
        column = QVBoxLayout(desk)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        # Shares of the height, whatever the two would like to have.
        above = in_a_row(panel, self.plot, self.values)
        for part in (self.plot, above, self.strip):
            part.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Ignored)
        column.addWidget(above, 4)
        column.addWidget(self.strip, 3)
        self.stand(desk)
        self.empty.setObjectName("distances-hint")
        self.setMinimumHeight(100)

    # -- state

    def showEvent(self, event: QShowEvent) -> None:
        """Catch up: while it is hidden the view does nothing."""
        super().showEvent(event)
        self._follow(self._bridge.state)

    def _follow(self, new: DocumentState) -> None:
        if not self.isVisible():
            return
        was, self._shown = self._shown, new
        take = new.take
        if take is not None and (was is None or take is not was.take):
            self.time_range.set_frames(take.frames)
            self.plot.time_axis.set_clock(float(take.rate), take.first_frame)
        reason = self._reasons.current
        if reason is not self._reason or was is None or new.selection != was.selection:
            self._reason = reason
            self._set_profile(new, reason)
        if was is None or new.proposals is not was.proposals:
            self._choose(new)
        if was is None or new.frame != was.frame:
            self.plot.set_frame(new.frame)
            self.time_range.reveal(new.frame)
        self._read_out()

    def _follow_ui(self, old: UiState, new: UiState) -> None:
        if old.preview != new.preview and self.isVisible():
            self._choose(self._bridge.state)

    def _set_profile(self, state: DocumentState, reason: Reason) -> None:
        profile, item = reason.profile, state.selected
        self.show_hint(profile is None or item is None)
        self.empty.setText(_why_empty(state, reason))
        self._own, self._marks = None, ()
        if profile is not None and item is not None:
            self.name.show_text(item.flag.joint)
            self._own = next((one for one in profile.takes if one.index == 0), None)
            self._marks = tuple(one for one in marks_of(profile) if one.index == 0)
            self._top = top_of(profile)
            self.plot.plotItem.vb.setYRange(0.0, self._top, padding=0)
            self.strip.setVisible(any(one.index for one in profile.takes))
        self.strip.show_profile(profile, self._choosable)
        self._choose(state)
        self._curve.refresh()
        self._over.refresh()

    def _choose(self, state: DocumentState) -> None:
        """Light the neighbour that is previewed, or that the proposal was made of."""
        choice, item = self._bridge.ui.preview, state.selected
        near = () if self._reason is None else self._reason.neighbours or ()
        proposal = None if item is None else state.proposals.get(item.flag.id)
        if choice is None and proposal is not None and proposal.donor in near:
            choice = near.index(proposal.donor)
        if choice != self._choice:
            self._choice = choice
            self._over.refresh()
        self.strip.mark(choice)

    @property
    def _choosable(self) -> bool:
        item = None if self._shown is None else self._shown.selected
        return item is not None and item.flag.joint not in ROOT_ROWS

    def _read_out(self) -> None:
        frame = 0 if self._shown is None else self._shown.frame
        place = None if self._own is None else place_at(self._own, frame)
        if self._own is None or place is None:
            self.values.show_values(())
        else:
            self.values.show_values((("here", f"{self._own.degrees[place]:.1f}°"),))

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        self.plot.restyle()
        self.axis.update()
        self.strip.update()
        self.values.update()

    # -- drawing

    def _y(self, degrees: float) -> float:
        area = self.plot.area
        return float(area.bottom() - degrees / self._top * area.height())

    def _places(self) -> list[tuple[int, QPointF]]:
        plot = self.plot
        return [(m.number, QPointF(plot.x_of(m.frame), self._y(m.degrees))) for m in self._marks]

    def _draw_curve(self, p: QPainter, area: QRectF) -> None:
        look, item = themes.current(), None if self._shown is None else self._shown.selected
        drawing.draw_levels(p, look, area, [self._y(value) for value, _ in self.axis.marks()])
        if item is not None:
            left = self.plot.x_of(item.flag.start - 0.5)
            right = max(self.plot.x_of(item.flag.end - 0.5), left + 2)
            tint = look.verdict(item.verdict)
            flagged = QRectF(left, area.top(), right - left, area.height())
            p.fillRect(flagged, colours.faded(tint, 0.13))
            p.setPen(QPen(colours.faded(QColor(tint), 0.55), 1))
            for x in (left, right):
                p.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()))
        if self._own is not None:
            frames, shown = self._own.frames, self.time_range
            across = area.left() + (frames - shown.start) / shown.length * area.width()
            height = self._own.degrees.astype(np.float64) / self._top * area.height()
            down = np.asarray(area.bottom() - height, dtype=np.float64)
            drawing.draw_curve(p, look, self._own, across, down)

    def _draw_marks(self, p: QPainter, area: QRectF) -> None:
        inside = [one for one in self._places() if area.left() <= one[1].x() <= area.right()]
        drawing.draw_marks(p, themes.current(), area, inside, self._choice)

    # -- intents and reading off

    def mark_at(self, at: QPointF) -> int | None:
        """Return the number of the neighbour whose minimum lies at a place, or None."""
        return drawing.hit(at, self._places(), self.plot.area)

    def read_out(self, at: QPointF) -> str:
        """Say in words what lies at a place of the upper plot, or "" where nothing does."""
        if self._own is None or not self.plot.area.contains(at):
            return ""
        number = self.mark_at(at)
        for mark in self._marks:
            if mark.number == number:
                return read_out(self._own, mark.place, mark, self._choosable)
        place = place_at(self._own, self.plot.frame_at(at.x()))
        return "" if place is None else read_out(self._own, place, None, self._choosable)

    def _click(self, at: QPointF) -> None:
        number = self.mark_at(at)
        if number is not None:
            self._reasons.choose(number)

    def _hover(self, at: QPointF | None) -> None:
        self.plot.tell(at, "" if at is None else self.read_out(at))

    def _zoom_to_flag(self) -> None:
        item = None if self._shown is None else self._shown.selected
        if item is not None:
            self.time_range.focus(item.flag.start, item.flag.end)


def _why_empty(state: DocumentState, reason: Reason) -> str:
    if state.selected is None:
        return "Select a flag to see how far it is from every other place"
    if state.analysis is None:
        return "Analyse again to measure distances (F5)"
    if reason.trouble is not None and reason.neighbours is None:
        return reason.trouble.cause
    if reason.neighbours is None:
        return "Measuring distances…"
    return "The flagged span is too long, or too short, to be compared with another"
