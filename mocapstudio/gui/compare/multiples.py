"""All sources below each other over the reference's time: differences, timing, misalignment."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QFontMetricsF, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QHBoxLayout, QWidget

from mocapstudio.gui import theme as themes
from mocapstudio.gui.compare import colours as kinds
from mocapstudio.gui.compare import heat_drawing as drawing
from mocapstudio.gui.compare.bridge import CompareBridge, CompareUi
from mocapstudio.gui.compare.heat_drawing import Scale
from mocapstudio.gui.compare.heat_layout import LANE
from mocapstudio.gui.compare.layout import Stretch
from mocapstudio.gui.compare.margins import TimingLegend
from mocapstudio.gui.compare.naming import short_names
from mocapstudio.gui.compare.pooling import columns
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.axes import small_font
from mocapstudio.gui.plots.layers import Layer
from mocapstudio.gui.plots.pooling import block_length
from mocapstudio.gui.plots.time_plot import LEFT_GUTTER, TimePlot
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.gui.widgets.native import NativeView
from mocapstudio.review.comparing import Compared, ComparingState, Linked
from mocapstudio.review.comparing_state import only_heads_differ

_GAP = 3.0


class MultiplesPlot(TimePlot):
    """A strip a source over the frames of the reference, the most alike uppermost.

    Parameters
    ----------
    time_range
        Visible reference frames.
    state
        Returns the state to be drawn.
    """

    source_pressed = Signal(str)
    """Id of the source whose strip was pressed."""

    def __init__(self, time_range: TimeRange, state: Callable[[], ComparingState]) -> None:
        self._state = state
        super().__init__(time_range, axis="top")
        self._strips = self.add_layer(Layer(self._draw, cached=True), 1)

    def refresh(self) -> None:
        """Draw anew."""
        self._strips.refresh()

    def strips(self) -> list[tuple[Compared, QRectF]]:
        """All sources with the place of each."""
        ranking, area = self._state().ranking, self.area
        height = (area.height() - LANE - _GAP) / max(len(ranking), 1)
        return [
            (one, QRectF(area.left(), area.top() + k * height, area.width(), height - _GAP))
            for k, one in enumerate(ranking)
        ]

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose the source under the mouse, and go to the moment."""
        for one, strip in self.strips():
            if strip.contains(event.position()):
                self.source_pressed.emit(one.id)
        super().mousePressEvent(event)

    def _draw(self, p: QPainter, area: QRectF) -> None:
        state = self._state()
        compared = [one for one in state.sources if one.linked is not None]
        highs = [
            float(np.nanmax(one.comparison.pose_difference)) for one in compared if one.comparison
        ]
        gaps = [float(np.abs(_gap(one, state)).max()) for one in compared]
        high, gap = max(highs, default=1.0), max([*gaps, 0.1])
        for one, strip in self.strips():
            chosen = one.id == state.chosen
            ground = colours.mixed(
                themes.current().field, themes.current().selection, 0.45 if chosen else 0.0
            )
            p.fillRect(strip, ground)
            if one.linked is not None:
                self._draw_strip(p, strip, one, (high, gap))
        lane = QRectF(area.left(), area.bottom() - LANE, area.width(), LANE)
        shown = Stretch(self.time_range.start, self.time_range.end)
        spans = [(one.name, one.start, one.end) for one in state.segments]
        scale = Scale(area.left(), area.width(), shown)
        drawing.draw_segments(p, lane, scale, spans, state.segment)
        p.setPen(QPen(colours.faded(themes.current().playhead, 0.25), 1))
        for _, start, end in spans:
            for edge in (start, end):
                x = scale.x(edge - 0.5)
                p.drawLine(QPointF(x, area.top()), QPointF(x, lane.top()))

    def _draw_strip(
        self, p: QPainter, strip: QRectF, one: Compared, most: tuple[float, float]
    ) -> None:
        assert one.linked is not None
        assert one.comparison is not None
        look, matched = themes.current(), one.linked.matched
        step = block_length(self.time_range.length / max(strip.width(), 1.0))
        shown = self.time_range.start, self.time_range.end
        timing = one.comparison.timing[matched]
        pooled = columns(one.comparison.pose_difference[matched], timing, *shown, step)
        if not len(pooled.first):
            return
        left = np.rint(
            [self.x_of(f - 0.5) for f in np.append(pooled.first, pooled.first[-1] + step)]
        )
        tops = strip.bottom() - 0.92 * strip.height() * pooled.high / max(most[0], 1e-9)
        for k in np.flatnonzero(np.isfinite(tops)):
            colour = kinds.timing(look, pooled.timing[k])
            bar = QRectF(
                left[k], tops[k], max(left[k + 1] - left[k], 1.0), strip.bottom() - tops[k]
            )
            p.fillRect(bar, colours.faded(colour, 0.5))
        gap = columns(_gap(one, self._state())[matched], timing, *shown, step)
        level = 0.5 * (gap.low + gap.high)
        middle = strip.center().y()
        y = middle - 0.45 * strip.height() * level / most[1]
        p.setPen(QPen(colours.faded(look.text, 0.25), 1))
        p.drawLine(QPointF(strip.left(), middle), QPointF(strip.right(), middle))
        p.setRenderHint(QPainter.RenderHint.Antialiasing)
        p.setPen(QPen(QColor(look.text), 1.3))
        half = 0.5 * (left[1] - left[0])
        p.drawPolyline(QPolygonF([QPointF(x + half, v) for x, v in zip(left[:-1], y, strict=True)]))
        p.setRenderHint(QPainter.RenderHint.Antialiasing, False)


