"""The three linked pictures of one comparison: pose difference, misalignment, colours."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPoint, QPointF, Qt, QTimer
from PySide6.QtWidgets import QGridLayout, QInputDialog, QMenu, QToolTip

from mocapstudio.comparison.model import Comparison
from mocapstudio.gui import theme as themes
from mocapstudio.gui.compare import colours as kinds
from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.compare.curve_plots import CurvePlot, DifferencePlot, MisalignmentPlot
from mocapstudio.gui.compare.heat_plot import HeatPlot
from mocapstudio.gui.compare.layout import frames_wide
from mocapstudio.gui.compare.margins import AxesLegend, HeatMargin, ReadOutPanel, TimingLegend
from mocapstudio.gui.plots.time_plot import TimePlot
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.gui.widgets.native import NativeView
from mocapstudio.gui.widgets.parts import Hint, panel
from mocapstudio.review.comparing import ComparingState

_DWELL_MS = 250


class PicturesView(NativeView):
    """Pose difference, misalignment and both performances as colours, over one stretch of time.

    A click goes to that moment, the wheel zooms about the pointer, the middle button pans, a
    click on a name selects its row; dragging in the lane at the bottom names a part.

    Parameters
    ----------
    bridge
        Where state comes from and intents go.
    """

    def __init__(self, bridge: CompareBridge) -> None:
        super().__init__()
        self.setObjectName("compare-pictures")
        self._bridge = bridge
        self._shown: ComparingState | None = None
        self._following = False
        self.time_range = TimeRange(self)
        self.difference = DifferencePlot(self.time_range)
        self.misalignment = MisalignmentPlot(self.time_range)
        self.heat = HeatPlot(self.time_range)
        self._margin = HeatMargin()
        self._difference_read = ReadOutPanel(
            "Pose difference",
            "How far the source's pose is from the reference's at the same point of the movement,\n"
            "in box units: 1 is the box the body is scaled into. With a joint selected,\n"
            "its own share is the line in front.",
        )
        self._misalignment_read = ReadOutPanel(
            "Misalignment",
            "Seconds the source is ahead of the reference (above zero) or behind it (below).",
        )
        self._lay_out()
        self._wire()
        self.show_state(bridge.state, bridge.state)

    @property
    def plots(self) -> tuple[TimePlot, ...]:
        """The three plots, from above."""
        return self.difference, self.misalignment, self.heat

    def _lay_out(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(0)
        rows = (
            (self._difference_read, self.difference, TimingLegend()),
            (self._misalignment_read, self.misalignment, panel("")),
        )
        for row, (left, plot, right) in enumerate(rows):
            grid.addWidget(left, row, 0)
            grid.addWidget(plot, row, 1, 1, 2)
            grid.addWidget(right, row, 3)
            plot.setMinimumHeight(44)
        grid.addWidget(self._margin, 2, 0, 1, 2)
        grid.addWidget(self.heat, 2, 2)
        grid.addWidget(AxesLegend(), 2, 3)
        grid.setColumnMinimumWidth(1, 46)
        grid.setColumnStretch(2, 1)
        for row, stretch in enumerate((19, 16, 65)):
            grid.setRowStretch(row, stretch)
        self.heat.setMinimumHeight(120)
        self._hint = Hint(self.heat.viewport(), "pictures-hint")

    def _wire(self) -> None:
        sitting = self._bridge.sitting
        self._dwell = QTimer(self)
        self._dwell.setSingleShot(True)
        self._dwell.setInterval(_DWELL_MS)
        self._dwell.timeout.connect(self._show_tip)
        self._pointer: tuple[TimePlot, QPointF] | None = None
        for plot in self.plots:
            plot.scrubbed.connect(sitting.go_source)
            plot.focus_wanted.connect(self.zoom_to_segment)
            plot.hovered.connect(lambda at, plot=plot: self._hover(plot, at))
        self.heat.reference_scrubbed.connect(sitting.go)
        self.heat.segment_drawn.connect(sitting.add_segment)
        self.heat.segment_moved.connect(sitting.move_segment)
        self.heat.segment_chosen.connect(sitting.select_segment)
        self.heat.arranged.connect(self._arrange)
        self.heat.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.heat.customContextMenuRequested.connect(self._menu)
        self._margin.rows_clicked.connect(self._select_row)
        self.time_range.changed.connect(self._tell_range)
        self._bridge.changed.connect(self.show_state)
        self._bridge.restyled.connect(self.restyle)

    # -- state

    def show_state(self, _old: ComparingState, new: ComparingState) -> None:
        """Take over what differs from what is shown."""
        was, self._shown = self._shown, new
        linked, comparison = new.linked, new.comparison
        anew = was is None or linked is not was.linked or new.source is not was.source
        if anew:
            self._show_comparison(new)
        elif was is not None and new.shown != was.shown:
            self._follow_range(new)
        if anew or (was is not None and new.row != was.row):
            self._show_row(new)
        if anew or (was is not None and (new.segments, new.segment) != (was.segments, was.segment)):
            self.heat.show_segments(new.segments, new.segment)
        if anew or was is None or (new.frame, new.source_frame) != (was.frame, was.source_frame):
            self._move_heads(new, comparison)

    def _show_comparison(self, state: ComparingState) -> None:
        comparison = state.comparison
        true_speed = state.parameters.true_speed
        if comparison is not None:
            self._following = True
            self.time_range.set_frames(frames_wide(comparison, true_speed))
            self._follow_range(state)
            self._set_clocks(state)
            self._margin.tell(comparison.source, comparison.reference)
        elif state.source is not None:
            self._following = True
            self.time_range.set_frames(state.source.take.frames)
            self._following = False
            self._set_clocks(state)
        self._hint.say(_waiting(state))
        self.heat.show_comparison(state.linked, true_speed)
        gap = None
        if comparison is not None:
            gap = comparison.misalignment if true_speed else comparison.misalignment_relative
        self.misalignment.show_curve(comparison, gap)

    def _set_clocks(self, state: ComparingState) -> None:
        if state.source is not None:
            take = state.source.take
            self.difference.time_axis.set_clock(float(take.rate), take.first_frame)
        if state.reference is not None:
            take = state.reference
            self.heat.reference_axis.set_clock(float(take.rate), take.first_frame)

    def _show_row(self, state: ComparingState) -> None:
        comparison = state.comparison
        beside = None
        if comparison is not None and state.row in comparison.rows:
            beside = comparison.joint_difference[:, comparison.rows.index(state.row)]
        values = None if comparison is None else comparison.pose_difference
        self.difference.show_curve(comparison, values, beside)
        self.heat.show_row(state.row)
        self._margin.mark(state.row)

    def _move_heads(self, state: ComparingState, comparison: Comparison | None) -> None:
        for plot in (self.difference, self.misalignment):
            plot.set_frame(state.source_frame)
        self.heat.set_frames(state.frame, state.source_frame)
        self.time_range.reveal(state.source_frame)
        if comparison is None:
            self._difference_read.tell("")
            self._misalignment_read.tell("")
            return
        self._difference_read.tell(*self._difference_words(state, comparison))
        gap = self.misalignment.value(state.source_frame)
        kind = int(comparison.timing[min(state.source_frame, len(comparison.timing) - 1)])
        written = "" if gap is None else f"{gap:+.2f} s".replace("-", "−")
        colour = kinds.timing(themes.current(), kind)
        self._misalignment_read.tell(written, kinds.TIMING_WORDS[kind], colour)

    @staticmethod
    def _difference_words(state: ComparingState, comparison: Comparison) -> tuple[str, str]:
        at = min(state.source_frame, len(comparison.pose_difference) - 1)
        words = ""
        if state.row in comparison.rows:
            own = comparison.joint_difference[at, comparison.rows.index(state.row)]
            words = f"{state.row} {own:.3f}"
        return f"{comparison.pose_difference[at]:.2f}", words

    def _arrange(self) -> None:
        self._margin.arrange(self.heat.rows, self.heat.bands)

    def _follow_range(self, state: ComparingState) -> None:
        self._following = True
        self.time_range.show(*state.shown)
        self._following = False

    def _tell_range(self) -> None:
        # What was only taken over, and clipped, must not come back as a wish of its own.
        if self._following:
            return
        self._bridge.sitting.show(self.time_range.start, self.time_range.end)

    def changeEvent(self, event: QEvent) -> None:
        """Follow the theme."""
        super().changeEvent(event)
        if event.type() in (QEvent.Type.StyleChange, QEvent.Type.PaletteChange):
            self.restyle()

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        for plot in self.plots:
            plot.restyle()
            if isinstance(plot, CurvePlot):
                plot.values_axis.update()
        self._margin.restyle()

    # -- intents

    def zoom_to_segment(self) -> None:
        """Zoom to the selected segment; without one, to about a second around the play head."""
        state = self._bridge.state
        linked = state.linked
        if linked is None:
            return
        if state.segment is not None:
            segment = state.segments[state.segment]
            start, end = linked.source_of(segment.start), linked.source_of(segment.end)
            room = 0.1 * max(end - start, 4)
            self.time_range.show(start - room, end + room)
        else:
            half = 0.5 * float(linked.comparison.source_rate)
            self.time_range.show(state.source_frame - half, state.source_frame + half)

    def whole(self) -> None:
        """Show all of both performances."""
        self.time_range.whole()

    def _select_row(self, rows: frozenset[str], _adds: bool) -> None:
        state = self._bridge.state
        row = next(iter(sorted(rows, key=lambda name: self.heat.rows.index.get(name, 0))), None)
        self._bridge.sitting.select_row(None if row == state.row else row)

    def _menu(self, at: QPoint) -> None:
        number = self.heat.segment_at(QPointF(at))
        if number is None:
            return
        sitting = self._bridge.sitting
        menu = QMenu(self)
        menu.setObjectName("segment-menu")
        menu.addAction("Rename…", lambda: self.rename(number))
        menu.addAction("Delete", lambda: sitting.delete_segment(number))
        menu.popup(self.heat.mapToGlobal(at))

    def rename(self, number: int) -> None:
        """Ask for another name of a segment."""
        dialog = QInputDialog(self)
        dialog.setObjectName("rename-segment")
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.setWindowTitle("Rename segment")
        dialog.setLabelText("Name")
        dialog.setTextValue(self._bridge.state.segments[number].name)
        dialog.textValueSelected.connect(
            lambda name: self._bridge.sitting.rename_segment(number, name)
        )
        dialog.open()

    # -- reading off

    def _hover(self, plot: TimePlot, at: QPointF | None) -> None:
        inside = at is not None and plot.area.contains(at)
        self._pointer = (plot, at) if inside and at is not None else None
        if not inside:
            self._dwell.stop()
            QToolTip.hideText()
        elif QToolTip.isVisible():
            self._show_tip()
        else:
            self._dwell.start()

    def _show_tip(self) -> None:
        if self._pointer is None:
            return
        plot, at = self._pointer
        text = self.read_out(plot, at)
        corner = plot.viewport().mapToGlobal(at.toPoint()) + QPoint(12, 8)
        QToolTip.showText(corner, text, plot)

    def read_out(self, plot: TimePlot, at: QPointF) -> str:
        """Say in words what lies at a place of a plot, or "" where nothing does."""
        state = self._bridge.state
        comparison, linked = state.comparison, state.linked
        if comparison is None or linked is None or state.source is None:
            return ""
        frame = min(max(round(plot.frame_at(at.x())), 0), len(comparison.warp) - 1)
        if plot is self.heat and at.y() > self.heat.bands.reference.top():
            frame = linked.source_of(self.heat.reference_frame_at(at.x()))
        other = linked.reference_of(frame)
        rates = float(comparison.source_rate), float(comparison.reference_rate)
        lines = [
            f"source {frame / rates[0]:.2f} s, reference {other / rates[1]:.2f} s",
            f"{comparison.misalignment[frame]:+.2f} s,"
            f" {kinds.TIMING_WORDS[int(comparison.timing[frame])]}".replace("-", "−"),
            f"pose difference {comparison.pose_difference[frame]:.2f}",
        ]
        row = self.heat.row_at(at) if plot is self.heat else None
        if row is not None:
            own = comparison.joint_difference[frame, comparison.rows.index(row)]
            lines.insert(0, f"{row}: {own:.3f} apart")
        return "\n".join(lines)


def _waiting(state: ComparingState) -> str:
    """Say why there is nothing to see yet, or "" where there is."""
    source = state.source
    if source is None or source.linked is not None:
        return ""
    if source.failure:
        return f"{source.id} is not compared: {source.failure}"
    return f"Comparing {source.id}…"
