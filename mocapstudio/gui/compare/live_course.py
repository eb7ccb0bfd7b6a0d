"""Early and late over the seconds of the action, and what the path costs, as they grow."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen, QPolygonF

from mocapstudio.gui import theme as themes
from mocapstudio.gui.compare import colours as kinds
from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.compare.live_bridge import LiveBridge
from mocapstudio.gui.compare.live_plot import LEFT, Array, LivePlot
from mocapstudio.gui.compare.live_words import timing_kind
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.axes import small_font
from mocapstudio.gui.plots.ticks import value_ticks

_RIGHT = int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
_LEAST_SECONDS = 0.5
_LEAST_COST = 0.05


class _Curve(LivePlot):
    """One curve over the action.

    Parameters
    ----------
    bridge, live
        Where state comes from.
    title
        What it shows.
    """

    def __init__(self, bridge: CompareBridge, live: LiveBridge, title: str) -> None:
        super().__init__(bridge, live, title)
        self.setMinimumHeight(70)

    def _values(self) -> Array:
        raise NotImplementedError

    def _limits(self, values: Array) -> tuple[float, float]:
        raise NotImplementedError

    def _draw_values(self, p: QPainter, points: list[QPointF], values: Array) -> None:
        raise NotImplementedError

    def draw(self, p: QPainter) -> None:
        """Draw marks and curve."""
        look, area = themes.current(), self.area
        values = self._values()
        known = values[np.isfinite(values)]
        low, high = self._limits(known)
        p.setFont(small_font(10))
        scale = area.height() / max(high - low, 1e-9)
        for value, words in value_ticks(low, high, max(2, int(area.height() / 28))):
            y = area.bottom() - (value - low) * scale
            p.setPen(QPen(colours.faded(look.border, 0.7), 1))
            p.drawLine(QPointF(area.left(), y), QPointF(area.right(), y))
            p.setPen(QColor(look.faint))
            p.drawText(QRectF(0, y - 7, LEFT - 5, 14), _RIGHT, words.replace("-", "−"))
        seconds = self.seconds_of_columns()
        x = area.left() + seconds / self.seconds_wide * area.width()
        y_of = area.bottom() - (values - low) * scale
        points = [QPointF(a, b) for a, b in zip(x.tolist(), y_of.tolist(), strict=True)]
        p.save()
        p.setClipRect(area)
        p.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._draw_values(p, points, values)
        p.restore()


class TimingCurve(_Curve):
    """Seconds ahead of the reference, in the colours of early and late."""

    def __init__(self, bridge: CompareBridge, live: LiveBridge) -> None:
        super().__init__(bridge, live, "Early or late, seconds")
        self.setObjectName("live-timing")
        self.setToolTip("Seconds ahead of the reference (above zero) or behind it (below).")

    def _values(self) -> Array:
        history = self._live.shown.history
        return np.zeros(0) if history is None else history.course.misalignment

    def _limits(self, values: Array) -> tuple[float, float]:
        reach = max(_LEAST_SECONDS, 1.1 * float(np.abs(values).max())) if values.size else 0.5
        return -reach, reach

    def _draw_values(self, p: QPainter, points: list[QPointF], values: Array) -> None:
        look, tolerance = themes.current(), self._bridge.state.parameters.tolerance
        middle = self.area.center().y()
        p.setPen(QPen(QColor(look.muted), 1))
        p.drawLine(QPointF(self.area.left(), middle), QPointF(self.area.right(), middle))
        classes = [timing_kind(float(v), tolerance) if np.isfinite(v) else None for v in values]
        begin = 0
        for at in range(1, len(points) + 1):
            if at < len(points) and classes[at] == classes[begin]:
                continue
            kind = classes[begin]
            if kind is not None:
                # Each piece reaches back to the one before, so that no gap is left.
                line = points[max(begin - 1, 0) : at]
                if begin and classes[begin - 1] is None:
                    line = line[1:]
                p.setPen(QPen(kinds.timing(look, kind), 2))
                p.drawPolyline(QPolygonF(line))
            begin = at
        if points and classes[-1] is not None:
            p.setPen(QPen(QColor(look.field), 1))
            p.setBrush(kinds.timing(look, classes[-1]))
            p.drawEllipse(points[-1], 4, 4)


class CostCurve(_Curve):
    """What the path costs a step, and each pose by itself."""

    def __init__(self, bridge: CompareBridge, live: LiveBridge) -> None:
        super().__init__(bridge, live, "Cost of the path (line) and of each pose (area)")
        self.setObjectName("live-cost")
        self.setToolTip(
            "Mean distance of poses along the path so far, and that of each pose from the one it\n"
            "is matched with: 0 is the same pose. High values mean that something else is done."
        )

    def _values(self) -> Array:
        history = self._live.shown.history
        return np.zeros(0) if history is None else history.course.pose_cost

    def _limits(self, values: Array) -> tuple[float, float]:
        high = 1.1 * float(np.percentile(values, 99.5)) if values.size else 0.0
        return 0.0, max(_LEAST_COST, high)

    def _draw_values(self, p: QPainter, points: list[QPointF], values: Array) -> None:
        history, look, area = self._live.shown.history, themes.current(), self.area
        if history is None or not points:
            return
        ground = [QPointF(points[-1].x(), area.bottom()), QPointF(points[0].x(), area.bottom())]
        p.setPen(Qt.PenStyle.NoPen)
        p.setBrush(colours.faded(look.accent, 0.28))
        p.drawPolygon(QPolygonF(points + ground))
        high = self._limits(values[np.isfinite(values)])[1]
        costs = area.bottom() - history.course.cost / high * area.height()
        line = [QPointF(one.x(), y) for one, y in zip(points, costs.tolist(), strict=True)]
        p.setPen(QPen(QColor(look.accent), 1.8))
        p.drawPolyline(QPolygonF(line))