def _gap(one: Compared, state: ComparingState) -> NDArray[np.float64]:
    assert one.comparison is not None
    if state.parameters.true_speed:
        return one.comparison.misalignment
    return one.comparison.misalignment_relative


class _Names(QWidget):
    """Rank, name and figures of each source beside its strip."""

    def __init__(self, plot: MultiplesPlot, bridge: CompareBridge) -> None:
        super().__init__()
        self.setFixedWidth(LEFT_GUTTER)
        self._plot, self._bridge = plot, bridge

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw the names."""
        look, state = themes.current(), self._bridge.state
        p = QPainter(self)
        p.fillRect(self.rect(), QColor(look.panel))
        left = int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        metrics = QFontMetricsF(small_font())
        short = short_names([one.id for one in state.sources])
        for rank, (one, strip) in enumerate(self._plot.strips(), start=1):
            number = state.sources.index(one)
            middle = strip.center().y()
            tall = strip.height() >= 30
            line = middle - (7 if tall else 0)
            p.setRenderHint(QPainter.RenderHint.Antialiasing)
            p.setPen(Qt.PenStyle.NoPen)
            p.setBrush(QColor(kinds.source(look, number)))
            p.drawEllipse(QPointF(14, line), 4, 4)
            p.setFont(small_font())
            p.setPen(QColor(look.text if one.id == state.chosen else look.muted))
            name = f"{rank if one.linked is not None else '–'}  {short[one.id]}"
            text = metrics.elidedText(name, Qt.TextElideMode.ElideMiddle, self.width() - 34)
            p.drawText(QRectF(24, line - 8, self.width() - 28, 16), left, text)
            if tall and one.comparison is not None:
                p.setFont(small_font(10))
                p.setPen(QColor(look.faint))
                off = np.abs(_gap(one, state)).mean()
                facts = f"{one.comparison.dissimilarity:.3f} unlike · {off:.2f} s off"
                p.drawText(QRectF(24, line + 6, self.width() - 28, 16), left, facts)
        p.end()


class MultiplesView(NativeView):
    """The strips of all sources with their names.

    A click chooses the source and goes to the moment; zooming and panning as in the pictures,
    whose stretch of time it shows.

    Parameters
    ----------
    bridge
        Where state comes from and intents go.
    """

    def __init__(self, bridge: CompareBridge) -> None:
        super().__init__()
        self.setObjectName("compare-multiples-view")
        self._bridge = bridge
        self.time_range = TimeRange(self)
        self._following = False
        self._told: tuple[float, float] | None = None
        self.plot = MultiplesPlot(self.time_range, lambda: bridge.state)
        self.plot.setToolTip(
            "Bars: pose difference, coloured by timing. Line: misalignment, above the middle where"
            " the source is ahead."
        )
        self._names = _Names(self.plot, bridge)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addWidget(self._names)
        row.addWidget(self.plot, 1)
        row.addWidget(TimingLegend())
        self.plot.scrubbed.connect(bridge.sitting.go)
        self.plot.source_pressed.connect(bridge.sitting.choose)
        self.time_range.changed.connect(self._tell_range)
        bridge.changed.connect(self._follow)
        bridge.ui_changed.connect(self._follow_ui)

    def _follow_ui(self, old: CompareUi, new: CompareUi) -> None:
        if new.multiples and not old.multiples:
            self._show(self._bridge.state)

    def _follow(self, old: ComparingState, new: ComparingState) -> None:
        if not self._bridge.ui.multiples:
            return
        if only_heads_differ(old, new):
            self.plot.set_frame(new.frame)
        else:
            self._show(new)

    def _show(self, state: ComparingState) -> None:
        reference = state.reference
        if reference is None:
            return
        self.time_range.set_frames(reference.frames)
        self.plot.time_axis.set_clock(float(reference.rate), reference.first_frame)
        if state.linked is not None and state.shown != self._told:
            self._follow_range(state.linked, state.shown)
        self.plot.set_frame(state.frame)
        self.plot.refresh()
        self._names.update()

    def _follow_range(self, linked: Linked, shown: tuple[float, float]) -> None:
        """Show the reference's part of a stretch of the source."""
        self._told = shown
        self._following = True
        if shown[1] - shown[0] >= linked.frames[1]:
            self.time_range.whole()
        else:
            first, last = (linked.reference_of(edge) for edge in shown)
            self.time_range.show(first, last)
        self._following = False

    def _tell_range(self) -> None:
        linked = self._bridge.state.linked
        # What was only taken over must not come back, rounded, as a wish of its own.
        if linked is None or self._following or not self._bridge.ui.multiples:
            return
        if self.time_range.is_whole:
            self._told = (-0.5, linked.frames[1] - 0.5)
        else:
            start, end = self.time_range.start, self.time_range.end
            self._told = float(linked.source_of(start)), float(linked.source_of(end))
        self._bridge.sitting.show(*self._told)

    def changeEvent(self, event: QEvent) -> None:
        """Follow the theme."""
        super().changeEvent(event)
        if event.type() in (QEvent.Type.StyleChange, QEvent.Type.PaletteChange):
            self.plot.restyle()
            self._names.update()
