"""Lanes of all markers over time, their names left of them."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QToolTip, QWidget

from mocapstudio.gui import theme as themes
from mocapstudio.gui import wording
from mocapstudio.gui.markers.bridge import MarkersBridge, MarkersShown
from mocapstudio.gui.markers.lane_drawing import Cell, cell_colour, cells, side_groups
from mocapstudio.gui.markers.lane_plot import LanePlot
from mocapstudio.gui.plots.axes import TIME_AXIS_HEIGHT, small_font
from mocapstudio.gui.plots.row_labels import RowLabels
from mocapstudio.gui.plots.rows import RowLayout
from mocapstudio.gui.plots.time_plot import RIGHT_GUTTER
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.gui.widgets.native import NativeView

_WORDS = {Cell.MISSING: "missing", Cell.FILLED: "filled", Cell.MEASURED: "measured"}


class LanesView(NativeView):
    """Shows when which marker is missing or filled.

    A click chooses a marker, goes to the frame and chooses the gap there; Shift and drag chooses
    a span; a double click zooms to it.

    Parameters
    ----------
    bridge
        What is shown and chosen.
    time_range
        The visible frames, shared with the curves.
    """

    def __init__(self, bridge: MarkersBridge, time_range: TimeRange) -> None:
        super().__init__()
        self.setObjectName("markers-lanes")
        self.setProperty("role", "panel")
        self._bridge = bridge
        self.plot = LanePlot(time_range)
        self.names = RowLabels()
        self._legend = _Legend(bridge)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        for part in (self.names, self.plot, self._legend):
            row.addWidget(part, 1 if part is self.plot else 0)
        self.setMinimumHeight(120)
        self.plot.scrubbed.connect(bridge.go)
        self.plot.clicked.connect(self._click)
        self.plot.swept.connect(self._sweep)
        self.plot.hovered.connect(self._hover)
        self.plot.focus_wanted.connect(self.zoom)
        self.names.rows_clicked.connect(lambda rows, _adds: self._choose(rows))
        bridge.changed.connect(self._follow)
        self._show(bridge.shown)

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        self.plot.restyle()
        self.names.update()
        self._legend.update()

    def zoom(self) -> None:
        """Zoom to the chosen span."""
        if self._bridge.shown.span is not None:
            self.plot.time_range.focus(*self._bridge.shown.span)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Give the names their places."""
        super().resizeEvent(event)
        self._place_names(self._bridge.shown)

    def _follow(self, old: MarkersShown, new: MarkersShown) -> None:
        if old.result is not new.result:
            self._show(new)
        elif (old.marker, old.span, old.protected) != (new.marker, new.span, new.protected):
            self._mark(new)
        if old.frame != new.frame:
            self.plot.set_frame(new.frame)
            self.plot.time_range.reveal(new.frame)

    def _show(self, shown: MarkersShown) -> None:
        take = shown.result
        if take is None:
            return
        self.plot.time_range.set_frames(take.frames)
        self.plot.time_axis.set_clock(float(take.rate), take.first_frame)
        self.plot.show_cells(cells(take), take.labels, side_groups(take.labels))
        self.plot.set_frame(shown.frame)
        self._place_names(shown)
        self._mark(shown)
        self._legend.update()

    def _place_names(self, shown: MarkersShown) -> None:
        if shown.result is not None:
            height = max(self.height() - TIME_AXIS_HEIGHT, 1)
            rows = RowLayout(side_groups(shown.result.labels), height)
            self.names.set_rows(rows, TIME_AXIS_HEIGHT)

    def _mark(self, shown: MarkersShown) -> None:
        self.plot.mark(shown.marker, shown.span)
        self.plot.protect(shown.protected)
        chosen = frozenset() if shown.marker is None else frozenset({shown.marker})
        worst = [one.label for one in shown.gaps.markers if one.gaps]
        self.names.set_marks(chosen, worst, None, edits=False)

    def _choose(self, rows: frozenset[str]) -> None:
        if len(rows) == 1:
            (name,) = rows
            self._bridge.choose(name)

    def _click(self, at: QPointF) -> None:
        self._bridge.choose(self.plot.marker_at(at), self.plot.whole_frame_at(at.x()))

    def _sweep(self, begin: QPointF, end: QPointF, _done: bool) -> None:
        marker = self.plot.marker_at(begin) or self._bridge.shown.marker
        self._bridge.set(marker=marker, span=self.plot.span_between(begin.x(), end.x()))

    def _hover(self, at: QPointF | None) -> None:
        shown = self._bridge.shown
        take, gaps = shown.result, shown.gaps
        name = None if at is None or not self.plot.area.contains(at) else self.plot.marker_at(at)
        if at is None or name is None or take is None:
            QToolTip.hideText()
            return
        frame = self.plot.whole_frame_at(at.x())
        words = f"{name} · {_WORDS[self.plot.cell_at(name, frame)]}"
        span = gaps.span_at(name, frame)
        if any(one.row == name and one.start <= frame < one.end for one in shown.protected):
            words += " · protected"
        words += f"\n{wording.span(take, *span)}" if span is not None else ""
        QToolTip.showText(self.plot.viewport().mapToGlobal(at.toPoint()), words, self.plot)


class _Legend(QWidget):
    """Which colour is what, and how much of it there is."""

    def __init__(self, bridge: MarkersBridge) -> None:
        super().__init__()
        self.setObjectName("markers-legend")
        self.setFixedWidth(RIGHT_GUTTER)
        self.setToolTip("Share of all samples that are missing, filled, measured")
        self._bridge = bridge

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw a swatch, a word and a share for each."""
        look, take = themes.current(), self._bridge.shown.result
        p = QPainter(self)
        p.fillRect(self.rect(), QColor(look.panel))
        if take is not None:
            missing = float(take.missing.mean())
            filled = 0.0 if take.filled is None else float((take.filled & ~take.missing).mean())
            shares = {Cell.MISSING: missing, Cell.FILLED: filled}
            shares[Cell.MEASURED] = 1.0 - missing - filled
            p.setFont(small_font())
            for number, (cell, share) in enumerate(shares.items()):
                top = TIME_AXIS_HEIGHT + 4 + 36 * number
                p.fillRect(QRectF(6, top + 3, 9, 9), cell_colour(look, cell))
                p.setPen(QColor(look.muted))
                p.drawText(QRectF(19, top, self.width() - 19, 15), 0, _WORDS[cell])
                p.setPen(QColor(look.text))
                p.drawText(QRectF(19, top + 15, self.width() - 19, 15), 0, f"{share:.2%}")
        p.end()
