"""Curves of the selected joint: original, proposal, result."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QColor, QPainter, QPen
from PySide6.QtWidgets import QWidget

from mocapstudio.formats.euler_order import euler_order
from mocapstudio.gui import theme as themes
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.axes import ValueAxis
from mocapstudio.gui.plots.curve_panels import VALUE_AXIS_WIDTH, CurvePanel, ReadOut
from mocapstudio.gui.plots.curve_set import CurveSet, Role, differing
from mocapstudio.gui.plots.layers import Layer, draw_trim
from mocapstudio.gui.plots.plot_view import HintedPlotView, in_a_row
from mocapstudio.gui.plots.quantities import (
    Curves,
    Quantity,
    curves,
    has_row,
    quantities_of,
    unit_of,
)
from mocapstudio.gui.plots.time_plot import TimePlot
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.motion.take import Take

if TYPE_CHECKING:
    from mocapstudio.cleaning.model import Proposal
    from mocapstudio.review.document import DocumentState

# The smallest stretch of values shown, so that noise of a still joint does not fill the plot.
_LEAST = {"°": 2.0, "m": 0.02, "m/s": 0.1, "°/s": 10.0}
_DECIMALS = {"°": 1, "m": 3, "m/s": 2, "°/s": 0}
_DEFAULT_ORDER = "ZXY"


class CurvesView(HintedPlotView):
    """Shows one quantity of the selected row over time, before and after.

    A click moves the play head, a drag selects a span; zooming and panning as in the map.

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
        self.setProperty("role", "panel")
        self._bridge = bridge
        self._shown: DocumentState | None = None
        self._row: str | None = None
        self._result: Take | None = None
        self._proposal: Proposal | None = None
        self._wanted: dict[tuple[Quantity, ...], Quantity] = {}
        self.time_range = time_range if time_range is not None else TimeRange(self)
        self.axis = ValueAxis(VALUE_AXIS_WIDTH)
        self.plot = TimePlot(self.time_range, axis="bottom", left=self.axis, sweeps=True)
        self.panel = CurvePanel()
        self.values = ReadOut()
        self.curve_set = CurveSet(self.plot.plotItem)
        self._under = self.plot.add_layer(Layer(self._draw_under, cached=True), -1)
        self._over = self.plot.add_layer(Layer(self._draw_over, cached=True), 5)
        self._lay_out()
        self.plot.scrubbed.connect(lambda frame: self._bridge.document.set_frame(frame))
        self.plot.swept.connect(self._sweep)
        self.plot.focus_wanted.connect(self.zoom_to_selection)
        self.panel.chosen.connect(self._choose)
        self.time_range.changed.connect(self._fit)
        bridge.changed.connect(self.show_state)
        self.show_state(None, bridge.state)

    def _lay_out(self) -> None:
        desk = in_a_row(self.panel, self.plot, self.values)
        self.stand(desk, "Select a joint or a flag to see its curves")
        self.setMinimumHeight(100)

    # -- state

    @property
    def row(self) -> str | None:
        """The joint or root row whose curves are shown."""
        return self._row

    @property
    def quantity(self) -> Quantity | None:
        """What is shown of it."""
        if self._row is None:
            return None
        offered = quantities_of(self._row)
        return self._wanted.get(offered, offered[0])

    def show_state(self, _old: DocumentState | None, new: DocumentState) -> None:
        """Take over what differs from what is shown."""
        was, self._shown = self._shown, new
        take = new.take
        if take is not None and (was is None or take is not was.take):
            self.time_range.set_frames(take.frames)
            self.plot.time_axis.set_clock(float(take.rate), take.first_frame)
        row = _row_of(new)
        result = self._bridge.document.result(new.active) if row is not None else None
        proposal = new.proposals.get(new.selection.flag or "") if row is not None else None
        anew = row != self._row or was is None or take is not was.take
        self._row = row
        self.show_hint(row is None)
        if anew or result is not self._result or proposal is not self._proposal:
            self._result, self._proposal = result, proposal
            self._compute()
        if row is not None:
            self.panel.show_row(row, max(len(new.selection.joints) - 1, 0))
        if was is None or new.selection != was.selection or new.queue != was.queue:
            self._under.refresh()
        if was is None or new.sitting is not was.sitting or take is not was.take:
            self._over.refresh()
        if was is None or new.frame != was.frame:
            self.plot.set_frame(new.frame)
            self.time_range.reveal(new.frame)
        self._read_out()

    def _compute(self) -> None:
        """Compute the curves of the row anew."""
        take, row, quantity = self._take, self._row, self.quantity
        if take is None or row is None or quantity is None or self._result is None:
            for role in Role:
                self.curve_set.set(role, None)
            return
        order = _DEFAULT_ORDER
        if row in take.skeleton.index:
            order = euler_order(take, take.skeleton.index[row]) or _DEFAULT_ORDER
        original = curves(take, row, quantity, order=order)
        changed = (
            self._result.rotations is not take.rotations
            or self._result.translations is not take.translations
        )
        result = None
        if changed:
            result = curves(self._result, row, quantity, order=order, near=original.values)
        first, last = (0, 0) if result is None else differing(original, result)
        edited = first < last
        beside = replace(original, values=original.values[first:last]) if edited else original
        self.curve_set.set(Role.ORIGINAL, beside, first)
        self.curve_set.set(Role.RESULT, result if edited else None)
        start, offered = self._offered(row, quantity, order, original)
        self.curve_set.set(Role.PROPOSAL, offered, start)
        self.panel.offer(quantities_of(row), quantity)
        drawn = tuple(r for r in Role if self.curve_set.curves(r) is not None)
        self.panel.legend.set_roles(drawn, original.names)
        self.axis.set_unit(unit_of(quantity))
        self._fit()

    def _offered(
        self, row: str, quantity: Quantity, order: str, original: Curves
    ) -> tuple[int, Curves | None]:
        """Compute the proposal's curves over its own span and a frame on either side."""
        if self._proposal is None or self._result is None:
            return 0, None
        # Only with a proposal at hand is the engine needed, which takes its time to import.
        from mocapstudio.cleaning.proposals import apply

        start = max(self._proposal.start - 1, 0)
        end = min(self._proposal.end + 1, self._result.frames)
        piece = replace(
            self._result,
            rotations=self._result.rotations[start:end],
            translations=self._result.translations[start:end],
            trim=None,
        )
        moved = replace(
            self._proposal, start=self._proposal.start - start, end=self._proposal.end - start
        )
        near = original.values[start:end]
        offered = curves(apply(piece, moved), row, quantity, order=order, near=near)
        # Once accepted it is the result.
        current = curves(piece, row, quantity, order=order, near=near)
        alike = np.allclose(offered.values, current.values, atol=1e-9, equal_nan=True)
        return start, None if alike else offered

    @property
    def _take(self) -> Take | None:
        return self._shown.take if self._shown is not None else None

    def _fit(self) -> None:
        quantity = self.quantity
        if quantity is None:
            return
        least = _LEAST[unit_of(quantity)]
        extent = self.curve_set.extent(self.time_range.start, self.time_range.end, least)
        if extent is not None:
            self.plot.plotItem.vb.setYRange(*extent, padding=0)
        self._under.refresh()

    def _read_out(self) -> None:
        quantity = self.quantity
        role = Role.RESULT if self.curve_set.curves(Role.RESULT) is not None else Role.ORIGINAL
        shown = self.curve_set.curves(role)
        frame = 0 if self._shown is None else self._shown.frame
        values = self.curve_set.value(role, frame)
        if quantity is None or shown is None or values is None:
            self.values.show_values(())
            return
        unit = unit_of(quantity)
        texts = (_written(float(value), unit) for value in values)
        self.values.show_values(tuple(zip(shown.names, texts, strict=True)))

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        self.plot.restyle()
        self.axis.update()
        self.curve_set.restyle()
        self.panel.legend.update()
        self.values.update()

    # -- drawing

    def _draw_under(self, p: QPainter, area: QRectF) -> None:
        look, state = themes.current(), self._shown
        if state is None or self._row is None:
            return
        if state.selection.span is not None:
            chosen = state.selected
            tint = look.accent if chosen is None else look.verdict(chosen.verdict)
            left = self.plot.x_of(state.selection.span[0] - 0.5)
            right = max(self.plot.x_of(state.selection.span[1] - 0.5), left + 2)
            p.fillRect(QRectF(left, area.top(), right - left, area.height()), _veil(tint, 0.13))
            p.setPen(QPen(_veil(tint, 0.55), 1))
            for x in (left, right):
                p.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()))
        low, high = self.plot.plotItem.vb.viewRange()[1]
        for value, _ in self.axis.marks():
            y = area.bottom() - (value - low) / max(high - low, 1e-12) * area.height()
            line = colours.mixed(look.field, look.border, 1.0 if value == 0 else 0.5)
            p.setPen(QPen(line, 1))
            p.drawLine(QPointF(area.left(), y), QPointF(area.right(), y))

    def _draw_over(self, p: QPainter, area: QRectF) -> None:
        state, take = self._shown, self._take
        if state is None or take is None:
            return
        trim = dict(state.sitting.trims).get(state.active, take.trim)
        if trim is None:
            return
        draw_trim(p, area, self.plot.x_of(trim[0] - 0.5), self.plot.x_of(trim[1] - 0.5))

    # -- intents

    def zoom_to_selection(self) -> None:
        """Zoom to the selected span; without one nothing happens."""
        if self._shown is not None and self._shown.selection.span is not None:
            self.time_range.focus(*self._shown.selection.span)

    def _choose(self, quantity: Quantity) -> None:
        if self._row is not None and quantity != self.quantity:
            self._wanted[quantities_of(self._row)] = quantity
            self._compute()
            self._read_out()

    def _sweep(self, begin: QPointF, end: QPointF, _done: bool) -> None:
        span = self.plot.span_between(begin.x(), end.x())
        self._bridge.document.select(span=span, flag="")


def _row_of(state: DocumentState) -> str | None:
    """Return the row whose curves to show: the selected flag's, else the first selected one."""
    take = state.take
    if take is None:
        return None
    chosen = state.selected
    if chosen is not None and has_row(take, chosen.flag.joint):
        return chosen.flag.joint
    every = (*take.skeleton.names, *ROOT_ROWS)
    return next((name for name in every if name in state.selection.joints), None)


def _written(value: float, unit: str) -> str:
    number = f"{value:.{_DECIMALS[unit]}f}".replace("-", "−")
    return number + unit if unit.startswith("°") else f"{number} {unit}"


def _veil(colour: str, alpha: float) -> QColor:
    return colours.faded(colour, alpha)
