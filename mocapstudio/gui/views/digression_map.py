"""The digression map: joints by limb over time, flags, edits, threshold."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt, QTimer
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QToolButton, QToolTip, QWidget

from mocapstudio.cleaning.model import DigressionMap
from mocapstudio.gui import theme as themes
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.plots import colours, map_readout
from mocapstudio.gui.plots import map_drawing as drawing
from mocapstudio.gui.plots.axes import TIME_AXIS_HEIGHT, small_font
from mocapstudio.gui.plots.colour_bar import ColourBar
from mocapstudio.gui.plots.layers import Layer, draw_trim
from mocapstudio.gui.plots.plot_view import HintedPlotView, in_a_row
from mocapstudio.gui.plots.pooling import PooledMap
from mocapstudio.gui.plots.row_labels import RowLabels
from mocapstudio.gui.plots.rows import Group, RowLayout, limb_groups
from mocapstudio.gui.plots.time_plot import RIGHT_GUTTER, TimePlot
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.review.model import QueueItem

if TYPE_CHECKING:
    from mocapstudio.motion.take import Take
    from mocapstudio.review.document import DocumentState

_EVERY_MS = 40
_DWELL_MS = 250


class MapPlot(TimePlot):
    """The map itself; it knows flags only as places that can be clicked."""

    def __init__(self, time_range: TimeRange, owner: DigressionMapView) -> None:
        self._owner = owner
        super().__init__(time_range, axis="top")

    def holds(self, at: QPointF) -> bool:
        """A flag waits for the release: a click selects it."""
        return self._owner.flag_at(at) is not None


class DigressionMapView(HintedPlotView):
    """Shows how far each row of the active take departs from its neighbours, and its flags.

    A click moves the play head, a click on a flag selects it, on a name its row; Shift-drag
    selects rows × span; the wheel zooms, the middle button pans, a double click or Z zooms to the
    selected flag, Home shows the whole take.

    Parameters
    ----------
    bridge
        Where state comes from and intents go.
    time_range
        The visible frames, shared with other plots; one of its own by default.
    parent
        Qt's parent.
    """

    def __init__(
        self,
        bridge: DocumentBridge,
        time_range: TimeRange | None = None,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._bridge = bridge
        self._shown: DocumentState | None = None
        self._map: DigressionMap | None = None
        self._pooled: PooledMap | None = None
        self._groups: tuple[Group, ...] = ()
        self._rows = RowLayout((), 0)
        self._threshold = 0.5
        self._hovered: str | None = None
        self._pointer: QPointF | None = None
        self.time_range = time_range if time_range is not None else TimeRange(self)
        self.plot = MapPlot(self.time_range, self)
        self.labels = RowLabels()
        self.bar = ColourBar()
        self._map_layer = self.plot.add_layer(Layer(self._draw_map, cached=True), 1)
        self._flag_layer = self.plot.add_layer(Layer(self._draw_flags, cached=True), 2)
        self._selection_layer = self.plot.add_layer(Layer(self._draw_selection), 3)
        self._lay_out()
        self._wire()
        self.show_state(None, bridge.state)

    def _lay_out(self) -> None:
        self.whole = QToolButton(self.bar)
        self.whole.setText("whole take")
        self.whole.setToolTip("Show the whole take (Home)")
        self.whole.setFont(small_font(10))
        self.whole.setStyleSheet("padding: 0; font-size: 10px;")
        self.whole.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.whole.setGeometry(4, 1, RIGHT_GUTTER - 10, TIME_AXIS_HEIGHT - 3)
        self.whole.hide()
        desk = in_a_row(self.labels, self.plot, self.bar)
        self.stand(desk, "Analyse a take to see its digression map")
        self.setMinimumHeight(110)

    def _wire(self) -> None:
        self._throttle = QTimer(self)
        self._throttle.setSingleShot(True)
        self._throttle.setInterval(_EVERY_MS)
        self._throttle.timeout.connect(self._send_threshold)
        self._dwell = QTimer(self)
        self._dwell.setSingleShot(True)
        self._dwell.setInterval(_DWELL_MS)
        self._dwell.timeout.connect(self._show_tip)
        self.plot.scrubbed.connect(lambda frame: self._bridge.document.set_frame(frame))
        self.plot.clicked.connect(self._click)
        self.plot.swept.connect(self._sweep)
        self.plot.hovered.connect(self._hover)
        self.plot.focus_wanted.connect(self.zoom_to_selection)
        self.whole.clicked.connect(self.whole_take)
        self.time_range.changed.connect(lambda: self.whole.setVisible(not self.time_range.is_whole))
        self.plot.plotItem.vb.sigResized.connect(lambda *_: self._arrange())
        self.labels.rows_clicked.connect(self._select_rows)
        self.bar.threshold_moved.connect(self._move_threshold)
        self._bridge.changed.connect(self.show_state)

    # -- state

    def show_state(self, _old: DocumentState | None, new: DocumentState) -> None:
        """Take over what differs from what is shown."""
        was, self._shown = self._shown, new
        take, analysis = new.take, new.analysis
        if was is None or take is not was.take:
            self._set_take(take)
        self._set_map(None if analysis is None else analysis.map)
        self.labels.set_left_out(() if analysis is None else analysis.unanalysed)
        if was is None or new.threshold != was.threshold:
            self._set_threshold(new.threshold)
        if was is None or new.sitting is not was.sitting or new.active != was.active:
            self._map_layer.refresh()
        if was is None or new.queue != was.queue:
            self._flag_layer.refresh()
            self._selection_layer.refresh()
        if was is None or new.selection != was.selection:
            self._selection_layer.refresh()
        if was is None or (new.queue, new.selection) != (was.queue, was.selection):
            self._mark_rows()
        if was is None or new.sitting is not was.sitting:
            self._mark_rows()
        if was is None or new.frame != was.frame:
            self.plot.set_frame(new.frame)
            self.time_range.reveal(new.frame)

    def _set_take(self, take: Take | None) -> None:
        if take is not None:
            self.time_range.set_frames(take.frames)
            self.plot.time_axis.set_clock(float(take.rate), take.first_frame)
        self._groups = ()

    def _set_map(self, mapped: DigressionMap | None) -> None:
        take = self._shown.take if self._shown is not None else None
        self.show_hint(mapped is None or take is None)
        if mapped is self._map and (self._groups or mapped is None):
            return
        self._map = mapped
        self._pooled = None
        self._groups = ()
        if mapped is not None and take is not None:
            self._groups = limb_groups(take.skeleton, mapped.rows)
            order = {name: i for i, name in enumerate(mapped.rows)}
            drawn = [order[name] for group in self._groups for name in group.rows]
            self._pooled = PooledMap(mapped.values, np.array(drawn, dtype=np.int64))
        self._arrange()

    def _set_threshold(self, threshold: float) -> None:
        self._threshold = threshold
        self.bar.set_threshold(threshold)
        self._map_layer.refresh()

    def _arrange(self) -> None:
        area = self.plot.area
        self._rows = RowLayout(self._groups, max(int(area.height()) - drawing.BAND_ROOM, 1))
        self.labels.set_rows(self._rows, int(area.top()))
        self.bar.set_extent(int(area.top()) + 1, max(self._rows.bottom - 2, 1))
        self._mark_rows()
        self.plot.refresh_layers()

    def _mark_rows(self) -> None:
        state = self._shown
        if state is None:
            return
        worst = dict.fromkeys(item.flag.joint for item in state.queue if item.current)
        edits = any(edit.performer == state.active for edit in state.sitting.edits)
        self.labels.set_marks(state.selection.joints, tuple(worst), self._hovered, edits)

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        self.plot.restyle()
        self.labels.update()
        self.bar.update()

    # -- drawing

    def _frame(self, area: QRectF) -> drawing.Frame:
        return drawing.Frame(area, self.time_range, self._rows, themes.current())

    def _draw_map(self, p: QPainter, area: QRectF) -> None:
        state = self._shown
        if self._pooled is None or state is None or state.take is None:
            return
        at = self._frame(area)
        drawing.draw_ground(p, at)
        table = colours.lookup_table(at.theme, self._threshold)
        drawing.draw_cells(p, at, self._pooled, table)
        drawing.draw_row_lines(p, at)
        sitting = state.sitting
        drawing.draw_protected(
            p, at, (one for one in sitting.protected if one.performer == state.active)
        )
        drawing.draw_edits(p, at, (one for one in sitting.edits if one.performer == state.active))
        trim = dict(sitting.trims).get(state.active, state.take.trim)
        if trim is not None:
            draw_trim(p, area, at.x(trim[0] - 0.5), at.x(trim[1] - 0.5))

    def _draw_flags(self, p: QPainter, area: QRectF) -> None:
        if self._pooled is not None and self._shown is not None:
            drawing.draw_flags(p, self._frame(area), self._shown.queue)

    def _draw_selection(self, p: QPainter, area: QRectF) -> None:
        state = self._shown
        if self._pooled is None or state is None:
            return
        at = self._frame(area)
        if state.selected is not None:
            drawing.draw_selected(p, at, state.selected)
        elif state.selection.span is not None:
            drawing.draw_selection(p, at, state.selection.joints, state.selection.span)

    # -- intents

    def flag_at(self, at: QPointF) -> QueueItem | None:
        """Return the flag at a place of the plot, the shortest where several lie over each other.

        A flag of the latest analysis comes before one that is no longer raised.
        """
        if self._shown is None or self._pooled is None:
            return None
        row = self._rows.row_at(at.y() - self.plot.area.top())
        frame = self._frame(self.plot.area)
        found = []
        for item in self._shown.queue:
            if item.flag.joint != row:
                continue
            cell = drawing.flag_cell(frame, item.flag)
            if cell is not None and cell.left() - 1.5 <= at.x() <= cell.right() + 1.5:
                found.append((not item.current, item.flag.end - item.flag.start, item))
        return min(found, key=lambda one: one[:2])[2] if found else None

    def zoom_to_selection(self) -> None:
        """Zoom to the selected flag or span; without one nothing happens."""
        state = self._shown
        if state is not None and state.selected is not None:
            self.time_range.focus(state.selected.flag.start, state.selected.flag.end)
        elif state is not None and state.selection.span is not None:
            self.time_range.focus(*state.selection.span)

    def whole_take(self) -> None:
        """Show the whole take."""
        self.time_range.whole()

    def _click(self, at: QPointF) -> None:
        item = self.flag_at(at)
        if item is not None:
            self._bridge.document.select_flag(item.flag.id)

    def _sweep(self, begin: QPointF, end: QPointF, _done: bool) -> None:
        top = self.plot.area.top()
        rows = self._rows.rows_between(begin.y() - top, end.y() - top)
        if rows:
            span = self.plot.span_between(begin.x(), end.x())
            self._bridge.document.select(joints=rows, span=span, flag="")

    def _select_rows(self, rows: frozenset[str], adds: bool) -> None:
        if self._shown is not None:
            chosen = rows | self._shown.selection.joints if adds else rows
            self._bridge.document.select(joints=chosen, flag="")

    def _move_threshold(self, threshold: float, done: bool) -> None:
        self._threshold = threshold
        self._map_layer.refresh()
        if done:
            self._throttle.stop()
            self._send_threshold()
        elif not self._throttle.isActive():
            self._throttle.start()

    def _send_threshold(self) -> None:
        self._bridge.document.set_threshold(self._threshold)

    # -- reading off

    def _hover(self, at: QPointF | None) -> None:
        area = self.plot.area
        inside = at is not None and area.contains(at)
        row = self._rows.row_at(at.y() - area.top()) if inside and at is not None else None
        self._pointer = at if inside else None
        if row != self._hovered:
            self._hovered = row
            self._mark_rows()
        if not inside:
            self._dwell.stop()
            QToolTip.hideText()
        elif QToolTip.isVisible():
            self._show_tip()
        else:
            self._dwell.start()

    def _show_tip(self) -> None:
        at = self._pointer
        self.plot.tell(at, "" if at is None else self.read_out(at))

    def read_out(self, at: QPointF) -> str:
        """Say in words what lies at a place of the plot, or "" where nothing does."""
        state = self._shown
        if state is None or state.take is None or self._map is None:
            return ""
        frame = self.plot.whole_frame_at(at.x())
        edits = [one for one in state.sitting.edits if one.performer == state.active]
        row = self._rows.row_at(at.y() - self.plot.area.top())
        if row is None:
            return "\n".join(map_readout.edit_lines(edits, frame))
        lines = [map_readout.place(self._map, state.take, row, frame)]
        item = self.flag_at(at)
        if item is not None:
            lines.append(map_readout.flag_line(item))
        lines += map_readout.edit_lines(edits, frame, row)
        spans = (one for one in state.sitting.protected if one.performer == state.active)
        if map_readout.is_protected(spans, frame, row):
            lines.append("protected")
        return "\n".join(lines)
