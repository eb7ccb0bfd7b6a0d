"""Where the chosen marker is over time: x, y and z, as read and with the edits."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen
from PySide6.QtWidgets import QHBoxLayout, QLabel, QStackedLayout, QWidget

from mocapstudio.gui import theme as themes
from mocapstudio.gui.markers.bridge import MarkersBridge, MarkersShown
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.axes import ValueAxis
from mocapstudio.gui.plots.curve_panels import VALUE_AXIS_WIDTH, CurvePanel, ReadOut
from mocapstudio.gui.plots.curve_set import CurveSet, Role
from mocapstudio.gui.plots.layers import Layer
from mocapstudio.gui.plots.quantities import Curves
from mocapstudio.gui.plots.time_plot import TimePlot
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.gui.widgets.native import NativeView
from mocapstudio.motion.markers import MarkerTake

_LEAST = 0.02
_AXES = ("x", "y", "z")


class CurvesView(NativeView):
    """Curves of one marker; gaps and filled spans are shaded, a drag chooses a span.

    Parameters
    ----------
    bridge
        What is shown and chosen.
    time_range
        The visible frames, shared with the lanes.
    """

    def __init__(self, bridge: MarkersBridge, time_range: TimeRange) -> None:
        super().__init__()
        self.setObjectName("markers-curves")
        self.setProperty("role", "panel")
        self._bridge, self._time_range = bridge, time_range
        self.axis = ValueAxis(VALUE_AXIS_WIDTH)
        self.axis.set_unit("m")
        self.plot = TimePlot(time_range, axis="bottom", left=self.axis, sweeps=True)
        self.plot.setObjectName("markers-curves-plot")
        self.panel, self.values = CurvePanel(), ReadOut()
        self.panel.chooser.hide()
        self.curve_set = CurveSet(self.plot.plotItem)
        self._under = self.plot.add_layer(Layer(self._draw_under, cached=True), -1)
        self._lay_out()
        self.plot.scrubbed.connect(bridge.go)
        self.plot.swept.connect(self._sweep)
        self.plot.focus_wanted.connect(self._zoom)
        time_range.changed.connect(self._fit)
        bridge.changed.connect(self._follow)
        self._show(bridge.shown)

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        self.plot.restyle()
        self.axis.update()
        self.curve_set.restyle()
        self.panel.legend.update()
        self.values.update()

    def _lay_out(self) -> None:
        desk = QWidget()
        row = QHBoxLayout(desk)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        for part in (self.panel, self.plot, self.values):
            row.addWidget(part, 1 if part is self.plot else 0)
        empty = QLabel("Choose a marker to see its curves")
        empty.setProperty("role", "hint")
        empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(desk)
        self._stack.addWidget(empty)
        self.setMinimumHeight(100)

    def _follow(self, old: MarkersShown, new: MarkersShown) -> None:
        if old.result is not new.result or old.marker != new.marker:
            self._show(new)
        elif old.span != new.span:
            self._under.refresh()
        if old.frame != new.frame:
            self.plot.set_frame(new.frame)
            self._read_out(new)

    def _show(self, shown: MarkersShown) -> None:
        source, result, marker = shown.source, shown.result, shown.marker
        self._stack.setCurrentIndex(1 if marker is None else 0)
        if source is None or result is None or marker is None:
            for role in Role:
                self.curve_set.set(role, None)
            return
        self.plot.time_axis.set_clock(float(result.rate), result.first_frame)
        at = source.index[marker]
        before, after = source.positions[:, at], result.positions[:, at]
        edited = not np.array_equal(before, after, equal_nan=True)
        self.curve_set.set(Role.ORIGINAL, _curves(source, at))
        self.curve_set.set(Role.RESULT, _curves(result, at) if edited else None)
        self.panel.show_row(marker, 0)
        roles = (Role.ORIGINAL, Role.RESULT) if edited else (Role.ORIGINAL,)
        self.panel.legend.set_roles(roles, _AXES)
        self.plot.set_frame(shown.frame)
        self._fit()
        self._read_out(shown)

    def _fit(self) -> None:
        shown = self._time_range
        extent = self.curve_set.extent(shown.start, shown.end, _LEAST)
        if extent is not None:
            self.plot.plotItem.vb.setYRange(*extent, padding=0)
        self._under.refresh()

    def _read_out(self, shown: MarkersShown) -> None:
        edited = self.curve_set.curves(Role.RESULT) is not None
        values = self.curve_set.value(Role.RESULT if edited else Role.ORIGINAL, shown.frame)
        if values is None:
            self.values.show_values(())
            return
        texts = ("–" if np.isnan(one) else f"{one:.3f}".replace("-", "−") for one in values)
        self.values.show_values(tuple(zip(_AXES, texts, strict=True)))

    def _draw_under(self, p: QPainter, area: QRectF) -> None:
        look, shown = themes.current(), self._bridge.shown
        if shown.marker is None:
            return
        one = shown.gaps.by_label[shown.marker]
        for spans, colour in ((one.gaps, look.rejected), (one.filled, look.result)):
            for start, end in spans:
                self._shade(p, area, (start, end), colours.faded(colour, 0.2))
        if shown.span is not None:
            left, right = self._shade(p, area, shown.span, colours.faded(look.accent, 0.12))
            p.setPen(QPen(colours.faded(look.accent, 0.7), 1))
            for x in (left, right):
                p.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()))
        low, high = self.plot.plotItem.vb.viewRange()[1]
        for value, _ in self.axis.marks():
            y = area.bottom() - (value - low) / max(high - low, 1e-12) * area.height()
            p.setPen(QPen(colours.mixed(look.field, look.border, 0.5), 1))
            p.drawLine(QPointF(area.left(), y), QPointF(area.right(), y))

    def _shade(
        self, p: QPainter, area: QRectF, span: tuple[int, int], colour: QColor
    ) -> tuple[float, float]:
        left = self.plot.x_of(span[0] - 0.5)
        right = max(self.plot.x_of(span[1] - 0.5), left + 1.5)
        if right >= area.left() and left <= area.right():
            p.fillRect(QRectF(left, area.top(), right - left, area.height()), colour)
        return left, right

    def _zoom(self) -> None:
        if self._bridge.shown.span is not None:
            self._time_range.focus(*self._bridge.shown.span)

    def _sweep(self, begin: QPointF, end: QPointF, _done: bool) -> None:
        self._bridge.set(span=self.plot.span_between(begin.x(), end.x()))


def _curves(take: MarkerTake, at: int) -> Curves:
    return Curves(_AXES, "m", np.asfortranarray(take.positions[:, at]))
