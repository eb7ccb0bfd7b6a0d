"""Slide and gap of the chosen lane over time, before and after the solve."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QRectF, Qt, QTimer
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QFrame, QGraphicsItem, QGridLayout, QLabel, QVBoxLayout, QWidget

from mocapstudio.cleaning.contacts.model import Contact
from mocapstudio.gui import theme as themes
from mocapstudio.gui.contacts.bridge import ContactsBridge, ContactsUi
from mocapstudio.gui.contacts.lanes import key_of, lanes_of
from mocapstudio.gui.contacts.measuring import Measured, measured
from mocapstudio.gui.contacts.reading import Readings
from mocapstudio.gui.plots.axes import ValueAxis, small_font
from mocapstudio.gui.plots.curve_panels import PANEL_WIDTH, VALUE_AXIS_WIDTH
from mocapstudio.gui.plots.layers import Layer
from mocapstudio.gui.plots.time_plot import RIGHT_GUTTER, TimePlot
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.gui.widgets.native import NativeView
from mocapstudio.review.state import DocumentState

_PAUSE, _DRAGGED = 30, 100
"""Milliseconds after which curves follow a change, and while something is dragged."""
_LEAST = {"slide": 2.0, "gap": 2.0}
_TITLES = {"slide": "Slide, cm/s", "gap": "Gap, mm"}
_WORDS = {
    "slide": "How fast points in contact move against what they touch, cm/s",
    "gap": "How far points in contact are from their targets, mm",
}


class CurvesView(NativeView):
    """Two plots under the lanes: slide and gap, before in grey and after in colour.

    They follow the chosen contact's lane, or all lanes while none is chosen, and what is being
    dragged.

    Parameters
    ----------
    bridge
        What is chosen and dragged.
    readings
        Points of the take under review.
    time_range
        The visible frames, shared with the lanes.
    """

    def __init__(self, bridge: ContactsBridge, readings: Readings, time_range: TimeRange) -> None:
        super().__init__()
        self.setObjectName("contacts-curves")
        self.setProperty("role", "panel")
        self._bridge, self._readings = bridge, readings
        self.before: Measured | None = None
        self.after: Measured | None = None
        self.plots = {
            "slide": _CurvePlot(time_range, "slide", last=False),
            "gap": _CurvePlot(time_range, "gap", last=True),
        }
        self._panel = _Panel()
        self._values = {name: _Values() for name in self.plots}
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(0)
        grid.addWidget(self._panel, 0, 0, 2, 1)
        for row, (name, plot) in enumerate(self.plots.items()):
            grid.addWidget(plot, row, 1)
            grid.addWidget(self._values[name], row, 2)
            # The lower one has the time axis as well.
            grid.setRowStretch(row, 10 + 3 * row)
            plot.scrubbed.connect(lambda frame: bridge.desk.document.set_frame(frame))
        self.setMinimumHeight(110)
        self._soon = QTimer(self)
        self._soon.setSingleShot(True)
        self._soon.timeout.connect(self.refresh)
        bridge.desk.changed.connect(self._follow)
        bridge.ui_changed.connect(self._follow_ui)
        readings.changed.connect(self.refresh)
        time_range.changed.connect(self._fit)
        self.refresh()

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        for plot in self.plots.values():
            plot.restyle()
        self._panel.update()
        for one in self._values.values():
            one.update()

    def refresh(self) -> None:
        """Measure and draw anew."""
        self._soon.stop()
        reading, state = self._readings.now, self._bridge.desk.state
        contacts, name = self._shown()
        self.before = self.after = None
        if reading is not None and reading.source is state.take:
            self.before = measured(reading, contacts, after=False)
            if reading.solved:
                self.after = measured(reading, contacts, after=True)
        self._panel.tell(name if contacts else "", self.before, self.after)
        for quantity, plot in self.plots.items():
            pair = [None if one is None else getattr(one, quantity)
                    for one in (self.before, self.after)]  # fmt: skip
            plot.show_curves(*pair)
            if state.take is not None:
                plot.time_axis.set_clock(float(state.take.rate), state.take.first_frame)
            plot.set_frame(state.frame)
        self._fit()
        self._read_out(state.frame)

    def _shown(self) -> tuple[list[Contact], str]:
        contacts, take = self._bridge.contacts, self._bridge.desk.state.take
        chosen = self._bridge.chosen or self._bridge.ui.held
        if chosen is None or take is None:
            return [one for one in contacts if one.id], "All contacts"
        key = key_of(chosen)
        reading = self._readings.now
        points = () if reading is None else reading.points
        lanes = lanes_of(take.skeleton, points, contacts)
        name = next((one.name for one in lanes if one.key == key), key[0])
        return [one for one in contacts if key_of(one) == key and one.id], name

    def _follow(self, old: DocumentState, new: DocumentState) -> None:
        if old.sitting is not new.sitting or old.active != new.active or old.take is not new.take:
            self._soon.start(_PAUSE)
        if old.frame != new.frame:
            for plot in self.plots.values():
                plot.set_frame(new.frame)
            self._read_out(new.frame)

    def _follow_ui(self, _old: ContactsUi, new: ContactsUi) -> None:
        if new.held is None:
            self._soon.start(_PAUSE)
        elif not self._soon.isActive():
            self._soon.start(_DRAGGED)

    def _fit(self) -> None:
        for plot in self.plots.values():
            plot.fit()

    def _read_out(self, frame: int) -> None:
        for quantity, values in self._values.items():
            pair = []
            for one in (self.before, self.after):
                curve = None if one is None else getattr(one, quantity)
                pair.append(np.nan if curve is None else float(curve[min(frame, len(curve) - 1)]))
            values.tell(pair[0], pair[1])


class _CurvePlot(TimePlot):
    """Before and after of one quantity."""

    def __init__(self, time_range: TimeRange, quantity: str, *, last: bool) -> None:
        self.value_axis = ValueAxis(VALUE_AXIS_WIDTH)
        self._before, self._after = _curve(0), _curve(1)
        self._least = _LEAST[quantity]
        self._drawn: list[NDArray[np.float64]] = []
        super().__init__(time_range, axis="bottom", left=self.value_axis)
        self.setObjectName(f"contacts-{quantity}")
        self.setToolTip(_WORDS[quantity])
        if not last:
            self.plotItem.showAxis("bottom", False)
        self._title = _TITLES[quantity]
        self.add_layer(Layer(self._draw_title), 6)
        for item in (self._before, self._after):
            self.plotItem.addItem(item)
        self.restyle()

    def show_curves(
        self, before: NDArray[np.float64] | None, after: NDArray[np.float64] | None
    ) -> None:
        """Show (F,) values, NaN for gaps."""
        self._drawn = [one for one in (before, after) if one is not None]
        for item, curve in ((self._before, before), (self._after, after)):
            if curve is None:
                item.setData([], [])
            else:
                item.setData(np.arange(len(curve), dtype=float), curve)

    def fit(self) -> None:
        """Let the visible values fill the height."""
        shown, top = self.time_range, self._least
        for curve in self._drawn:
            part = curve[max(int(shown.start), 0) : max(int(shown.end) + 1, 0)]
            part = part[np.isfinite(part)]
            if part.size:
                top = max(top, float(part.max()))
        self.plotItem.vb.setYRange(-0.06 * top, 1.12 * top, padding=0)

    def _draw_title(self, p: QPainter, area: QRectF) -> None:
        look = themes.current()
        p.setPen(QPen(QColor(look.border), 1))
        p.drawLine(area.bottomLeft(), area.bottomRight())
        p.setFont(small_font())
        p.setPen(QColor(look.muted))
        p.drawText(area.adjusted(8, 5, 0, 0), int(Qt.AlignmentFlag.AlignLeft), self._title)

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        super().restyle()
        look = themes.current()
        self._before.setPen(_pen(look.faint if self._drawn[1:] else look.muted))
        self._after.setPen(_pen(look.result))


class _Panel(QFrame):
    """Name of the lane and what the lines are, with their means."""

    def __init__(self) -> None:
        super().__init__()
        self.setProperty("role", "panel")
        self.setFixedWidth(PANEL_WIDTH)
        self._name = QLabel()
        self._name.setProperty("role", "title")
        self._lines = _Legend()
        column = QVBoxLayout(self)
        column.setContentsMargins(8, 7, 2, 4)
        column.setSpacing(6)
        column.addWidget(self._name)
        column.addWidget(self._lines)
        column.addStretch(1)

    def tell(self, name: str, before: Measured | None, after: Measured | None) -> None:
        """Show means: slide in cm/s and the largest gap in mm."""
        self._name.setText(name or "Slide and gap")
        lines = []
        for words, one in (("before", before), ("after", after)):
            if one is not None and name:
                lines.append((words, f"{one.mean_slide:.1f} cm/s", f"{one.worst_gap:.0f} mm"))
        self._lines.tell(lines)


class _Legend(QWidget):
    def __init__(self) -> None:
        super().__init__()
        self._lines: Sequence[tuple[str, str, str]] = ()
        self.setFixedHeight(104)
        self.setToolTip("Mean slide in contact, and the largest gap")

    def tell(self, lines: Sequence[tuple[str, str, str]]) -> None:
        if lines != self._lines:
            self._lines = lines
            self.update()

    def paintEvent(self, _event: QPaintEvent) -> None:
        look = themes.current()
        p = QPainter(self)
        p.setFont(small_font())
        middle = int(Qt.AlignmentFlag.AlignVCenter)
        for row, (words, slide, gap) in enumerate(self._lines):
            top = row * 52
            p.setPen(_pen(look.muted if words == "before" else look.result))
            p.drawLine(2, top + 8, 18, top + 8)
            p.setPen(QColor(look.muted))
            p.drawText(QRectF(24, top, self.width() - 24, 16), middle, words)
            p.setPen(QColor(look.text))
            for line, value in enumerate((slide, gap), 1):
                p.drawText(QRectF(24, top + 15 * line, self.width() - 24, 16), middle, value)
        p.end()


class _Values(QWidget):
    """Values at the play head."""

    def __init__(self) -> None:
        super().__init__()
        self.setFixedWidth(RIGHT_GUTTER)
        # It changes at every frame: what lies behind need not be painted with it.
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self._pair = (np.nan, np.nan)

    def tell(self, before: float, after: float) -> None:
        """Show a value before and one after; NaN for none."""
        if not np.array_equal((before, after), self._pair, equal_nan=True):
            self._pair = (before, after)
            self.update()

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw them under one another."""
        look = themes.current()
        p = QPainter(self)
        p.fillRect(self.rect(), QColor(look.panel))
        p.setFont(small_font(12))
        for row, (value, colour) in enumerate(
            zip(self._pair, (look.muted, look.result), strict=True)
        ):
            if np.isfinite(value):
                p.setPen(QColor(colour))
                room = QRectF(8, 4 + 18 * row, self.width() - 18, 17)
                p.drawText(room, int(Qt.AlignmentFlag.AlignRight), f"{value:.1f}")
        p.end()


def _pen(colour: str) -> QPen:
    pen = QPen(QColor(colour), 1)
    pen.setCosmetic(True)
    return pen


def _curve(z: int) -> pg.PlotDataItem:
    item = pg.PlotDataItem(connect="finite", clipToView=True, autoDownsample=True,
                           downsampleMethod="peak", antialias=True)  # fmt: skip
    item.setZValue(z)
    item.curve.setCacheMode(QGraphicsItem.CacheMode.DeviceCoordinateCache)
    return item
